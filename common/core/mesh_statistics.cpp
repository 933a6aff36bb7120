#include "common/core/mesh_statistics.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>
#include <tbb/parallel_sort.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <atomic>
#include <sstream>
#include <utility>

#include "common/core/disjoint_sets.h"
#include "common/core/mesh_topology.h"
#include "common/core/triangle_intersection.h"

namespace meshcomplete {
namespace {

Index next(Index half_edge) { return half_edge % 3 == 2 ? half_edge - 2 : half_edge + 1; }

/// Everything that follows from which faces use which vertices. Corner h is the corner from which half-edge h
/// leaves.
class Combinatorics {
 public:
  Combinatorics(const TriangleMesh& mesh, const MeshTopology& topology)
      : mesh_(mesh),
        topology_(topology),
        skipped_(mesh.triangles.size(), 0),
        fans_(3 * mesh.triangles.size()) {
    for (Index f : topology.degenerate_faces) skipped_[f] = 1;
  }

  void count(MeshStatistics& s) {
    count_edges(s);
    count_fans(s);
    count_components(s);
    count_boundary_loops(s);
    s.orientable = is_orientable();
    if (s.orientable && s.non_manifold_edges == 0) {
      // Euler's formula for the capped surface, a vertex counted once for every fan; summed over the
      // components.
      const long long faces = static_cast<long long>(s.faces - topology_.degenerate_faces.size());
      const long long euler = fan_count_ - static_cast<long long>(edges_) + faces;
      const long long capped = euler + static_cast<long long>(s.boundary_loops.size());
      s.genus = static_cast<long long>(s.components) - capped / 2;
    }
  }

 private:
  Index from(Index h) const { return mesh_.triangles[h / 3][h % 3]; }
  Index to(Index h) const { return from(next(h)); }
  Index corner_at(Index h, Index vertex) const { return from(h) == vertex ? h : next(h); }
  bool paired(Index h) const { return topology_.opposite[h] < topology_.opposite.size(); }

  void count_edges(MeshStatistics& s);
  void count_fans(MeshStatistics& s);
  void count_components(MeshStatistics& s);
  void count_boundary_loops(MeshStatistics& s);
  bool is_orientable() const;

