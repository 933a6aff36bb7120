#include "filter_atomicvolumes/nearest_side.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

namespace meshcomplete {
namespace {

// Triangles in a leaf of the tree: a box costs as much memory as four triangles' numbers and time as two of
// them.
constexpr std::size_t leaf_size = 8;

// The point of a triangle that is closest to another point, and what it lies on.
struct Closest {
  enum Place { face = -1, edge = 0, corner = 3 };  // `edge` + k from corner k to the next, `corner` + k
  Vector3 position;
  int place;
};

// Ericson, Real-Time Collision Detection, section 5.1.5.
Closest closest_on_triangle(const Vector3& p, const Vector3& a, const Vector3& b, const Vector3& c) {
  const Vector3 ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
  const double d1 = ab.dot(ap), d2 = ac.dot(ap), d3 = ab.dot(bp), d4 = ac.dot(bp), d5 = ab.dot(cp),
               d6 = ac.dot(cp);
  if (d1 <= 0 && d2 <= 0) return {a, Closest::corner};
  if (d3 >= 0 && d4 <= d3) return {b, Closest::corner + 1};
  if (d6 >= 0 && d5 <= d6) return {c, Closest::corner + 2};
  const double vc = d1 * d4 - d3 * d2, vb = d5 * d2 - d1 * d6, va = d3 * d6 - d5 * d4;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return {a + d1 / (d1 - d3) * ab, Closest::edge};
  if (va <= 0 && d4 >= d3 && d5 >= d6)
    return {b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b), Closest::edge + 1};
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return {a + d2 / (d2 - d6) * ac, Closest::edge + 2};
  const double total = va + vb + vc;
  return {a + vb / total * ab + vc / total * ac, Closest::face};
}

double squared_distance(const Box& box, const Vector3& p) {
  double sum = 0;
  for (int k = 0; k < 3; ++k) {
    const double outside = std::max({box.low[k] - p[k], p[k] - box.high[k], 0.0});
    sum += outside * outside;
  }
  return sum;
}

double angle_between(const Vector3& a, const Vector3& b) { return std::atan2(a.cross(b).norm(), a.dot(b)); }

}  // namespace

SideFinder::SideFinder(const TriangleMesh& mesh, const MeshTopology& topology)
    : mesh_(mesh), topology_(topology), vertex_normals_(mesh.vertices.size(), Vector3::Zero()) {
  build_tree();
  add_vertex_normals();
}

Box SideFinder::box_of(Index triangle) const {
  const Triangle& t = mesh_.triangles[triangle];
  return bounding_box(mesh_.vertices[t[0]], mesh_.vertices[t[1]], mesh_.vertices[t[2]]);
}

void SideFinder::build_tree() {
  std::vector<Box> boxes;
  boxes.reserve(mesh_.triangles.size());
  for (Index t = 0; t < mesh_.triangles.size(); ++t) boxes.push_back(box_of(t));
  order_ = spatial_order(boxes);
  std::vector<Box> leaves((order_.size() + leaf_size - 1) / leaf_size);
  for (std::size_t i = 0; i < order_.size(); ++i) leaves[i / leaf_size].include(boxes[order_[i]]);
  tree_ = BoxTree(std::move(leaves));
}

void SideFinder::add_vertex_normals() {
  for (Index t = 0; t < mesh_.triangles.size(); ++t) {
    const Vector3 n = normal(t);
    if (!n.allFinite()) continue;
    const Triangle& corners = mesh_.triangles[t];
    for (int k = 0; k < 3; ++k) {
      const Vector3& p = mesh_.vertices[corners[k]];
      vertex_normals_[corners[k]] += n * angle_between(mesh_.vertices[corners[(k + 1) % 3]] - p,
                                                       mesh_.vertices[corners[(k + 2) % 3]] - p);
    }
  }
  for (const auto* half_edges : {&topology_.boundary_half_edges, &topology_.non_manifold_half_edges})
    for (Index h : *half_edges)
      for (Index k : {h % 3, (h + 1) % 3}) vertex_normals_[mesh_.triangles[h / 3][k]].setZero();
}

// Zero for a triangle without area.
Vector3 SideFinder::normal(Index triangle) const {
  const Triangle& t = mesh_.triangles[triangle];
  const Vector3& a = mesh_.vertices[t[0]];
  return (mesh_.vertices[t[1]] - a).cross(mesh_.vertices[t[2]] - a).normalized();
}

NearestSide SideFinder::side_of(const Vector3& point, Index triangle) const {
  const Triangle& t = mesh_.triangles[triangle];
  const Closest closest =
      closest_on_triangle(point, mesh_.vertices[t[0]], mesh_.vertices[t[1]], mesh_.vertices[t[2]]);
  const Vector3 offset = point - closest.position;
  NearestSide result{offset.norm(), std::nullopt};
  Vector3 pseudo_normal = normal(triangle);
  if (closest.place >= Closest::corner) {
    pseudo_normal = vertex_normals_[t[static_cast<std::size_t>(closest.place - Closest::corner)]];
  } else if (closest.place >= Closest::edge) {
    const Index other = topology_.opposite[3 * triangle + static_cast<Index>(closest.place)];
    if (other / 3 >= mesh_.triangles.size()) return result;  // boundary, or more than two faces
    pseudo_normal += normal(other / 3);
  }
  const double height = offset.dot(pseudo_normal);
  if (height != 0) result.inside = height < 0;
  return result;
}

NearestSide SideFinder::nearest(const Vector3& point, Index& near, double radius) const {
  double best = radius * radius;
  Index found = static_cast<Index>(mesh_.triangles.size());
  const auto offer = [&](Index t) {
    const Triangle& corners = mesh_.triangles[t];
    const Closest closest = closest_on_triangle(point, mesh_.vertices[corners[0]], mesh_.vertices[corners[1]],
                                                mesh_.vertices[corners[2]]);
    const double distance = (closest.position - point).squaredNorm();
    // Of triangles with the same nearest point the first: it does not matter where the search began.
    if (!(distance < best) && !(distance == best && t < found)) return;
    best = distance;
    found = t;
  };
  if (near < mesh_.triangles.size()) offer(near);
  tree_.descend([&](const Box& box) { return squared_distance(box, point) <= best; },
                [&](std::size_t leaf) {
                  const std::size_t past = std::min((leaf + 1) * leaf_size, order_.size());
                  for (std::size_t i = leaf * leaf_size; i < past; ++i) offer(order_[i]);
                  return true;
                });
  if (found >= mesh_.triangles.size()) return {};
  near = found;
  return side_of(point, found);
}

}  // namespace meshcomplete
