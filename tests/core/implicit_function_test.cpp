#include "common/core/implicit_function.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <random>

namespace meshcomplete {
namespace {

class Ball : public ImplicitFunction {
 public:
  double value(const Vector3& p) const override {
    ++asked;
    return std::pow(p.norm(), 5) - 1;
  }
  mutable std::atomic<int> asked{0};
};

TEST(Crossing, IsOnTheSurface) {
  const Ball ball;
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  int crossings = 0;
  for (int i = 0; i < 500; ++i) {
    const Vector3 a(normal(random), normal(random), normal(random)),
        b(normal(random), normal(random), normal(random));
    const auto found = crossing(ball, a, b, 1e-9);
    EXPECT_EQ(found.has_value(), (a.norm() < 1) != (b.norm() < 1));
    if (!found) continue;
    ++crossings;
    EXPECT_NEAR(found->norm(), 1, 1e-9);
    EXPECT_NEAR((*found - a).norm() + (b - *found).norm(), (b - a).norm(), 1e-12);
  }
  EXPECT_GT(crossings, 100);
  EXPECT_LT(ball.asked, 1000 + 14 * crossings);
}

TEST(Crossing, AnEvenNumberIsNotSeen) { EXPECT_FALSE(crossing(Ball(), {-2, 0, 0}, {2, 0, 0}, 1e-6)); }

TEST(Crossing, EndsCount) {
  const Ball ball;
  EXPECT_EQ(crossing(ball, {1, 0, 0}, {0, 0, 0}, 1e-6), Vector3(1, 0, 0));
  EXPECT_EQ(crossing(ball, {0, 0, 0}, {0, 1, 0}, 1e-6), Vector3(0, 1, 0));
}

}  // namespace
}  // namespace meshcomplete
