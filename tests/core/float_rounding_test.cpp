// The vectorizer of g++ 12.2 takes double(float(x)) for x in loops like these: from -O3 for arrays, from -O2
// for Eigen's vectors. The whole suite rests on positions that are exactly what MeshLab stores, so it is
// built without that vectorizer.
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <array>
#include <vector>

#include "common/core/patch.h"

namespace meshcomplete {
namespace {

constexpr int count = 101;  // odd, so that vectorized loops have a rest

double value(int i, int k) { return 0.1 * (3 * i + k + 1); }

/// Stored in memory in between, so that the compiler cannot leave the rounding out here.
bool is_float(double x) {
  volatile float stored = static_cast<float>(x);
  return static_cast<double>(stored) == x;
}

template <class Points>
int not_rounded(const Points& points) {
  int found = 0;
  for (const auto& p : points)
    for (int k = 0; k < 3; ++k) found += !is_float(p[k]);
  return found;
}

template <class Points>
Points filled() {
  Points points(count);
  for (int i = 0; i < count; ++i)
    for (int k = 0; k < 3; ++k) points[i][k] = value(i, k);
  return points;
}

TEST(FloatRounding, ValuesNeedRounding) {
  EXPECT_GT(not_rounded(filled<std::vector<std::array<double, 3>>>()), 3 * count / 2);
}

TEST(FloatRounding, LoopOverArrays) {
  auto points = filled<std::vector<std::array<double, 3>>>();
  for (auto& v : points)
    for (auto& x : v) x = static_cast<double>(static_cast<float>(x));
  EXPECT_EQ(not_rounded(points), 0);
}

TEST(FloatRounding, LoopOverVectors) {
  auto points = filled<std::vector<Vector3>>();
  for (Vector3& p : points) p = p.cast<float>().cast<double>();
  EXPECT_EQ(not_rounded(points), 0);
}

TEST(FloatRounding, LoopOverVectorsByComponent) {
  auto points = filled<std::vector<Vector3>>();
  for (Vector3& p : points)
    for (int k = 0; k < 3; ++k) p[k] = static_cast<double>(static_cast<float>(p[k]));
  EXPECT_EQ(not_rounded(points), 0);
}

TEST(FloatRounding, AsStored) {
  auto points = filled<std::vector<Vector3>>();
  for (Vector3& p : points) p = as_stored(p);
  EXPECT_EQ(not_rounded(points), 0);
  const Vector3 p(0.1, -16777217.0, 1e-50);
  EXPECT_EQ(as_stored(p), Vector3(0.100000001490116119384765625, -16777216.0, 0.0));
}

TEST(FloatRounding, Matrix) {
  Eigen::MatrixXd points(3, count);
  for (int i = 0; i < count; ++i)
    for (int k = 0; k < 3; ++k) points(k, i) = value(i, k);
  points = points.cast<float>().cast<double>().eval();
  EXPECT_EQ(not_rounded(points.colwise()), 0);
}

}  // namespace
}  // namespace meshcomplete
