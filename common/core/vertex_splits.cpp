#include "common/core/vertex_splits.h"

#include <algorithm>
#include <tuple>

#include "common/core/disjoint_sets.h"

namespace meshcomplete {
namespace {

Index next(Index half_edge) { return half_edge % 3 == 2 ? half_edge - 2 : half_edge + 1; }

}  // namespace

std::vector<VertexSplit> split_overlapping_vertices(const TriangleMesh& mesh, const MeshTopology& topology) {
  constexpr Index none = 0xffffffffu;
  const auto vertex = [&](Index corner) { return mesh.triangles[corner / 3][corner % 3]; };
  const auto corners = static_cast<Index>(3 * mesh.triangles.size());
  DisjointSets fans(corners);  // by its least corner
  for (Index h = 0; h < corners; ++h) {
    const Index other = topology.opposite[h];
    if (other >= corners || other < h) continue;
    const bool same_way = vertex(h) == vertex(other);
    fans.unite(h, same_way ? other : next(other));
    fans.unite(next(h), same_way ? next(other) : other);
  }
  std::vector<Index> keeps(mesh.vertices.size(), none);  // the fan that keeps the vertex
  std::vector<std::tuple<Index, Index, Index>> moved;    // vertex, fan, face
  std::size_t skipped = 0;
  for (Index c = 0; c < corners; ++c) {
    const std::vector<Index>& degenerate = topology.degenerate_faces;
    while (skipped < degenerate.size() && degenerate[skipped] < c / 3) ++skipped;
    if (skipped < degenerate.size() && degenerate[skipped] == c / 3) continue;
    const Index fan = fans.root(c), v = vertex(c);
    if (keeps[v] == none) keeps[v] = fan;
    if (keeps[v] != fan) moved.emplace_back(v, fan, c / 3);
  }
  std::sort(moved.begin(), moved.end());
  std::vector<VertexSplit> splits;
  for (std::size_t i = 0; i < moved.size(); ++i) {
    const auto& [v, fan, face] = moved[i];
    if (i == 0 || std::get<0>(moved[i - 1]) != v || std::get<1>(moved[i - 1]) != fan)
      splits.push_back({v, {}});
    splits.back().faces.push_back(face);
  }
  return splits;
}

void apply_splits(TriangleMesh& mesh, const std::vector<VertexSplit>& splits) {
  for (const VertexSplit& split : splits) {
    const auto copy = static_cast<Index>(mesh.vertices.size());
    const Vector3 position = mesh.vertices[split.vertex];
    mesh.vertices.push_back(position);
    for (const Index face : split.faces)
      std::replace(mesh.triangles[face].begin(), mesh.triangles[face].end(), split.vertex, copy);
  }
}

}  // namespace meshcomplete
