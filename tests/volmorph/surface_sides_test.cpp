#include "filter_volmorph/surface_sides.h"

#include <gtest/gtest.h>

#include <random>

#include "tests/support/meshes.h"

namespace meshcomplete {
namespace {

/// What is said of balls is true of their points, and something is said of many.
void expect_balls_agree_with_points(const TriangleMesh& mesh, double least_share) {
  const SurfaceSides sides(mesh);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> place(-2, 2), size(0, 0.5), part(-1, 1);
  std::size_t sure = 0, before = 0;
  constexpr std::size_t balls = 3000;
  for (std::size_t i = 0; i < balls; ++i) {
    const Vector3 middle(place(random), place(random), place(random));
    const double radius = size(random);
    Index start = 0;
    const std::optional<bool> all = sides.before(middle, radius, start);
    if (!all) continue;
    ++sure;
    before += *all;
    for (int k = 0; k < 10; ++k) {
      Vector3 way(part(random), part(random), part(random));
      if (way.norm() > 1) way.normalize();
      ASSERT_EQ(sides.before(middle + radius * way, start), *all) << middle.transpose() << ' ' << radius;
    }
  }
  EXPECT_GT(sure, least_share * balls);
  EXPECT_GT(before, 0u);
  EXPECT_LT(before, sure);
}

TEST(SurfaceSides, of_balls_are_those_of_their_points_round_a_sphere) {
  expect_balls_agree_with_points(test::icosphere(4), 0.3);
}

TEST(SurfaceSides, of_balls_are_those_of_their_points_round_a_torus) {
  expect_balls_agree_with_points(test::torus(60, 30), 0.2);
}

TEST(SurfaceSides, of_balls_are_those_of_their_points_round_a_sphere_with_a_hole) {
  expect_balls_agree_with_points(test::sphere_with_hole(4, 0.5), 0.1);
}

TEST(SurfaceSides, of_balls_are_those_of_their_points_round_a_rough_sphere) {
  expect_balls_agree_with_points(test::rough_sphere(4, 0.05, 3), 0.02);
}

}  // namespace
}  // namespace meshcomplete
