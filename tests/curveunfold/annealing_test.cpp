#include "filter_curveunfold/annealing.h"

#include <gtest/gtest.h>

#include "filter_curveunfold/loop_tree.h"
#include "tests/support/loop_families.h"

namespace meshcomplete {
namespace {

constexpr double pi = 3.14159265358979323846;

Loop unit_size(Loop loop) {
  Vector3 low = loop[0], high = loop[0];
  for (const Vector3& p : loop) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  for (Vector3& p : loop) p = (p - (low + high) / 2) / (high - low).norm();
  return loop;
}

/// Rims that no fitted plane shows without a crossing.
std::vector<Loop> rims_to_unfold(int points, int count) {
  std::vector<Loop> rims;
  for (std::uint64_t seed = 1; seed < 2000 && rims.size() < static_cast<std::size_t>(count); ++seed) {
    Loop rim = unit_size(testing::rough_rim(points, seed));
    if (!simple_projection(rim, 0)) rims.push_back(std::move(rim));
  }
  return rims;
}

TEST(PlanarityEnergy, of_planar_loops_is_half_a_turn_per_change_of_side) {
  EXPECT_NEAR(planarity_energy(testing::saddle(30, 1, 0)), 0, 1e-9);
  // One dent: the sense of turning changes twice.
  const Loop dented = {Vector3(0, 0, 0), Vector3(4, 0, 0), Vector3(4, 4, 0), Vector3(2, 1, 0),
                       Vector3(0, 4, 0)};
  EXPECT_NEAR(planarity_energy(dented), 2 * pi, 1e-9);
}

TEST(PlanarityEnergy, of_a_bent_square_is_the_sum_of_the_angles_between_its_planes) {
  const double height = 0.5;
  const Loop bent = {Vector3(0, 0, 0), Vector3(1, 0, height), Vector3(1, 1, 0), Vector3(0, 1, height)};
  double expected = 0;
  for (int i = 0; i < 4; ++i) {
    const auto normal = [&](int k) -> Vector3 {
      return (bent[k % 4] - bent[(k + 1) % 4]).cross(bent[(k + 2) % 4] - bent[(k + 1) % 4]);
    };
    const Vector3 a = normal(i).normalized(), b = normal(i + 1).normalized();
    expected += std::acos(a.dot(b));
  }
  EXPECT_NEAR(planarity_energy(bent), expected, 1e-12);
}

TEST(Annealing, a_simple_projection_counts_as_one_run_without_steps) {
  const AnnealingResult result = anneal(unit_size(testing::saddle(40, 2, 0.3)), UnfoldOptions());
  EXPECT_TRUE(result.polygon);
  EXPECT_EQ(result.runs, 1);
  EXPECT_EQ(result.steps, 0u);
}

TEST(Annealing, no_accepted_step_lets_segments_touch) {
  const Loop rim = rims_to_unfold(33, 1).at(0);
  UnfoldOptions options;
  options.restarts = 2;
  std::size_t accepted = 0;
  anneal(rim, options, Progress(), [&](const Loop& before, const Loop& after) {
    ++accepted;
    const double start = LoopTree(before).least_distance(before, 10);
    const double end = LoopTree(after).least_distance(after, 10);
    double moved = 0;
    for (std::size_t i = 0; i < before.size(); ++i) moved = std::max(moved, (after[i] - before[i]).norm());
    // Two segments that are `start` apart cannot meet while no point moves by half of that.
    ASSERT_LT(moved, start / 2);
    ASSERT_GT(end, options.min_distance);
  });
  EXPECT_GT(accepted, 50u);
}

TEST(Annealing, knots_stay_knotted) {
  UnfoldOptions options;
  options.restarts = 3;
  const AnnealingResult result = anneal(unit_size(testing::torus_knot(20, 2, 3)), options);
  EXPECT_FALSE(result.polygon);
  EXPECT_EQ(result.runs, 3);
  EXPECT_GT(result.steps, 1000u);
}

TEST(Annealing, is_repeatable_and_depends_on_the_seed) {
  const Loop rim = rims_to_unfold(53, 1).at(0);
  UnfoldOptions options;
  const AnnealingResult first = anneal(rim, options), second = anneal(rim, options);
  ASSERT_TRUE(first.polygon);
  EXPECT_EQ(first.steps, second.steps);
  EXPECT_EQ(*first.polygon, *second.polygon);
  options.seed = 2;
  EXPECT_NE(first.steps, anneal(rim, options).steps);
}

TEST(Annealing, unfolds_rims_as_large_as_the_papers_with_nine_of_ten_seeds) {
  for (const int points : {33, 35, 53, 63}) {
    const std::vector<Loop> rims = rims_to_unfold(points, 1);
    ASSERT_EQ(rims.size(), 1u);
    int unfolded = 0;
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
      UnfoldOptions options;
      options.seed = seed;
      const AnnealingResult result = anneal(rims[0], options);
      if (!result.polygon) continue;
      ++unfolded;
      EXPECT_TRUE(is_simple(*result.polygon));
      EXPECT_GT(signed_area(*result.polygon), 0);
    }
    EXPECT_GE(unfolded, 9) << points << " points";
  }
}

}  // namespace
}  // namespace meshcomplete
