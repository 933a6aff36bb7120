#include "filter_volmorph/rim_fan.h"

namespace meshcomplete {

Patch rim_fan(const TriangleMesh& mesh, const BoundaryLoop& loop) {
  Patch patch;
  patch.input_vertices = static_cast<Index>(mesh.vertices.size());
  const std::size_t edges = loop.vertices.size();
  Vector3 sum = Vector3::Zero();
  for (const Index v : loop.vertices) sum += mesh.vertices[v];
  patch.vertices.push_back(as_stored(sum / static_cast<double>(edges)));
  for (std::size_t i = 0; i < edges; ++i)
    patch.triangles.push_back({loop.vertices[i], loop.vertices[(i + 1) % edges], patch.input_vertices});
  return patch;
}

}  // namespace meshcomplete
