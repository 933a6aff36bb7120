#include "benchmarks/surface_distance.h"

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Simple_cartesian.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

namespace meshcomplete::benchmarks {
namespace {

using Kernel = CGAL::Simple_cartesian<double>;
using Triangles = std::vector<Kernel::Triangle_3>;
using Primitive = CGAL::AABB_triangle_primitive<Kernel, Triangles::const_iterator>;
using Tree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>>;

struct DistanceTree {
  explicit DistanceTree(Triangles list)
      : triangles(std::move(list)), tree(triangles.cbegin(), triangles.cend()) {
    tree.accelerate_distance_queries();
  }
  Triangles triangles;
  Tree tree;
};

Kernel::Point_3 point_of(const Vector3& v) { return {v[0], v[1], v[2]}; }

}  // namespace

OrientedPoints points_on(const TriangleMesh& mesh, std::size_t count, std::uint64_t seed) {
  std::vector<double> area_up_to;
  double total = 0;
  for (const Triangle& t : mesh.triangles) {
    const Vector3& a = mesh.vertices[t[0]];
    total += (mesh.vertices[t[1]] - a).cross(mesh.vertices[t[2]] - a).norm();
    area_up_to.push_back(total);
  }
  OrientedPoints set;
  Uniform uniform(seed);
  while (set.points.size() < count) {
    const auto at = std::upper_bound(area_up_to.begin(), area_up_to.end(), uniform() * total);
    if (at == area_up_to.end()) continue;
    const Triangle& t = mesh.triangles[static_cast<std::size_t>(at - area_up_to.begin())];
    const Vector3 a = mesh.vertices[t[0]], b = mesh.vertices[t[1]] - a, c = mesh.vertices[t[2]] - a;
    double u = uniform(), v = uniform();
    if (u + v > 1) u = 1 - u, v = 1 - v;
    set.points.push_back(a + u * b + v * c);
    set.normals.push_back(b.cross(c).normalized());
  }
  return set;
}

Distance distance_of(const std::vector<Vector3>& points,
                     const std::function<double(const Vector3&)>& distance) {
  Distance result;
  double sum = 0;
  for (const Vector3& p : points) {
    const double d = distance(p);
    sum += d * d;
    result.greatest = std::max(result.greatest, d);
  }
  result.root_mean_square = std::sqrt(sum / static_cast<double>(points.size()));
  return result;
}

std::function<double(const Vector3&)> distance_function(const TriangleMesh& mesh) {
  Triangles triangles;
  for (const Triangle& t : mesh.triangles)
    triangles.emplace_back(point_of(mesh.vertices[t[0]]), point_of(mesh.vertices[t[1]]),
                           point_of(mesh.vertices[t[2]]));
  triangles.erase(std::remove_if(triangles.begin(), triangles.end(),
                                 [](const Kernel::Triangle_3& t) { return t.is_degenerate(); }),
                  triangles.end());
  const auto tree = std::make_shared<DistanceTree>(std::move(triangles));
  return [tree](const Vector3& p) { return std::sqrt(tree->tree.squared_distance(point_of(p))); };
}

double diagonal_of(const TriangleMesh& mesh) {
  Eigen::AlignedBox3d box;
  for (const Vector3& v : mesh.vertices) box.extend(v);
  return box.sizes().norm();
}

}  // namespace meshcomplete::benchmarks
