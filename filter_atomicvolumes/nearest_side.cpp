#include "filter_atomicvolumes/nearest_side.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "common/core/closest_point.h"

namespace meshcomplete {
namespace {

// Triangles in a leaf of the tree: a box costs as much memory as four triangles' numbers and time as two of
// them.
constexpr std::size_t leaf_size = 8;

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
  const ClosestPoint closest =
      closest_point(point, mesh_.vertices[t[0]], mesh_.vertices[t[1]], mesh_.vertices[t[2]]);
  const Vector3 offset = point - closest.position;
  NearestSide result{offset.norm(), std::nullopt};
  Vector3 pseudo_normal = normal(triangle);
  if (closest.place >= ClosestPoint::corner) {
    pseudo_normal = vertex_normals_[t[static_cast<std::size_t>(closest.place - ClosestPoint::corner)]];
  } else if (closest.place >= ClosestPoint::edge) {
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
    const ClosestPoint closest = closest_point(point, mesh_.vertices[corners[0]], mesh_.vertices[corners[1]],
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
