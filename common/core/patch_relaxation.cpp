#include "common/core/patch_relaxation.h"

namespace meshcomplete {
namespace {

// The inner vertices within `rings` edges of the triangles' corners, nearest first.
std::vector<Index> vertices_around(const PatchMesh& patch, const std::vector<Index>& triangles, int rings) {
  std::vector<char> reached(patch.vertex_count(), 0);
  std::vector<Index> vertices;
  const auto reach = [&](Index v) {
    if (reached[v]) return;
    reached[v] = 1;
    vertices.push_back(v);
  };
  for (Index t : triangles)
    for (Index corner : patch.triangles()[t]) reach(corner);
  std::size_t first = 0;
  for (int ring = 0; ring < rings; ++ring) {
    const std::size_t last = vertices.size();
    for (; first < last; ++first) patch.for_neighbours(vertices[first], reach);
  }
  std::vector<Index> inner;
  for (Index v : vertices)
    if (!patch.on_rim(v)) inner.push_back(v);
  return inner;
}

}  // namespace

void relax_around(PatchMesh& patch, const std::vector<Index>& tangled, int rings, int sweeps) {
  const std::vector<Index> vertices = vertices_around(patch, tangled, rings);
  for (int sweep = 0; sweep < sweeps; ++sweep)
    for (Index v : vertices) {
      Vector3 sum = Vector3::Zero();
      double count = 0;
      patch.for_neighbours(v, [&](Index neighbour) {
        sum += patch.position(neighbour);
        ++count;
      });
      patch.move(v, sum / count);
    }
}

}  // namespace meshcomplete
