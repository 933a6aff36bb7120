#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include "common/core/error.h"
#include "common/core/mesh_statistics.h"
#include "common/core/triangle_intersection.h"
#include "filter_volmorph/hole_spanning.h"
#include "filter_volmorph/published_fans.h"
#include "tests/support/cancelling.h"
#include "tests/support/meshes.h"
#include "tests/support/patches.h"

namespace meshcomplete {
namespace {

PublishedFans close(const TriangleMesh& mesh, SpanningPieces spanning = SpanningPieces::all_but_largest) {
  return close_as_published(mesh, MeshSelection(), {{}, spanning});
}

// The new layer.
TriangleMesh result_of(const TriangleMesh& mesh, const PublishedFans& fans) {
  TriangleMesh rest = mesh;
  for (auto f = fans.removed.rbegin(); f != fans.removed.rend(); ++f)
    rest.triangles.erase(rest.triangles.begin() + *f);
  TriangleMesh result = test::with_patch(rest, fans.completion.patch);
  apply_splits(result, fans.splits);
  return result;
}

// Says that it is so, and how the result is.
MeshStatistics expect_closed_manifold(const TriangleMesh& mesh, const PublishedFans& fans) {
  const TriangleMesh result = result_of(mesh, fans);
  const MeshStatistics statistics = measure(result, true);
  EXPECT_TRUE(statistics.watertight());
  EXPECT_TRUE(statistics.manifold());
  EXPECT_EQ(statistics.self_intersecting_pairs, std::optional<std::size_t>(fans.intersections));
  EXPECT_EQ(fans.completion.report.count(HoleOutcome::closed), fans.completion.report.holes.size());
  return statistics;
}

bool has_note(const PublishedFans& fans, const std::string& text) {
  const std::vector<std::string>& notes = fans.completion.report.notes;
  return std::any_of(notes.begin(), notes.end(),
                     [&](const std::string& note) { return note.find(text) != std::string::npos; });
}

// A sphere two vertices of which are one: it touches itself there.
TriangleMesh sphere_that_touches_itself(TriangleMesh mesh) {
  const auto upper = [](const Vector3& a, const Vector3& b) { return a.z() < b.z(); };
  const auto low = std::min_element(mesh.vertices.begin(), mesh.vertices.end(), upper);
  const auto high = std::max_element(mesh.vertices.begin(), mesh.vertices.end(), upper);
  for (Triangle& t : mesh.triangles)
    std::replace(t.begin(), t.end(), static_cast<Index>(low - mesh.vertices.begin()),
                 static_cast<Index>(high - mesh.vertices.begin()));
  return mesh;
}

// --- the thesis's figure 1.3

TEST(PublishedFans, remove_hole_spanning_faces) {  // a
  TriangleMesh mesh = test::sphere_with_hole(3, 0.6);
  const BoundaryLoop loop = test::loops_of(mesh)[0];
  const std::size_t third = loop.vertices.size() / 3;
  const auto number = static_cast<Index>(mesh.triangles.size() / 2);
  mesh.triangles.insert(mesh.triangles.begin() + number,
                        {loop.vertices[0], loop.vertices[third], loop.vertices[2 * third]});
  for (const SpanningPieces spanning : {SpanningPieces::all_but_largest, SpanningPieces::touching_larger}) {
    const PublishedFans fans = close(mesh, spanning);
    EXPECT_EQ(fans.removed, std::vector<Index>{number});
    EXPECT_TRUE(fans.splits.empty());
    EXPECT_TRUE(has_note(fans, "Removed 1 hole-spanning face, in 1 piece"));
    EXPECT_TRUE(expect_closed_manifold(mesh, fans).solid());
  }
}

TEST(PublishedFans, split_overlapping_vertices) {  // b
  for (const TriangleMesh& sphere :
       {test::icosphere(2), test::without_ball(test::icosphere(3), Vector3(1, 0, 0), 0.5)}) {
    const TriangleMesh mesh = sphere_that_touches_itself(sphere);
    const PublishedFans fans = close(mesh);
    EXPECT_TRUE(fans.removed.empty());
    EXPECT_EQ(fans.splits.size(), 1u);
    EXPECT_TRUE(has_note(fans, "Split vertices where several fans of faces met: 1 copy"));
    EXPECT_EQ(expect_closed_manifold(mesh, fans).genus, std::optional<long long>(0));
  }
}

// Two fans of a vertex become one where the holes between them are filled: nothing to split.
TEST(PublishedFans, fill_holes_that_touch_without_a_split) {
  const TriangleMesh mesh = test::sphere_with_touching_holes();
  const PublishedFans fans = close(mesh);
  EXPECT_TRUE(fans.splits.empty());
  EXPECT_TRUE(expect_closed_manifold(mesh, fans).solid());
}

TEST(PublishedFans, report_intersections_and_do_not_avoid_them) {  // c
  const TriangleMesh holed = test::sphere_with_hole(3, 0.5);
  const Vector3 apex = test::fan_patch(holed, test::loops_of(holed)[0]).vertices[0];
  const TriangleMesh mesh = test::join(
      holed, test::translated(test::scaled(test::cube(), 0x1p-4), apex - Vector3::Constant(0x1p-5)));
  const PublishedFans fans = close(mesh, SpanningPieces::touching_larger);
  EXPECT_TRUE(fans.removed.empty());
  EXPECT_GT(fans.intersections, 0u);
  EXPECT_EQ(fans.intersections, count_improper_pairs(test::corners_of(result_of(mesh, fans))));
  EXPECT_TRUE(has_note(fans, "of faces of the result intersect"));
  expect_closed_manifold(mesh, fans);
  const PublishedFans alone = close(mesh);
  EXPECT_EQ(alone.removed.size(), 12u) << "the cube is a piece of its own";
  EXPECT_EQ(alone.intersections, 0u);
  EXPECT_TRUE(has_note(alone, "No faces of the result intersect"));
}

// --- pieces, and edges that are not manifold

TEST(PublishedFans, keep_the_largest_piece_or_all_that_touch_no_larger_one) {
  const TriangleMesh mesh =
      test::join(test::sphere_with_hole(2), test::translated(test::sphere_with_hole(3), Vector3(3, 0, 0)));
  const PublishedFans one = close(mesh);
  EXPECT_EQ(one.removed.size(), test::sphere_with_hole(2).triangles.size());
  EXPECT_EQ(one.removed.front(), 0u);
  EXPECT_EQ(expect_closed_manifold(mesh, one).components, 1u);
  const PublishedFans both = close(mesh, SpanningPieces::touching_larger);
  EXPECT_TRUE(both.removed.empty());
  EXPECT_EQ(expect_closed_manifold(mesh, both).components, 2u);
  const PublishedFans pinched = close(test::pinched_tetrahedra(), SpanningPieces::touching_larger);
  EXPECT_EQ(pinched.removed.size(), 4u);
  EXPECT_TRUE(pinched.splits.empty());
}

TEST(HoleSpanning, a_fin_goes_and_the_surface_under_it_stays) {
  const TriangleMesh mesh = test::sphere_with_hole_and_fin();
  const SweptMesh swept =
      sweep_hole_spanning_faces(mesh, MeshSelection(), SpanningPieces::all_but_largest, false);
  EXPECT_EQ(swept.spanning_faces, 1u);
  EXPECT_EQ(swept.spanning_pieces, 1u);
  EXPECT_EQ(swept.unclear_faces, 0u);
  expect_closed_manifold(mesh, close(mesh));
}

// An edge of a sphere is an edge on its other side, too: it has four faces of one piece.
TEST(HoleSpanning, faces_at_an_edge_where_a_piece_touches_itself_go) {
  TriangleMesh mesh = test::icosphere(2);
  const Index a = mesh.triangles[0][0], b = mesh.triangles[0][1];
  Triangle far = mesh.triangles[0];
  for (const Triangle& t : mesh.triangles)
    if (mesh.vertices[t[0]].dot(mesh.vertices[a]) < mesh.vertices[far[0]].dot(mesh.vertices[a])) far = t;
  for (Triangle& t : mesh.triangles) {
    std::replace(t.begin(), t.end(), far[0], a);
    std::replace(t.begin(), t.end(), far[1], b);
  }
  const SweptMesh swept =
      sweep_hole_spanning_faces(mesh, MeshSelection(), SpanningPieces::all_but_largest, false);
  EXPECT_EQ(swept.unclear_faces, 4u);
  EXPECT_EQ(swept.spanning_faces, 0u);
  const PublishedFans fans = close(mesh);
  EXPECT_TRUE(has_note(fans, "Removed 4 faces at edges with three or more faces"));
  expect_closed_manifold(mesh, fans);
}

TEST(PublishedFans, are_closed_and_manifold_whatever_the_mesh) {
  const std::vector<TriangleMesh> meshes = {test::sphere_with_holes(6),
                                            test::torus(12, 8),
                                            test::open_cylinder(),
                                            test::sphere_with_island(3),
                                            test::flat_grid(4, 3),
                                            test::rough_sheet(14, 14, 0.3, 3, 5),
                                            test::moebius_strip(),
                                            test::isolated_triangle(),
                                            test::pinched_tetrahedra(),
                                            test::book(),
                                            test::book(6),
                                            test::sphere_with_hole_and_fin(),
                                            test::unwelded(test::cube()),
                                            test::plate_with_tunnels(2),
                                            test::cube_with_zero_area_face(),
                                            test::flipped(test::sphere_with_hole()),
                                            test::rough_sphere_with_ragged_holes(3, 4, 7)};
  for (const TriangleMesh& mesh : meshes)
    for (const SpanningPieces spanning : {SpanningPieces::all_but_largest, SpanningPieces::touching_larger}) {
      const PublishedFans fans = close(mesh, spanning);
      expect_closed_manifold(mesh, fans);
      const TriangleMesh result = result_of(mesh, fans);
      const PublishedFans again = close(result, spanning);
      EXPECT_TRUE(again.removed.empty() && again.splits.empty() && again.completion.patch.empty());
    }
}

// Faces between vertices drawn at random: all that can be wrong with edges and vertices is.
TEST(PublishedFans, are_closed_and_manifold_for_random_faces) {
  std::mt19937 random(3);
  std::size_t split = 0, unclear = 0;
  for (int round = 0; round < 300; ++round) {
    TriangleMesh mesh;
    const int vertices = 5 + round % 25;
    for (int i = 0; i < vertices; ++i)
      mesh.vertices.push_back(Vector3(random() % 64, random() % 64, random() % 64));
    for (int i = 0; i < 3 * vertices; ++i) {
      Triangle t;
      for (Index& v : t) v = static_cast<Index>(random() % static_cast<unsigned>(vertices));
      mesh.triangles.push_back(t);
    }
    // A piece of a surface as well, so that more than single faces hang together.
    const TriangleMesh whole = test::join(test::flat_grid(3, 3), mesh);
    TriangleMesh glued = whole;
    for (int i = 0; i < 6; ++i) {
      const auto from = static_cast<Index>(random() % 16),
                 to = static_cast<Index>(random() % whole.vertices.size());
      for (Triangle& t : glued.triangles) std::replace(t.begin(), t.end(), from, to);
    }
    for (const SpanningPieces spanning : {SpanningPieces::all_but_largest, SpanningPieces::touching_larger}) {
      const SweptMesh swept = sweep_hole_spanning_faces(glued, MeshSelection(), spanning, false);
      unclear += swept.unclear_faces;
      const PublishedFans fans = close(glued, spanning);
      expect_closed_manifold(glued, fans);
      split += fans.splits.size();
      ASSERT_FALSE(HasFailure()) << "round " << round;
    }
  }
  EXPECT_GT(split, 0u);
  EXPECT_GT(unclear, 0u);
}

TEST(HoleSpanning, refuses_a_mesh_of_which_nothing_would_be_left) {
  TriangleMesh mesh = test::tetrahedron();
  mesh.triangles = {{0, 0, 1}, {2, 2, 3}};
  EXPECT_THROW(close(mesh), CompletionError);
  EXPECT_NO_THROW(close(TriangleMesh()));
}

// --- the parameters of all filters

TEST(PublishedFans, close_selected_holes_only) {
  const TriangleMesh mesh = test::sphere_with_holes(3);
  const std::vector<BoundaryLoop> loops = test::loops_of(mesh);
  MeshSelection selection;
  selection.vertices.assign(mesh.vertices.size(), 0);
  selection.vertices[loops[1].vertices[0]] = 1;
  PublishedFansOptions options;
  options.holes.selected_only = true;
  const PublishedFans fans = close_as_published(mesh, selection, options);
  EXPECT_EQ(fans.completion.report.count(HoleOutcome::closed), 1u);
  EXPECT_EQ(fans.completion.report.count(HoleOutcome::skipped), 2u);
  EXPECT_TRUE(measure(result_of(mesh, fans), false).manifold());
}

TEST(PublishedFans, can_be_cancelled_at_any_time) {
  const TriangleMesh mesh = test::sphere_with_holes(6, 4);
  test::expect_cancels_at_any_step(
      [&](const Progress& progress) { close_as_published(mesh, MeshSelection(), {}, progress); });
}

}  // namespace
}  // namespace meshcomplete
