#include "filter_curveunfold/loop_geometry.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/intersections.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "filter_curveunfold/loop_tree.h"

namespace meshcomplete {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

constexpr double pi = 3.14159265358979323846;

Kernel::Point_2 exact_point(const Vector2& p) { return {p.x(), p.y()}; }

/// Whether the edges i < j of a closed polygon of n points have a common point in any case.
bool are_neighbours(std::size_t i, std::size_t j, std::size_t n) {
  return j == i + 1 || (i == 0 && j + 1 == n);
}

Loop in_space(const Polygon& polygon) {
  Loop flat(polygon.size());
  for (std::size_t i = 0; i < polygon.size(); ++i) flat[i] = Vector3(polygon[i].x(), polygon[i].y(), 0);
  return flat;
}

Eigen::Matrix3d covariance(const Loop& loop) {
  Vector3 mean = Vector3::Zero();
  for (const Vector3& p : loop) mean += p;
  mean /= static_cast<double>(loop.size());
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (const Vector3& p : loop) sum += (p - mean) * (p - mean).transpose();
  return sum / static_cast<double>(loop.size());
}

/// How well a projection shows the loop: the share of the edges' length that is left, plus the square root of
/// the smallest share that any edge keeps (one edge of length zero is worse than many that are a little
/// shorter), plus the share of the greatest area (a polygon seen from its edge keeps its lengths and is a
/// sliver all the same).
double projection_quality(const Loop& loop, const Vector3& normal, const Vector3& area) {
  double length = 0, projected = 0, least = 1;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const Vector3 edge = loop[(i + 1) % loop.size()] - loop[i];
    const double whole = edge.norm();
    const double flat = (edge - normal * normal.dot(edge)).norm();
    length += whole;
    projected += flat;
    if (whole > 0) least = std::min(least, flat / whole);
  }
  const double greatest_area = area.norm();
  return projected / length + std::sqrt(least) +
         (greatest_area > 0 ? std::abs(normal.dot(area)) / greatest_area : 0);
}

std::vector<Vector3> best_first(const Loop& loop, const Vector3& area, const std::vector<Vector3>& normals) {
  std::vector<std::pair<double, std::size_t>> order(normals.size());
  for (std::size_t k = 0; k < normals.size(); ++k)
    order[k] = {-projection_quality(loop, normals[k], area), k};
  std::sort(order.begin(), order.end());
  std::vector<Vector3> sorted;
  for (const auto& [quality, k] : order) sorted.push_back(normals[k]);
  return sorted;
}

std::optional<Polygon> projection_if_simple(const Loop& loop, const Vector3& normal) {
  Polygon polygon = project(loop, plane_with_normal(normal));
  const bool clockwise = signed_area(polygon) < 0;
  if (clockwise) {
    // The same plane seen from its other side.
    for (Vector2& p : polygon) std::swap(p.x(), p.y());
  }
  if (!is_simple(polygon)) return std::nullopt;
  return polygon;
}

/// Squared distance from a point to a triangle's inside; infinite when the point does not lie above the
/// inside.
double squared_distance_above(const Vector3& p, const Vector3& a, const Vector3& ab, const Vector3& ac,
                              const Vector3& normal, double squared_normal) {
  const Vector3 ap = p - a;
  const double s = ap.cross(ac).dot(normal);
  const double t = ab.cross(ap).dot(normal);
  if (s < 0 || t < 0 || s + t > squared_normal) return std::numeric_limits<double>::infinity();
  const double height = ap.dot(normal);
  return height * height / squared_normal;
}

}  // namespace

double signed_area(const Polygon& polygon) {
  double twice = 0;
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
    const Vector2 a = polygon[i] - polygon[0];
    const Vector2 b = polygon[i + 1] - polygon[0];
    twice += a.x() * b.y() - a.y() * b.x();
  }
  return twice / 2;
}

