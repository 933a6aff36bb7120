// Outlines of a scan's faces in the image that its sensor sees.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <utility>

namespace meshcomplete {

using Vector2 = Eigen::Vector2d;

/// From `low` to `high`, both included; empty when made.
struct Range {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();
  void include(double x) {
    low = std::min(low, x);
    high = std::max(high, x);
  }
};

inline constexpr Range unlimited{-std::numeric_limits<double>::infinity(),
                                 std::numeric_limits<double>::infinity()};

/// A convex outline in the image, of at most four corners.
struct Outline {
  std::array<Vector2, 4> corners;
  int count = 0;
  void add(const Vector2& corner) { corners[static_cast<std::size_t>(count++)] = corner; }
};

/// The part of the u axis that an outline takes up between two values of v.
inline Range columns_between(const Outline& outline, double v_low, double v_high) {
  Range range;
  for (int i = 0; i < outline.count; ++i) {
    Vector2 a = outline.corners[static_cast<std::size_t>(i)];
    Vector2 b = outline.corners[static_cast<std::size_t>((i + 1) % outline.count)];
    if (a.y() > b.y()) std::swap(a, b);
    if (b.y() < v_low || a.y() > v_high) continue;
    const double height = b.y() - a.y();
    const auto at = [&](double v) {
      return height > 0 ? a.x() + std::clamp((v - a.y()) / height, 0.0, 1.0) * (b.x() - a.x()) : a.x();
    };
    range.include(at(std::max(v_low, a.y())));
    range.include(at(std::min(v_high, b.y())));
    if (height <= 0) range.include(b.x());
  }
  return range;
}

}  // namespace meshcomplete
