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

void smooth_along(const std::vector<Index>& next, std::vector<double>& values) {
  std::vector<double> before(values.size());
  for (int round = 0; round < length_smoothing_rounds; ++round) {
    const std::vector<double> old = values;
    for (std::size_t i = 0; i < values.size(); ++i) before[next[i]] = old[i];
    for (std::size_t i = 0; i < values.size(); ++i)
      values[i] = 0.25 * before[i] + 0.5 * old[i] + 0.25 * old[next[i]];
  }
}

// Chords from a vertex that the loops visit more than once: the same two vertices could be joined at two of
// its places. Chords of many edges' length do not come up.
void forbid_chords(Rim& rim, Index place) {
  constexpr double longest = 16;  // in edges
  const double reach = longest * rim.edge_length[place];
  for (Index other = 0; other < rim.positions.size(); ++other)
    if (other != place && rim.next[place] != other && rim.next[other] != place &&
        (rim.positions[other] - rim.positions[place]).norm() <= reach)
      rim.forbidden.emplace_back(std::min(place, other), std::max(place, other));
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
  return collect_rim(mesh, topology, std::vector<BoundaryLoop>{loop});
}

Rim collect_rim(const TriangleMesh& mesh, const MeshTopology& topology,
                const std::vector<BoundaryLoop>& loops) {
  Rim rim;
  std::unordered_map<Index, Index> number;               // in the ring
  std::unordered_map<Index, std::vector<Index>> places;  // of rim vertices
  std::vector<Index> faces;
  for (const BoundaryLoop& loop : loops) {
    const Index first = static_cast<Index>(rim.positions.size()),
                n = static_cast<Index>(loop.vertices.size());
    for (Index i = 0; i < n; ++i) {
      const Index v = loop.vertices[i];
      number.try_emplace(v, first + i);
      places[v].push_back(first + i);
      rim.positions.push_back(mesh.vertices[v]);
      rim.next.push_back(first + (i + 1) % n);
    }
    const std::vector<Index> ring = ring_faces(mesh, topology, loop);
    faces.insert(faces.end(), ring.begin(), ring.end());
  }
  std::sort(faces.begin(), faces.end());
  faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
  rim.ring.vertices = rim.positions;
  const Index rim_size = static_cast<Index>(rim.positions.size());
  std::vector<double> sum(rim_size, 0.0);
  std::vector<int> count(rim_size, 0);
  for (Index face : faces) {
    const Triangle& t = mesh.triangles[face];
    Triangle corners;
    for (int k = 0; k < 3; ++k) {
      const auto [it, fresh] = number.try_emplace(t[k], static_cast<Index>(rim.ring.vertices.size()));
      if (fresh) rim.ring.vertices.push_back(mesh.vertices[t[k]]);
      corners[k] = it->second;
    }
    rim.ring.triangles.push_back(corners);
    for (int k = 0; k < 3; ++k) {
      const Index v = t[k], w = t[(k + 1) % 3];
      const double length = (mesh.vertices[v] - mesh.vertices[w]).norm();
      const auto at_v = places.find(v), at_w = places.find(w);
      for (const auto& at : {at_v, at_w}) {
        if (at == places.end()) continue;
        for (Index place : at->second) {
          sum[place] += length;
          ++count[place];
        }
      }
      if (at_v == places.end() || at_w == places.end()) continue;
      for (Index a : at_v->second)
        for (Index b : at_w->second)
          if (rim.next[a] != b && rim.next[b] != a)
            rim.forbidden.emplace_back(std::min(a, b), std::max(a, b));
    }
  }
  for (Index v = 0; v < rim_size; ++v) rim.edge_length.push_back(sum[v] / std::max(count[v], 1));
  smooth_along(rim.next, rim.edge_length);
  for (const auto& [vertex, all] : places)
    if (all.size() > 1)
      for (Index place : all) forbid_chords(rim, place);
  std::sort(rim.forbidden.begin(), rim.forbidden.end());
  rim.forbidden.erase(std::unique(rim.forbidden.begin(), rim.forbidden.end()), rim.forbidden.end());
  return rim;
}

}  // namespace meshcomplete
