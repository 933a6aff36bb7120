#include "common/core/patch.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <string>

#include "tests/support/meshes.h"
#include "tests/support/patches.h"

namespace meshcomplete {
namespace {

TEST(Patch, PositionsAreRoundedToWhatIsStored) {
  const Vector3 p(0.1, -1.0 / 3, 123456789.0);
  const Vector3 stored = as_stored(p);
  for (int k = 0; k < 3; ++k) {
    EXPECT_EQ(stored[k], static_cast<double>(static_cast<float>(p[k])));
    EXPECT_NE(stored[k], p[k]) << "none of these is a float";
  }
  EXPECT_EQ(as_stored(stored), stored);
  EXPECT_EQ(as_stored(Vector3(0.5, -2, 1e30f)), Vector3(0.5, -2, 1e30f));
}

TEST(Patch, CornersBelowTheInputAreTheMeshs) {
  const TriangleMesh mesh = test::tetrahedron(2);
  Patch patch;
  patch.input_vertices = 4;
  patch.vertices = {Vector3(7, 8, 9), Vector3(1, 2, 3)};
  const auto at = corners(mesh, patch, {3, 5, 4});
  EXPECT_EQ(at[0], mesh.vertices[3]);
  EXPECT_EQ(at[1], Vector3(1, 2, 3));
  EXPECT_EQ(at[2], Vector3(7, 8, 9));
}

TEST(Patch, AppendingRenumbersTheNewVerticesOnly) {
  Patch all;
  EXPECT_TRUE(all.empty());
  Patch first;
  first.input_vertices = 10;
  first.vertices = {Vector3(1, 0, 0), Vector3(2, 0, 0)};
  first.triangles = {{0, 9, 10}, {9, 11, 10}};
  Patch second;
  second.input_vertices = 10;
  second.vertices = {Vector3(3, 0, 0)};
  second.triangles = {{9, 1, 10}};
  append(all, first);
  append(all, second);
  append(all, Patch{10, {}, {{1, 2, 3}}});
  EXPECT_EQ(all.input_vertices, 10u);
  EXPECT_EQ(all.vertices, (std::vector<Vector3>{Vector3(1, 0, 0), Vector3(2, 0, 0), Vector3(3, 0, 0)}));
  EXPECT_EQ(all.triangles, (std::vector<Triangle>{{0, 9, 10}, {9, 11, 10}, {9, 1, 12}, {1, 2, 3}}));
  EXPECT_FALSE(all.empty());
}

// What a triangle is does not depend on what was appended before it.
TEST(Patch, AppendingKeepsEveryTriangleInItsPlace) {
  const TriangleMesh mesh = test::sphere_with_holes(4);
  Patch all;
  std::vector<std::array<Vector3, 3>> expected;
  for (const BoundaryLoop& loop : test::loops_of(mesh)) {
    const Patch patch = test::fan_patch(mesh, loop);
    for (const Triangle& t : patch.triangles) expected.push_back(corners(mesh, patch, t));
    append(all, patch);
  }
  ASSERT_EQ(all.triangles.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i)
    EXPECT_EQ(corners(mesh, all, all.triangles[i]), expected[i]);
}

TEST(Patch, OutcomesHaveNames) {
  EXPECT_STREQ(name(HoleOutcome::closed), "closed");
  EXPECT_STREQ(name(HoleOutcome::partial), "partial");
  EXPECT_STREQ(name(HoleOutcome::skipped), "skipped");
  EXPECT_STREQ(name(HoleOutcome::failed), "failed");
}

TEST(Patch, TheReportCountsOutcomes) {
  CompletionReport report;
  EXPECT_EQ(report.count(HoleOutcome::closed), 0u);
  for (HoleOutcome outcome :
       {HoleOutcome::closed, HoleOutcome::failed, HoleOutcome::closed, HoleOutcome::partial}) {
    report.holes.emplace_back();
    report.holes.back().outcome = outcome;
  }
  report.holes.emplace_back();
  EXPECT_EQ(report.count(HoleOutcome::closed), 2u);
  EXPECT_EQ(report.count(HoleOutcome::failed), 1u);
  EXPECT_EQ(report.count(HoleOutcome::partial), 1u);
  EXPECT_EQ(report.count(HoleOutcome::skipped), 1u) << "what a hole is until something happens to it";
}

}  // namespace
}  // namespace meshcomplete
