#include "filter_curveunfold/loop_geometry.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "filter_curveunfold/loop_tree.h"
#include "tests/support/loop_families.h"

namespace meshcomplete {
namespace {

constexpr double pi = 3.14159265358979323846;

Polygon star(int points, double inner) {
  Polygon polygon;
  for (int i = 0; i < points; ++i) {
    const double radius = i % 2 == 0 ? 1 : inner;
    polygon.emplace_back(radius * std::cos(2 * pi * i / points), radius * std::sin(2 * pi * i / points));
  }
  return polygon;
}

TEST(LoopGeometry, simplicity_agrees_with_brute_force_on_random_polygons) {
  std::mt19937_64 random(1);
  int simple = 0, crossing = 0;
  for (int k = 0; k < 3000; ++k) {
    // Points of a small grid: repeated points, touching and collinear edges are all frequent.
    const std::size_t n = 3 + random() % 6;
    Polygon polygon;
    for (std::size_t i = 0; i < n; ++i) {
      polygon.emplace_back(static_cast<double>(random() % 7), static_cast<double>(random() % 7));
    }
    const bool expected = testing::is_simple_by_brute_force(polygon);
    EXPECT_EQ(is_simple(polygon), expected) << "polygon " << k;
    ++(expected ? simple : crossing);
  }
  EXPECT_GT(simple, 100);
  EXPECT_GT(crossing, 100);
}

TEST(LoopGeometry, simplicity_of_large_polygons) {
  Polygon polygon = star(10000, 0.3);
  EXPECT_TRUE(is_simple(polygon));
  std::swap(polygon[4000], polygon[4003]);
  EXPECT_FALSE(is_simple(polygon));
}

TEST(LoopGeometry, degenerate_polygons_are_not_simple) {
  EXPECT_FALSE(is_simple({Vector2(0, 0), Vector2(1, 0)}));
  EXPECT_FALSE(is_simple({Vector2(0, 0), Vector2(1, 0), Vector2(2, 0)}));
  EXPECT_FALSE(is_simple({Vector2(0, 0), Vector2(1, 0), Vector2(0, 0), Vector2(0, 1)}));
  EXPECT_FALSE(is_simple({Vector2(0, 0), Vector2(1, 0), Vector2(1, std::nan(""))}));
  EXPECT_TRUE(
      is_simple({Vector2(0, 0), Vector2(1, 0), Vector2(2, 0), Vector2(1, 1)}));  // a straight angle is fine
}

TEST(LoopGeometry, simple_projection_is_counter_clockwise_in_the_loops_order) {
  Loop loop = testing::saddle(50, 2, 0.3);
  for (int flip = 0; flip < 2; ++flip) {
    const std::optional<Polygon> polygon = simple_projection(loop, 0);
    ASSERT_TRUE(polygon);
    EXPECT_GT(signed_area(*polygon), 0);
    for (std::size_t i = 0; i < loop.size(); ++i) {
      EXPECT_LE(((*polygon)[(i + 1) % 50] - (*polygon)[i]).norm(),
                (loop[(i + 1) % 50] - loop[i]).norm() + 1e-12);
    }
    std::reverse(loop.begin(), loop.end());
  }
}

TEST(LoopGeometry, simple_projection_finds_directions_that_no_fitted_plane_gives) {
  // A long thin loop, folded over lengthwise so that its principal plane shows a crossing.
  const Loop loop = testing::sampled(
      60, [](double t) { return Vector3(3 * std::cos(t), std::sin(2 * t), 0.8 * std::sin(t)); });
  EXPECT_FALSE(is_simple(project(loop, plane_with_normal(best_fitting_normal(loop)))));
  const std::optional<Polygon> polygon = simple_projection(loop, 48);
  ASSERT_TRUE(polygon);
  EXPECT_TRUE(is_simple(*polygon));
}

TEST(LoopGeometry, knots_have_no_simple_projection) {
  EXPECT_FALSE(simple_projection(testing::torus_knot(60, 2, 3), 200));
  EXPECT_FALSE(simple_projection(testing::figure_eight_knot(80), 200));
}

TEST(LoopGeometry, segment_distance_is_the_least_over_samples) {
  std::mt19937_64 random(7);
  const auto coordinate = [&] { return static_cast<double>(random() % 1000) / 500 - 1; };
  const auto point = [&] { return Vector3(coordinate(), coordinate(), coordinate()); };
  for (int k = 0; k < 200; ++k) {
    const Vector3 a = point(), b = point(), c = point(), d = k % 4 == 0 ? Vector3(c + (b - a)) : point();
    const double distance = std::sqrt(squared_distance(a, b, c, d));
    double sampled = 1e9;
    for (int i = 0; i <= 100; ++i) {
      for (int j = 0; j <= 100; ++j) {
        sampled = std::min(sampled, (a + (b - a) * (i / 100.0) - c - (d - c) * (j / 100.0)).norm());
      }
    }
    EXPECT_LE(distance, sampled + 1e-12);
    EXPECT_GE(distance, sampled - 0.02);
  }
}

TEST(LoopGeometry, distance_to_triangle_is_zero_exactly_when_it_is_met) {
  const Vector3 a(0, 0, 0), b(4, 0, 0), c(0, 4, 0);
  EXPECT_EQ(squared_distance_to_triangle(Vector3(1, 1, -1), Vector3(1, 1, 1), a, b, c), 0);
  EXPECT_NEAR(squared_distance_to_triangle(Vector3(1, 1, 0.5), Vector3(1, 1, 2), a, b, c), 0.25, 1e-15);
  EXPECT_NEAR(squared_distance_to_triangle(Vector3(3, 3, -1), Vector3(3, 3, 1), a, b, c), 2, 1e-12);
  EXPECT_EQ(squared_distance_to_triangle(Vector3(1, 1, 0), Vector3(1.5, 1, 0), a, b, c),
            0);  // within its plane
}

TEST(LoopGeometry, total_curvature_of_convex_polygons_is_two_pi) {
  EXPECT_NEAR(total_curvature(testing::saddle(40, 1, 0.0)), 2 * pi, 1e-12);
  EXPECT_GT(total_curvature(testing::torus_knot(200, 2, 3)), 4 * pi);
}

TEST(LoopTree, distances_agree_with_brute_force) {
  for (const int points : {5, 37, 128}) {
    const Loop loop = testing::random_tangle(points, 3);
    const std::size_t n = loop.size();
    double least = 1e9;
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = i + 2; j < n; ++j) {
        if (i == 0 && j + 1 == n) continue;
        const double d = std::sqrt(squared_distance(loop[i], loop[i + 1], loop[j], loop[(j + 1) % n]));
        least = std::min(least, d);
      }
    }
    const LoopTree tree(loop);
    EXPECT_NEAR(tree.least_distance(loop, 100), least, 1e-12);
    EXPECT_DOUBLE_EQ(tree.least_distance(loop, least / 2), least / 2);
  }
}

}  // namespace
}  // namespace meshcomplete
