#include "common/core/wall_thickness.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <random>

#include "tests/support/meshes.h"

namespace meshcomplete {
namespace {

/// A plate from z = 0 to z = -`thickness`: faces up above, faces down below, no sides.
TriangleMesh plate(double thickness) {
  return test::join(test::flat_grid(10, 10),
                    test::flipped(test::translated(test::flat_grid(10, 10), {0, 0, -thickness})));
}

const Vector3 up(0, 0, 1);

TEST(WallThickness, IsTheDistanceToTheOtherSide) {
  const TriangleMesh mesh = plate(0.5);
  const TriangleBlocks blocks(mesh);
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> place(0.5, 9.5);
  for (int i = 0; i < 100; ++i) {
    const auto wall = wall_thickness(blocks, {place(random), place(random), 0}, up, 0.1, 2);
    ASSERT_TRUE(wall);
    EXPECT_NEAR(*wall, 0.5, 1e-12);
  }
  const auto below = wall_thickness(blocks, {3.3, 4.4, -0.5}, -up, 0.1, 2);
  ASSERT_TRUE(below);
  EXPECT_NEAR(*below, 0.5, 1e-12);
}

TEST(WallThickness, IsMeasuredAlongTheNormal) {
  const TriangleMesh mesh = plate(0.5);
  const auto wall =
      wall_thickness(TriangleBlocks(mesh), {4.2, 4.3, 0}, Vector3(3, 0, 4).normalized(), 0.1, 2);
  ASSERT_TRUE(wall);
  EXPECT_NEAR(*wall, 0.625, 1e-12) << "0.5 downwards on a way that is 5 long for every 4 down";
}

TEST(WallThickness, OnlyBetweenTheLimits) {
  const TriangleMesh mesh = plate(0.5);
  const TriangleBlocks blocks(mesh);
  const Vector3 at(4.2, 4.3, 0);
  EXPECT_FALSE(wall_thickness(blocks, at, up, 0.1, 0.49)) << "beyond the reach";
  EXPECT_TRUE(wall_thickness(blocks, at, up, 0.1, 0.51));
  EXPECT_FALSE(wall_thickness(blocks, at, up, 0.51, 2)) << "nearer than what counts";
  EXPECT_TRUE(wall_thickness(blocks, at, up, 0.49, 2));
}

// Two sheets that look the same way, and what lies in front of the point.
TEST(WallThickness, FacesThatLookTheSameWayAreNoWall) {
  const TriangleMesh steps =
      test::join(test::flat_grid(10, 10), test::translated(test::flat_grid(10, 10), {0, 0, -0.5}));
  EXPECT_FALSE(wall_thickness(TriangleBlocks(steps), {4.2, 4.3, 0}, up, 0.1, 2));
  const TriangleMesh gap = test::join(test::flat_grid(10, 10),
                                      test::flipped(test::translated(test::flat_grid(10, 10), {0, 0, 0.5})));
  EXPECT_FALSE(wall_thickness(TriangleBlocks(gap), {4.2, 4.3, 0}, up, 0.1, 2));
}

TEST(WallThickness, TheNearestOfSeveral) {
  const TriangleMesh mesh = test::join(plate(0.75), test::translated(plate(0.5), {0, 0, -0.5}));
  const auto wall = wall_thickness(TriangleBlocks(mesh), {4.2, 4.3, 0}, up, 0.1, 2);
  ASSERT_TRUE(wall);
  EXPECT_NEAR(*wall, 0.75, 1e-12);
}

TEST(WallThickness, OfABall) {
  const TriangleMesh mesh = test::icosphere(4);
  const TriangleBlocks blocks(mesh);
  for (Index t = 0; t < mesh.triangles.size(); t += 97) {
    const auto& [a, b, c] = mesh.triangles[t];
    const Vector3 middle = (mesh.vertices[a] + mesh.vertices[b] + mesh.vertices[c]) / 3;
    const auto wall = wall_thickness(blocks, middle, middle.normalized(), 0.1, 3);
    ASSERT_TRUE(wall);
    EXPECT_NEAR(*wall, 2, 0.02);
  }
}

TEST(WallThickness, FacesWithoutAreaAreNoWall) {
  TriangleMesh mesh = test::flat_grid(10, 10);
  const Index first = static_cast<Index>(mesh.vertices.size());
  for (double x : {0.0, 5.0, 10.0}) mesh.vertices.push_back({x, x, -0.5});
  mesh.triangles.push_back({first, first + 2, first + 1});
  EXPECT_FALSE(wall_thickness(TriangleBlocks(mesh), {4.25, 4.25, 0}, up, 0.1, 2));
}

}  // namespace
}  // namespace meshcomplete
