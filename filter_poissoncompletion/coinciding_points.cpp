#include "filter_poissoncompletion/coinciding_points.h"

#include <algorithm>
#include <numeric>
#include <tuple>
#include <utility>

namespace meshcomplete {

std::vector<Index> first_at_position(const std::vector<Vector3>& points) {
  std::vector<Index> order(points.size()), first(points.size());
  std::iota(order.begin(), order.end(), Index(0));
  std::sort(order.begin(), order.end(), [&](Index a, Index b) {
    const Vector3 &p = points[a], &q = points[b];
    return std::tie(p[0], p[1], p[2], a) < std::tie(q[0], q[1], q[2], b);
  });
  for (std::size_t k = 0; k < order.size(); ++k) {
    const bool again = k > 0 && points[order[k - 1]] == points[order[k]];
    first[order[k]] = again ? first[order[k - 1]] : order[k];
  }
  return first;
}

std::unique_ptr<MergedRims> merge_rims(const TriangleMesh& mesh, const MeshTopology& topology) {
  std::vector<Index> vertices;
  for (Index h : topology.boundary_half_edges)
    for (Index k : {h % 3, (h + 1) % 3}) vertices.push_back(mesh.triangles[h / 3][k]);
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  std::vector<Vector3> points;
  for (Index v : vertices) points.push_back(mesh.vertices[v]);
  const std::vector<Index> first = first_at_position(points);
  std::vector<Index> name(mesh.vertices.size());
  std::iota(name.begin(), name.end(), Index(0));
  bool any = false;
  for (std::size_t i = 0; i < first.size(); ++i) {
    any |= first[i] != i;
    name[vertices[i]] = vertices[first[i]];
  }
  if (!any) return nullptr;
  auto merged = std::make_unique<MergedRims>();
  merged->mesh = mesh;
  for (Triangle& t : merged->mesh.triangles)
    for (Index& v : t) v = name[v];
  merged->topology = build_topology(merged->mesh);
  return merged;
}

}  // namespace meshcomplete
