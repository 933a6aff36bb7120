#include "common/core/closest_point.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace meshcomplete {
namespace {

double uniform(std::mt19937& random) { return random() * (1.0 / 4294967296.0); }

Vector3 anywhere(std::mt19937& random) { return {uniform(random), uniform(random), uniform(random)}; }

TEST(ClosestPoint, NoOtherPointOfTheTriangleIsCloser) {
  std::mt19937 random(1);
  for (int i = 0; i < 300; ++i) {
    const Vector3 a = anywhere(random), b = anywhere(random), c = anywhere(random),
                  p = 3 * anywhere(random) - Vector3::Ones();
    const ClosestPoint closest = closest_point(p, a, b, c);
    const double distance = (closest.position - p).norm();
    constexpr int steps = 40;
    double least = 1e300;
    for (int u = 0; u <= steps; ++u)
      for (int v = 0; u + v <= steps; ++v)
        least = std::min(least, (a + (b - a) * u / steps + (c - a) * v / steps - p).norm());
    EXPECT_LE(distance, least + 1e-12);
    EXPECT_GE(distance, least - 2.0 / steps) << "not in the triangle";
  }
}

TEST(ClosestPoint, TellsWhatItLiesOn) {
  const Vector3 a(0, 0, 0), b(4, 0, 0), c(0, 4, 0);
  const auto place = [&](const Vector3& p) { return closest_point(p, a, b, c).place; };
  EXPECT_EQ(place({1, 1, 5}), ClosestPoint::face);
  EXPECT_EQ(place({2, -1, 1}), ClosestPoint::edge);
  EXPECT_EQ(place({3, 3, 1}), ClosestPoint::edge + 1);
  EXPECT_EQ(place({-1, 2, 1}), ClosestPoint::edge + 2);
  EXPECT_EQ(place({-1, -1, 1}), ClosestPoint::corner);
  EXPECT_EQ(place({6, -1, 1}), ClosestPoint::corner + 1);
  EXPECT_EQ(place({-1, 6, 1}), ClosestPoint::corner + 2);
  EXPECT_EQ(place({2, 0, 0}), ClosestPoint::edge) << "a point on a side";
  EXPECT_EQ(closest_point({3, 3, 1}, a, b, c).position, Vector3(2, 2, 0));
}

TEST(ClosestPoint, DistanceFromABox) {
  const Box box = bounding_box({0, 0, 0}, {2, 1, 0}, {1, 0, 3});
  EXPECT_EQ(squared_distance(box, {1, 0.5, 2}), 0);
  EXPECT_EQ(squared_distance(box, {4, 0.5, 2}), 4);
  EXPECT_EQ(squared_distance(box, {-1, 3, 5}), 1 + 4 + 4);
  EXPECT_EQ(squared_distance(Box(), {0, 0, 0}), std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace meshcomplete
