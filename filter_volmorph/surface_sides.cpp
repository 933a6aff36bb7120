#include "filter_volmorph/surface_sides.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "common/core/closest_point.h"
#include "common/core/threads.h"

namespace meshcomplete {
namespace {

constexpr std::size_t fan_out = 4;  // also the faces of the smallest nodes
constexpr std::size_t nodes_at_once = 256;
constexpr std::size_t exact_levels = 2;  // whose cones are as narrow as can be; above them are few nodes

std::size_t parents(std::size_t count) { return (count + fan_out - 1) / fan_out; }

Vector3 normal_of(const TriangleMesh& mesh, const Triangle& t) {
  return (mesh.vertices[t[1]] - mesh.vertices[t[0]])
      .cross(mesh.vertices[t[2]] - mesh.vertices[t[0]])
      .normalized();
}

Vector3 corner(const Box& box, int k) {
  const auto at = [&](std::size_t axis) { return (k >> axis & 1 ? box.high : box.low)[axis]; };
  return {at(0), at(1), at(2)};
}

}  // namespace

struct SurfaceSides::Nearest {
  double square = std::numeric_limits<double>::infinity();
  Index face = 0;
  ClosestPoint point;
};

/// The faces at every vertex, and which vertices are on the rim.
class SurfaceSides::Stars {
 public:
  Stars(const TriangleMesh& mesh, const MeshTopology& topology)
      : first_(mesh.vertices.size() + 1, 0), faces_(3 * mesh.triangles.size()), rim_(mesh.vertices.size()) {
    for (const Triangle& t : mesh.triangles)
      for (const Index v : t) ++first_[v + 1];
    for (std::size_t v = 1; v < first_.size(); ++v) first_[v] += first_[v - 1];
    std::vector<Index> next(first_.begin(), first_.end() - 1);
    for (Index f = 0; f < mesh.triangles.size(); ++f)
      for (const Index v : mesh.triangles[f]) faces_[next[v]++] = f;
    for (const Index h : topology.boundary_half_edges)
      for (const Index k : {h % 3, (h % 3 + 1) % 3}) rim_[mesh.triangles[h / 3][k]] = true;
  }

  bool rim(Index vertex) const { return rim_[vertex]; }
  template <class Visit>
  void visit(Index vertex, Visit&& visit) const {
    for (Index i = first_[vertex]; i < first_[vertex + 1]; ++i) visit(faces_[i]);
  }

