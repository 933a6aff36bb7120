#include "filter_poissoncompletion/facet_quality.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace meshcomplete {
namespace {

constexpr double radians = 3.14159265358979323846 / 180;

}  // namespace

double length_ratio(const std::array<Vector3, 3>& p, double size, const RefinementCriteria& criteria) {
  const double longest = std::max({(p[1] - p[0]).norm(), (p[2] - p[1]).norm(), (p[0] - p[2]).norm()});
  return longest / (criteria.longest * size);
}

Vector3 axis_foot(const std::array<Vector3, 3>& p) {
  const Vector3 a = p[1] - p[0], b = p[2] - p[0], normal = a.cross(b);
  return p[0] + (a.squaredNorm() * b - b.squaredNorm() * a).cross(normal) / (2 * normal.squaredNorm());
}

double badness(const std::array<Vector3, 3>& p, double size, const RefinementCriteria& criteria,
               const std::function<std::optional<Vector3>()>& surface_centre) {
  std::array<double, 3> side;
  for (std::size_t k = 0; k < 3; ++k) side[k] = (p[(k + 1) % 3] - p[k]).norm();
  const auto [shortest, longest] = std::minmax_element(side.begin(), side.end());
  const double ratio = *longest / (criteria.longest * size);
  if (ratio > 1) return ratio;
  // The smallest angle lies across from the shortest side.
  const Vector3 normal = (p[1] - p[0]).cross(p[2] - p[0]);
  const double sine = normal.norm() * *shortest / (side[0] * side[1] * side[2]);
  const double bound = std::sin(criteria.smallest_angle * radians);
  if (sine < bound) return 1 - (1 - bad_shape) * sine / bound;
  if (!criteria.distance) return 0;
  const std::optional<Vector3> at = surface_centre();
  if (!at) return 0;
  const double height = std::abs(normal.normalized().dot(*at - p[0]));
  return height > *criteria.distance ? bad_shape * (1 - *criteria.distance / height) : 0;
}

}  // namespace meshcomplete
