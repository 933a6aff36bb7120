#include "common/core/partial_fill.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>
#include <utility>

#include "common/core/error.h"
#include "tests/support/complexes.h"
#include "tests/support/meshes.h"
#include "tests/support/patches.h"

namespace meshcomplete {
namespace {

constexpr int columns = 16, rows = 12;  // of the hole in the sheets below
constexpr int margin = 3;

Vector3 middle(const TriangleMesh& mesh, Index face) {
  const Triangle& t = mesh.triangles[face];
  return (mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]) / 3;
}

// A sheet with a rectangular hole and what fills it; with an island of 2 x 2 squares in its middle if wanted.
test::CutOut sheet(bool island = false) {
  const TriangleMesh grid = test::flat_grid(columns + 2 * margin, rows + 2 * margin);
  return test::cut_out(grid, [&](Index face) {
    const Vector3 at = middle(grid, face) - Vector3(margin, margin, 0);
    const Vector3 from_centre = at - Vector3(columns, rows, 0) / 2;
    const bool in_hole = at.x() > 0 && at.y() > 0 && at.x() < columns && at.y() < rows;
    return in_hole && !(island && from_centre.cwiseAbs().maxCoeff() < 1);
  });
}

// The rims of the hole and of the island, by their positions among the loops.
std::vector<std::size_t> inner_rims(const TriangleMesh& mesh, const std::vector<BoundaryLoop>& loops) {
  std::vector<std::size_t> rims;
  for (std::size_t i = 0; i < loops.size(); ++i)
    if (perimeter(mesh, loops[i]) < 2 * (columns + rows) + 1) rims.push_back(i);
  return rims;
}

MeshSelection vertices_where(const TriangleMesh& mesh, const std::function<bool(const Vector3&)>& select) {
  MeshSelection selection;
  for (const Vector3& p : mesh.vertices) selection.vertices.push_back(select(p - Vector3(margin, margin, 0)));
  return selection;
}

struct Filled {
  std::vector<BoundaryLoop> loops;
  std::vector<std::size_t> rims;
  Strip strip;
  double area = 0;
};

Filled fill(const test::CutOut& part, const std::function<bool(const Vector3&)>& select) {
  Filled filled;
  filled.loops = test::loops_of(part.mesh);
  filled.rims = inner_rims(part.mesh, filled.loops);
  const auto stretches = selected_stretches(part.mesh, filled.loops, vertices_where(part.mesh, select));
  filled.strip = cut_strip(part.mesh, filled.loops, filled.rims, stretches, part.patch);
  for (const Triangle& t : filled.strip.patch.triangles) {
    const auto [a, b, c] = corners(part.mesh, filled.strip.patch, t);
    filled.area += 0.5 * (b - a).cross(c - a).norm();
  }
  return filled;
}

// Manifold, no vertex without a face, and the hole smaller by just the edges that the strip says.
void expect_sound(const test::CutOut& part, const Filled& filled) {
  const Patch& patch = filled.strip.patch;
  std::set<Index> used;
  for (const Triangle& t : patch.triangles) used.insert(t.begin(), t.end());
  for (Index v = 0; v < patch.vertices.size(); ++v) EXPECT_TRUE(used.count(patch.input_vertices + v));
  const TriangleMesh whole = test::with_patch(part.mesh, patch);
  EXPECT_TRUE(test::shape_of(whole.triangles).manifold);
  std::size_t open = 0;
  for (const auto& [edge, times] : test::boundary_of(whole.triangles)) {
    EXPECT_EQ(std::abs(times), 1);
    open += edge.first < patch.input_vertices && edge.second < patch.input_vertices;
  }
  EXPECT_EQ(open, test::boundary_of(part.mesh.triangles).size() - filled.strip.edges);
}

TEST(PartialFill, StretchesAreTheLongestRunsOfSelectedEdges) {
  const TriangleMesh mesh = test::sphere_with_holes(3);
  const std::vector<BoundaryLoop> loops = test::loops_of(mesh);
  ASSERT_EQ(loops.size(), 3u);
  const std::size_t count = loops[0].vertices.size();
  ASSERT_GE(count, 16u);
  MeshSelection selection;
  selection.vertices.assign(mesh.vertices.size(), 0);
  for (std::size_t k :
       {count - 2, count - 1, std::size_t(0), std::size_t(1), std::size_t(4)})  // over the start
    selection.vertices[loops[0].vertices[k]] = 1;
  for (Index v : loops[2].vertices) selection.vertices[v] = 1;
  auto stretches = selected_stretches(mesh, loops, selection);
  ASSERT_EQ(stretches.size(), 2u);
  EXPECT_EQ(stretches[0].loop, 0u);
  EXPECT_EQ(stretches[0].first, count - 2);
  EXPECT_EQ(stretches[0].edges, 3u);
  EXPECT_EQ(stretches[1].loop, 2u);
  EXPECT_EQ(stretches[1].edges, loops[2].vertices.size());
  // Faces count as their corners do.
  selection.vertices.clear();
  selection.faces.assign(mesh.triangles.size(), 0);
  selection.faces[loops[1].faces[3]] = 1;
  stretches = selected_stretches(mesh, loops, selection);
  ASSERT_EQ(stretches.size(), 1u);
  EXPECT_EQ(stretches[0].loop, 1u);
  EXPECT_LE(stretches[0].first, 3u);
  EXPECT_GT(stretches[0].first + stretches[0].edges, 3u);
}

TEST(PartialFill, NothingSelectedAtTheBoundary) {
  const TriangleMesh mesh = test::sphere_with_hole();
  const std::vector<BoundaryLoop> loops = test::loops_of(mesh);
  MeshSelection selection;
  selection.vertices.assign(mesh.vertices.size(), 0);
  selection.vertices[loops[0].vertices[5]] = 1;  // no edge
  try {
    selected_stretches(mesh, loops, selection);
    FAIL();
  } catch (const CompletionError& error) {
    EXPECT_NE(std::string(error.what()).find("no edge of the boundary is selected"), std::string::npos);
  }
}

// The corner of the hole, from one side to the next.
TEST(PartialFill, OneStretchIsClosedByTheShortestPathBetweenItsEnds) {
  const test::CutOut part = sheet();
  const Filled filled = fill(part, [](const Vector3& p) {
    return (p.x() == 0 && p.y() >= 0 && p.y() <= 6) || (p.y() == 0 && p.x() >= 0 && p.x() <= 6);
  });
  EXPECT_EQ(filled.strip.reason, "");
  EXPECT_EQ(filled.strip.edges, 12u);
  EXPECT_EQ(filled.strip.of, 2u * (columns + rows));
  // All paths along the grid are equally long, since its diagonals go the other way. The straight one halves
  // the corner.
  EXPECT_NEAR(filled.area, 6 * 6 / 2.0, 3);
  expect_sound(part, filled);
}

TEST(PartialFill, TwoStretchesAreJoinedByAStripAcross) {
  const test::CutOut part = sheet();
  const Filled filled =
      fill(part, [](const Vector3& p) { return (p.y() == 0 || p.y() == rows) && p.x() >= 5 && p.x() <= 9; });
  EXPECT_EQ(filled.strip.reason, "");
  EXPECT_EQ(filled.strip.edges, 8u);
  EXPECT_NEAR(filled.area, 4 * rows, 1e-9);
  expect_sound(part, filled);
}

TEST(PartialFill, AnIslandInTheStripIsClosedToo) {
  const test::CutOut part = sheet(true);
  const Filled around =
      fill(part, [](const Vector3& p) { return (p.y() == 0 || p.y() == rows) && p.x() >= 4 && p.x() <= 12; });
  EXPECT_EQ(around.rims.size(), 2u);
  EXPECT_EQ(around.strip.edges, 16u + 8u);
  EXPECT_NEAR(around.area, 8 * rows - 4, 1e-9);
  expect_sound(part, around);
  const Filled beside =
      fill(part, [](const Vector3& p) { return (p.y() == 0 || p.y() == rows) && p.x() >= 1 && p.x() <= 4; });
  EXPECT_EQ(beside.strip.edges, 6u);
  expect_sound(part, beside);
}

// Of two rows of vertices, so that a path from one end to the other has to go along a rim or far round.
TEST(PartialFill, EndsAreMovedWhereThePatchIsNarrow) {
  const TriangleMesh grid = test::flat_grid(20, 9);
  const test::CutOut part = test::cut_out(grid, [&](Index face) {
    const Vector3 at = middle(grid, face);
    return at.y() > 4 && at.y() < 5 && at.x() > 2 && at.x() < 18;
  });
  const std::vector<BoundaryLoop> loops = test::loops_of(part.mesh);
  const auto rims = inner_rims(part.mesh, loops);
  MeshSelection selection;
  for (const Vector3& p : part.mesh.vertices)  // opposite ones are joined by no edge: diagonals go up
    selection.vertices.push_back((p.y() == 4 && p.x() >= 8 && p.x() <= 11) ||
                                 (p.y() == 5 && p.x() >= 6 && p.x() <= 9));
  const Strip strip =
      cut_strip(part.mesh, loops, rims, selected_stretches(part.mesh, loops, selection), part.patch);
  EXPECT_EQ(strip.reason, "");
  EXPECT_GE(strip.edges, 4u);
  EXPECT_LE(strip.edges, 12u);
  EXPECT_TRUE(test::shape_of(test::with_patch(part.mesh, strip.patch).triangles).manifold);
}

// From the hole's lower side to the island.
TEST(PartialFill, StretchesOfTwoRimsAreJoined) {
  const test::CutOut part = sheet(true);
  const Filled filled = fill(part, [](const Vector3& p) {
    return (p.y() == 0 || p.y() == rows / 2 - 1) && p.x() >= columns / 2 - 1 && p.x() <= columns / 2 + 1;
  });
  EXPECT_EQ(filled.strip.reason, "");
  EXPECT_EQ(filled.strip.edges, 4u);
  EXPECT_NEAR(filled.area, 2 * (rows / 2 - 1), 1e-9);
  expect_sound(part, filled);
}

TEST(PartialFill, WithTheWholeRimItIsTheWholePatch) {
  const test::CutOut part = sheet();
  const Filled filled = fill(
      part, [](const Vector3& p) { return p.x() >= 0 && p.y() >= 0 && p.x() <= columns && p.y() <= rows; });
  EXPECT_EQ(filled.strip.edges, filled.strip.of);
  EXPECT_NEAR(filled.area, columns * rows, 1e-9);
  EXPECT_EQ(filled.strip.patch.triangles, part.patch.triangles);
}

TEST(PartialFill, SaysWhyThereIsNoStrip) {
  const test::CutOut part = sheet();
  // No vertex inside: every path would go along the rim.
  test::CutOut plain = part;
  const std::vector<BoundaryLoop> loops = test::loops_of(plain.mesh);
  plain.patch = test::fan_from_corner(plain.mesh, loops[inner_rims(plain.mesh, loops).front()]);
  const Filled none = fill(plain, [](const Vector3& p) { return p.y() == rows && p.x() >= 6 && p.x() <= 9; });
  EXPECT_NE(none.strip.reason.find("no path over the new surface"), std::string::npos) << none.strip.reason;
  EXPECT_TRUE(none.strip.patch.empty());
}

TEST(PartialFill, TooManyStretchesAreRefused) {
  const test::CutOut part = sheet();
  const std::vector<BoundaryLoop> loops = test::loops_of(part.mesh);
  const auto rims = inner_rims(part.mesh, loops);
  std::vector<RimStretch> stretches;
  for (std::size_t k = 0; k < 8; ++k) stretches.push_back({rims.front(), 7 * k, 1});
  const Strip strip = cut_strip(part.mesh, loops, rims, stretches, part.patch);
  EXPECT_NE(strip.reason.find("select at most 7"), std::string::npos) << strip.reason;
  EXPECT_TRUE(strip.patch.empty());
}

// As a rectangle takes them where the rim is ragged.
TEST(PartialFill, ShortInterruptionsAndShortStretchesDoNotCount) {
  const test::CutOut part = sheet();
  const std::vector<BoundaryLoop> loops = test::loops_of(part.mesh);
  const BoundaryLoop& rim = loops[inner_rims(part.mesh, loops).front()];
  const auto stretches = [&](const std::vector<std::pair<std::size_t, std::size_t>>& selected) {
    MeshSelection selection;
    selection.vertices.assign(part.mesh.vertices.size(), 0);
    for (const auto& [first, last] : selected)
      for (std::size_t k = first; k <= last; ++k)
        selection.vertices[rim.vertices[k % rim.vertices.size()]] = 1;
    std::vector<std::pair<std::size_t, std::size_t>> found;
    for (const RimStretch& s : selected_stretches(part.mesh, loops, selection))
      found.emplace_back(s.first, s.edges);
    return found;
  };
  using Found = std::vector<std::pair<std::size_t, std::size_t>>;
  EXPECT_EQ(stretches({{5, 9}, {14, 20}}), (Found{{5, 15}}));
  EXPECT_EQ(stretches({{5, 9}, {14, 18}}), (Found{{5, 4}, {14, 4}}));
  EXPECT_EQ(stretches({{5, 9}, {20, 22}}), (Found{{5, 4}}));
  EXPECT_EQ(stretches({{20, 22}}), (Found{{20, 2}}));
  EXPECT_EQ(stretches({{50, 54}, {58, 64}}), (Found{{50, 14}}));  // over the start of 56
  EXPECT_EQ(stretches({{0, 50}}), (Found{{0, 56}}));
}

// Two bays at opposite ends of the hole: a strip between them would be far longer than both.
TEST(PartialFill, StretchesThatAreFarApartAreBays) {
  const TriangleMesh grid = test::flat_grid(66, 10);
  const test::CutOut part = test::cut_out(grid, [&](Index face) {
    const Vector3 at = middle(grid, face);
    return at.x() > 3 && at.x() < 63 && at.y() > 3 && at.y() < 7;
  });
  const std::vector<BoundaryLoop> loops = test::loops_of(part.mesh);
  std::vector<std::size_t> rims;
  for (std::size_t i = 0; i < loops.size(); ++i)
    if (loops[i].vertices.size() == 128) rims.push_back(i);
  ASSERT_EQ(rims.size(), 1u);
  MeshSelection selection;
  for (const Vector3& p : part.mesh.vertices)
    selection.vertices.push_back(p.y() >= 3 && p.y() <= 7 && (p.x() <= 5 || p.x() >= 61));
  const Strip strip =
      cut_strip(part.mesh, loops, rims, selected_stretches(part.mesh, loops, selection), part.patch);
  EXPECT_EQ(strip.edges, 2u * (4 + 2 + 2));
  EXPECT_LT(strip.patch.triangles.size(), 50u);
}

TEST(PartialFill, HolesAtAStretchAndNearItAreTargeted) {
  const TriangleMesh mesh =
      test::join(sheet(true).mesh, test::translated(test::sphere_with_hole(), {50, 50, 0}));
  OpenMesh open = find_holes(mesh, {}, {});
  const auto selection =
      vertices_where(mesh, [](const Vector3& p) { return p.y() == 0 && p.x() >= 3 && p.x() <= 6; });
  const auto stretches = selected_stretches(mesh, open.loops, selection);
  target_stretches(mesh, stretches, open);
  std::size_t targeted = 0;
  for (std::size_t i = 0; i < open.loops.size(); ++i) {
    if (open.holes[i].centre.x() > 40) {
      EXPECT_EQ(open.holes[i].reason, "not selected");
      EXPECT_EQ(open.holes[i].outcome, HoleOutcome::skipped);
    }
    targeted += is_targeted(open.holes[i]);
  }
  EXPECT_GE(targeted, 2u);  // the hole and the island
}

TEST(PartialFill, CanBeCancelled) {
  const test::CutOut part = sheet();
  const std::vector<BoundaryLoop> loops = test::loops_of(part.mesh);
  const auto rims = inner_rims(part.mesh, loops);
  const std::vector<RimStretch> stretches = {{rims.front(), 0, 5}};
  EXPECT_THROW(cut_strip(part.mesh, loops, rims, stretches, part.patch,
                         Progress([](double, const std::string&) { return false; })),
               Cancelled);
}

}  // namespace
}  // namespace meshcomplete
