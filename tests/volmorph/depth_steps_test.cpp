#include "filter_volmorph/depth_steps.h"

#include <gtest/gtest.h>

#include <cmath>

#include "common/core/error.h"
#include "tests/support/meshes.h"

namespace meshcomplete {
namespace {

using namespace test;

const LineOfSight from_above = LineOfSight::parallel(Vector3::UnitZ());

/// A flat grid of unit squares, and one face more with the given corners.
TriangleMesh grid_and(const Vector3& a, const Vector3& b, const Vector3& c) {
  TriangleMesh mesh = flat_grid(10, 10);
  const Index first = static_cast<Index>(mesh.vertices.size());
  for (const Vector3& corner : {a, b, c}) mesh.vertices.push_back(corner);
  mesh.triangles.push_back({first, first + 1, first + 2});
  return mesh;
}

TEST(DepthSteps, a_flat_scan_loses_nothing) {
  const TriangleMesh mesh = flat_grid(10, 10);
  const DepthSteps steps = drop_depth_steps(mesh, from_above, "a scan");
  EXPECT_EQ(steps.counts.kept, 200u);
  EXPECT_EQ(steps.counts.dropped(), 0u);
  EXPECT_EQ(steps.mesh.triangles, mesh.triangles);
  EXPECT_DOUBLE_EQ(steps.median_edge, 1);
  EXPECT_DOUBLE_EQ(steps.longest_edge, 4);
}

TEST(DepthSteps, every_face_is_dropped_for_the_first_reason_that_holds) {
  const auto counts = [](const Vector3& a, const Vector3& b, const Vector3& c) {
    const DepthSteps steps = drop_depth_steps(grid_and(a, b, c), from_above, "a scan");
    EXPECT_EQ(steps.counts.kept + steps.counts.dropped(), 201u);
    EXPECT_EQ(steps.mesh.triangles.size(), steps.counts.kept);
    return steps.counts;
  };
  EXPECT_EQ(counts({0, 0, 1}, {0, 1, 1}, {1, 0, 1}).from_behind, 1u);
  EXPECT_EQ(counts({0, 0, 1}, {5, 0, 1}, {0, 5, 1}).long_edge, 1u);
  EXPECT_EQ(counts({0, 0, 0}, {0.5, 0, 3}, {0.5, 1, 3}).grazing, 1u);
  EXPECT_EQ(counts({0, 0, 1}, {1, 0, 1}, {2, 0, 1}).degenerate, 1u);
  EXPECT_EQ(counts({0, 0, 1}, {std::nan(""), 0, 1}, {0, 1, 1}).degenerate, 1u);
  EXPECT_EQ(counts({0, 0, 0}, {1, 0, 3}, {1, 1, 3}).kept, 201u);  // 71.6 degrees
}

TEST(DepthSteps, limits_can_be_set) {
  const TriangleMesh mesh = grid_and({0, 0, 0}, {1, 0, 3}, {1, 1, 3});
  DepthStepOptions options;
  options.grazing_angle = 71;
  EXPECT_EQ(drop_depth_steps(mesh, from_above, "a scan", options).counts.grazing, 1u);
  options.longest_edge = 3.1;
  EXPECT_EQ(drop_depth_steps(mesh, from_above, "a scan", options).counts.long_edge, 1u);
  options.longest_edge = 1.4;  // shorter than the diagonals
  EXPECT_THROW(drop_depth_steps(mesh, from_above, "a scan", options), CompletionError);
}

TEST(DepthSteps, a_viewpoint_sees_every_face_from_its_own_direction) {
  const TriangleMesh ball = icosphere(3);
  const DepthSteps steps = drop_depth_steps(ball, LineOfSight::from({0, 0, 2}), "a scan");
  DepthStepOptions all;
  all.grazing_angle = 90;
  const DepthSteps front = drop_depth_steps(ball, LineOfSight::from({0, 0, 2}), "a scan", all);
  for (const Triangle& t : front.mesh.triangles)  // what is before the horizon, at a height of a half
    for (const Index v : t) EXPECT_GT(ball.vertices[v].z(), 0.3);
  EXPECT_EQ(front.counts.grazing, 0u);
  EXPECT_GT(steps.counts.grazing, 0u);
  EXPECT_EQ(steps.counts.from_behind, front.counts.from_behind);
  EXPECT_NEAR(front.counts.kept / double(ball.triangles.size()), 0.25, 0.02);
}

}  // namespace
}  // namespace meshcomplete