 private:
  std::vector<Index> first_, faces_;
  std::vector<bool> rim_;
};

SurfaceSides::SurfaceSides(const TriangleMesh& mesh, const Progress& progress)
    : mesh_(mesh),
      topology_(build_topology(mesh, progress.part(0, 0.2, "preparing the surface"))),
      signs_(mesh, topology_),
      winding_(mesh, topology_) {
  progress.update(0.5);
  build_boxes();
  build_cones(progress.part(0.6, 1, "preparing the surface"));
}

void SurfaceSides::build_boxes() {
  std::vector<Box> boxes;
  for (const Triangle& t : mesh_.triangles) {
    boxes.push_back(bounding_box(mesh_.vertices[t[0]], mesh_.vertices[t[1]], mesh_.vertices[t[2]]));
    normals_.push_back(normal_of(mesh_, t));
  }
  order_ = spatial_order(boxes);
  std::vector<Box> sorted;
  for (const Index f : order_) sorted.push_back(boxes[f]);
  do {
    std::vector<Box> coarse(parents(sorted.size()));
    for (std::size_t i = 0; i < sorted.size(); ++i) coarse[i / fan_out].include(sorted[i]);
    boxes_.push_back(coarse);
    sorted = std::move(coarse);
  } while (sorted.size() > 1);
}

/// Opens the cone as wide as the normals of the faces (`order_`, from `begin` on) and of those round them.
void SurfaceSides::widen(Cone& cone, const Stars& stars, std::size_t begin, std::size_t end) const {
  for (std::size_t i = begin; i < end; ++i) cone.axis += normals_[order_[i]];
  if (cone.axis.norm() > 0) cone.axis.normalize();
  for (std::size_t i = begin; i < end; ++i) {
    for (const Index v : mesh_.triangles[order_[i]]) {
      cone.rim = cone.rim || stars.rim(v);
      stars.visit(v, [&](Index g) { cone.cosine = std::min(cone.cosine, cone.axis.dot(normals_[g])); });
    }
  }
  cone.sine = std::sqrt(std::max(0.0, 1 - cone.cosine * cone.cosine));
}

/// Opens the cone as wide as others, which it then contains.
void SurfaceSides::widen(Cone& cone, const std::vector<Cone>& others, std::size_t begin, std::size_t end) {
  for (std::size_t i = begin; i < end; ++i) cone.axis += others[i].axis;
  if (cone.axis.norm() > 0) cone.axis.normalize();
  for (std::size_t i = begin; i < end; ++i) {
    const Cone& other = others[i];
    cone.rim = cone.rim || other.rim;
    const double between = std::clamp(cone.axis.dot(other.axis), -1.0, 1.0);
    // The angles add; where they make more than a half turn the cone is everything.
    const bool all = between + other.cosine <= 0;
    const double sine = std::sqrt(1 - between * between);
    cone.cosine = std::min(cone.cosine, all ? -1 : between * other.cosine - sine * other.sine);
  }
  cone.sine = std::sqrt(std::max(0.0, 1 - cone.cosine * cone.cosine));
}

void SurfaceSides::build_cones(const Progress& progress) {
  const Stars stars(mesh_, topology_);
  faces_.resize(order_.size());
  for_each(order_.size(), nodes_at_once, progress, [&](std::size_t i) {
    const Triangle& t = mesh_.triangles[order_[i]];
    Cone& cone = faces_[i];
    cone.middle = (mesh_.vertices[t[0]] + mesh_.vertices[t[1]] + mesh_.vertices[t[2]]) / 3;
    for (const Index v : t) cone.radius = std::max(cone.radius, (mesh_.vertices[v] - cone.middle).norm());
    widen(cone, stars, i, i + 1);
  });
  std::size_t span = fan_out;
  for (const std::vector<Box>& boxes : boxes_) {
    progress.update(static_cast<double>(cones_.size()) / static_cast<double>(boxes_.size()));
    std::vector<Cone> cones(boxes.size());
    for_each(boxes.size(), nodes_at_once, progress, [&](std::size_t node) {
      Cone& cone = cones[node];
      cone.middle = (corner(boxes[node], 0) + corner(boxes[node], 7)) / 2;
      cone.radius = (corner(boxes[node], 7) - cone.middle).norm();
      // The normals themselves make narrower cones, but on all levels that would be O(faces log faces).
      if (cones_.size() < exact_levels)
        widen(cone, stars, node * span, std::min((node + 1) * span, order_.size()));
      else
        widen(cone, cones_.back(), node * fan_out, std::min((node + 1) * fan_out, cones_.back().size()));
    });
    cones_.push_back(std::move(cones));
    span *= fan_out;
  }
}

void SurfaceSides::search(const Vector3& point, std::size_t level, std::size_t node, Nearest& nearest) const {
  if (level == 0) {
    const std::size_t end = std::min((node + 1) * fan_out, order_.size());
    for (std::size_t i = node * fan_out; i < end; ++i) {
      const double away = (faces_[i].middle - point).norm() - faces_[i].radius;
      if (away > 0 && away * away > nearest.square) continue;
      const Triangle& t = mesh_.triangles[order_[i]];
      const ClosestPoint found =
          closest_point(point, mesh_.vertices[t[0]], mesh_.vertices[t[1]], mesh_.vertices[t[2]]);
      const double square = (found.position - point).squaredNorm();
      if (square < nearest.square || (square == nearest.square && order_[i] < nearest.face))
        nearest = {square, order_[i], found};
    }
    return;
  }
  std::array<std::pair<double, std::size_t>, fan_out> children;
  std::size_t count = 0;
  const std::size_t end = std::min((node + 1) * fan_out, boxes_[level - 1].size());
  for (std::size_t i = node * fan_out; i < end; ++i) {
    const double square = squared_distance(boxes_[level - 1][i], point);
    if (square > nearest.square) continue;
    std::size_t at = count++;  // the nearest first
    for (; at > 0 && children[at - 1].first > square; --at) children[at] = children[at - 1];
    children[at] = {square, i};
  }
  for (std::size_t i = 0; i < count; ++i)
    if (children[i].first <= nearest.square) search(point, level - 1, children[i].second, nearest);
}

SurfaceSides::Nearest SurfaceSides::nearest(const Vector3& point, Index start) const {
  const Triangle& t = mesh_.triangles[start];
  Nearest result;
  result.point = closest_point(point, mesh_.vertices[t[0]], mesh_.vertices[t[1]], mesh_.vertices[t[2]]);
  result.square = (result.point.position - point).squaredNorm();
  result.face = start;
  search(point, boxes_.size() - 1, 0, result);
  return result;
}

bool SurfaceSides::before(const Vector3& point, Index& start) const {
  const Nearest found = nearest(point, start);
  start = found.face;
  if (signs_.place(found.face, found.point) != SurfacePlace::surface) return !winding_.inside(point);
  return (point - found.point.position).dot(signs_.normal(found.face, found.point)) > 0;
}

/// Adds what the faces of a cone may be to a ball; returns whether that is all that can be said of them.
bool SurfaceSides::look(const Cone& cone, const Vector3& middle, double radius, Chances& chances) {
  const Vector3 way = middle - cone.middle;
  const double distance = way.norm(), reach = radius + cone.radius;
  if (!(distance > reach)) return false;
  // The angles add: of the cone, and of the ball as it looks from the faces.
  const double sine = reach / distance, cosine = std::sqrt(1 - sine * sine);
  const double both = cone.cosine * cosine - cone.sine * sine;
  if (!(cone.cosine > 0 && both > 0)) return false;
  const double along = cone.axis.dot(way) / distance;
  chances.before = chances.before || along >= both;
  chances.behind = chances.behind || along <= -both;
  return true;
}

/// Returns false as soon as it is clear that nothing is sure.
bool SurfaceSides::collect(const Vector3& middle, double radius, double reach, std::size_t level,
                           std::size_t node, Chances& chances) const {
  if (squared_distance(boxes_[level][node], middle) > reach * reach) return true;
  const Cone& cone = cones_[level][node];
  if ((!cone.rim || chances.rim) && look(cone, middle, radius, chances))
    return !(chances.before && chances.behind);
  if (level > 0) {
    const std::size_t end = std::min((node + 1) * fan_out, boxes_[level - 1].size());
    for (std::size_t i = node * fan_out; i < end; ++i)
      if (!collect(middle, radius, reach, level - 1, i, chances)) return false;
    return true;
  }
  const std::size_t end = std::min((node + 1) * fan_out, order_.size());
  for (std::size_t i = node * fan_out; i < end; ++i) {
    if ((faces_[i].middle - middle).norm() > reach + faces_[i].radius) continue;
    chances.rim = chances.rim || faces_[i].rim;
    if (!look(faces_[i], middle, radius, chances) || (chances.before && chances.behind)) return false;
  }
  return true;
}

std::optional<bool> SurfaceSides::before(const Vector3& middle, double radius, Index& start) const {
  const Nearest found = nearest(middle, start);
  start = found.face;
  Chances chances;
  const double reach = std::sqrt(found.square) + 2 * radius;
  if (!collect(middle, radius, reach, boxes_.size() - 1, 0, chances)) return {};
  if (chances.rim) {
    const double change = winding_.steepest(middle, radius);
    if (!std::isfinite(change)) return {};
    const double winding = winding_.at(middle);
    if (!(std::abs(winding - 0.5) > radius * change + WindingNumber::largest_error)) return {};
    (winding > 0.5 ? chances.behind : chances.before) = true;
  }
  if (chances.before == chances.behind) return {};
  return chances.before;
}

}  // namespace meshcomplete
