// Cubes that a patch must not enter when it is smoothed: nothing is known of the surface inside them.
#pragma once

#include <array>
#include <vector>

#include "filter_atomicvolumes/decomposition.h"

namespace meshcomplete {

/// Whether the closed triangle and the open box have a point in common; touching the box does not count. The
/// box may be flat: then it is empty. Exact.
bool enters(const std::array<Vector3, 3>& triangle, const Vector3& low, const Vector3& high);

/// The corners of a cube as the vertices of a patch there will be stored: rounded to floats, so that what
/// touched the cube before rounding touches it after.
struct StoredBox {
  Vector3 low, high;
};
StoredBox stored_box(const LatticeMesh& mesh, const Octree& octree, Index cube);

/// Calls `visit(cube)` for every leaf whose box meets the closed box (and some just beside it), in no
/// particular order. The box must lie in the root. Cost: O(depth) and the leaves there.
template <class Visit>
void visit_leaves(const LatticeMesh& mesh, const Octree& octree, const Box& box, Visit&& visit) {
  // Snapping moves a point by up to two steps.
  LatticeBox around;
  const LatticePoint low = mesh.lattice.snap(Vector3(box.low[0], box.low[1], box.low[2]));
  const LatticePoint high = mesh.lattice.snap(Vector3(box.high[0], box.high[1], box.high[2]));
  for (int k = 0; k < 3; ++k) {
    around.low[k] = low[k] - 2;
    around.high[k] = high[k] + 2;
  }
  const auto descend = [&](const auto& self, Index cube) -> void {
    const LatticePoint& corner = octree[cube].low;
    const std::int64_t side = Octree::side(octree[cube].depth);
    for (int k = 0; k < 3; ++k)
      if (corner[k] + side < around.low[k] || around.high[k] < corner[k]) return;
    if (octree.is_leaf(cube)) {
      visit(cube);
      return;
    }
    for (Index child = 0; child < 8; ++child) self(self, octree[cube].children + child);
  };
  descend(descend, 0);
}

/// The cubes that the mesh divides, and those that are cut into convex cells, near a box: as they will be
/// stored. Cost: O(depth) and the leaves there.
std::vector<StoredBox> rigid_cubes_near(const LatticeMesh& mesh, const Decomposition& decomposition,
                                        const Box& box);

}  // namespace meshcomplete
