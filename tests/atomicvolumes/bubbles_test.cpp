#include "filter_atomicvolumes/bubbles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "tests/support/meshes.h"

namespace meshcomplete {
namespace {

Sheet sheet_of(const TriangleMesh& mesh, std::vector<Index> closes) {
  Sheet sheet;
  for (const Vector3& p : mesh.vertices) sheet.vertices.push_back({p});
  sheet.triangles = mesh.triangles;
  sheet.closes = std::move(closes);
  return sheet;
}

TEST(Bubbles, PointsInThemAreNamed) {
  const std::vector<Sheet> sheets = {sheet_of(test::icosphere(2), {}),
                                     sheet_of(test::flipped(test::icosphere(2, 0.5)), {}),
                                     sheet_of(test::icosphere(2, 1, Vector3(5, 0, 0)), {17})};
  VolumeConstraints given;
  given.inside = {{0, 0, 0.75}};
  std::vector<std::string> notes = describe_bubbles(sheets, given);
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_EQ(notes[0].rfind("The point given as inside is inside only within bubbles", 0), 0u) << notes[0];
  given.inside = {{0, 0, 0.75}, {0, 0, 0.25}, {5, 0, 0}, {0, 0, 3}, {0.8, 0, 0.1}};
  given.outside = {{0.1, 0, 3}};
  notes = describe_bubbles(sheets, given);
  ASSERT_EQ(notes.size(), 1u) << "in two bubbles, at a rim, beside: no bubble decides";
  EXPECT_EQ(notes[0].rfind("2 of the 5 points given as inside are inside only", 0), 0u) << notes[0];
  EXPECT_TRUE(describe_bubbles(sheets, {}).empty());
}

// A point alone in front of a closed part of the mesh is obeyed by a bubble.
TEST(Bubbles, TheReportNamesPointsWithoutEffect) {
  const TriangleMesh mesh = test::sphere_with_hole(2, 0.6);
  AtomicVolumesOptions options;
  options.shifts = 1;
  const auto notes = [&] { return fill_by_atomic_volumes(mesh, {}, options).completion.report.notes; };
  EXPECT_TRUE(notes().empty());
  options.constraints.inside = {{0.75, 0.75, -0.75}};
  ASSERT_EQ(notes().size(), 1u);
  EXPECT_NE(notes()[0].find("touch no rim"), std::string::npos) << notes()[0];
  options.constraints.inside = {{0, 0, 0.2}};
  EXPECT_TRUE(notes().empty());
}

}  // namespace
}  // namespace meshcomplete
