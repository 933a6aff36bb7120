#include "common/core/rim.h"

#include <algorithm>
#include <unordered_map>

#include "common/core/triangle_blocks.h"
#include "common/core/triangle_intersection.h"

namespace meshcomplete {
namespace {

// Rounds of averaging the edge lengths along the rim: a single long edge should not make a coarse spot.
constexpr int length_smoothing_rounds = 3;

// The faces round `pivot` from `face` on, in one sense of turning, until the fan ends.
void turn(const TriangleMesh& mesh, const MeshTopology& topology, Index pivot, Index face, bool forward,
          std::vector<Index>& faces) {
  const Index start = face;
  for (;;) {
    faces.push_back(face);
    const Triangle& t = mesh.triangles[face];
    const Index k = static_cast<Index>(std::find(t.begin(), t.end(), pivot) - t.begin());
    const Index side = 3 * face + (forward ? (k + 2) % 3 : k);
    const Index opposite = topology.opposite[side];
    if (opposite >= MeshTopology::non_manifold || opposite / 3 == start) return;
    face = opposite / 3;
  }
}

std::vector<Index> ring_faces(const TriangleMesh& mesh, const MeshTopology& topology,
                              const BoundaryLoop& loop) {
  std::vector<Index> faces;
  const std::size_t n = loop.vertices.size();
  for (std::size_t i = 0; i < n; ++i)
    for (Index face : {loop.faces[i], loop.faces[(i + n - 1) % n]})
      for (bool forward : {true, false}) turn(mesh, topology, loop.vertices[i], face, forward, faces);
  std::sort(faces.begin(), faces.end());
  faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
  return faces;
}

void smooth_cyclic(std::vector<double>& values) {
  const std::size_t n = values.size();
  for (int round = 0; round < length_smoothing_rounds; ++round) {
    const std::vector<double> old = values;
    for (std::size_t i = 0; i < n; ++i)
      values[i] = 0.25 * old[(i + n - 1) % n] + 0.5 * old[i] + 0.25 * old[(i + 1) % n];
  }
}

}  // namespace

bool is_obstructed(const InputNeighbourhood& input, const Vector3& a, const Vector3& b) {
  const TriangleMesh& mesh = input.mesh();
  const Box segment = bounding_box(a, b, b);
  bool obstructed = false;
  input.blocks().visit(segment, [&](Index triangle) {
    const Triangle& t = mesh.triangles[triangle];
    const std::array<Vector3, 3> corners = {mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]};
    for (const Vector3& corner : corners)
      if (corner == a || corner == b) return true;
    obstructed = !collinear(corners[0], corners[1], corners[2]) && segment_meets_triangle(a, b, corners);
    return !obstructed;
  });
  return obstructed;
}

std::vector<Index> obstructed_edges(const InputNeighbourhood& input, const BoundaryLoop& loop) {
  const std::vector<Vector3>& vertices = input.mesh().vertices;
  std::vector<Index> edges;
  for (Index i = 0; i < loop.vertices.size(); ++i)
    if (is_obstructed(input, vertices[loop.vertices[i]],
                      vertices[loop.vertices[(i + 1) % loop.vertices.size()]]))
      edges.push_back(i);
  return edges;
}

Rim collect_rim(const TriangleMesh& mesh, const MeshTopology& topology, const BoundaryLoop& loop) {
  Rim rim;
  const Index n = static_cast<Index>(loop.vertices.size());
  std::unordered_map<Index, Index> number;  // in the ring
  const auto local = [&](Index v) {
    const auto [it, fresh] = number.try_emplace(v, static_cast<Index>(rim.ring.vertices.size()));
    if (fresh) rim.ring.vertices.push_back(mesh.vertices[v]);
    return it->second;
  };
  for (Index v : loop.vertices) local(v);
  rim.positions = rim.ring.vertices;

  std::vector<double> sum(n, 0.0);
  std::vector<int> count(n, 0);
  for (Index face : ring_faces(mesh, topology, loop)) {
    const Triangle& t = mesh.triangles[face];
    const Triangle corners = {local(t[0]), local(t[1]), local(t[2])};
    rim.ring.triangles.push_back(corners);
    for (int k = 0; k < 3; ++k) {
      const Index a = corners[k], b = corners[(k + 1) % 3];
      const double length = (rim.ring.vertices[a] - rim.ring.vertices[b]).norm();
      for (Index v : {a, b})
        if (v < n) {
          sum[v] += length;
          ++count[v];
        }
      const bool neighbours = (a + 1) % n == b || (b + 1) % n == a;
      if (a < n && b < n && !neighbours) rim.forbidden.emplace_back(std::min(a, b), std::max(a, b));
    }
  }
  std::sort(rim.forbidden.begin(), rim.forbidden.end());
  rim.forbidden.erase(std::unique(rim.forbidden.begin(), rim.forbidden.end()), rim.forbidden.end());
  for (Index v = 0; v < n; ++v) rim.edge_length.push_back(sum[v] / std::max(count[v], 1));
  smooth_cyclic(rim.edge_length);
  return rim;
}

}  // namespace meshcomplete
