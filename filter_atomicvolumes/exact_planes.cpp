#include "filter_atomicvolumes/exact_planes.h"

#include <Eigen/Geometry>
#include <boost/multiprecision/cpp_int.hpp>
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

using Integer = boost::multiprecision::number<boost::multiprecision::cpp_int_backend<
    64 * ExactInteger::limbs, 64 * ExactInteger::limbs, boost::multiprecision::signed_magnitude,
    boost::multiprecision::unchecked, void>>;
using Triple = std::array<Integer, 3>;

Integer load(const ExactInteger& value) {
  Integer result;
  import_bits(result, value.magnitude.begin(), value.magnitude.end(), 64, false);
  return value.negative ? Integer(-result) : result;
}

ExactInteger store(const Integer& value) {
  ExactInteger result;
  result.negative = value < 0;
  export_bits(Integer(abs(value)), result.magnitude.begin(), 64, false);
  return result;
}

Triple load(const std::array<ExactInteger, 3>& v) { return {load(v[0]), load(v[1]), load(v[2])}; }

std::array<ExactInteger, 3> store(const Triple& v) { return {store(v[0]), store(v[1]), store(v[2])}; }

int sign(const Integer& value) { return value.sign(); }

double to_double(const Integer& value) { return value.convert_to<double>(); }

Triple cross(const Triple& u, const Triple& v) {
  return {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
}

Integer dot(const Triple& u, const Triple& v) { return u[0] * v[0] + u[1] * v[1] + u[2] * v[2]; }

Triple difference(const LatticePoint& a, const LatticePoint& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

Triple triple(const LatticePoint& a) { return {a[0], a[1], a[2]}; }

}  // namespace

ExactInteger::ExactInteger(std::int64_t value) : negative(value < 0) {
  const std::uint64_t bits = static_cast<std::uint64_t>(value);
  magnitude[0] = negative ? ~bits + 1 : bits;
}

ExactPlane::ExactPlane(const std::array<ExactInteger, 3>& n, const ExactInteger& o) : normal(n), offset(o) {
  for (int k = 0; k < 3; ++k) rounded[k] = to_double(load(normal[k]));
  rounded[3] = to_double(load(offset));
}

ExactPlane ExactPlane::through(const LatticeTriangle& t) {
  const Triple normal = cross(difference(t[1], t[0]), difference(t[2], t[0]));
  return {store(normal), store(-dot(normal, triple(t[0])))};
}

ExactPlane ExactPlane::along(const LatticePoint& a, const LatticePoint& b, const LatticePoint& direction,
                             const LatticePoint& inner) {
  Triple normal = cross(difference(b, a), triple(direction));
  if (dot(normal, difference(inner, a)) < 0)
    for (Integer& component : normal) component = -component;
  return {store(normal), store(-dot(normal, triple(a)))};
}

ExactPlane ExactPlane::across(int axis, std::int64_t value) {
  std::array<ExactInteger, 3> normal;
  normal[axis] = 1;
  return {normal, -value};
}

bool ExactPlane::normalise() {
  using boost::multiprecision::gcd;
  const Triple n = load(normal);
  const Integer o = load(offset);
  Integer divisor = gcd(Integer(gcd(n[0], n[1])), Integer(gcd(n[2], o)));
  int first = 0;
  for (int k = 0; k < 3 && first == 0; ++k) first = sign(n[k]);
  if (first < 0) divisor = -divisor;
  const Triple divided = {n[0] / divisor, n[1] / divisor, n[2] / divisor};
  *this = ExactPlane(store(divided), store(o / divisor));
  return first < 0;
}

bool ExactPlane::operator<(const ExactPlane& other) const {
  const Triple a = load(normal), b = load(other.normal);
  return a != b ? a < b : load(offset) < load(other.offset);
}

ExactPoint::ExactPoint(const LatticePoint& p) : coordinates{p[0], p[1], p[2]}, weight(1) {
  for (int k = 0; k < 3; ++k) rounded[k] = static_cast<double>(p[k]);
}

ExactPoint::ExactPoint(const ExactPlane& a, const ExactPlane& b, const ExactPlane& c) {
  const Triple na = load(a.normal), nb = load(b.normal), nc = load(c.normal);
  const Integer oa = load(a.offset), ob = load(b.offset), oc = load(c.offset);
  const Triple bc = cross(nb, nc), ca = cross(nc, na), ab = cross(na, nb);
  Integer divisor = dot(na, bc);
  if (divisor == 0) throw std::logic_error("Three planes without a common point.");
  Triple sums;
  for (int k = 0; k < 3; ++k) sums[k] = -(oa * bc[k] + ob * ca[k] + oc * ab[k]);
  if (divisor < 0) {
    divisor = -divisor;
    for (Integer& sum : sums) sum = -sum;
  }
  weight = store(divisor);
  coordinates = store(sums);
  const double divided_by = to_double(divisor);
  for (int k = 0; k < 3; ++k) rounded[k] = to_double(sums[k]) / divided_by;
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
  return sign(
      Integer(dot(load(plane.normal), load(point.coordinates)) + load(plane.offset) * load(point.weight)));
}

int compare(const ExactPoint& point, int axis, std::int64_t value) {
  const double apart = point.rounded[axis] - static_cast<double>(value);
  if (std::abs(apart) > error_of_side * std::abs(point.rounded[axis])) return apart > 0 ? 1 : -1;
  return sign(Integer(load(point.coordinates[axis]) - value * load(point.weight)));
}

int compare(const ExactPoint& a, std::int64_t origin_of_a, const ExactPoint& b, std::int64_t origin_of_b,
            int axis) {
  const double x = a.rounded[axis] + static_cast<double>(origin_of_a);
  const double y = b.rounded[axis] + static_cast<double>(origin_of_b);
  const double magnitude = std::abs(a.rounded[axis]) + std::abs(static_cast<double>(origin_of_a)) +
                           std::abs(b.rounded[axis]) + std::abs(static_cast<double>(origin_of_b));
  if (std::abs(x - y) > error_of_side * magnitude) return x > y ? 1 : -1;
  const Integer wa = load(a.weight), wb = load(b.weight);
  return sign(Integer((load(a.coordinates[axis]) + origin_of_a * wa) * wb -
                      (load(b.coordinates[axis]) + origin_of_b * wb) * wa));
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
