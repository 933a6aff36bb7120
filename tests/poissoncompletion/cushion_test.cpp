#include "filter_poissoncompletion/cushion.h"

#include <gtest/gtest.h>

#include <random>

#include "tests/poissoncompletion/oracles.h"
#include "tests/support/meshes.h"

namespace meshcomplete {
namespace {

std::optional<Cushion::Nearest> within(const Cushion& cushion, const Vector3& point,
                                       const Vector3& outwards) {
  std::optional<Cushion::Nearest> nearest = cushion.nearest(point);
  if (nearest && !cushion.reaches(*nearest, outwards)) nearest.reset();
  return nearest;
}

std::vector<Vector3> random_points(std::size_t count, double range) {
  std::mt19937 random(7);
  const auto uniform = [&] { return range * (random() / 4294967296.0 * 2 - 1); };
  std::vector<Vector3> points;
  for (std::size_t i = 0; i < count; ++i) {
    const double x = uniform(), y = uniform(), z = uniform();
    points.emplace_back(x, y, z);
  }
  return points;
}

TEST(Cushion, IsWhatIsNearerThanItsRadius) {
  const TriangleMesh mesh = test::rough_sphere_with_ragged_holes(3, 4, 5);
  const TriangleBlocks blocks(mesh);
  const Cushion cushion(blocks, 0.1);
  int in = 0;
  for (const Vector3& p : random_points(1000, 1.3)) {
    const double distance = test::distance_to(mesh, p);
    const auto near = within(cushion, p, Vector3::UnitX());
    ASSERT_EQ(near.has_value(), distance < 0.1);
    if (!near) continue;
    ++in;
    EXPECT_NEAR(near->distance, distance, 1e-12);
    EXPECT_NEAR((near->position - p).norm(), distance, 1e-12);
    const Triangle& t = mesh.triangles[near->triangle];
    const Vector3 on =
        closest_point(p, mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]).position;
    EXPECT_NEAR((on - p).norm(), distance, 1e-12);
  }
  EXPECT_GT(in, 50);
}

TEST(Cushion, RadiusChangesOverTheMesh) {
  const TriangleMesh mesh = test::flat_grid(8, 8);
  const TriangleBlocks blocks(mesh);
  const Cushion cushion(
      blocks, [](const Vector3& at, bool) { return at[0] < 4 ? 0.5 : 2.0; }, 3);
  EXPECT_TRUE(within(cushion, {2.3, 2.2, 0.4}, Vector3::UnitZ()));
  EXPECT_FALSE(within(cushion, {2.3, 2.2, 0.6}, Vector3::UnitZ()));
  EXPECT_TRUE(within(cushion, {6.3, 2.2, 1.9}, Vector3::UnitZ()));
  EXPECT_FALSE(within(cushion, {6.3, 2.2, 2.1}, Vector3::UnitZ()));
}

TEST(Cushion, SidesAreToldApart) {
  const TriangleMesh mesh = test::flat_grid(8, 8);
  const TriangleBlocks blocks(mesh);
  const Cushion cushion(
      blocks, [](const Vector3&, bool alike) { return alike ? 2.0 : 0.5; }, 2);
  const Vector3 above(2.3, 2.2, 1);
  EXPECT_TRUE(within(cushion, above, Vector3(0.3, 0, 1)));
  EXPECT_FALSE(within(cushion, above, Vector3(0.3, 0, -1)));
  EXPECT_FALSE(within(cushion, above, Vector3(1, 0, 0)));
}

TEST(Cushion, LargestRadiusBoundsTheOthers) {
  const TriangleMesh mesh = test::flat_grid(2, 2);
  const TriangleBlocks blocks(mesh);
  const Cushion cushion(
      blocks, [](const Vector3&, bool) { return 5.0; }, 1);
  EXPECT_TRUE(within(cushion, {1, 1, 0.9}, Vector3::UnitZ()));
  EXPECT_FALSE(within(cushion, {1, 1, 1.1}, Vector3::UnitZ()));
}

TEST(Cushion, OfNothingIsEmpty) {
  const TriangleMesh mesh;
  const TriangleBlocks blocks(mesh);
  EXPECT_FALSE(Cushion(blocks, 1).nearest({0, 0, 0}));
}

}  // namespace
}  // namespace meshcomplete
