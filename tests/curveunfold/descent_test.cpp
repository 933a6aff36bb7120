#include <gtest/gtest.h>

#include <cmath>

#include "filter_curveunfold/planar_stretch.h"
#include "filter_curveunfold/repulsive_flow.h"
#include "filter_curveunfold/safe_motion.h"
#include "filter_curveunfold/self_avoiding_descent.h"
#include "tests/support/loop_families.h"

namespace meshcomplete {
namespace {

Loop unit_size(Loop loop) {
  Vector3 low = loop[0], high = loop[0];
  for (const Vector3& p : loop) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  for (Vector3& p : loop) p = (p - (low + high) / 2) / (high - low).norm();
  return loop;
}

/// Ratio of the shortest to the longest edge of the polygon, each relative to the loop's edge.
double evenness(const Polygon& polygon, const Loop& loop) {
  double least = 1e300, greatest = 0;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const std::size_t next = (i + 1) % loop.size();
    const double ratio = (polygon[next] - polygon[i]).norm() / (loop[next] - loop[i]).norm();
    least = std::min(least, ratio);
    greatest = std::max(greatest, ratio);
  }
  return least / greatest;
}

TEST(TangentPointEnergy, gradient_is_the_derivative_of_the_value) {
  const Loop loop = unit_size(testing::wound_rim(20, 2));
  const TangentPointEnergy energy(loop, 0.1);
  EXPECT_GT(energy.pieces(), loop.size());
  Eigen::MatrixX3d gradient;
  EXPECT_NEAR(energy.gradient(loop, gradient), energy.value(loop), 1e-9 * energy.value(loop));
  constexpr double h = 1e-6;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    for (int k = 0; k < 3; ++k) {
      Loop left = loop, right = loop;
      left[i][k] -= h;
      right[i][k] += h;
      const double difference = (energy.value(right) - energy.value(left)) / (2 * h);
      EXPECT_NEAR(gradient(static_cast<Eigen::Index>(i), k), difference, 1e-7 * gradient.norm());
    }
  }
}

TEST(TangentPointEnergy, inner_product_is_symmetric_and_positive) {
  const Loop loop = unit_size(testing::random_tangle(40, 2));
  const Eigen::MatrixXd inner = TangentPointEnergy(loop, 0.2).inner_product(loop);
  EXPECT_EQ(inner, Eigen::MatrixXd(inner.transpose()));
  EXPECT_EQ(inner.llt().info(), Eigen::Success);
}

TEST(ContactBarrier, gradient_is_the_derivative_of_the_value) {
  const Loop loop = unit_size(testing::random_tangle(30, 4));
  const ContactBarrier barrier(edge_lengths(loop), 0.1);
  EXPECT_GT(barrier.value(loop), 0);
  Eigen::MatrixX3d gradient = Eigen::MatrixX3d::Zero(30, 3);
  Eigen::MatrixXd inner = Eigen::MatrixXd::Zero(30, 30);
  EXPECT_DOUBLE_EQ(barrier.add_derivatives(loop, gradient, inner), barrier.value(loop));
  constexpr double h = 1e-8;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    for (int k = 0; k < 3; ++k) {
      Loop left = loop, right = loop;
      left[i][k] -= h;
      right[i][k] += h;
      const double difference = (barrier.value(right) - barrier.value(left)) / (2 * h);
      EXPECT_NEAR(gradient(static_cast<Eigen::Index>(i), k), difference, 1e-4 * gradient.norm());
    }
  }
}

TEST(RepulsiveFlow, every_step_is_an_isotopy_and_keeps_the_edge_lengths) {
  const Loop start = unit_size(testing::wound_rim(60, 4));
  const std::vector<double> rest = edge_lengths(start);
  RepulsiveFlow flow(start, rest, FlowConstraint::edge_lengths, 0.05);
  Loop previous = start;
  for (int k = 0; k < 25; ++k) {
    ASSERT_TRUE(flow.step());
    ASSERT_EQ(safe_fraction(previous, flow.loop()), 1);
    previous = flow.loop();
  }
  const std::vector<double> lengths = edge_lengths(flow.loop());
  for (std::size_t i = 0; i < rest.size(); ++i) EXPECT_NEAR(lengths[i], rest[i], 0.05 * rest[i]);
  EXPECT_GT(principal_spread(flow.loop()).greatest, 1.5 * principal_spread(start).greatest);
}