bool is_simple(const Polygon& polygon) {
  const std::size_t n = polygon.size();
  if (n < 3) return false;
  for (const Vector2& p : polygon) {
    if (!p.allFinite()) return false;
  }
  return count_crossings(polygon, 1) == 0;
}

bool segments_meet(const Vector2& a, const Vector2& b, const Vector2& c, const Vector2& d) {
  return CGAL::do_intersect(Kernel::Segment_2(exact_point(a), exact_point(b)),
                            Kernel::Segment_2(exact_point(c), exact_point(d)));
}

bool folds_back(const Vector2& a, const Vector2& b, const Vector2& c) {
  const Kernel::Point_2 p = exact_point(a), q = exact_point(b), r = exact_point(c);
  if (p == q || q == r) return true;
  return CGAL::orientation(p, q, r) == CGAL::COLLINEAR && CGAL::angle(p, q, r) == CGAL::ACUTE;
}

std::size_t count_crossings(const Polygon& polygon, std::size_t most) {
  const std::size_t n = polygon.size();
  std::size_t count = 0;
  for (std::size_t i = 0; i < n && count < most; ++i) {
    if (folds_back(polygon[(i + n - 1) % n], polygon[i], polygon[(i + 1) % n])) ++count;
  }
  if (count >= most) return most;
  LoopTree(in_space(polygon)).for_each_overlapping_pair([&](std::size_t i, std::size_t j) {
    if (are_neighbours(i, j, n)) return true;  // looked at above
    if (segments_meet(polygon[i], polygon[(i + 1) % n], polygon[j], polygon[(j + 1) % n])) ++count;
    return count < most;
  });
  return count;
}

ProjectionPlane plane_with_normal(const Vector3& normal) {
  ProjectionPlane plane;
  plane.normal = normal.normalized();
  // The axis that is least along the normal gives the best conditioned cross product.
  int axis = 0;
  plane.normal.cwiseAbs().minCoeff(&axis);
  plane.u = Vector3::Unit(axis).cross(plane.normal).normalized();
  plane.v = plane.normal.cross(plane.u);
  return plane;
}

Polygon project(const Loop& loop, const ProjectionPlane& plane) {
  Polygon polygon(loop.size());
  for (std::size_t i = 0; i < loop.size(); ++i)
    polygon[i] = Vector2(loop[i].dot(plane.u), loop[i].dot(plane.v));
  return polygon;
}

Vector3 best_fitting_normal(const Loop& loop) {
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(covariance(loop)).eigenvectors().col(0);
}

PrincipalSpread principal_spread(const Loop& loop) {
  const Vector3 values = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(covariance(loop)).eigenvalues();
  return {std::sqrt(std::max(0.0, values[0])), std::sqrt(std::max(0.0, values[2]))};
}

Vector3 area_vector(const Loop& loop) {
  Vector3 sum = Vector3::Zero();
  for (std::size_t i = 1; i + 1 < loop.size(); ++i) sum += (loop[i] - loop[0]).cross(loop[i + 1] - loop[0]);
  return sum / 2;
}

std::vector<Vector3> half_sphere_directions(int count) {
  // The spherical Fibonacci lattice, upper half; the offset keeps it clear of the poles and of the axes.
  const double golden_angle = pi * (3 - std::sqrt(5.0));
  std::vector<Vector3> directions;
  directions.reserve(static_cast<std::size_t>(count));
  for (int k = 0; k < count; ++k) {
    const double z = (k + 0.5) / count;
    const double radius = std::sqrt(1 - z * z);
    const double angle = golden_angle * k + 0.1;
    directions.emplace_back(radius * std::cos(angle), radius * std::sin(angle), z);
  }
  return directions;
}

std::vector<Vector3> fitted_normals(const Loop& loop) {
  const Vector3 area = area_vector(loop);
  std::vector<Vector3> normals = {best_fitting_normal(loop)};
  if (area.norm() > 0) normals.push_back(area.normalized());
  return best_first(loop, area, normals);
}

