#include "filter_volmorph/scan_view.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <random>

#include "tests/volmorph/scans.h"

namespace meshcomplete {
namespace {

using namespace test;

constexpr double ramp = 0.1;

/// A scan of 13,000 faces, and the same with a face far beside it: a thousand times the scan's size.
struct Crowd {
  explicit Crowd(const LineOfSight& line_of_sight) : view(line_of_sight) {
    const Solid bumps =
        both(sphere(Vector3(0.3, 0.1, 0), 0.6), half_space(Vector3::Zero(), Vector3::UnitZ()));
    plain = scan(bumps, view, Vector3::Zero(), 0.025, 40).mesh;
    // Depth steps are no surface to a view: faces look towards the sensor.
    plain.triangles.erase(std::remove_if(plain.triangles.begin(), plain.triangles.end(),
                                         [&](const Triangle& t) { return !faces_sensor(t); }),
                          plain.triangles.end());
    with_fragment = plain;
    const auto count = static_cast<Index>(plain.vertices.size());
    const Vector3 at(2000, 1400, 0);
    for (const Vector3& corner : {at, Vector3(at + Vector3::UnitX()), Vector3(at + Vector3::UnitY())})
      with_fragment.vertices.push_back(corner);
    with_fragment.triangles.push_back({count, count + 1, count + 2});
  }

  bool faces_sensor(const Triangle& t) const {
    const Vector3 &a = plain.vertices[t[0]], &b = plain.vertices[t[1]], &c = plain.vertices[t[2]];
    return (b - a).cross(c - a).normalized().dot(view.towards_sensor((a + b + c) / 3)) > 0.05;
  }

  LineOfSight view;
  TriangleMesh plain, with_fragment;
};

class CrowdedViews : public testing::TestWithParam<bool> {
 protected:
  Crowd crowd{GetParam() ? LineOfSight::from(Vector3(10, 20, 4000))
                         : LineOfSight::parallel(Vector3(0.01, 0.03, 1))};
  std::vector<ScanView> plain = ScanView::make(crowd.plain, crowd.view, 100);
  std::vector<ScanView> halved = ScanView::make(crowd.with_fragment, crowd.view, 100);
};

TEST_P(CrowdedViews, see_the_same_as_one_image_without_the_fragment) {
  ASSERT_EQ(plain.size(), 1u);
  ASSERT_GT(halved.size(), 1u);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> place(-1.3, 1.3);
  std::size_t seen[4] = {0, 0, 0, 0};
  for (int i = 0; i < 20000; ++i) {
    const Vector3 at(place(random), place(random), 0.5 * place(random));
    const Sighting should = plain[0].sight(at, ramp);
    std::size_t answers = 0;
    for (const ScanView& view : halved) {
      const Sighting is = view.sight(at, ramp);
      if (is.view == BlockView::nothing) continue;
      ++answers;
      ASSERT_EQ(is.view, should.view) << at.transpose();
      ASSERT_EQ(is.hit.corners, should.hit.corners);
      ASSERT_EQ(is.hit.distance, should.hit.distance);
      ASSERT_EQ(is.hit.parts, should.hit.parts);
    }
    ASSERT_EQ(answers, should.view == BlockView::nothing ? 0u : 1u) << at.transpose();
    ++seen[static_cast<std::size_t>(should.view)];
  }
  for (const BlockView view : {BlockView::nothing, BlockView::empty, BlockView::near})
    EXPECT_GT(seen[static_cast<std::size_t>(view)], 500u);
}

TEST_P(CrowdedViews, never_say_more_of_a_cube_than_is_known) {
  std::mt19937 random(8);
  std::uniform_real_distribution<double> place(-1.3, 1.3), size(0.01, 0.2), part(-1, 1);
  std::size_t sure = 0;
  for (int i = 0; i < 5000; ++i) {
    const Vector3 middle(place(random), place(random), place(random));
    const double half = size(random);
    bool empty = false, nothing = true;
    for (const ScanView& view : halved) {
      const BlockView look = view.look(middle, half, ramp);
      empty = empty || look == BlockView::empty;
      nothing = nothing && look == BlockView::nothing;
    }
    if (!empty && !nothing) continue;
    ++sure;
    for (int k = 0; k < 10; ++k) {
      const Vector3 at = middle + half * Vector3(part(random), part(random), part(random));
      ASSERT_EQ(plain[0].sight(at, ramp).view, empty ? BlockView::empty : BlockView::nothing);
    }
  }
  EXPECT_GT(sure, 1000u);
}

INSTANTIATE_TEST_SUITE_P(LinesOfSight, CrowdedViews, testing::Bool());

TEST(ScanView, points_straight_above_a_vertex_meet_one_of_the_faces_round_it) {
  std::mt19937 random(9);
  std::uniform_real_distribution<double> place(0, 100), part(0.5, 1.5);
  for (int i = 0; i < 2000; ++i) {
    TriangleMesh fan;
    const Vector3 middle(place(random), place(random), place(random));
    fan.vertices.push_back(middle);
    constexpr int faces = 7;
    for (Index k = 0; k < faces; ++k) {
      const double angle = 2 * M_PI * k / faces, radius = part(random);
      fan.vertices.push_back(middle + Vector3(radius * std::cos(angle), radius * std::sin(angle), 0.1));
      fan.triangles.push_back({0, k + 1, (k + 1) % faces + 1});
    }
    const ScanView view = ScanView::make(fan, LineOfSight::parallel(Vector3::UnitZ()), 1).front();
    ASSERT_EQ(view.sight(middle + Vector3(0, 0, 0.5), 1).view, BlockView::near) << i;
  }
}

}  // namespace
}  // namespace meshcomplete
