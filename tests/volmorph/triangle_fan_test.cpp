#include "filter_volmorph/triangle_fan.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "common/core/error.h"
#include "common/core/mesh_statistics.h"
#include "filter_volmorph/rim_fan.h"
#include "tests/support/cancelling.h"
#include "tests/support/meshes.h"
#include "tests/support/patches.h"

namespace meshcomplete {
namespace {

using test::with_patch;

Completion close(const TriangleMesh& mesh, const HoleSelectionOptions& holes = {},
                 const MeshSelection& selection = {}) {
  return close_by_fans(mesh, selection, {holes});
}

// What became of the only hole that was asked for.
HoleReport only_target(const Completion& completion) {
  std::vector<HoleReport> list;
  for (const HoleReport& hole : completion.report.holes)
    if (hole.outcome != HoleOutcome::skipped) list.push_back(hole);
  EXPECT_EQ(list.size(), 1u);
  return list.empty() ? HoleReport() : list.front();
}

// A collar under a rim that a test makes.
TriangleMesh collar_under(const std::vector<Vector3>& rim) {
  std::vector<Vector3> outer = rim;
  for (Vector3& p : outer) p.z() -= 1;
  return test::collar(rim, outer);
}

// Of a mesh of which only the hole at these vertices is to be closed.
Completion close_rim(const TriangleMesh& mesh, std::size_t vertices) {
  MeshSelection selection;
  selection.vertices.assign(mesh.vertices.size(), 0);
  std::fill_n(selection.vertices.begin(), vertices, 1);
  HoleSelectionOptions holes;
  holes.selected_only = true;
  return close(mesh, holes, selection);
}

// --- the fan

TEST(RimFan, joins_every_edge_to_the_mean_of_the_rim) {
  const TriangleMesh mesh = test::open_cylinder(24, 8);
  for (const BoundaryLoop& loop : test::loops_of(mesh)) {
    const Patch fan = rim_fan(mesh, loop);
    Vector3 mean = Vector3::Zero();
    for (const Index v : loop.vertices) mean += mesh.vertices[v] / 24.0;
    ASSERT_EQ(fan.vertices.size(), 1u);
    EXPECT_LT((fan.vertices[0] - mean).norm(), 1e-7);
    EXPECT_EQ(fan.vertices[0], as_stored(fan.vertices[0]));
    ASSERT_EQ(fan.triangles.size(), 24u);
    for (std::size_t i = 0; i < 24; ++i)
      EXPECT_EQ(fan.triangles[i],
                (Triangle{loop.vertices[i], loop.vertices[(i + 1) % 24], fan.input_vertices}));
  }
}

TEST(TriangleFan, closes_flat_and_curved_rims) {
  std::vector<Vector3> wavy;
  for (int i = 0; i < 40; ++i) {
    const double turn = i * M_PI / 20;
    wavy.push_back(as_stored(Vector3(std::cos(turn), std::sin(turn), 0.4 * std::cos(3 * turn))));
  }
  for (const TriangleMesh& mesh :
       {test::sphere_with_hole(), test::sphere_with_holes(6), test::open_cylinder(),
        test::sphere_with_touching_holes(), collar_under(wavy)}) {
    const Completion completion = close(mesh);
    EXPECT_EQ(completion.report.count(HoleOutcome::closed), completion.report.holes.size());
    EXPECT_EQ(completion.patch.vertices.size(), completion.report.holes.size());
    const MeshStatistics statistics = measure(with_patch(mesh, completion.patch), true);
    EXPECT_TRUE(statistics.watertight());
    EXPECT_TRUE(statistics.manifold());
    EXPECT_EQ(statistics.self_intersecting_pairs, std::optional<std::size_t>(0));
  }
}

TEST(TriangleFan, adds_no_handle) {
  const TriangleMesh mesh = test::without_ball(test::torus(24, 12), Vector3(1.4, 0, 0), 0.4);
  EXPECT_EQ(measure(with_patch(mesh, close(mesh).patch), false).genus, std::optional<long long>(1));
}

// --- rims of three edges

TEST(TriangleFan, has_a_new_vertex_over_three_edges_too) {
  const TriangleMesh mesh = test::without_faces(test::icosphere(1), [](Index face) { return face == 7; });
  const Completion completion = close(mesh);
  EXPECT_EQ(completion.patch.vertices.size(), 1u);
  EXPECT_EQ(completion.patch.triangles.size(), 3u);
  EXPECT_EQ(completion.report.holes[0].route, "fan");
}

// The mean of the rim is rounded to the corner behind it.
TEST(TriangleFan, is_a_single_triangle_where_floats_are_too_coarse_for_a_vertex) {
  const TriangleMesh mesh = test::without_faces(
      test::translated(test::tetrahedron(), Vector3::Constant(0x1p23)),
      [solid = test::tetrahedron()](Index f) {
        const Triangle& t = solid.triangles[f];
        return std::none_of(t.begin(), t.end(), [&](Index v) { return solid.vertices[v].isZero(0); });
      });
  ASSERT_EQ(mesh.triangles.size(), 3u);
  const Completion completion = close(mesh);
  EXPECT_TRUE(completion.patch.vertices.empty());
  EXPECT_EQ(completion.patch.triangles.size(), 1u);
  EXPECT_EQ(completion.report.holes[0].route, "single triangle");
  EXPECT_TRUE(measure(with_patch(mesh, completion.patch), true).solid());
}

// --- what stays open, and why

// The mean of the rim of a flat hole in the form of a U lies outside of it.
TEST(TriangleFan, leaves_open_a_hole_whose_fan_would_meet_itself) {
  const TriangleMesh grid = test::flat_grid(11, 11);
  const TriangleMesh mesh = test::without_faces(grid, [&](Index f) {
    const Triangle& t = grid.triangles[f];
    const Vector3 middle = (grid.vertices[t[0]] + grid.vertices[t[1]] + grid.vertices[t[2]]) / 3;
    const auto within = [](double x, double low, double high) { return low < x && x < high; };
    return (within(middle.x(), 2, 9) && within(middle.y(), 2, 3)) ||
           ((within(middle.x(), 2, 3) || within(middle.x(), 8, 9)) && within(middle.y(), 2, 9));
  });
  const Completion completion = close(mesh);
  EXPECT_TRUE(completion.patch.empty());
  const HoleReport hole = only_target(completion);
  EXPECT_EQ(hole.outcome, HoleOutcome::failed);
  EXPECT_EQ(hole.reason, "the patch intersects itself");
}

TEST(TriangleFan, leaves_open_a_hole_whose_fan_would_meet_the_mesh) {
  const TriangleMesh holed = test::sphere_with_hole(3, 0.5);
  const Vector3 apex = rim_fan(holed, test::loops_of(holed)[0]).vertices[0];
  const TriangleMesh mesh = test::join(holed, test::scaled(test::cube(), 0x1p-4));
  EXPECT_FALSE(close(mesh).patch.empty()) << "the cube is at the sphere's centre";
  const TriangleMesh blocked = test::join(
      holed, test::translated(test::scaled(test::cube(), 0x1p-4), apex - Vector3::Constant(0x1p-5)));
  const Completion completion = close(blocked);
  EXPECT_TRUE(completion.patch.empty());
  EXPECT_EQ(only_target(completion).reason, "the patch intersects the mesh");
}

TEST(TriangleFan, says_when_faces_pass_through_the_rim_itself) {
  const TriangleMesh holed = test::sphere_with_hole(3, 0.5);
  const BoundaryLoop loop = test::loops_of(holed)[0];
  const Vector3 a = holed.vertices[loop.vertices[0]], b = holed.vertices[loop.vertices[1]];
  TriangleMesh blade;
  const Vector3 middle = (a + b) / 2, up = 0.05 * middle, across = 0.05 * (b - a).cross(middle).normalized();
  blade.vertices = {as_stored(middle - up - across), as_stored(middle + up), as_stored(middle + across)};
  blade.triangles = {{0, 1, 2}};
  const Completion completion = close(test::join(holed, blade));
  EXPECT_NE(only_target(completion).reason.find("pass through 1 edge of this rim"), std::string::npos)
      << only_target(completion).reason;
}

// The mean of the rim lies on the line through its first edge.
TEST(TriangleFan, leaves_open_a_hole_whose_fan_has_a_face_without_area) {
  const TriangleMesh mesh =
      collar_under({Vector3(-3, 0, 0), Vector3(-1, 0, 0), Vector3(2, 2, 0), Vector3(2, -2, 0)});
  const Completion completion = close_rim(mesh, 4);
  EXPECT_TRUE(completion.patch.empty());
  EXPECT_EQ(only_target(completion).reason, "a face of the patch has no area");
}

TEST(TriangleFan, leaves_open_rims_on_a_line_and_with_repeated_positions) {
  const TriangleMesh line =
      collar_under({Vector3(0, 0, 0), Vector3(1, 0, 0), Vector3(3, 0, 0), Vector3(2, 0, 0)});
  EXPECT_EQ(only_target(close_rim(line, 4)).reason, describe(LoopDefect::degenerate_rim));
  const TriangleMesh repeated =
      collar_under({Vector3(0, 0, 0), Vector3(1, 0, 0), Vector3(1, 0, 0), Vector3(0, 1, 0)});
  EXPECT_EQ(only_target(close_rim(repeated, 4)).reason, describe(LoopDefect::edge_without_length));
}

// Two rims, one within the other, far up where heights are whole numbers: the mean of each is rounded to the
// same point. The shorter one keeps it.
TEST(TriangleFan, of_two_fans_with_one_apex_the_shorter_stays) {
  const double far = 12582912;  // even, with steps of 1 above and below
  std::vector<Vector3> rim, outer;
  for (int i = 0; i < 8; ++i) {
    const double turn = i * M_PI / 4, odd = i % 2;
    const Vector3 out = as_stored(Vector3(std::cos(turn), std::sin(turn), 0));
    rim.push_back(out + Vector3(0, 0, far + odd));
    outer.push_back(1.5 * out + Vector3(0, 0, far + odd - 1));
  }
  const TriangleMesh mesh = test::collar(rim, outer);
  for (const TriangleMesh& turned : {mesh, test::collar(outer, rim)}) {
    const Completion completion = close(turned);
    ASSERT_EQ(completion.report.holes.size(), 2u);
    std::vector<HoleReport> holes = completion.report.holes;
    std::sort(holes.begin(), holes.end(),
              [](const HoleReport& a, const HoleReport& b) { return a.perimeter < b.perimeter; });
    EXPECT_EQ(holes[0].outcome, HoleOutcome::closed) << holes[0].reason;
    EXPECT_EQ(holes[1].outcome, HoleOutcome::failed);
    EXPECT_EQ(holes[1].reason, "the patch meets the patch of another hole");
    EXPECT_EQ(completion.patch.triangles.size(), 8u);
  }
}

// --- cancelling

// The check of so long a rim takes many looks at the progress.
TEST(TriangleFan, can_be_cancelled_at_any_time) {
  std::vector<Vector3> rim;
  for (int i = 0; i < 1500; ++i) {
    const double turn = i * M_PI / 750;
    rim.push_back(as_stored(Vector3(std::cos(turn), std::sin(turn), 0)));
  }
  const TriangleMesh mesh = collar_under(rim);
  test::expect_cancels_at_any_step(
      [&](const Progress& progress) { close_by_fans(mesh, MeshSelection(), {}, progress); });
}

// --- which holes

TEST(TriangleFan, closes_selected_holes_only) {
  const TriangleMesh mesh = test::sphere_with_holes(6);
  const std::vector<BoundaryLoop> loops = test::loops_of(mesh);
  MeshSelection selection;
  selection.vertices.assign(mesh.vertices.size(), 0);
  selection.vertices[loops[2].vertices[5]] = 1;
  HoleSelectionOptions holes;
  holes.selected_only = true;
  const Completion completion = close(mesh, holes, selection);
  for (std::size_t i = 0; i < 6; ++i)
    EXPECT_EQ(completion.report.holes[i].outcome, i == 2 ? HoleOutcome::closed : HoleOutcome::skipped);
  EXPECT_EQ(completion.patch.triangles.size(), loops[2].vertices.size());
  EXPECT_THROW(close(mesh, holes), CompletionError) << "nothing is selected";
  holes = HoleSelectionOptions();
  holes.max_edges = loops[0].vertices.size() - 1;
  EXPECT_EQ(close(mesh, holes).report.holes[0].outcome, HoleOutcome::skipped);
}

TEST(TriangleFan, does_not_cover_sheets_or_mind_edges_of_three_faces_elsewhere) {
  EXPECT_TRUE(close(test::flat_grid(4, 3)).patch.empty());
  EXPECT_TRUE(close(test::isolated_triangle()).patch.empty());
  const Completion fin = close(test::sphere_with_hole_and_fin());
  EXPECT_EQ(fin.report.count(HoleOutcome::closed), 1u);
  const Completion strip = close(test::moebius_strip());
  EXPECT_TRUE(strip.patch.empty());
  EXPECT_EQ(only_target(strip).reason, describe(LoopDefect::inconsistent_normals));
}

}  // namespace
}  // namespace meshcomplete