std::vector<Vector3> spread_normals(const Loop& loop, int directions) {
  return best_first(loop, area_vector(loop), half_sphere_directions(directions));
}

std::optional<Polygon> simple_projection(const Loop& loop, int directions) {
  const auto first_simple = [&loop](const std::vector<Vector3>& normals) -> std::optional<Polygon> {
    for (const Vector3& normal : normals) {
      if (std::optional<Polygon> polygon = projection_if_simple(loop, normal)) return polygon;
    }
    return std::nullopt;
  };
  if (std::optional<Polygon> polygon = first_simple(fitted_normals(loop))) return polygon;
  return first_simple(spread_normals(loop, directions));
}

ClosestPoints closest_points(const Vector3& a, const Vector3& b, const Vector3& c, const Vector3& d) {
  // Ericson, "Real-Time Collision Detection" (2005), section 5.1.9.
  const Vector3 u = b - a, v = d - c, w = a - c;
  const double uu = u.squaredNorm(), vv = v.squaredNorm(), uv = u.dot(v), uw = u.dot(w), vw = v.dot(w);
  double s = 0, t = 0;
  if (uu <= 0 && vv <= 0) return {0, 0, w};
  if (uu <= 0) {
    t = std::clamp(vw / vv, 0.0, 1.0);
  } else if (vv <= 0) {
    s = std::clamp(-uw / uu, 0.0, 1.0);
  } else {
    const double denominator = uu * vv - uv * uv;
    if (denominator > 0) s = std::clamp((uv * vw - uw * vv) / denominator, 0.0, 1.0);
    t = (uv * s + vw) / vv;
    if (t < 0) {
      t = 0;
      s = std::clamp(-uw / uu, 0.0, 1.0);
    } else if (t > 1) {
      t = 1;
      s = std::clamp((uv - uw) / uu, 0.0, 1.0);
    }
  }
  return {s, t, w + s * u - t * v};
}

double squared_distance(const Vector3& a, const Vector3& b, const Vector3& c, const Vector3& d) {
  return closest_points(a, b, c, d).difference.squaredNorm();
}

double squared_distance_to_triangle(const Vector3& p, const Vector3& q, const Vector3& a, const Vector3& b,
                                    const Vector3& c) {
  double best =
      std::min({squared_distance(p, q, a, b), squared_distance(p, q, b, c), squared_distance(p, q, c, a)});
  const Vector3 ab = b - a, ac = c - a;
  const Vector3 normal = ab.cross(ac);
  const double squared_normal = normal.squaredNorm();
  if (!(squared_normal > 0)) return best;
  const double from = (p - a).dot(normal), to = (q - a).dot(normal);
  if ((from < 0) != (to < 0)) {
    const Vector3 hit = p + (q - p) * (from / (from - to));
    if (squared_distance_above(hit, a, ab, ac, normal, squared_normal) <
        std::numeric_limits<double>::infinity()) {
      return 0;
    }
  }
  best = std::min(best, squared_distance_above(p, a, ab, ac, normal, squared_normal));
  return std::min(best, squared_distance_above(q, a, ab, ac, normal, squared_normal));
}

double angle_between(const Vector3& a, const Vector3& b) { return std::atan2(a.cross(b).norm(), a.dot(b)); }

std::vector<double> edge_lengths(const Loop& loop) {
  std::vector<double> lengths(loop.size());
  for (std::size_t i = 0; i < loop.size(); ++i) lengths[i] = (loop[(i + 1) % loop.size()] - loop[i]).norm();
  return lengths;
}

double total_curvature(const Loop& loop) {
  const std::size_t n = loop.size();
  double sum = 0;
  for (std::size_t i = 0; i < n; ++i) {
    sum += angle_between(loop[(i + 1) % n] - loop[i], loop[(i + 2) % n] - loop[(i + 1) % n]);
  }
  return sum;
}

}  // namespace meshcomplete
