#include "filter_curveunfold/unfold.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <limits>

#include "common/core/error.h"
#include "filter_curveunfold/loop_geometry.h"
#include "tests/support/loop_families.h"

namespace meshcomplete {
namespace {

void expect_valid(const Unfolding& unfolding, std::size_t points) {
  ASSERT_EQ(unfolding.polygon.size(), points);
  Polygon rounded;
  for (const Vector2& p : unfolding.polygon) rounded.push_back(testing::on_grid(p));
  EXPECT_TRUE(testing::is_simple_by_brute_force(rounded));
  EXPECT_GT(signed_area(unfolding.polygon), 0);
  EXPECT_GE(unfolding.seconds, 0);
}

TEST(Unfold, small_and_flat_loops_are_projected) {
  const std::vector<testing::Loop> loops = {
      {Vector3(0, 0, 0), Vector3(1, 0, 0), Vector3(0, 1, 5)},
      {Vector3(0, 0, 0), Vector3(1, 0, 1), Vector3(1, 1, 0), Vector3(0, 1, 1)},
      testing::saddle(30, 2, 0.2),
      testing::saddle(1000, 3, 0.5)};
  for (const testing::Loop& loop : loops) {
    const Unfolding unfolding = unfold(loop);
    EXPECT_EQ(unfolding.outcome, UnfoldOutcome::projected);
    expect_valid(unfolding, loop.size());
    EXPECT_EQ(unfolding.steps, 0u);
  }
}

TEST(Unfold, a_bow_tie_is_opened_and_not_seen_from_its_edge) {
  const Unfolding unfolding =
      unfold({Vector3(0, 0, 0), Vector3(1, 1, 0.01), Vector3(1, 0, 0), Vector3(0, 1, 0.02)});
  expect_valid(unfolding, 4);
  EXPECT_GT(signed_area(unfolding.polygon), 0.05);
}

TEST(Unfold, planar_loops_keep_their_shape) {
  const testing::Loop loop = testing::sampled(40, [](double t) {
    const double radius = 1 + 0.5 * std::cos(3 * t);
    return Vector3(radius * std::cos(t), 7, radius * std::sin(t));
  });
  const Unfolding unfolding = unfold(loop);
  expect_valid(unfolding, loop.size());
  const double scale = (unfolding.polygon[1] - unfolding.polygon[0]).norm() / (loop[1] - loop[0]).norm();
  for (std::size_t i = 0; i < loop.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      EXPECT_NEAR((unfolding.polygon[i] - unfolding.polygon[j]).norm(), scale * (loop[i] - loop[j]).norm(),
                  1e-9);
    }
  }
}

TEST(Unfold, loops_that_no_projection_unfolds_are_untangled) {
  for (const testing::Loop& loop : {testing::wound_rim(80, 3), testing::random_tangle(60, 2)}) {
    const Unfolding unfolding = unfold(loop);
    EXPECT_EQ(unfolding.outcome, UnfoldOutcome::untangled);
    expect_valid(unfolding, loop.size());
    EXPECT_GT(unfolding.steps, 0u);
    EXPECT_EQ(unfolding.knot_determinant, 1);
  }
}

TEST(Unfold, knots_are_refused_by_every_method) {
  for (const UnfoldMethod method :
       {UnfoldMethod::automatic, UnfoldMethod::annealing, UnfoldMethod::descent}) {
    UnfoldOptions options;
    options.method = method;
    const Unfolding trefoil = unfold(testing::torus_knot(60, 2, 3), options);
    EXPECT_EQ(trefoil.outcome, UnfoldOutcome::knotted);
    EXPECT_EQ(trefoil.knot_determinant, 3);
    EXPECT_TRUE(trefoil.polygon.empty());
    const Unfolding figure_eight = unfold(testing::figure_eight_knot(2000), options);
    EXPECT_EQ(figure_eight.outcome, UnfoldOutcome::knotted);
    EXPECT_EQ(figure_eight.knot_determinant, 5);
  }
}

TEST(Unfold, knots_that_the_determinant_misses_are_not_unfolded) {
  const Unfolding unfolding = unfold(testing::torus_knot(100, 3, 5));
  EXPECT_EQ(unfolding.outcome, UnfoldOutcome::not_unfolded);
  EXPECT_EQ(unfolding.knot_determinant, 1);
  EXPECT_TRUE(unfolding.polygon.empty());
}

TEST(Unfold, annealing_gives_up_after_its_restarts) {
  UnfoldOptions options;
  options.method = UnfoldMethod::annealing;
  options.restarts = 3;
  const Unfolding unfolding = unfold(testing::wound_rim(60, 3), options);
  EXPECT_EQ(unfolding.outcome, UnfoldOutcome::not_unfolded);
  EXPECT_EQ(unfolding.restarts, 3);
}

TEST(Unfold, chosen_methods_are_used_for_simple_loops_too) {
  UnfoldOptions options;
  options.method = UnfoldMethod::annealing;
  const Unfolding annealed = unfold(testing::saddle(40, 2, 0.3), options);
  EXPECT_EQ(annealed.outcome, UnfoldOutcome::annealed);
  EXPECT_EQ(annealed.restarts, 1);
  options.method = UnfoldMethod::descent;
  EXPECT_EQ(unfold(testing::saddle(40, 2, 0.3), options).outcome, UnfoldOutcome::untangled);
}

TEST(Unfold, stretching_gives_another_more_open_polygon) {
  for (const testing::Loop& loop : {testing::saddle(60, 3, 1.0), testing::wound_rim(80, 3)}) {
    UnfoldOptions options;
    const Unfolding first = unfold(loop, options);
    options.stretch = true;
    const Unfolding second = unfold(loop, options);
    EXPECT_EQ(first.outcome, second.outcome);
    expect_valid(second, loop.size());
    EXPECT_GT(signed_area(second.polygon), 1.5 * signed_area(first.polygon));
  }
}

TEST(Unfold, does_not_depend_on_scale_and_place) {
  const testing::Loop loop = testing::wound_rim(64, 3);
  const Unfolding expected = unfold(loop);
  for (const double scale : {0x1p-100, 0x1p-30, 0x1p30, 0x1p100}) {
    testing::Loop scaled = loop;
    for (Vector3& p : scaled) p *= scale;
    EXPECT_EQ(unfold(scaled).polygon, expected.polygon);
  }
  testing::Loop far = loop;
  for (Vector3& p : far) p += Vector3(1e6, -3e6, 2e5);
  const Unfolding moved = unfold(far);
  EXPECT_EQ(moved.outcome, expected.outcome);
  expect_valid(moved, loop.size());
}

TEST(Unfold, is_repeatable) {
  const testing::Loop loop = testing::random_tangle(100, 7);
  EXPECT_EQ(unfold(loop).polygon, unfold(loop).polygon);
}

TEST(Unfold, total_curvature_below_four_pi_needs_no_knot_test) {
  UnfoldOptions options;
  options.method = UnfoldMethod::descent;
  const Unfolding unfolding = unfold(testing::saddle(60, 2, 0.2), options);
  EXPECT_LT(unfolding.total_curvature, 4 * 3.14159265358979);
  EXPECT_FALSE(unfolding.knot_determinant);
}

TEST(Unfold, refuses_what_is_not_a_loop) {
  EXPECT_THROW(unfold({}), CompletionError);
  EXPECT_THROW(unfold({Vector3(0, 0, 0), Vector3(1, 0, 0)}), CompletionError);
  EXPECT_THROW(unfold({Vector3(0, 0, 0), Vector3(1, 0, 0), Vector3(1, 0, 0), Vector3(0, 1, 0)}),
               CompletionError);
  EXPECT_THROW(unfold({Vector3(0, 0, 0), Vector3(1, 0, 0), Vector3(0, 1, 0), Vector3(0, 0, 0)}),
               CompletionError);
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_THROW(unfold({Vector3(0, 0, 0), Vector3(1, 0, infinity), Vector3(0, 1, 0)}), CompletionError);
}

TEST(Unfold, loops_that_touch_themselves_are_not_unfolded) {
  testing::Loop loop = testing::wound_rim(40, 2);
  loop[25] = loop[5];
  const Unfolding unfolding = unfold(loop);
  EXPECT_EQ(unfolding.outcome, UnfoldOutcome::not_unfolded);
}

TEST(Unfold, options_out_of_range_are_refused) {
  const testing::Loop loop = testing::saddle(20, 2, 0.1);
  UnfoldOptions options;
  options.restarts = 0;
  EXPECT_THROW(unfold(loop, options), CompletionError);
  options = UnfoldOptions();
  options.cooling = 1;
  EXPECT_THROW(unfold(loop, options), CompletionError);
  options = UnfoldOptions();
  options.min_distance = 0.5;
  EXPECT_THROW(unfold(loop, options), CompletionError);
  options = UnfoldOptions();
  options.start_temperature = -1;
  EXPECT_THROW(unfold(loop, options), CompletionError);
}

TEST(Unfold, can_be_cancelled) {
  int calls = 0;
  const Progress progress([&calls](double, const std::string&) { return ++calls < 2; });
  UnfoldOptions options;
  options.method = UnfoldMethod::annealing;
  options.restarts = 10000;
  EXPECT_THROW(unfold(testing::wound_rim(60, 3), options, progress), Cancelled);
}

}  // namespace
}  // namespace meshcomplete
