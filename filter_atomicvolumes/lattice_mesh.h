// The mesh on the lattice: what every question about cubes and triangles is asked of.
#pragma once

#include <vector>

#include "common/core/lattice.h"
#include "common/core/mesh.h"
#include "common/core/mesh_topology.h"
#include "common/core/patch_check.h"
#include "common/core/triangle_blocks.h"

namespace meshcomplete {

/// Refers to its parts, which must outlive it. Immutable, safe to ask from many threads.
struct LatticeMesh {
  const TriangleMesh& mesh;
  const MeshTopology& topology;
  const InputNeighbourhood& neighbourhood;
  Lattice lattice;

  LatticePoint vertex(Index v) const { return lattice.snap(mesh.vertices[v]); }
  LatticeTriangle triangle(Index t) const {
    const Triangle& corners = mesh.triangles[t];
    return {vertex(corners[0]), vertex(corners[1]), vertex(corners[2])};
  }
  Index origin(Index half_edge) const { return mesh.triangles[half_edge / 3][half_edge % 3]; }
  Index target(Index half_edge) const { return mesh.triangles[half_edge / 3][(half_edge % 3 + 1) % 3]; }

  /// Calls `visit(t, corners)` for every triangle that meets the closed box, in no particular order, until it
  /// returns false. Degenerate triangles are left out. Cost: O(log faces + triangles nearby).
  template <class Visit>
  void triangles_in(const LatticeBox& box, Visit&& visit) const {
    neighbourhood.blocks().visit(lattice.around(box), [&](Index t) {
      const Triangle& corners = mesh.triangles[t];
      if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0]) return true;
      const LatticeTriangle placed = triangle(t);
      return !meets(placed, box) || visit(t, placed);
    });
  }
};

}  // namespace meshcomplete
