#include "common/core/hole_selection.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "common/core/error.h"
#include "tests/support/meshes.h"
#include "tests/support/patches.h"

namespace meshcomplete {
namespace {

using test::loops_of;

/// Positions of the holes that are to be worked on.
std::vector<std::size_t> chosen(const std::vector<HoleReport>& holes) {
  std::vector<std::size_t> list;
  for (std::size_t i = 0; i < holes.size(); ++i)
    if (holes[i].outcome == HoleOutcome::failed && holes[i].reason.empty()) list.push_back(i);
  return list;
}

bool mentions(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// A large flat sheet with a small and a middle-sized hole in it.
class HoleSelection : public ::testing::Test {
 protected:
  HoleSelection() {
    const TriangleMesh grid = test::flat_grid(16, 8);
    mesh_ = test::without_faces(grid, [](Index f) {
      const Index x = f / 2 % 16, y = f / 2 / 16;
      return (x == 3 && y == 3) || (x >= 9 && x < 12 && y >= 3 && y < 5);
    });
    loops_ = loops_of(mesh_);
  }

  std::vector<HoleReport> select(const HoleSelectionOptions& options,
                                 const MeshSelection& selection = {}) const {
    return select_holes(mesh_, loops_, selection, options);
  }
  std::vector<char> no_vertices() const { return std::vector<char>(mesh_.vertices.size(), 0); }
  std::vector<char> no_faces() const { return std::vector<char>(mesh_.triangles.size(), 0); }

  TriangleMesh mesh_;
  std::vector<BoundaryLoop> loops_;  // the outer rim, the small hole of 4 edges, the large one of 10
};

TEST_F(HoleSelection, DescribesEveryLoop) {
  const std::vector<HoleReport> holes = select({});
  ASSERT_EQ(holes.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(holes[i].loops, std::vector<std::size_t>{i});
    EXPECT_EQ(holes[i].edges, loops_[i].vertices.size());
    EXPECT_DOUBLE_EQ(holes[i].perimeter, perimeter(mesh_, loops_[i]));
  }
  EXPECT_EQ(holes[1].edges, 4u);
  EXPECT_LT((holes[1].centre - Vector3(3.5, 3.5, 0)).norm(), 1e-12);
  EXPECT_LT((holes[2].centre - Vector3(10.5, 4, 0)).norm(), 1e-12);
}

TEST_F(HoleSelection, AllHolesButNotTheRimOfTheSheet) {
  const std::vector<HoleReport> holes = select({});
  EXPECT_EQ(chosen(holes), (std::vector<std::size_t>{1, 2}));
  EXPECT_EQ(holes[0].outcome, HoleOutcome::skipped);
  EXPECT_EQ(holes[0].reason, describe(LoopDefect::open_sheet));
}

TEST_F(HoleSelection, NumberOfEdges) {
  HoleSelectionOptions options;
  options.max_edges = 9;
  const std::vector<HoleReport> holes = select(options);
  EXPECT_EQ(chosen(holes), std::vector<std::size_t>{1});
  EXPECT_EQ(holes[2].outcome, HoleOutcome::skipped);
  EXPECT_TRUE(mentions(holes[2].reason, "9 edges")) << holes[2].reason;
  options.max_edges = 10;
  EXPECT_EQ(chosen(select(options)), (std::vector<std::size_t>{1, 2})) << "the limit itself is allowed";
  options.max_edges = 3;
  EXPECT_TRUE(chosen(select(options)).empty());
}

TEST_F(HoleSelection, Perimeter) {
  HoleSelectionOptions options;
  options.max_perimeter = 9.5;
  const std::vector<HoleReport> holes = select(options);
  EXPECT_EQ(chosen(holes), std::vector<std::size_t>{1});
  EXPECT_TRUE(mentions(holes[2].reason, "9.5")) << holes[2].reason;
  options.max_perimeter = 10;
  EXPECT_EQ(chosen(select(options)), (std::vector<std::size_t>{1, 2}));
}

TEST_F(HoleSelection, TheLongestStaysOpen) {
  HoleSelectionOptions options;
  options.keep_largest = true;
  EXPECT_TRUE(mentions(select(options)[0].reason, "longest")) << "the rim of the sheet is the longest";
  const TriangleMesh vase = test::join(test::open_cylinder(24, 4, 1, 2), test::sphere_with_hole(3, 0.3));
  const std::vector<BoundaryLoop> loops = loops_of(vase);
  ASSERT_EQ(loops.size(), 3u);
  const std::vector<HoleReport> holes = select_holes(vase, loops, {}, options);
  EXPECT_EQ(chosen(holes).size(), 2u);
  EXPECT_EQ(chosen(holes).back(), 2u) << "one of the cylinder's equal rims stays open, and only one";
}

TEST_F(HoleSelection, SelectedVertices) {
  HoleSelectionOptions options;
  options.selected_only = true;
  MeshSelection selection{no_vertices(), {}};
  selection.vertices[loops_[2].vertices[3]] = 1;
  const std::vector<HoleReport> holes = select(options, selection);
  EXPECT_EQ(chosen(holes), std::vector<std::size_t>{2});
  EXPECT_EQ(holes[0].reason, "not selected");
  EXPECT_EQ(holes[1].reason, "not selected");
  EXPECT_EQ(holes[1].outcome, HoleOutcome::skipped);
}

TEST_F(HoleSelection, SelectedFaces) {
  HoleSelectionOptions options;
  options.selected_only = true;
  MeshSelection selection{no_vertices(), no_faces()};
  selection.faces[loops_[1].faces[0]] = 1;
  EXPECT_EQ(chosen(select(options, selection)), std::vector<std::size_t>{1});
  // A face that has only a corner on the rim touches the hole too.
  const auto touches = std::find_if(mesh_.triangles.begin(), mesh_.triangles.end(), [&](const Triangle& t) {
    return std::count(t.begin(), t.end(), loops_[2].vertices[0]) == 1 &&
           std::none_of(t.begin(), t.end(), [&](Index v) {
             return v != loops_[2].vertices[0] &&
                    std::count(loops_[2].vertices.begin(), loops_[2].vertices.end(), v);
           });
  });
  ASSERT_NE(touches, mesh_.triangles.end());
  selection.faces = no_faces();
  selection.faces[static_cast<std::size_t>(touches - mesh_.triangles.begin())] = 1;
  EXPECT_EQ(chosen(select(options, selection)), std::vector<std::size_t>{2});
}

TEST_F(HoleSelection, ASelectionAwayFromTheHolesSelectsNone) {
  HoleSelectionOptions options;
  options.selected_only = true;
  MeshSelection selection{no_vertices(), {}};
  for (std::size_t v = 0; v < mesh_.vertices.size(); ++v)
    selection.vertices[v] = mesh_.vertices[v] == Vector3(6, 2, 0);
  EXPECT_TRUE(chosen(select(options, selection)).empty());
}

TEST_F(HoleSelection, TheSelectionIsIgnoredUnlessAskedFor) {
  MeshSelection selection{no_vertices(), {}};
  selection.vertices[loops_[1].vertices[0]] = 1;
  EXPECT_EQ(chosen(select({}, selection)), (std::vector<std::size_t>{1, 2}));
}

TEST_F(HoleSelection, OptionsCombine) {
  HoleSelectionOptions options;
  options.selected_only = true;
  options.max_edges = 9;
  MeshSelection selection{std::vector<char>(mesh_.vertices.size(), 1), {}};
  EXPECT_EQ(chosen(select(options, selection)), std::vector<std::size_t>{1});
  options.max_perimeter = 3.0;
  EXPECT_TRUE(chosen(select(options, selection)).empty());
}

TEST_F(HoleSelection, NothingSelectedIsAnError) {
  HoleSelectionOptions options;
  options.selected_only = true;
  for (const MeshSelection& selection : {MeshSelection(), MeshSelection{no_vertices(), no_faces()}}) {
    try {
      select(options, selection);
      FAIL() << "accepted an empty selection";
    } catch (const CompletionError& error) {
      EXPECT_EQ(error.stage(), "choosing the holes");
      EXPECT_TRUE(mentions(error.what(), "nothing is selected")) << error.what();
    }
  }
}

TEST_F(HoleSelection, TheSelectionOfAnotherMeshIsAnError) {
  HoleSelectionOptions options;
  options.selected_only = true;
  EXPECT_THROW(select(options, {std::vector<char>(mesh_.vertices.size() + 1, 1), {}}), CompletionError);
  EXPECT_THROW(select(options, {{}, std::vector<char>(3, 1)}), CompletionError);
}

TEST_F(HoleSelection, LimitsOutOfRangeAreErrors) {
  for (std::size_t edges : {0u, 1u, 2u}) {
    HoleSelectionOptions options;
    options.max_edges = edges;
    EXPECT_THROW(select(options), CompletionError) << edges;
  }
  const double infinity = std::numeric_limits<double>::infinity();
  for (double length : {0.0, -1.0, infinity, -infinity, std::numeric_limits<double>::quiet_NaN()}) {
    HoleSelectionOptions options;
    options.max_perimeter = length;
    EXPECT_THROW(select(options), CompletionError) << length;
  }
}

TEST(HoleSelectionDefects, AskedForButDefectiveHolesFail) {
  TriangleMesh mesh = test::sphere_with_holes(2);
  std::vector<BoundaryLoop> loops = loops_of(mesh);
  std::swap(mesh.triangles[loops[0].faces[1]][0], mesh.triangles[loops[0].faces[1]][1]);
  mesh = test::join(mesh, test::isolated_triangle());
  loops = loops_of(mesh);
  ASSERT_EQ(loops.size(), 3u);
  const std::vector<HoleReport> holes = select_holes(mesh, loops, {}, {});
  EXPECT_EQ(holes[0].outcome, HoleOutcome::failed);
  EXPECT_EQ(holes[0].reason, describe(LoopDefect::inconsistent_normals));
  EXPECT_EQ(chosen(holes), std::vector<std::size_t>{1});
  EXPECT_EQ(holes[2].outcome, HoleOutcome::skipped) << "a single triangle is no hole, hence no failure";
  EXPECT_EQ(holes[2].reason, describe(LoopDefect::isolated_triangle));

  HoleSelectionOptions options;
  options.max_edges = 3;
  const std::vector<HoleReport> small = select_holes(mesh, loops, {}, options);
  EXPECT_EQ(small[0].outcome, HoleOutcome::skipped) << "not asked for: its defect does not matter";
}

TEST(HoleSelectionDefects, NoLoops) {
  HoleSelectionOptions options;
  options.keep_largest = true;
  EXPECT_TRUE(select_holes(test::cube(), {}, {}, options).empty());
}

}  // namespace
}  // namespace meshcomplete
