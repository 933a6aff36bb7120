#include "filter_curveunfold/safe_motion.h"

#include <gtest/gtest.h>

#include <random>

#include "filter_curveunfold/loop_tree.h"
#include "tests/support/loop_families.h"

namespace meshcomplete {
namespace {

Loop between(const Loop& from, const Loop& to, double t) {
  Loop loop(from.size());
  for (std::size_t i = 0; i < from.size(); ++i) loop[i] = from[i] + t * (to[i] - from[i]);
  return loop;
}

Loop shaken(const Loop& loop, double amount, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const auto coordinate = [&] { return static_cast<double>(random() % 2001) / 1000 - 1; };
  Loop result = loop;
  for (Vector3& p : result) p += amount * Vector3(coordinate(), coordinate(), coordinate());
  return result;
}

TEST(SafeMotion, nothing_touches_within_the_certified_fraction) {
  int limited = 0;
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    const Loop from = testing::random_tangle(25, seed);
    const Loop to = shaken(from, 0.3, seed);
    const double fraction = safe_fraction(from, to);
    EXPECT_GT(fraction, 0);
    limited += fraction < 1;
    const double before = LoopTree(from).least_distance(from, 10);
    for (int k = 0; k <= 200; ++k) {
      const Loop loop = between(from, to, fraction * k / 200);
      ASSERT_GE(LoopTree(loop).least_distance(loop, 10), 0.099 * before);
    }
  }
  EXPECT_GT(limited, 5);
}

TEST(SafeMotion, a_motion_through_itself_is_stopped_before_the_crossing) {
  // A rectangle with a finger: the finger's tip moves through the opposite side half-way.
  const Loop from = {Vector3(0, 0, 0),   Vector3(4, 0, 0),   Vector3(4, 3, 0), Vector3(2.5, 3, 0),
                     Vector3(2, 1, 0.1), Vector3(1.5, 3, 0), Vector3(0, 3, 0)};
  Loop to = from;
  to[4] =
      Vector3(2, -1, 0.0);  // level with the lower side after half of the way, 0.05 above it: just misses it
  EXPECT_EQ(safe_fraction(from, from), 1);
  Loop through = to;
  through[4] = Vector3(2, -1, -0.1);
  const double fraction = safe_fraction(from, through);
  EXPECT_GT(fraction, 0.3);
  EXPECT_LT(fraction, 0.5);
}

TEST(SafeMotion, neighbours_do_not_fold_onto_each_other) {
  const Loop from = {Vector3(0, 0, 0), Vector3(1, 0, 0), Vector3(1, 1, 0), Vector3(0, 1, 0)};
  Loop to = from;
  to[2] = Vector3(0.2, -0.6, 0);  // swings the edge at (1, 0) across the one before it
  EXPECT_LT(safe_fraction(from, to), 0.7);
  EXPECT_GT(safe_fraction(from, to), 0.2);
}

TEST(SafeMotion, rigid_translations_are_free) {
  const Loop from = testing::random_tangle(60, 5);
  Loop to = from;
  for (Vector3& p : to) p += Vector3(10, -5, 3);
  EXPECT_EQ(safe_fraction(from, to), 1);
}

TEST(SafeMotion, folding_bound_keeps_the_angle_open) {
  std::mt19937_64 random(3);
  const auto coordinate = [&] { return static_cast<double>(random() % 2001) / 1000 - 1; };
  for (int k = 0; k < 500; ++k) {
    const Vector3 a(coordinate(), coordinate(), coordinate()), b(coordinate(), coordinate(), coordinate());
    const double bound = 0.99 * folding_bound(a, Vector3::Zero(), b);
    const auto moved = [&](const Vector3& p) {
      return Vector3(p + bound * Vector3(coordinate(), coordinate(), coordinate()).normalized());
    };
    const Vector3 corner = moved(Vector3::Zero());
    EXPECT_GT(angle_between(moved(a) - corner, moved(b) - corner), 0);
    // The worst case: the ends move towards each other and the corner, straight.
    const Vector3 chord = (b - a).normalized();
    EXPECT_GT(angle_between(a + bound * chord, b - bound * chord), 1e-3 * angle_between(a, b));
  }
}

}  // namespace
}  // namespace meshcomplete
