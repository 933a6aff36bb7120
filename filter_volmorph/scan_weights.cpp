#include "filter_volmorph/scan_weights.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <utility>

#include "common/core/mesh_topology.h"
#include "common/core/parameter_checks.h"

namespace meshcomplete {
namespace {

/// What is left of the weight at the boundary, and of the cosine where it is grazing or, at a crease, the
/// vertex' normal looks away.
constexpr double least_factor = 0.05;

/// Who is joined to a vertex by an edge: `to[first[v]]` up to `to[first[v + 1]]`, with repetitions.
struct Neighbours {
  std::vector<std::size_t> first;
  std::vector<Index> to;
};

Neighbours neighbours(const TriangleMesh& mesh) {
  Neighbours result;
  result.first.assign(mesh.vertices.size() + 2, 0);
  for (const Triangle& t : mesh.triangles)
    for (const Index v : t) result.first[v + 2] += 2;
  for (std::size_t i = 2; i < result.first.size(); ++i) result.first[i] += result.first[i - 1];
  result.to.resize(6 * mesh.triangles.size());
  for (const Triangle& t : mesh.triangles) {
    for (int k = 0; k < 3; ++k) {
      result.to[result.first[t[k] + 1]++] = t[(k + 1) % 3];
      result.to[result.first[t[k] + 1]++] = t[(k + 2) % 3];
    }
  }
  return result;
}

/// Distances along edges to the boundary, those beyond `reach` infinite (Dijkstra).
std::vector<double> boundary_distances(const TriangleMesh& mesh, double reach) {
  const MeshTopology topology = build_topology(mesh);
  const Neighbours edges = neighbours(mesh);
  std::vector<double> distance(mesh.vertices.size(), std::numeric_limits<double>::infinity());
  using Entry = std::pair<double, Index>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<Entry>> queue;
  const auto start_at = [&](const std::vector<Index>& half_edges) {
    for (const Index h : half_edges) {
      for (const Index v : {mesh.triangles[h / 3][h % 3], mesh.triangles[h / 3][(h % 3 + 1) % 3]}) {
        if (distance[v] == 0) continue;
        distance[v] = 0;
        queue.emplace(0.0, v);
      }
    }
  };
  start_at(topology.boundary_half_edges);
  start_at(topology.non_manifold_half_edges);
  while (!queue.empty()) {
    const auto [near, v] = queue.top();
    queue.pop();
    if (near > distance[v]) continue;
    for (std::size_t i = edges.first[v]; i < edges.first[v + 1]; ++i) {
      const Index w = edges.to[i];
      const double way = near + (mesh.vertices[w] - mesh.vertices[v]).norm();
      if (way >= distance[w] || way > reach) continue;
      distance[w] = way;
      queue.emplace(way, w);
    }
  }
  return distance;
}

}  // namespace

void check_options(const ScanWeightOptions& options) {
  require(std::isfinite(options.grazing_power) && options.grazing_power >= 0,
          "The power of the grazing angle's weight must be at least 0.");
  require(std::isfinite(options.boundary_falloff) && options.boundary_falloff >= 0,
          "The distance over which weights fall towards a scan's boundary must be at least 0.");
}

ScanWeights weigh_scan(const TriangleMesh& scan, const LineOfSight& line_of_sight,
                       const ScanWeightOptions& options) {
  check_options(options);
  std::vector<Vector3> normals(scan.vertices.size(), Vector3::Zero());
  for (const Triangle& t : scan.triangles) {
    const Vector3& a = scan.vertices[t[0]];
    const Vector3 normal = (scan.vertices[t[1]] - a).cross(scan.vertices[t[2]] - a);
    for (const Index v : t) normals[v] += normal;
  }
  std::vector<double> distances;
  if (options.boundary_falloff > 0) distances = boundary_distances(scan, options.boundary_falloff);
  ScanWeights result;
  result.normals.resize(scan.vertices.size(), Eigen::Vector3f::Zero());
  result.weights.resize(scan.vertices.size(), 0);
  for (std::size_t v = 0; v < scan.vertices.size(); ++v) {
    const double length = normals[v].norm();
    if (!(length > 0)) continue;
    const Vector3 normal = normals[v] / length;
    result.normals[v] = normal.cast<float>();
    const double cosine = normal.dot(line_of_sight.towards_sensor(scan.vertices[v]));
    double weight = std::pow(std::max(least_factor, cosine), options.grazing_power);
    if (!distances.empty()) {
      weight *= std::max(least_factor, std::min(1.0, distances[v] / options.boundary_falloff));
    }
    result.weights[v] = static_cast<float>(weight);
  }
  return result;
}

}  // namespace meshcomplete
