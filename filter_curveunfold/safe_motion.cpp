#include "filter_curveunfold/safe_motion.h"

#include <algorithm>
#include <cmath>

#include "filter_curveunfold/loop_tree.h"

namespace meshcomplete {
namespace {

/// The share of its distance that a pair of segments keeps. Any share above 0 is safe; a larger one ends
/// steps early.
constexpr double kept_share = 0.1;

/// A step may also keep no more than this share of the angle between neighbouring segments.
constexpr double kept_angle_share = 0.1;

/// Conservative advancement converges geometrically; after so many steps what is left is not worth having.
constexpr int most_advances = 64;

struct MovingPoint {
  Vector3 start;
  Vector3 displacement;
  Vector3 at(double t) const { return start + t * displacement; }
};

/// Safe fraction, at most `limit`, for the segments ab and cd.
double safe_fraction_of_pair(MovingPoint a, MovingPoint b, MovingPoint c, MovingPoint d, double limit) {
  // What all four have in common changes no distance.
  const Vector3 common = (a.displacement + b.displacement + c.displacement + d.displacement) / 4;
  for (MovingPoint* p : {&a, &b, &c, &d}) p->displacement -= common;
  const double speed = std::sqrt(std::max(a.displacement.squaredNorm(), b.displacement.squaredNorm())) +
                       std::sqrt(std::max(c.displacement.squaredNorm(), d.displacement.squaredNorm()));
  double distance = std::sqrt(squared_distance(a.start, b.start, c.start, d.start));
  const double kept = kept_share * distance;
  double t = 0;
  for (int k = 0; k < most_advances; ++k) {
    if ((distance - kept) >= speed * (limit - t)) return limit;
    const double advance = (distance - kept) / speed;
    // Stop once the gap has shrunk so far that another advance gains next to nothing.
    if (advance < 1e-3 * limit) return t;
    t += advance;
    distance = std::sqrt(squared_distance(a.at(t), b.at(t), c.at(t), d.at(t)));
  }
  return t;
}

/// Safe fraction, at most `limit`, for the neighbouring segments ab and bc: the angle at b stays above 0.
double safe_fraction_of_corner(const MovingPoint& a, const MovingPoint& b, const MovingPoint& c,
                               double limit) {
  const double first_speed = (a.displacement - b.displacement).norm();
  const double second_speed = (c.displacement - b.displacement).norm();
  const auto state = [&](double t, double& first, double& second) {
    const Vector3 to_a = a.at(t) - b.at(t), to_c = c.at(t) - b.at(t);
    first = to_a.norm();
    second = to_c.norm();
    return angle_between(to_a, to_c);
  };
  double first = 0, second = 0;
  double angle = state(0, first, second);
  const double kept = kept_angle_share * angle;
  double t = 0;
  for (int k = 0; k < most_advances; ++k) {
    // A direction of length l whose end moves by s turns by at most asin(s / l) <= (pi / 2) s / l, while s <
    // l.
    const double rate = 1.5707963267948966 * (first_speed / first + second_speed / second);
    const double advance = rate > 0 ? std::min(angle - kept, 1.5) / rate : limit;
    if (t + advance >= limit) return limit;
    if (advance < 1e-3 * limit) return t;
    t += advance;
    angle = state(t, first, second);
    if (angle <= kept) return t;
  }
  return t;
}

}  // namespace

double folding_bound(const Vector3& before, const Vector3& point, const Vector3& after) {
  const Vector3 to_before = before - point, to_after = after - point;
  // Both ends of a segment move, so its direction turns by at most asin(2 s / l); both segments turn.
  const double least = std::min(to_before.norm(), to_after.norm());
  return least * std::sin(angle_between(to_before, to_after) / 2) / 2;
}

double safe_fraction(const Loop& from, const Loop& to) {
  const std::size_t n = from.size();
  const auto moving = [&](std::size_t i) {
    const std::size_t k = i < n ? i : i - n;
    return MovingPoint{from[k], to[k] - from[k]};
  };
  double fraction = 1;
  for (std::size_t i = 0; i < n; ++i) {
    fraction = safe_fraction_of_corner(moving(i), moving(i + 1), moving(i + 2), fraction);
    if (fraction <= 0) return 0;
  }
  // Every segment grown by the largest displacement: pairs whose boxes stay apart are no nearer than their
  // motion.
  double largest = 0;
  for (std::size_t i = 0; i < n; ++i) largest = std::max(largest, (to[i] - from[i]).squaredNorm());
  const double reach = std::sqrt(largest) / (1 - kept_share);
  const LoopTree tree(from);
  for (std::size_t i = 0; i < n; ++i) {
    const LoopTree::Box box = LoopTree::grown(LoopTree::box_of(from[i], from[(i + 1) % n]), 2 * reach);
    tree.for_each_in_box(box, [&](std::size_t j) {
      if (j <= i + 1 || (i == 0 && j + 1 == n)) return true;
      fraction = safe_fraction_of_pair(moving(i), moving(i + 1), moving(j), moving(j + 1), fraction);
      return fraction > 0;
    });
    if (fraction <= 0) return 0;
  }
  return fraction;
}

}  // namespace meshcomplete
