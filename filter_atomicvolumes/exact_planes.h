// Points given as the meeting of three planes with integer coefficients: whatever is asked of them has an
// exact answer, however many planes have cut before.
#pragma once

#include <array>
#include <cstdint>

#include "common/core/lattice.h"

namespace meshcomplete {

/// An integer as the arithmetic in the source file stores it: planes through lattice points have normals of
/// 79 bits and offsets of 120, points where three of them meet coordinates of 281 bits over 240; the side of
/// a plane needs 363 bits, the order of two points 523.
struct ExactInteger {
  static constexpr int limbs = 9;
  std::array<std::uint64_t, limbs> magnitude{};  ///< the lowest limb first
  bool negative = false;                         ///< never for 0

  ExactInteger(std::int64_t value = 0);
};

/// normal . p + offset = 0; the positive side is that of the normal. Coordinates are relative to an origin
/// that the planes and points of one complex share.
struct ExactPlane {
  std::array<ExactInteger, 3> normal;
  ExactInteger offset;
  std::array<double, 4> rounded;  ///< the normal and the offset

  ExactPlane(const std::array<ExactInteger, 3>& normal, const ExactInteger& offset);

  /// Through the triangle; the normal is that of the triangle.
  static ExactPlane through(const LatticeTriangle& triangle);
  /// Through the edge from `a` to `b` and along `direction`; `inner` is on its positive side. The three
  /// points and the direction must not lie in one plane.
  static ExactPlane along(const LatticePoint& a, const LatticePoint& b, const LatticePoint& direction,
                          const LatticePoint& inner);
  /// Where coordinate `axis` has this value; the normal points up.
  static ExactPlane across(int axis, std::int64_t value);

  /// The same for all triangles in one plane: no common factor, the first coefficient that is not 0 positive.
  /// Returns whether the normal was turned over.
  bool normalise();
  bool operator<(const ExactPlane& other) const;
};

/// coordinates / weight, with a positive weight.
struct ExactPoint {
  std::array<ExactInteger, 3> coordinates;
  ExactInteger weight;
  Vector3 rounded;

  explicit ExactPoint(const LatticePoint& p);
  /// Where three planes meet that have one point in common.
  ExactPoint(const ExactPlane& a, const ExactPlane& b, const ExactPlane& c);

  bool operator==(const ExactPoint& other) const;
};

/// On which side of the plane the point lies: 1 on the positive one, 0 on the plane. Exact.
int side_of(const ExactPlane& plane, const ExactPoint& point);

/// The sign of a coordinate less `value`. Exact.
int compare(const ExactPoint& point, int axis, std::int64_t value);

/// The sign of the difference between a coordinate of two points that are relative to different origins.
int compare(const ExactPoint& a, std::int64_t origin_of_a, const ExactPoint& b, std::int64_t origin_of_b,
            int axis);

/// A vector of small integers nearly along the triangle's normal: good for planes through its sides.
LatticePoint rounded_normal(const LatticeTriangle& triangle);

}  // namespace meshcomplete
