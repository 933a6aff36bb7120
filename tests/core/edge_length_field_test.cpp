#include "common/core/edge_length_field.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "common/core/error.h"

namespace meshcomplete {
namespace {

std::vector<RimSample> circle(const Vector3& centre, double radius, int count, double length) {
  std::vector<RimSample> samples;
  for (int i = 0; i < count; ++i) {
    const double angle = 2 * 3.14159265358979 * i / count;
    samples.push_back({centre + radius * Vector3(std::cos(angle), std::sin(angle), 0), length});
  }
  return samples;
}

std::vector<RimSample> two_rims() {
  std::vector<RimSample> samples = circle(Vector3::Zero(), 1, 60, 0.1);
  for (const RimSample& s : circle(Vector3(0, 0, 3), 1, 15, 0.4)) samples.push_back(s);
  return samples;
}

TEST(EdgeLengthField, OneDensityIsThatEverywhere) {
  const EdgeLengthField field(circle(Vector3::Zero(), 1, 60, 0.1));
  for (const Vector3& p : {Vector3(0, 0, 0), Vector3(1, 0, 0), Vector3(10, -20, 30)})
    EXPECT_EQ(field.at(p), 0.1);
}

TEST(EdgeLengthField, EachRimHasItsOwnAndBetweenThemItChanges) {
  const EdgeLengthField field(two_rims());
  for (const RimSample& s : two_rims()) EXPECT_NEAR(field.at(s.position), s.edge_length, 1e-12);
  double before = 0.1;
  for (double z = 0; z <= 3; z += 0.1) {
    const double here = field.at({1, 0, z});
    EXPECT_GE(here, before - 1e-12);
    before = here;
  }
  EXPECT_GT(field.at({1, 0, 1.5}), 0.15);
  EXPECT_LT(field.at({1, 0, 1.5}), 0.35);
}

// Against the definition, by all samples.
TEST(EdgeLengthField, IsTheMeanOfBothExtensions) {
  std::mt19937 random(3);
  const auto uniform = [&] { return random() / 4294967296.0; };
  std::vector<RimSample> samples;
  for (int i = 0; i < 500; ++i) {
    const double x = uniform(), y = uniform(), z = uniform();
    samples.push_back({Vector3(x, y, z), 0.01 + 0.2 * uniform()});
  }
  const EdgeLengthField field(samples);
  for (int i = 0; i < 200; ++i) {
    const double x = 3 * uniform() - 1, y = 3 * uniform() - 1, z = 3 * uniform() - 1;
    const Vector3 p(x, y, z);
    double upper = field.longest(), lower = field.shortest(), nearest = 100;
    for (const RimSample& s : samples) {
      const double distance = (s.position - p).norm();
      upper = std::min(upper, s.edge_length + EdgeLengthField::gradation * distance);
      lower = std::max(lower, s.edge_length - EdgeLengthField::gradation * distance);
      nearest = std::min(nearest, distance);
    }
    EXPECT_NEAR(field.at(p), 0.5 * (upper + lower), 1e-12);
    EXPECT_NEAR(field.distance(p), nearest, 1e-12);
    EXPECT_LE(std::abs(field.at(p) - field.at(p + Vector3(1e-3, 0, 0))), 1e-3);
  }
}

TEST(EdgeLengthField, WithoutSamples) {
  EXPECT_THROW(EdgeLengthField(std::vector<RimSample>()), CompletionError);
}

TEST(SmoothedSamples, AverageAlongTheLoop) {
  std::vector<Vector3> positions;
  std::vector<double> lengths;
  for (int i = 0; i < 100; ++i) {
    positions.emplace_back(i, 0, 0);
    lengths.push_back(i % 2 ? 0.5 : 1.5);
  }
  const std::vector<RimSample> samples = smoothed_samples(positions, lengths);
  ASSERT_EQ(samples.size(), 100u);
  for (int i = 0; i < 100; ++i) {
    EXPECT_EQ(samples[static_cast<std::size_t>(i)].position, positions[static_cast<std::size_t>(i)]);
    EXPECT_NEAR(samples[static_cast<std::size_t>(i)].edge_length, 1, 0.05);
  }
}

TEST(SmoothedSamples, TinyEdgesAfterALongOne) {
  std::vector<double> lengths(100, 1e-12);
  lengths[50] = 1e6;
  const std::vector<RimSample> samples =
      smoothed_samples(std::vector<Vector3>(100, Vector3::Zero()), lengths);
  EXPECT_NEAR(samples[10].edge_length, 1e-12, 1e-18);
  EXPECT_NEAR(samples[90].edge_length, 1e-12, 1e-18);
}

TEST(SmoothedSamples, ShortLoop) {
  const std::vector<RimSample> samples =
      smoothed_samples({Vector3(0, 0, 0), Vector3(1, 0, 0), Vector3(0, 1, 0)}, {1, 2, 3});
  ASSERT_EQ(samples.size(), 3u);
  for (const RimSample& s : samples) EXPECT_NEAR(s.edge_length, 2, 1e-12);
}

}  // namespace
}  // namespace meshcomplete
