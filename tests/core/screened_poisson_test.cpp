#include "common/core/screened_poisson.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include "common/core/error.h"

namespace meshcomplete {
namespace {

constexpr double pi = 3.14159265358979323846;

/// Samples of a sphere, those left out for which `missing` holds.
std::vector<OrientedSample> sphere(int count, int depth,
                                   const std::function<bool(const Vector3&)>& missing = nullptr,
                                   const Vector3& centre = Vector3::Zero(), double radius = 1) {
  std::vector<OrientedSample> samples;
  for (int i = 0; i < count; ++i) {
    const double z = 1 - 2 * (i + 0.5) / count, turn = i * pi * (3 - std::sqrt(5.0));
    const Vector3 n(std::sqrt(1 - z * z) * std::cos(turn), std::sqrt(1 - z * z) * std::sin(turn), z);
    if (missing && missing(n)) continue;
    samples.push_back({centre + radius * n, 4 * pi * radius * radius / count * n, depth});
  }
  return samples;
}

Lattice lattice() { return Lattice(Vector3(-2.187, -2.183, -2.189), 4.4); }

/// Where a ray from inside leaves the surface.
double radius(const ImplicitFunction& field, const Vector3& way, const Vector3& centre = Vector3::Zero()) {
  const auto at = crossing(field, centre + 0.3 * way, centre + 1.9 * way, 1e-9);
  return at ? (*at - centre).norm() : std::numeric_limits<double>::quiet_NaN();
}

std::vector<Vector3> directions(int count) {
  std::vector<Vector3> result;
  for (const OrientedSample& s : sphere(count, 0)) result.push_back(s.position);
  return result;
}

double worst_error(const ImplicitFunction& field) {
  double worst = 0;
  for (const Vector3& way : directions(300)) {
    const double error = std::abs(radius(field, way) - 1);
    worst = std::isnan(error) ? std::numeric_limits<double>::infinity() : std::max(worst, error);
  }
  return worst;
}

TEST(ScreenedPoisson, ASphereConvergesWithTheSquareOfTheCubes) {
  std::vector<double> errors;
  for (int depth : {5, 6, 7})
    errors.push_back(worst_error(solve_screened_poisson(lattice(), sphere(60000, depth), {}).field));
  EXPECT_LT(errors[2], 1e-3);
  EXPECT_LT(errors[1], 0.5 * errors[0]);
  EXPECT_LT(errors[2], 0.5 * errors[1]);
}

TEST(ScreenedPoisson, NegativeInsidePositiveOutside) {
  const PoissonSolution solution = solve_screened_poisson(lattice(), sphere(20000, 6), {});
  for (const Vector3& way : directions(50)) {
    EXPECT_NEAR(solution.field.value(0.5 * way), -0.5, 0.1);
    EXPECT_NEAR(solution.field.value(1.6 * way), 0.5, 0.1);
  }
}

// A cap of 30 degrees is missing: the surface bulges over the gap, which a flat lid would not.
TEST(ScreenedPoisson, AHoleIsClosedRound) {
  const double cap = std::cos(pi / 6);
  const PoissonSolution solution =
      solve_screened_poisson(lattice(), sphere(40000, 6, [&](const Vector3& n) { return n[2] > cap; }), {});
  const double middle = radius(solution.field, {0, 0, 1});
  EXPECT_GT(middle, cap + 0.03);
  EXPECT_LT(middle, 1);
}

TEST(ScreenedPoisson, OnlyCubesRoundSamplesAreFine) {
  std::vector<OrientedSample> samples = sphere(40000, 5);
  for (OrientedSample& s : samples)
    if (s.position[2] > 0.8) s.depth = 8;
  const PoissonSolution solution = solve_screened_poisson(lattice(), samples, {});
  EXPECT_DOUBLE_EQ(solution.field.leaf_size({0, 0, 1}), 4.4 / 256);
  EXPECT_DOUBLE_EQ(solution.field.leaf_size({0, 0, -1}), 4.4 / 32);
  EXPECT_LT(worst_error(solution.field), 0.01) << "the samples' depths do not disturb each other";
}

// Two balls a third of a radius apart: with the values at the outside given they stay two.
TEST(ScreenedPoisson, SeparatePartsStaySeparate) {
  std::vector<OrientedSample> samples = sphere(30000, 7, nullptr, {-0.9, 0, 0}, 0.75);
  for (const OrientedSample& s : sphere(30000, 7, nullptr, {0.9, 0, 0}, 0.75)) samples.push_back(s);
  const PoissonSolution solution = solve_screened_poisson(lattice(), samples, {});
  for (double x = -0.1; x <= 0.1; x += 0.02) EXPECT_GT(solution.field.value({x, 0, 0}), 0.05);
  EXPECT_LT(solution.field.value({0.9, 0, 0}), -0.4);
  EXPECT_LT(solution.field.value({-0.9, 0, 0}), -0.4);
}

// A sheet that ends at the sides of the root: a free boundary lets it.
TEST(ScreenedPoisson, AFreeBoundaryLetsTheSurfaceEndThere) {
  std::vector<OrientedSample> samples;
  for (int i = 0; i < 60; ++i)
    for (int j = 0; j < 60; ++j)
      samples.push_back({{-2.1 + 0.07 * i, -2.1 + 0.07 * j, 0.01}, {0, 0, 0.0049}, 6});
  ScreenedPoissonOptions options;
  options.boundary = PoissonBoundary::neumann;
  const PoissonSolution solution = solve_screened_poisson(lattice(), samples, options);
  for (double x : {-1.5, 0.0, 1.5}) {
    EXPECT_LT(solution.field.value({x, x, -1}), -0.2);
    EXPECT_GT(solution.field.value({x, x, 1}), 0.2);
  }
  options.boundary = PoissonBoundary::dirichlet;
  EXPECT_GT(solve_screened_poisson(lattice(), samples, options).field.value({0, 0, -2}), 0)
      << "a closed box has no inside of its own";
}

TEST(ScreenedPoisson, TheNumberOfThreadsDoesNotMatter) {
  const std::vector<OrientedSample> samples = sphere(20000, 6);
  std::vector<std::vector<double>> results;
  for (int threads : {1, 2, 5}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    const PoissonSolution solution = solve_screened_poisson(lattice(), samples, {});
    results.emplace_back();
    for (const Vector3& way : directions(200)) results.back().push_back(solution.field.value(0.97 * way));
  }
  EXPECT_EQ(results[0], results[1]);
  EXPECT_EQ(results[0], results[2]);
}

TEST(ScreenedPoisson, EveryLevelIsSolved) {
  ScreenedPoissonOptions options;
  options.iterations = 500;
  const PoissonSolution solution = solve_screened_poisson(lattice(), sphere(20000, 6), options);
  ASSERT_EQ(solution.levels.size(), 6u);
  for (const PoissonLevelFigures& level : solution.levels) EXPECT_LE(level.residual, options.tolerance);
}

TEST(ScreenedPoisson, NothingToStartFrom) {
  EXPECT_THROW(solve_screened_poisson(lattice(), {}, {}), CompletionError);
}

TEST(ScreenedPoisson, CanBeCancelled) {
  const Progress stop([](double, const std::string&) { return false; });
  EXPECT_THROW(solve_screened_poisson(lattice(), sphere(1000, 5), {}, stop), Cancelled);
}

}  // namespace
}  // namespace meshcomplete
