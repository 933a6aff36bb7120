#include "benchmarks/cut_holes.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include "common/core/patch.h"
#include "filter_curveunfold/loop_geometry.h"

namespace meshcomplete {
namespace benchmarks {
namespace {

constexpr double pi = 3.14159265358979323846;

double uniform(std::mt19937& random) { return random() * 0x1p-32; }

std::uint64_t edge_key(Index from, Index to) { return std::uint64_t{from} << 32 | to; }

/// A mesh to cut from.
class Cutter {
 public:
  explicit Cutter(const TriangleMesh& mesh)
      : mesh_(mesh), faces_(mesh.vertices.size()), normals_(mesh.vertices.size(), Vector3::Zero()) {
    for (Index f = 0; f < mesh.triangles.size(); ++f) {
      const Triangle& t = mesh.triangles[f];
      const Vector3 normal =
          (mesh.vertices[t[1]] - mesh.vertices[t[0]]).cross(mesh.vertices[t[2]] - mesh.vertices[t[0]]);
      for (Index corner : t) {
        faces_[corner].push_back(f);
        normals_[corner] += normal;
      }
    }
    for (Vector3& normal : normals_) normal.normalize();
  }

  /// Vertices that faces use and that lie in the region.
  std::vector<Index> inside(const Region& region) const {
    std::vector<Index> list;
    for (Index v = 0; v < faces_.size(); ++v)
      if (!faces_[v].empty() &&
          (region.radius <= 0 || (mesh_.vertices[v] - region.centre).norm() <= region.radius))
        list.push_back(v);
    return list;
  }

  std::vector<Index> neighbours(Index v) const {
    std::vector<Index> list;
    for (Index f : faces_[v])
      for (Index corner : mesh_.triangles[f])
        if (corner != v && std::find(list.begin(), list.end(), corner) == list.end()) list.push_back(corner);
    return list;
  }

  const std::vector<Index>& faces(Index v) const { return faces_[v]; }
  const Vector3& normal(Index v) const { return normals_[v]; }
  const TriangleMesh& mesh() const { return mesh_; }

 private:
  const TriangleMesh& mesh_;
  std::vector<std::vector<Index>> faces_;
  std::vector<Vector3> normals_;
};

/// Faces that are to be cut away, and the half-edges that they border the rest with.
class Cut {
 public:
  explicit Cut(const Cutter& cutter) : cutter_(cutter) {}

  void add(Index face) {
    if (!faces_.insert(face).second) return;
    const Triangle& t = cutter_.mesh().triangles[face];
    for (int k = 0; k < 3; ++k) {
      const Index from = t[k], to = t[(k + 1) % 3];
      if (!border_.erase(edge_key(to, from))) border_.insert(edge_key(from, to));
    }
  }

  void add_round(Index vertex, int rings) {
    for (Index face : cutter_.faces(vertex)) {
      add(face);
      if (rings > 1)
        for (Index corner : cutter_.mesh().triangles[face])
          if (corner != vertex) add_round(corner, rings - 1);
    }
  }

  std::size_t border() const { return border_.size(); }
  bool has(Index face) const { return faces_.count(face) > 0; }

  /// The vertices of the rim in order, in the direction of the faces cut away. None if that is not one cycle
  /// which bounds a disk of the cut, or if it touches a boundary.
  std::optional<std::vector<Index>> rim() const {
    std::unordered_map<Index, Index> next;
    for (std::uint64_t key : border_)
      if (!next.emplace(static_cast<Index>(key >> 32), static_cast<Index>(key)).second) return std::nullopt;
    if (next.empty()) return std::nullopt;
    std::vector<Index> cycle = {std::min_element(next.begin(), next.end())->first};
    for (Index v = next.at(cycle[0]); v != cycle[0]; v = next.at(v)) {
      cycle.push_back(v);
      if (cycle.size() > next.size() || next.count(v) == 0) return std::nullopt;
    }
    if (cycle.size() != next.size()) return std::nullopt;
    std::unordered_set<Index> vertices;
    for (Index face : faces_)
      for (Index corner : cutter_.mesh().triangles[face]) vertices.insert(corner);
    // A disk: V - E + F = 1, with 2 E = 3 F + rim.
    if (2 * vertices.size() + 2 * faces_.size() != 3 * faces_.size() + cycle.size() + 2) return std::nullopt;
    for (Index v : cycle)
      if (cutter_.faces(v).size() != cutter_.neighbours(v).size()) return std::nullopt;
    return cycle;
  }

  TriangleMesh rest() const {
    const TriangleMesh& mesh = cutter_.mesh();
    TriangleMesh rest;
    std::vector<Index> number(mesh.vertices.size(), no_number);
    for (Index f = 0; f < mesh.triangles.size(); ++f) {
      if (has(f)) continue;
      Triangle t = mesh.triangles[f];
      for (Index& corner : t) {
        if (number[corner] == no_number) {
          number[corner] = static_cast<Index>(rest.vertices.size());
          rest.vertices.push_back(mesh.vertices[corner]);
        }
        corner = number[corner];
      }
      rest.triangles.push_back(t);
    }
    return rest;
  }

 private:
  static constexpr Index no_number = 0xffffffffu;