TEST(Descent, never_unties_a_knot) {
  for (const Loop& loop : {testing::torus_knot(30, 2, 3), testing::figure_eight_knot(60),
                           testing::torus_knot(80, 3, 5), testing::torus_knot(400, 2, 5)}) {
    EXPECT_FALSE(descend(unit_size(loop)).polygon);
  }
}

void expect_unfolded(const Loop& loop, const char* what) {
  const DescentResult result = descend(unit_size(loop));
  ASSERT_TRUE(result.polygon) << what;
  ASSERT_EQ(result.polygon->size(), loop.size()) << what;
  EXPECT_TRUE(is_simple(*result.polygon)) << what;
  EXPECT_GT(signed_area(*result.polygon), 0) << what;
}

TEST(Descent, unfolds_wound_rims_helices_and_cylinder_loops) {
  for (const int points : {50, 120, 500}) {
    for (const int turns : {2, 3, 5}) {
      expect_unfolded(testing::wound_rim(points, turns), "wound rim");
      expect_unfolded(testing::closed_helix(points, turns), "closed helix");
    }
    expect_unfolded(testing::wound_round_cylinder(points | 1, 3), "wound round a cylinder");
    expect_unfolded(testing::saddle(points, 3, 1.0), "saddle");
  }
}

TEST(Descent, unfolds_random_tangles) {
  for (const auto& [points, seeds] : {std::pair(50, 20), std::pair(100, 4), std::pair(500, 1)}) {
    int unfolded = 0;
    for (int seed = 1; seed <= seeds; ++seed) {
      const Loop loop = unit_size(testing::random_tangle(points, static_cast<std::uint64_t>(seed)));
      const DescentResult result = descend(loop);
      if (!result.polygon) continue;
      ++unfolded;
      Polygon rounded;
      for (const Vector2& p : *result.polygon) rounded.push_back(testing::on_grid(p));
      EXPECT_TRUE(is_simple(*result.polygon));
      if (points <= 100) {
        EXPECT_TRUE(testing::is_simple_by_brute_force(rounded));
      }
    }
    EXPECT_GE(unfolded, static_cast<int>(std::ceil(0.95 * seeds))) << points << " points";
  }
}

TEST(Descent, large_loops_cost_few_steps) {
  const DescentResult result = descend(unit_size(testing::wound_rim(10000, 4)));
  ASSERT_TRUE(result.polygon);
  EXPECT_TRUE(is_simple(*result.polygon));
  EXPECT_LT(result.steps, 60u);
}

TEST(PlanarStretch, gives_a_projection_its_edge_lengths_back) {
  const Loop loop = unit_size(testing::saddle(60, 3, 1.0));
  const std::optional<Polygon> polygon = simple_projection(loop, 0);
  ASSERT_TRUE(polygon);
  const PlanarStretch opened = stretched(*polygon, loop, 60);
  EXPECT_GT(opened.steps, 0u);
  EXPECT_TRUE(is_simple(opened.polygon));
  EXPECT_GT(signed_area(opened.polygon), 0);
  EXPECT_LT(evenness(*polygon, loop), 0.6);
  EXPECT_GT(evenness(opened.polygon, loop), 0.85);
}

TEST(PlanarStretch, opens_a_spiral) {
  Polygon spiral;
  Loop loop;
  for (int i = 0; i < 120; ++i) {
    const bool back = i >= 60;
    const double t = (back ? 119 - i : i) / 59.0;
    const double radius = (back ? 0.04 : 0.0) + 0.1 + 0.3 * t;
    spiral.emplace_back(radius * std::cos(12 * t), radius * std::sin(12 * t));
    loop.emplace_back(spiral.back().x(), spiral.back().y(), 0.0);
  }
  if (signed_area(spiral) < 0) {
    std::reverse(spiral.begin(), spiral.end());
    std::reverse(loop.begin(), loop.end());
  }
  ASSERT_TRUE(is_simple(spiral));
  const PlanarStretch opened = stretched(spiral, loop, 60);
  EXPECT_TRUE(is_simple(opened.polygon));
  EXPECT_GT(signed_area(opened.polygon), 3 * signed_area(spiral));
}

}  // namespace
}  // namespace meshcomplete
