#include "common/core/patch_fairing.h"

#include <algorithm>

namespace meshcomplete {
namespace {

// The patch's triangles, followed by the ring's.
TriangleMesh with_ring(const PatchMesh& patch, const Rim& rim, std::vector<char>& fixed) {
  const Index rim_size = static_cast<Index>(patch.rim_size());
  TriangleMesh surface{patch.positions(), patch.triangles()};
  const Index offset = static_cast<Index>(surface.vertices.size()) - rim_size;
  surface.vertices.insert(surface.vertices.end(), rim.ring.vertices.begin() + rim_size,
                          rim.ring.vertices.end());
  for (Triangle t : rim.ring.triangles) {
    for (Index& corner : t)
      if (corner >= rim_size) corner += offset;
    surface.triangles.push_back(t);
  }
  fixed.assign(surface.vertices.size(), 1);
  std::fill(fixed.begin() + rim_size, fixed.begin() + static_cast<std::ptrdiff_t>(patch.vertex_count()), 0);
  return surface;
}

void move_inner(PatchMesh& patch, const TriangleMesh& surface) {
  for (Index v = static_cast<Index>(patch.rim_size()); v < patch.vertex_count(); ++v)
    patch.move(v, surface.vertices[v]);
}

}  // namespace

void fair(PatchMesh& patch, const Rim& rim, SurfaceEnergy energy, LaplacianWeights weights,
          const Progress& progress) {
  std::vector<char> fixed;
  TriangleMesh surface = with_ring(patch, rim, fixed);
  minimize_energy(surface, fixed, energy, weights, progress);
  move_inner(patch, surface);
}

void fair_near(PatchMesh& patch, const Rim& rim, double largest_move, const Progress& progress) {
  std::vector<char> fixed;
  TriangleMesh surface = with_ring(patch, rim, fixed);
  lower_normal_variation(surface, fixed, largest_move, progress);
  move_inner(patch, surface);
}

}  // namespace meshcomplete