  const TriangleMesh& mesh_;
  const MeshTopology& topology_;
  std::vector<char> skipped_;  ///< faces with a repeated corner
  std::vector<Index>
      beyond_;  ///< half-edges at edges with three or more faces, those of an edge side by side
  std::vector<std::size_t> beyond_first_;  ///< where each such edge begins in `beyond_`, and the end
  DisjointSets fans_;                      ///< of corners
  std::size_t edges_ = 0;
  long long fan_count_ = 0;
};

void Combinatorics::count_edges(MeshStatistics& s) {
  std::size_t paired_half_edges = 0;
  for (Index h = 0; h < topology_.opposite.size(); ++h) {
    if (!paired(h)) continue;
    ++paired_half_edges;
    if (from(h) == from(topology_.opposite[h])) ++s.inconsistent_edges;
  }
  s.inconsistent_edges /= 2;
  s.boundary_edges = topology_.boundary_half_edges.size();

  const auto key = [&](Index h) {
    return std::make_pair(std::min(from(h), to(h)), std::max(from(h), to(h)));
  };
  beyond_ = topology_.non_manifold_half_edges;
  std::sort(beyond_.begin(), beyond_.end(),
            [&](Index a, Index b) { return key(a) != key(b) ? key(a) < key(b) : a < b; });
  for (std::size_t i = 0; i < beyond_.size(); ++i)
    if (i == 0 || key(beyond_[i]) != key(beyond_[i - 1])) beyond_first_.push_back(i);
  s.non_manifold_edges = beyond_first_.size();
  beyond_first_.push_back(beyond_.size());
  edges_ = paired_half_edges / 2 + s.boundary_edges + s.non_manifold_edges;
}

void Combinatorics::count_fans(MeshStatistics& s) {
  const auto join = [&](Index h, Index g) {
    fans_.unite(corner_at(h, from(h)), corner_at(g, from(h)));
    fans_.unite(corner_at(h, to(h)), corner_at(g, to(h)));
  };
  for (Index h = 0; h < topology_.opposite.size(); ++h)
    if (paired(h) && h < topology_.opposite[h]) join(h, topology_.opposite[h]);
  for (std::size_t e = 0; e + 1 < beyond_first_.size(); ++e)
    for (std::size_t i = beyond_first_[e] + 1; i < beyond_first_[e + 1]; ++i)
      join(beyond_[i - 1], beyond_[i]);

  std::vector<char> fans_at(mesh_.vertices.size(), 0);  // 2 stands for more than one
  for (Index h = 0; h < topology_.opposite.size(); ++h) {
    if (skipped_[h / 3] || fans_.root(h) != h) continue;
    ++fan_count_;
    char& fans = fans_at[from(h)];
    if (++fans == 2) ++s.non_manifold_vertices;
    fans = std::min<char>(fans, 2);
  }
}

void Combinatorics::count_components(MeshStatistics& s) {
  DisjointSets faces(mesh_.triangles.size());
  for (Index h = 0; h < topology_.opposite.size(); ++h)
    if (paired(h)) faces.unite(h / 3, topology_.opposite[h] / 3);
  for (std::size_t e = 0; e + 1 < beyond_first_.size(); ++e)
    for (std::size_t i = beyond_first_[e] + 1; i < beyond_first_[e + 1]; ++i)
      faces.unite(beyond_[i - 1] / 3, beyond_[i] / 3);
  for (Index f = 0; f < mesh_.triangles.size(); ++f) s.components += !skipped_[f] && faces.root(f) == f;
}

/// Boundary edges that end at one fan belong to one loop.
void Combinatorics::count_boundary_loops(MeshStatistics& s) {
  const std::vector<Index>& boundary = topology_.boundary_half_edges;
  std::vector<std::pair<Index, Index>> ends;  // fan, number of the boundary edge
  for (Index i = 0; i < boundary.size(); ++i) {
    ends.emplace_back(fans_.root(boundary[i]), i);
    ends.emplace_back(fans_.root(next(boundary[i])), i);
  }
  std::sort(ends.begin(), ends.end());
  DisjointSets loops(boundary.size());
  for (std::size_t i = 1; i < ends.size(); ++i)
    if (ends[i].first == ends[i - 1].first) loops.unite(ends[i].second, ends[i - 1].second);
  std::vector<std::size_t> edges(boundary.size(), 0);
  for (Index i = 0; i < boundary.size(); ++i) ++edges[loops.root(i)];
  for (std::size_t count : edges)
    if (count > 0) s.boundary_loops.push_back(count);
  std::sort(s.boundary_loops.rbegin(), s.boundary_loops.rend());
}

/// Whether the faces can be turned so that across every edge of two faces both agree.
bool Combinatorics::is_orientable() const {
  std::vector<char> turned(mesh_.triangles.size(), 2);  // 2: not reached yet
  std::vector<Index> flood;
  for (Index start = 0; start < turned.size(); ++start) {
    if (turned[start] != 2) continue;
    turned[start] = 0;
    flood.push_back(start);
    while (!flood.empty()) {
      const Index f = flood.back();
      flood.pop_back();
      for (Index h = 3 * f; h < 3 * f + 3; ++h) {
        if (!paired(h)) continue;
        const Index g = topology_.opposite[h];
        const char wanted = static_cast<char>(turned[f] ^ static_cast<char>(from(h) == from(g)));
        if (turned[g / 3] == 2) {
          turned[g / 3] = wanted;
          flood.push_back(g / 3);
        } else if (turned[g / 3] != wanted) {
          return false;
        }
      }
    }
  }
  return true;
}

void count_duplicate_faces(const TriangleMesh& mesh, const MeshTopology& topology, MeshStatistics& s) {
  std::vector<Triangle> sorted;
  sorted.reserve(mesh.triangles.size());
  std::size_t next_skipped = 0;
  for (Index f = 0; f < mesh.triangles.size(); ++f) {
    if (next_skipped < topology.degenerate_faces.size() && topology.degenerate_faces[next_skipped] == f) {
      ++next_skipped;
      continue;
    }
    sorted.push_back(mesh.triangles[f]);
    std::sort(sorted.back().begin(), sorted.back().end());
  }
  tbb::parallel_sort(sorted.begin(), sorted.end());
  for (std::size_t i = 1; i < sorted.size(); ++i) s.duplicate_faces += sorted[i] == sorted[i - 1];
}

void count_vertices(const TriangleMesh& mesh, MeshStatistics& s) {
  std::vector<char> used(mesh.vertices.size(), 0);
  for (const Triangle& triangle : mesh.triangles)
    for (Index v : triangle) used[v] = 1;
  std::vector<std::array<double, 3>> places;
  places.reserve(mesh.vertices.size());
  Vector3 sum = Vector3::Zero();
  for (std::size_t v = 0; v < used.size(); ++v) {
    if (!used[v]) {
      ++s.unreferenced_vertices;
      continue;
    }
    const Vector3& p = mesh.vertices[v];
    sum += p;
    if (p.allFinite()) places.push_back({p.x(), p.y(), p.z()});
  }
  tbb::parallel_sort(places.begin(), places.end());
  for (std::size_t i = 1; i < places.size(); ++i) s.duplicated_vertices += places[i] == places[i - 1];

  // About the mean vertex, so that far from the origin the digits are not lost.
  const std::size_t count = used.size() - s.unreferenced_vertices;
  const Vector3 mean = count ? Vector3(sum / static_cast<double>(count)) : sum;
  for (const auto& [a, b, c] : mesh.triangles)
    s.volume += (mesh.vertices[a] - mean).dot((mesh.vertices[b] - mean).cross(mesh.vertices[c] - mean)) / 6;
}

std::vector<std::array<Vector3, 3>> corners_of(const TriangleMesh& mesh) {
  std::vector<std::array<Vector3, 3>> corners(mesh.triangles.size());
  for (std::size_t f = 0; f < corners.size(); ++f)
    for (int k = 0; k < 3; ++k) corners[f][k] = mesh.vertices[mesh.triangles[f][k]];
  return corners;
}

/// Faces without area, those with a corner that is not finite among them: neither has a normal.
std::size_t count_degenerate_faces(const TriangleMesh& mesh) {
  std::atomic<std::size_t> count{0};
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, mesh.triangles.size(), 4096), [&](const auto& range) {
    std::size_t here = 0;
    for (std::size_t f = range.begin(); f != range.end(); ++f) {
      const auto& [a, b, c] = mesh.triangles[f];
      const Vector3 &p = mesh.vertices[a], &q = mesh.vertices[b], &r = mesh.vertices[c];
      here += !p.allFinite() || !q.allFinite() || !r.allFinite() || collinear(p, q, r);
    }
    count += here;
  });
  return count;
}

