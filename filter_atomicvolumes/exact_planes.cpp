#include "filter_atomicvolumes/exact_planes.h"

#include <Eigen/Geometry>
#include <cmath>
#include <stdexcept>
#include <tuple>

namespace meshcomplete {
namespace {

// Coordinates and coefficients are rounded a few times by 2^-53 of themselves, and so are the three products
// and their sum: beyond this share of the sum of magnitudes the sign is certain.
constexpr double error_of_side = 1e-14;

// Of the integers in `rounded_normal`.
constexpr double direction_units = 128;

int sign(const ExactInteger& value) { return value.sign(); }

double to_double(const ExactInteger& value) { return value.convert_to<double>(); }

using Triple = std::array<ExactInteger, 3>;

Triple cross(const Triple& u, const Triple& v) {
  return {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
}

ExactInteger dot(const Triple& u, const Triple& v) { return u[0] * v[0] + u[1] * v[1] + u[2] * v[2]; }

Triple difference(const LatticePoint& a, const LatticePoint& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

Triple triple(const LatticePoint& a) { return {a[0], a[1], a[2]}; }

}  // namespace

ExactPlane::ExactPlane(const std::array<ExactInteger, 3>& n, const ExactInteger& o) : normal(n), offset(o) {
  for (int k = 0; k < 3; ++k) rounded[k] = to_double(normal[k]);
  rounded[3] = to_double(offset);
}

ExactPlane ExactPlane::through(const LatticeTriangle& t) {
  const Triple normal = cross(difference(t[1], t[0]), difference(t[2], t[0]));
  return {normal, -dot(normal, triple(t[0]))};
}

ExactPlane ExactPlane::along(const LatticePoint& a, const LatticePoint& b, const LatticePoint& direction,
                             const LatticePoint& inner) {
  Triple normal = cross(difference(b, a), triple(direction));
  if (dot(normal, difference(inner, a)) < 0)
    for (ExactInteger& component : normal) component = -component;
  return {normal, -dot(normal, triple(a))};
}

ExactPlane ExactPlane::across(int axis, std::int64_t value) {
  Triple normal = {0, 0, 0};
  normal[axis] = 1;
  return {normal, -ExactInteger(value)};
}

bool ExactPlane::normalise() {
  using boost::multiprecision::gcd;
  ExactInteger divisor = gcd(gcd(normal[0], normal[1]), gcd(normal[2], offset));
  int first = 0;
  for (int k = 0; k < 3 && first == 0; ++k) first = sign(normal[k]);
  if (first < 0) divisor = -divisor;
  *this = ExactPlane({normal[0] / divisor, normal[1] / divisor, normal[2] / divisor}, offset / divisor);
  return first < 0;
}

bool ExactPlane::operator<(const ExactPlane& o) const {
  return std::tie(normal, offset) < std::tie(o.normal, o.offset);
}

ExactPoint::ExactPoint(const LatticePoint& p) : coordinates(triple(p)), weight(1) {
  for (int k = 0; k < 3; ++k) rounded[k] = static_cast<double>(p[k]);
}

ExactPoint::ExactPoint(const ExactPlane& a, const ExactPlane& b, const ExactPlane& c) {
  const Triple bc = cross(b.normal, c.normal), ca = cross(c.normal, a.normal), ab = cross(a.normal, b.normal);
  weight = dot(a.normal, bc);
  if (weight == 0) throw std::logic_error("Three planes without a common point.");
  for (int k = 0; k < 3; ++k) coordinates[k] = -(a.offset * bc[k] + b.offset * ca[k] + c.offset * ab[k]);
  if (weight < 0) {
    weight = -weight;
    for (ExactInteger& coordinate : coordinates) coordinate = -coordinate;
  }
  const double divisor = to_double(weight);
  for (int k = 0; k < 3; ++k) rounded[k] = to_double(coordinates[k]) / divisor;
}

bool ExactPoint::operator==(const ExactPoint& o) const {
  for (int k = 0; k < 3; ++k) {
    const double apart = std::abs(rounded[k] - o.rounded[k]);
    if (apart > error_of_side * (std::abs(rounded[k]) + std::abs(o.rounded[k]))) return false;
  }
  for (int k = 0; k < 3; ++k)
    if (compare(*this, 0, o, 0, k) != 0) return false;
  return true;
}

int side_of(const ExactPlane& plane, const ExactPoint& point) {
  double value = plane.rounded[3], magnitude = std::abs(value);
  for (int k = 0; k < 3; ++k) {
    const double part = plane.rounded[k] * point.rounded[k];
    value += part;
    magnitude += std::abs(part);
  }
  if (std::abs(value) > error_of_side * magnitude) return value > 0 ? 1 : -1;
  return sign(dot(plane.normal, point.coordinates) + plane.offset * point.weight);
}

int compare(const ExactPoint& point, int axis, std::int64_t value) {
  const double apart = point.rounded[axis] - static_cast<double>(value);
  if (std::abs(apart) > error_of_side * std::abs(point.rounded[axis])) return apart > 0 ? 1 : -1;
  return sign(point.coordinates[axis] - value * point.weight);
}

int compare(const ExactPoint& a, std::int64_t origin_of_a, const ExactPoint& b, std::int64_t origin_of_b,
            int axis) {
  const double x = a.rounded[axis] + static_cast<double>(origin_of_a);
  const double y = b.rounded[axis] + static_cast<double>(origin_of_b);
  const double magnitude = std::abs(a.rounded[axis]) + std::abs(static_cast<double>(origin_of_a)) +
                           std::abs(b.rounded[axis]) + std::abs(static_cast<double>(origin_of_b));
  if (std::abs(x - y) > error_of_side * magnitude) return x > y ? 1 : -1;
  return sign((a.coordinates[axis] + origin_of_a * a.weight) * b.weight -
              (b.coordinates[axis] + origin_of_b * b.weight) * a.weight);
}

LatticePoint rounded_normal(const LatticeTriangle& t) {
  const auto edge = [&](int k) {
    return Vector3(static_cast<double>(t[k][0] - t[0][0]), static_cast<double>(t[k][1] - t[0][1]),
                   static_cast<double>(t[k][2] - t[0][2]));
  };
  const Vector3 normal = edge(1).cross(edge(2));
  const double scale = direction_units / normal.cwiseAbs().maxCoeff();
  LatticePoint direction;
  for (int k = 0; k < 3; ++k) direction[k] = std::llround(scale * normal[k]);
  return direction;
}

}  // namespace meshcomplete
