#include "filter_curveunfold/crossing_removal.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "filter_curveunfold/unfold.h"
#include "tests/support/loop_families.h"

namespace meshcomplete {
namespace {

constexpr double pi = 3.14159265358979323846;

/// The next number of a sequence that is the same everywhere, between -1 and 1.
double noise(std::mt19937_64& random) { return 2 * std::ldexp(static_cast<double>(random() >> 11), -53) - 1; }

/// The angle at which point i of a rim stands but for its jags.
double smooth_angle(int i, int points) { return 2 * pi * i / points; }

/// A nearly planar rim whose points stand up to 1.2 edges before or behind their place: its teeth hook into
/// each other when seen from above.
Loop jagged_rim(int points, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  Loop loop;
  for (int i = 0; i < points; ++i) {
    const double angle = smooth_angle(i, points) + 1.2 * noise(random) * 2 * pi / points;
    const double radius = 0.35 * (1 + 0.03 * noise(random));
    const double height = 0.03 * std::cos(2 * angle) + 0.01 * noise(random);
    loop.emplace_back(radius * std::cos(angle), radius * std::sin(angle), height);
  }
  return loop;
}

Loop scaled(Loop loop, double x, double y, double z) {
  for (Vector3& p : loop) p = p.cwiseProduct(Vector3(x, y, z));
  return loop;
}

void expect_same_cyclic_order(const Polygon& polygon) {
  const int points = static_cast<int>(polygon.size());
  // Point 0 may be jagged itself: the turn that all points share is that of their mean.
  Vector2 mean_turn(0, 0);
  std::vector<double> turns[2];
  for (int mirrored = 0; mirrored < 2; ++mirrored) {
    mean_turn.setZero();
    for (int i = 0; i < points; ++i) {
      const Vector2& p = polygon[static_cast<std::size_t>(i)];
      const double turn = std::atan2(p.y(), p.x()) - (mirrored ? -1 : 1) * smooth_angle(i, points);
      turns[mirrored].push_back(turn);
      mean_turn += Vector2(std::cos(turn), std::sin(turn));
    }
    if (!mirrored && mean_turn.norm() < 0.5 * points) continue;  // the plane was seen from below
    const double mean = std::atan2(mean_turn.y(), mean_turn.x());
    for (const double turn : turns[mirrored]) EXPECT_LT(std::abs(std::remainder(turn - mean, 2 * pi)), 0.15);
    return;
  }
}

TEST(CrossingRemoval, unfolds_jagged_rims_in_a_few_moves) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const Loop loop = jagged_rim(400, seed);
    ASSERT_FALSE(simple_projection(loop, 48)) << seed;
    const CrossingRemoval removal = remove_crossings(loop);
    ASSERT_TRUE(removal.polygon) << seed;
    ASSERT_EQ(removal.polygon->size(), loop.size());
    EXPECT_GT(removal.moves, 0u);
    EXPECT_LT(removal.moves, loop.size() / 2);
    Polygon rounded;
    for (const Vector2& p : *removal.polygon) rounded.push_back(testing::on_grid(p));
    EXPECT_TRUE(is_simple(*removal.polygon));
    EXPECT_TRUE(testing::is_simple_by_brute_force(rounded));
    EXPECT_GT(signed_area(*removal.polygon), 0.3);  // of the 0.38 of the circle
    expect_same_cyclic_order(*removal.polygon);
    EXPECT_EQ(*remove_crossings(loop).polygon, *removal.polygon);
  }
}

TEST(CrossingRemoval, comes_before_the_descent_and_needs_no_knot_test) {
  const Loop loop = jagged_rim(400, 1);
  const Unfolding unfolding = unfold(loop);
  EXPECT_EQ(unfolding.outcome, UnfoldOutcome::untangled);
  EXPECT_GT(unfolding.steps, 0u);
  EXPECT_FALSE(unfolding.knot_determinant);
  EXPECT_TRUE(is_simple(unfolding.polygon));
  UnfoldOptions options;
  options.method = UnfoldMethod::descent;
  EXPECT_TRUE(unfold(loop, options).knot_determinant);
}

TEST(CrossingRemoval, never_unties_a_knot) {
  for (const Loop& knot : {testing::torus_knot(150, 2, 3), testing::torus_knot(400, 2, 5),
                           testing::figure_eight_knot(300), testing::torus_knot(300, 3, 5)}) {
    const Loop flat = scaled(knot, 0.1, 0.1, 0.02);
    EXPECT_FALSE(remove_crossings(flat).polygon);
    // Small enough for a tooth, somewhere on a rim whose other crossings go away.
    const Loop on_rim = testing::connected_sum(jagged_rim(400, 2), scaled(knot, 0.005, 0.005, 0.005));
    EXPECT_FALSE(remove_crossings(on_rim).polygon);
  }
  const Loop trefoil = scaled(testing::torus_knot(40, 2, 3), 0.005, 0.005, 0.005);
  const Unfolding unfolding = unfold(testing::connected_sum(jagged_rim(400, 2), trefoil));
  EXPECT_EQ(unfolding.outcome, UnfoldOutcome::knotted);
  EXPECT_EQ(unfolding.knot_determinant, 3);
}

TEST(CrossingRemoval, leaves_bent_and_wound_loops_alone) {
  EXPECT_EQ(remove_crossings(scaled(testing::rough_rim(500, 3), 0.3, 0.3, 0.3)).moves, 0u);
  const Loop wound = scaled(testing::wound_rim(500, 3), 0.3, 0.3, 0.3);
  EXPECT_FALSE(remove_crossings(wound).polygon);
}

TEST(CrossingRemoval, does_not_unfold_a_loop_that_touches_itself) {
  Loop loop = jagged_rim(400, 3);
  loop[120] = loop[20];
  EXPECT_FALSE(remove_crossings(loop).polygon);
  loop = jagged_rim(400, 3);
  loop[24] = loop[20];
  EXPECT_FALSE(remove_crossings(loop).polygon);
}

TEST(CrossingRemoval, handles_the_smallest_loops) {
  EXPECT_FALSE(
      remove_crossings({Vector3(0, 0, 0), Vector3(0.5, 0.5, 0.01), Vector3(0.5, 0, 0), Vector3(0, 0.5, 0.02)})
          .polygon);
}

TEST(CountCrossings, counts_pairs_of_edges_up_to_a_bound) {
  const Polygon pentagram = {{0, 1}, {0.6, -0.8}, {-1, 0.3}, {1, 0.3}, {-0.6, -0.8}};
  EXPECT_EQ(count_crossings(pentagram, 100), 5u);
  EXPECT_EQ(count_crossings(pentagram, 3), 3u);
  EXPECT_EQ(count_crossings({{0, 0}, {1, 0}, {1, 1}, {0, 1}}, 100), 0u);
  EXPECT_EQ(count_crossings({{0, 0}, {2, 0}, {1, 0}, {1, 1}}, 100), 2u);  // folded back, and touched
}

}  // namespace
}  // namespace meshcomplete
