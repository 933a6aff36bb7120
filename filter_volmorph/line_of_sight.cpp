#include "filter_volmorph/line_of_sight.h"

#include <CGAL/Min_sphere_of_points_d_traits_3.h>
#include <CGAL/Min_sphere_of_spheres_d.h>
#include <CGAL/Simple_cartesian.h>

#include <Eigen/Geometry>
#include <cmath>
#include <vector>

#include "common/core/error.h"

namespace meshcomplete {
namespace {

using Kernel = CGAL::Simple_cartesian<double>;
using Spheres = CGAL::Min_sphere_of_spheres_d<CGAL::Min_sphere_of_points_d_traits_3<Kernel, double>>;

/// Area vectors that sum up to less than this share of the area have no common direction: their sum is what
/// rounding left of a closed surface.
constexpr double least_net_area = 1e-6;

}  // namespace

Vector3 estimate_axis(const TriangleMesh& scan) {
  std::vector<Kernel::Point_3> normals;
  normals.reserve(scan.triangles.size());
  Vector3 sum = Vector3::Zero();
  double area = 0;
  for (const Triangle& t : scan.triangles) {
    const Vector3& a = scan.vertices[t[0]];
    const Vector3 cross = (scan.vertices[t[1]] - a).cross(scan.vertices[t[2]] - a);
    const double length = cross.norm();
    if (!(length > 0) || !std::isfinite(length)) continue;
    normals.emplace_back(cross.x() / length, cross.y() / length, cross.z() / length);
    sum += cross;
    area += length;
  }
  if (!(sum.norm() > least_net_area * area)) {
    throw CompletionError("estimating the line of sight",
                          "The scan's own axis cannot be estimated: its faces look in all directions alike. "
                          "Give a direction or a viewpoint as line of sight.");
  }
  const Vector3 mean = sum.normalized();
  // The smallest ball round unit vectors that fit into a half-space has its middle on the axis of the
  // narrowest cone, at the cosine of its angle.
  Spheres ball(normals.begin(), normals.end());
  const auto* middle = ball.center_cartesian_begin();
  const Vector3 axis(middle[0], middle[1], middle[2]);
  const bool half_space = axis.norm() > least_net_area && axis.dot(mean) > 0;
  return half_space ? Vector3(axis.normalized()) : mean;
}

}  // namespace meshcomplete