  const Cutter& cutter_;
  std::unordered_set<Index> faces_;
  std::unordered_set<std::uint64_t> border_;
};

std::vector<Vector3> positions(const TriangleMesh& mesh, const std::vector<Index>& vertices) {
  std::vector<Vector3> list;
  for (Index v : vertices) list.push_back(mesh.vertices[v]);
  return list;
}

bool is_like(const std::vector<Vector3>& rim, Rim wanted) {
  if (wanted == Rim::any) return true;
  return !simple_projection(rim, wanted == Rim::overlapping ? 48 : 0);
}

/// Follows a winding path until the rim is as long as wanted; returns the rim if it is as wanted.
std::optional<std::vector<Index>> wind(const Cutter& cutter, const std::vector<Index>& starts,
                                       std::size_t size, int rings, std::uint32_t seed, Cut& cut) {
  std::mt19937 random(seed);
  Index at = starts[random() % starts.size()];
  const double swing = 2.5 * uniform(random);        // radians to each side
  const double waves = 0.5 + 2.5 * uniform(random);  // along the whole path
  const double phase = 2 * pi * uniform(random);
  const double bend = (uniform(random) - 0.5) * 2 * pi;  // of the path as a whole
  const double steps = 0.5 * static_cast<double>(size);  // about
  Vector3 direction = cutter.normal(at).unitOrthogonal();
  direction = Eigen::AngleAxisd(2 * pi * uniform(random), cutter.normal(at)) * direction;
  const auto heading = [&](int step) {
    return bend * step / steps + swing * std::sin(2 * pi * waves * step / steps + phase);
  };
  cut.add_round(at, rings);
  for (int step = 0; cut.border() < size; ++step) {
    if (step > 2 * static_cast<int>(size)) return std::nullopt;
    const Vector3& normal = cutter.normal(at);
    direction -= normal.dot(direction) * normal;
    if (direction.norm() < 1e-6) return std::nullopt;
    direction = Eigen::AngleAxisd(heading(step + 1) - heading(step), normal) * direction.normalized();
    Index best = at;
    double most = 0.2;
    for (Index v : cutter.neighbours(at)) {
      const double along =
          (cutter.mesh().vertices[v] - cutter.mesh().vertices[at]).normalized().dot(direction);
      if (along > most) most = along, best = v;
    }
    if (best == at) return std::nullopt;
    at = best;
    cut.add_round(at, rings);
  }
  if (cut.border() != size) return std::nullopt;
  return cut.rim();
}

}  // namespace

std::optional<CutMesh> cut_winding_hole(const TriangleMesh& mesh, std::size_t size, Rim rim,
                                        std::uint32_t seed, const Region& region, int rings, int tries) {
  const Cutter cutter(mesh);
  const std::vector<Index> starts = cutter.inside(region);
  if (starts.empty()) return std::nullopt;
  for (int i = 0; i < tries; ++i, ++seed) {
    Cut cut(cutter);
    const std::optional<std::vector<Index>> loop = wind(cutter, starts, size, rings, seed, cut);
    if (!loop || !is_like(positions(mesh, *loop), rim)) continue;
    return CutMesh{cut.rest(), positions(mesh, *loop), seed};
  }
  return std::nullopt;
}

std::optional<CutMesh> cut_round_hole(const TriangleMesh& mesh, const Region& ball) {
  const Cutter cutter(mesh);
  std::vector<Index> queue = cutter.inside(ball);
  if (queue.empty()) return std::nullopt;
  const auto nearer = [&](Index a, Index b) {
    return (mesh.vertices[a] - ball.centre).squaredNorm() < (mesh.vertices[b] - ball.centre).squaredNorm();
  };
  queue = {*std::min_element(queue.begin(), queue.end(), nearer)};
  std::unordered_set<Index> seen(queue.begin(), queue.end());
  Cut cut(cutter);
  while (!queue.empty()) {
    const Index v = queue.back();
    queue.pop_back();
    cut.add_round(v, 1);
    for (Index w : cutter.neighbours(v))
      if ((mesh.vertices[w] - ball.centre).norm() <= ball.radius && seen.insert(w).second) queue.push_back(w);
  }
  const std::optional<std::vector<Index>> loop = cut.rim();
  if (!loop) return std::nullopt;
  return CutMesh{cut.rest(), positions(mesh, *loop), 0};
}

TriangleMesh subdivided(const TriangleMesh& mesh) {
  TriangleMesh fine;
  fine.vertices = mesh.vertices;
  std::unordered_map<std::uint64_t, Index> middle;
  const auto between = [&](Index a, Index b) {
    const auto [entry, is_new] =
        middle.emplace(edge_key(std::min(a, b), std::max(a, b)), static_cast<Index>(fine.vertices.size()));
    if (is_new) fine.vertices.push_back(as_stored(0.5 * (mesh.vertices[a] + mesh.vertices[b])));
    return entry->second;
  };
  for (const Triangle& t : mesh.triangles) {
    const Index ab = between(t[0], t[1]), bc = between(t[1], t[2]), ca = between(t[2], t[0]);
    fine.triangles.push_back({t[0], ab, ca});
    fine.triangles.push_back({ab, t[1], bc});
    fine.triangles.push_back({ca, bc, t[2]});
    fine.triangles.push_back({ab, bc, ca});
  }
  return fine;
}

}  // namespace benchmarks
}  // namespace meshcomplete
