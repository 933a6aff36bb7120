#include "filter_volmorph/winding_number.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "common/core/closest_point.h"

namespace meshcomplete {
namespace {

constexpr std::size_t faces_in_leaf = 8;
constexpr std::size_t fan_out = 4;
constexpr std::size_t between_checks = 4096;  // faces or half-edges

/// Nodes farther than so many of their radii are one dipole. The terms left out are smaller than that one by
/// the square of this, and of both signs over a mesh: the sum stays well within `largest_error`.
constexpr double far_radii = 2.5;

double solid_angle(const Vector3& a, const Vector3& b, const Vector3& c) {
  // Van Oosterom and Strackee, "The Solid Angle of a Plane Triangle" (1983), equation 8.
  const double x = a.norm(), y = b.norm(), z = c.norm();
  return 2 * std::atan2(a.dot(b.cross(c)), x * y * z + a.dot(b) * z + b.dot(c) * x + c.dot(a) * y);
}

}  // namespace

WindingNumber::WindingNumber(const TriangleMesh& mesh, const MeshTopology& topology, const Progress& progress)
    : mesh_(mesh) {
  std::vector<Box> boxes;
  boxes.reserve(mesh.triangles.size());
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
    if (f % between_checks == 0) progress.check();
    const Triangle& t = mesh.triangles[f];
    boxes.push_back(bounding_box(mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]));
  }
  progress.update(0.1);
  order_ = spatial_order(boxes);
  progress.update(0.4);
  build_nodes(boxes, progress);
  progress.update(0.8);
  build_rims(topology, progress);
  progress.update(1);
}

void WindingNumber::build_nodes(const std::vector<Box>& boxes, const Progress& progress) {
  const auto finish = [](Node& node) {
    if (node.area > 0) node.middle /= node.area;
    for (int k = 0; k < 8; ++k) {
      const auto corner = [&](std::size_t axis) {
        return (k >> axis & 1 ? node.box.high : node.box.low)[axis];
      };
      node.radius = std::max(node.radius, (Vector3(corner(0), corner(1), corner(2)) - node.middle).norm());
    }
  };
  std::vector<Node> nodes((order_.size() + faces_in_leaf - 1) / faces_in_leaf);
  for (std::size_t i = 0; i < order_.size(); ++i) {
    if (i % between_checks == 0) progress.check();
    const Triangle& t = mesh_.triangles[order_[i]];
    const Vector3 &a = mesh_.vertices[t[0]], &b = mesh_.vertices[t[1]], &c = mesh_.vertices[t[2]];
    const Vector3 normal = (b - a).cross(c - a) / 2;
    if (!normal.allFinite()) continue;
    Node& node = nodes[i / faces_in_leaf];
    node.normal += normal;
    node.area += normal.norm();
    node.middle += normal.norm() * (a + b + c) / 3;
    node.box.include(boxes[order_[i]]);
  }
  for (Node& node : nodes) finish(node);
  levels_.push_back(std::move(nodes));
  while (levels_.back().size() > 1) {
    const std::vector<Node>& fine = levels_.back();
    std::vector<Node> coarse((fine.size() + fan_out - 1) / fan_out);
    for (std::size_t i = 0; i < fine.size(); ++i) {
      Node& node = coarse[i / fan_out];
      node.normal += fine[i].normal;
      node.area += fine[i].area;
      node.middle += fine[i].area * fine[i].middle;
      node.box.include(fine[i].box);
    }
    for (Node& node : coarse) finish(node);
    levels_.push_back(std::move(coarse));
  }
}

void WindingNumber::build_rims(const MeshTopology& topology, const Progress& progress) {
  std::vector<Rim> rims;
  std::vector<Box> boxes;
  const auto half_edges = static_cast<Index>(topology.opposite.size());
  const auto start = [&](Index h) { return mesh_.triangles[h / 3][h % 3]; };
  for (Index h = 0; h < half_edges; ++h) {
    if (h % between_checks == 0) progress.check();
    if (topology.opposite[h] < half_edges && start(topology.opposite[h]) != start(h)) continue;
    const Vector3 &a = mesh_.vertices[start(h)], &b = mesh_.vertices[mesh_.triangles[h / 3][(h % 3 + 1) % 3]];
    boxes.push_back(bounding_box(a, b, b));
    rims.push_back({boxes.back(), (b - a).norm()});
  }
  std::vector<Rim> sorted;
  for (const Index i : spatial_order(boxes)) sorted.push_back(rims[i]);
  if (sorted.empty()) return;
  rims_.push_back(std::move(sorted));
  while (rims_.back().size() > 1) {
    const std::vector<Rim>& fine = rims_.back();
    std::vector<Rim> coarse((fine.size() + fan_out - 1) / fan_out);
    for (std::size_t i = 0; i < fine.size(); ++i) {
      coarse[i / fan_out].box.include(fine[i].box);
      coarse[i / fan_out].length += fine[i].length;
    }
    rims_.push_back(std::move(coarse));
  }
}

double WindingNumber::at(const Vector3& point) const { return at(point, levels_.size() - 1, 0) / (4 * M_PI); }

double WindingNumber::at(const Vector3& point, std::size_t level, std::size_t index) const {
  const Node& node = levels_[level][index];
  const Vector3 way = node.middle - point;
  const double distance = way.norm();
  if (distance > far_radii * node.radius) {
    return node.area > 0 ? node.normal.dot(way) / (distance * distance * distance) : 0;
  }
  double sum = 0;
  if (level > 0) {
    const std::size_t end = std::min((index + 1) * fan_out, levels_[level - 1].size());
    for (std::size_t i = index * fan_out; i < end; ++i) sum += at(point, level - 1, i);
    return sum;
  }
  const std::size_t end = std::min((index + 1) * faces_in_leaf, order_.size());
  for (std::size_t i = index * faces_in_leaf; i < end; ++i) {
    const Triangle& t = mesh_.triangles[order_[i]];
    const double angle =
        solid_angle(mesh_.vertices[t[0]] - point, mesh_.vertices[t[1]] - point, mesh_.vertices[t[2]] - point);
    if (std::isfinite(angle)) sum += angle;
  }
  return sum;
}

double WindingNumber::steepest(const Vector3& point, double radius) const {
  return rims_.empty() ? 0 : steepest(point, radius, rims_.size() - 1, 0) / (4 * M_PI);
}

double WindingNumber::steepest(const Vector3& point, double radius, std::size_t level,
                               std::size_t index) const {
  const Rim& rim = rims_[level][index];
  const double distance = std::sqrt(squared_distance(rim.box, point)) - radius;
  double extent = 0;
  for (std::size_t k = 0; k < 3; ++k) extent = std::max(extent, rim.box.high[k] - rim.box.low[k]);
  if (level == 0 || distance > extent) {
    return distance > 0 ? rim.length / (distance * distance) : std::numeric_limits<double>::infinity();
  }
  double sum = 0;
  const std::size_t end = std::min((index + 1) * fan_out, rims_[level - 1].size());
  for (std::size_t i = index * fan_out; i < end && std::isfinite(sum); ++i) {
    sum += steepest(point, radius, level - 1, i);
  }
  return sum;
}

}  // namespace meshcomplete
