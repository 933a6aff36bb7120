// Implicit functions to test with: their surfaces are known.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>
#include <vector>

#include "common/core/closest_point.h"
#include "common/core/implicit_function.h"
#include "common/core/mesh.h"

namespace meshcomplete {
namespace test {

class Oracle : public ImplicitFunction {
 public:
  explicit Oracle(std::function<double(const Vector3&)> value) : value_(std::move(value)) {}
  double value(const Vector3& position) const override { return value_(position); }

 private:
  std::function<double(const Vector3&)> value_;
};

inline Oracle sphere_oracle(double radius = 1, const Vector3& centre = Vector3::Zero()) {
  return Oracle([=](const Vector3& p) { return (p - centre).norm() - radius; });
}

inline double torus_value(const Vector3& p, double major_radius, double minor_radius) {
  return std::hypot(std::hypot(p[0], p[1]) - major_radius, p[2]) - minor_radius;
}

inline Oracle torus_oracle(double major_radius = 1, double minor_radius = 0.4) {
  return Oracle([=](const Vector3& p) { return torus_value(p, major_radius, minor_radius); });
}

/// The least of both: inside either.
inline Oracle both(const Oracle& a, const Oracle& b) {
  return Oracle([=](const Vector3& p) { return std::min(a.value(p), b.value(p)); });
}

/// The distance by the definition.
inline double distance_to(const TriangleMesh& mesh, const Vector3& p) {
  double least = std::numeric_limits<double>::infinity();
  for (const Triangle& t : mesh.triangles)
    least = std::min(
        least, (closest_point(p, mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]).position - p)
                   .norm());
  return least;
}

/// Edges of two triangles count twice.
inline double mean_edge(const std::vector<Vector3>& vertices, const std::vector<Triangle>& triangles) {
  double sum = 0;
  for (const Triangle& t : triangles)
    for (int k = 0; k < 3; ++k) sum += (vertices[t[k]] - vertices[t[(k + 1) % 3]]).norm();
  return sum / (3.0 * static_cast<double>(triangles.size()));
}

/// The smallest angle of a triangle, in degrees.
inline double smallest_angle(const Vector3& a, const Vector3& b, const Vector3& c) {
  const auto angle = [](const Vector3& at, const Vector3& p, const Vector3& q) {
    return std::atan2((p - at).cross(q - at).norm(), (p - at).dot(q - at)) * 180 / 3.14159265358979323846;
  };
  return std::min({angle(a, b, c), angle(b, c, a), angle(c, a, b)});
}

}  // namespace test
}  // namespace meshcomplete