const char* yes_or_no(bool value) { return value ? "yes" : "no"; }

}  // namespace

bool MeshStatistics::watertight() const {
  return faces > 0 && boundary_edges == 0 && non_manifold_edges == 0 && inconsistent_edges == 0;
}

bool MeshStatistics::manifold() const { return non_manifold_edges == 0 && non_manifold_vertices == 0; }

bool MeshStatistics::solid() const {
  return watertight() && manifold() && degenerate_faces == 0 && duplicate_faces == 0 &&
         self_intersecting_pairs == std::size_t{0} && volume > 0;
}

MeshStatistics measure(const TriangleMesh& mesh, bool count_intersections, const Progress& progress) {
  MeshStatistics s;
  s.vertices = mesh.vertices.size();
  s.faces = mesh.triangles.size();
  const double combinatorics_done = count_intersections ? 0.5 : 1.0;
  const MeshTopology topology = build_topology(mesh, progress.part(0, 0.3 * combinatorics_done, "edges"));
  // Each writes its own members of the statistics.
  tbb::parallel_invoke([&] { Combinatorics(mesh, topology).count(s); },
                       [&] {
                         count_duplicate_faces(mesh, topology, s);
                         count_vertices(mesh, s);
                         s.degenerate_faces = count_degenerate_faces(mesh);
                       });
  progress.update(combinatorics_done);
  if (count_intersections) {
    s.self_intersecting_pairs = count_improper_pairs(corners_of(mesh), progress);
    progress.update(1);
  }
  return s;
}

std::vector<std::string> describe(const MeshStatistics& s) {
  std::vector<std::string> lines;
  const auto add = [&](const auto&... parts) {
    std::ostringstream line;
    (line << ... << parts);
    lines.push_back(line.str());
  };
  add("Vertices: ", s.vertices, ", of which ", s.unreferenced_vertices, " belong to no face and ",
      s.duplicated_vertices, " lie where another one is");
  add("Faces: ", s.faces, ", of which ", s.degenerate_faces, " have no area and ", s.duplicate_faces,
      " have the corners of another one");
  add("Connected components: ", s.components);
  std::ostringstream loops;
  constexpr std::size_t most_listed = 20;
  for (std::size_t i = 0; i < std::min(s.boundary_loops.size(), most_listed); ++i)
    loops << (i ? ", " : " (edges: ") << s.boundary_loops[i];
  if (!s.boundary_loops.empty()) loops << (s.boundary_loops.size() > most_listed ? ", ...)" : ")");
  add("Boundary edges: ", s.boundary_edges);
  add("Boundary loops: ", s.boundary_loops.size(), loops.str());
  add("Non-manifold edges: ", s.non_manifold_edges);
  add("Non-manifold vertices: ", s.non_manifold_vertices);
  add("Orientation: ", s.inconsistent_edges == 0
                           ? "consistent"
                           : std::to_string(s.inconsistent_edges) +
                                 " edges where the two faces disagree which side is the front");
  add("Orientable: ", yes_or_no(s.orientable));
  if (s.genus)
    add("Genus: ", *s.genus);
  else
    add("Genus: undefined, because ",
        s.orientable ? "edges have more than two faces" : "the surface is not orientable");
  if (s.self_intersecting_pairs)
    add("Self-intersecting pairs of faces: ", *s.self_intersecting_pairs);
  else
    add("Self-intersecting pairs of faces: not counted");
  add("Watertight: ", yes_or_no(s.watertight()));
  if (s.watertight()) add("Volume: ", s.volume);
  if (s.self_intersecting_pairs) add("Solid: ", yes_or_no(s.solid()));
  return lines;
}

}  // namespace meshcomplete
