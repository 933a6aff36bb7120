#include "common/core/boundary_loops.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "common/core/error.h"
#include "tests/support/loop_families.h"
#include "tests/support/meshes.h"
#include "tests/support/patches.h"

namespace meshcomplete {
namespace {

using test::loops_of;

constexpr double pi = 3.14159265358979323846;

bool walks(const Triangle& t, Index from, Index to) {
  for (int k = 0; k < 3; ++k)
    if (t[k] == from && t[(k + 1) % 3] == to) return true;
  return false;
}

bool walked_by_a_face(const TriangleMesh& mesh, Index from, Index to) {
  return std::any_of(mesh.triangles.begin(), mesh.triangles.end(),
                     [&](const Triangle& t) { return walks(t, from, to) || walks(t, to, from); });
}

/// What every list of loops fulfils, whatever the mesh.
void expect_right(const TriangleMesh& mesh, const std::vector<BoundaryLoop>& loops) {
  std::size_t edges = 0;
  for (const BoundaryLoop& loop : loops) {
    ASSERT_EQ(loop.faces.size(), loop.vertices.size());
    edges += loop.faces.size();
    if (loop.defect == LoopDefect::non_manifold_edge) continue;
    ASSERT_GE(loop.vertices.size(), 3u);
    EXPECT_EQ(loop.vertices[0], *std::min_element(loop.vertices.begin(), loop.vertices.end()));
    if (loop.defect == LoopDefect::inconsistent_normals) continue;
    EXPECT_EQ(std::set<Index>(loop.vertices.begin(), loop.vertices.end()).size(), loop.vertices.size())
        << "a vertex occurs twice";
    for (std::size_t i = 0; i < loop.vertices.size(); ++i)
      EXPECT_TRUE(walks(mesh.triangles[loop.faces[i]], loop.vertices[(i + 1) % loop.vertices.size()],
                        loop.vertices[i]))
          << "a patch walks against the face that is there";
  }
  EXPECT_EQ(edges, build_topology(mesh).boundary_half_edges.size()) << "every boundary edge in one loop";
  for (std::size_t i = 1; i < loops.size(); ++i) EXPECT_LE(loops[i - 1].vertices[0], loops[i].vertices[0]);
}

std::vector<BoundaryLoop> right_loops(const TriangleMesh& mesh) {
  std::vector<BoundaryLoop> loops = loops_of(mesh);
  expect_right(mesh, loops);
  return loops;
}

std::vector<LoopDefect> defects(const std::vector<BoundaryLoop>& loops) {
  std::vector<LoopDefect> list;
  for (const BoundaryLoop& loop : loops) list.push_back(loop.defect);
  return list;
}

TEST(BoundaryLoops, NoneOnClosedMeshes) {
  for (const TriangleMesh& mesh : {test::cube(), test::torus(8, 5), test::pinched_tetrahedra(),
                                   test::cube_with_zero_area_face(), TriangleMesh()})
    EXPECT_TRUE(loops_of(mesh).empty());
}

TEST(BoundaryLoops, OnePerHole) {
  for (int holes = 1; holes <= 6; ++holes)
    EXPECT_EQ(defects(right_loops(test::sphere_with_holes(holes))),
              std::vector<LoopDefect>(static_cast<std::size_t>(holes), LoopDefect::none));
  EXPECT_EQ(right_loops(test::sphere_with_island()).size(), 2u);
}

TEST(BoundaryLoops, TheDirectionIsThatOfAPatch) {
  // The lid of a cube without its two upper faces, seen from above, is counter-clockwise.
  const TriangleMesh cube = test::cube();
  const TriangleMesh box = test::without_faces(cube, [&](Index f) {
    const Triangle& t = cube.triangles[f];
    return std::all_of(t.begin(), t.end(), [&](Index v) { return cube.vertices[v].z() == 1; });
  });
  const std::vector<BoundaryLoop> loops = right_loops(box);
  ASSERT_EQ(loops.size(), 1u);
  ASSERT_EQ(loops[0].vertices.size(), 4u);
  double area = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const Vector3 a = box.vertices[loops[0].vertices[i]], b = box.vertices[loops[0].vertices[(i + 1) % 4]];
    area += 0.5 * (a.x() * b.y() - a.y() * b.x());
  }
  EXPECT_EQ(area, 1);
  EXPECT_EQ(loops[0].defect, LoopDefect::none);
}

// The numbering decides nothing but the order.
TEST(BoundaryLoops, TheSameLoopsForAnyNumbering) {
  const auto rims = [](const TriangleMesh& mesh) {
    std::set<std::set<std::array<double, 3>>> sets;
    for (const BoundaryLoop& loop : right_loops(mesh)) {
      std::set<std::array<double, 3>> rim;
      for (Index v : loop.vertices)
        rim.insert({mesh.vertices[v].x(), mesh.vertices[v].y(), mesh.vertices[v].z()});
      sets.insert(rim);
    }
    return sets;
  };
  const TriangleMesh mesh = test::sphere_with_holes(6);
  for (std::uint32_t seed = 1; seed <= 5; ++seed) EXPECT_EQ(rims(test::shuffled(mesh, seed)), rims(mesh));
}

TEST(BoundaryLoops, RaggedHoles) {
  for (std::uint32_t seed = 1; seed <= 30; ++seed) {
    right_loops(test::rough_sphere_with_ragged_holes(3, 5, seed));
    right_loops(test::shuffled(test::rough_sheet(12, 12, 0.1, 5, seed), seed));
  }
}

// --- vertices with several fans
// --------------------------------------------------------------------------------------------------

TEST(BoundaryLoops, HolesThatTouchAtAVertexAreTwo) {
  const std::vector<BoundaryLoop> loops = right_loops(test::sphere_with_touching_holes());
  ASSERT_EQ(defects(loops), (std::vector<LoopDefect>{LoopDefect::none, LoopDefect::none}));
  std::vector<Index> first = loops[0].vertices, second = loops[1].vertices, common;
  std::sort(first.begin(), first.end());
  std::sort(second.begin(), second.end());
  std::set_intersection(first.begin(), first.end(), second.begin(), second.end(), std::back_inserter(common));
  EXPECT_EQ(common.size(), 1u);
}

// Four squares round a vertex, two of them missing at opposite corners: a figure of eight.
TEST(BoundaryLoops, AFigureOfEightIsCutWhereItMeetsItself) {
  const TriangleMesh grid = test::flat_grid(4, 4);
  const auto square = [](Index face) { return face / 2; };
  const TriangleMesh mesh =
      test::without_faces(grid, [&](Index f) { return square(f) == 5 || square(f) == 10; });
  const std::vector<BoundaryLoop> loops = right_loops(mesh);
  ASSERT_EQ(loops.size(), 3u);
  EXPECT_EQ(loops[0].vertices.size(), 16u);
  EXPECT_EQ(loops[1].vertices.size(), 4u);
  EXPECT_EQ(loops[2].vertices.size(), 4u);
  EXPECT_EQ(defects(loops),
            (std::vector<LoopDefect>{LoopDefect::open_sheet, LoopDefect::none, LoopDefect::none}));
}

// The other two missing: two sheets that only touch, each with its own rim.
TEST(BoundaryLoops, FansOfDifferentSheetsAreNotMixed) {
  const TriangleMesh grid = test::flat_grid(2, 2);
  const TriangleMesh mesh = test::without_faces(grid, [](Index f) { return f / 2 == 1 || f / 2 == 2; });
  const std::vector<BoundaryLoop> loops = right_loops(mesh);
  ASSERT_EQ(loops.size(), 2u);
  for (const BoundaryLoop& loop : loops) {
    EXPECT_EQ(loop.vertices.size(), 4u);
    EXPECT_EQ(loop.faces[0] / 2, loop.faces[2] / 2) << "all faces of one square";
    EXPECT_EQ(loop.defect, LoopDefect::open_sheet);
  }
}

// A hole at the point where two closed surfaces touch belongs to one of them.
TEST(BoundaryLoops, APinchedVertexOnARim) {
  TriangleMesh mesh = test::pinched_tetrahedra();
  mesh.triangles.erase(std::find_if(mesh.triangles.begin(), mesh.triangles.end(), [](const Triangle& t) {
    return std::find(t.begin(), t.end(), 0u) != t.end();
  }));
  const std::vector<BoundaryLoop> loops = right_loops(mesh);
  ASSERT_EQ(loops.size(), 1u);
  EXPECT_EQ(loops[0].vertices.size(), 3u);
  EXPECT_EQ(loops[0].defect, LoopDefect::none);
}

// --- edges with three or more faces
// --------------------------------------------------------------------------------------------------

/// An edge from the rim of `sphere_with_hole` inwards: (vertex on the rim, vertex not on any rim).
std::pair<Index, Index> edge_from_rim(const TriangleMesh& mesh) {
  const BoundaryLoop loop = loops_of(mesh)[0];
  const auto on_rim = [&](Index v) {
    return std::find(loop.vertices.begin(), loop.vertices.end(), v) != loop.vertices.end();
  };
  for (const Triangle& t : mesh.triangles)
    for (int k = 0; k < 3; ++k)
      if (on_rim(t[k]) && !on_rim(t[(k + 1) % 3])) return {t[k], t[(k + 1) % 3]};
  throw std::logic_error("no such edge");
}

TEST(BoundaryLoops, ANonManifoldEdgeFarFromTheRimDoesNotMatter) {
  const std::vector<BoundaryLoop> loops = right_loops(test::sphere_with_hole_and_fin());
  ASSERT_EQ(loops.size(), 2u);
  EXPECT_EQ(loops[0].vertices.size(), right_loops(test::sphere_with_hole())[0].vertices.size());
  EXPECT_EQ(loops[0].defect, LoopDefect::none);
  EXPECT_EQ(loops[1].defect, LoopDefect::non_manifold_edge) << "the fin's own free edges";
  EXPECT_EQ(loops[1].vertices.size(), 2u);
}

// Three ends of fans at one rim vertex: any two of them could belong together.
TEST(BoundaryLoops, AFinThatEndsAtTheRimMakesItAmbiguous) {
  TriangleMesh mesh = test::sphere_with_hole();
  const auto [at, inside] = edge_from_rim(mesh);
  mesh.triangles.push_back({at, inside, static_cast<Index>(mesh.vertices.size())});
  mesh.vertices.push_back(1.5 * mesh.vertices[inside]);
  for (const BoundaryLoop& loop : right_loops(mesh)) EXPECT_EQ(loop.defect, LoopDefect::non_manifold_edge);
}

// A closed tetrahedron on an edge that ends at the rim leaves two ends of fans there: only they can belong
// together.
TEST(BoundaryLoops, TheOnlyContinuationAtANonManifoldEdgeIsTaken) {
  const TriangleMesh sphere = test::sphere_with_hole();
  TriangleMesh mesh = sphere;
  const auto [a, b] = edge_from_rim(mesh);
  const Index c = static_cast<Index>(mesh.vertices.size()), d = c + 1;
  mesh.vertices.push_back(1.5 * mesh.vertices[a] + Vector3(0.1, 0, 0));
  mesh.vertices.push_back(1.5 * mesh.vertices[a] - Vector3(0.1, 0, 0));
  for (const Triangle& t : {Triangle{a, b, c}, {b, a, d}, {a, c, d}, {c, b, d}}) mesh.triangles.push_back(t);
  ASSERT_FALSE(build_topology(mesh).non_manifold_half_edges.empty());
  const std::vector<BoundaryLoop> loops = right_loops(mesh);
  ASSERT_EQ(loops.size(), 1u);
  EXPECT_EQ(loops[0].defect, LoopDefect::none);
  EXPECT_EQ(loops[0].vertices, loops_of(sphere)[0].vertices);
}

TEST(BoundaryLoops, TheFreeEdgesOfABook) {
  const std::vector<BoundaryLoop> loops = right_loops(test::book(3));
  EXPECT_EQ(defects(loops), std::vector<LoopDefect>(3, LoopDefect::non_manifold_edge));
}

// --- orientation
// --------------------------------------------------------------------------------------------------

TEST(BoundaryLoops, AFaceTurnedOverAtTheRim) {
  TriangleMesh mesh = test::sphere_with_hole();
  const BoundaryLoop before = loops_of(mesh)[0];
  std::swap(mesh.triangles[before.faces[2]][0], mesh.triangles[before.faces[2]][1]);
  const std::vector<BoundaryLoop> loops = right_loops(mesh);
  ASSERT_EQ(loops.size(), 1u);
  EXPECT_EQ(loops[0].defect, LoopDefect::inconsistent_normals);
  EXPECT_EQ(loops[0].vertices.size(), before.vertices.size());
}

TEST(BoundaryLoops, AFaceTurnedOverElsewhereDoesNotMatter) {
  TriangleMesh mesh = test::sphere_with_hole();
  const auto lowest = std::min_element(mesh.triangles.begin(), mesh.triangles.end(),
                                       [&](const Triangle& s, const Triangle& t) {
                                         return mesh.vertices[s[0]].z() < mesh.vertices[t[0]].z();
                                       });
  std::swap((*lowest)[0], (*lowest)[1]);
  EXPECT_EQ(defects(right_loops(mesh)), std::vector<LoopDefect>{LoopDefect::none});
}

TEST(BoundaryLoops, AMoebiusStripHasNoFront) {
  const std::vector<BoundaryLoop> loops = right_loops(test::moebius_strip(24));
  ASSERT_EQ(loops.size(), 1u);
  EXPECT_EQ(loops[0].defect, LoopDefect::inconsistent_normals);
  EXPECT_EQ(loops[0].vertices.size(), 48u);
}

// --- hole or sheet?
// --------------------------------------------------------------------------------------------------

TEST(BoundaryLoops, ASingleTriangleIsNoHole) {
  EXPECT_EQ(defects(right_loops(test::isolated_triangle())),
            std::vector<LoopDefect>{LoopDefect::isolated_triangle});
  const TriangleMesh soup = test::unwelded(test::cube());
  EXPECT_EQ(defects(right_loops(soup)), std::vector<LoopDefect>(12, LoopDefect::isolated_triangle));
}

TEST(BoundaryLoops, TheRimOfASheetIsNoHole) {
  for (const TriangleMesh& sheet :
       {test::flat_grid(1, 1), test::flat_grid(7, 4), test::rough_sheet(10, 10, 0.1, 0, 1),
        test::scaled(test::flat_grid(7, 4), 1.0 / 1024), test::sphere_with_hole(4, pi - 0.5)})
    EXPECT_EQ(defects(right_loops(sheet)), std::vector<LoopDefect>{LoopDefect::open_sheet});
}

TEST(BoundaryLoops, AHoleInASheetIsAHole) {
  const TriangleMesh sheet = test::without_ball(test::flat_grid(12, 12), Vector3(6, 6, 0), 2.5);
  const std::vector<BoundaryLoop> loops = right_loops(sheet);
  ASSERT_EQ(loops.size(), 2u);
  EXPECT_EQ(loops[0].defect, LoopDefect::open_sheet);
  EXPECT_EQ(loops[1].defect, LoopDefect::none);
}

TEST(BoundaryLoops, AHemisphereOrAVaseIsNoSheet) {
  EXPECT_EQ(defects(right_loops(test::sphere_with_hole(3, pi / 2))),
            std::vector<LoopDefect>{LoopDefect::none});
  EXPECT_EQ(defects(right_loops(test::open_cylinder())),
            (std::vector<LoopDefect>{LoopDefect::none, LoopDefect::none}));
  const TriangleMesh cylinder = test::open_cylinder(24, 4, 1, 1);
  const TriangleMesh vase =
      test::with_patch(cylinder, test::fan_patch(cylinder, loops_of(cylinder)[0], Vector3(0, 0, 0)));
  EXPECT_EQ(defects(right_loops(vase)), std::vector<LoopDefect>{LoopDefect::none});
}

// A ring of a coin's edge, or a band along a rim of any shape, has two rims and no inside that a patch could
// double.
TEST(BoundaryLoops, ABandIsNoSheet) {
  const std::vector<LoopDefect> two_holes(2, LoopDefect::none);
  EXPECT_EQ(defects(right_loops(test::open_cylinder(24, 1, 1, 1.0 / 64))), two_holes);
  std::vector<Vector3> outer;
  const std::vector<Vector3> rim = testing::wound_rim(48, 2);
  for (const Vector3& p : rim) outer.push_back(p - Vector3(0, 0, 0.02));
  EXPECT_EQ(defects(right_loops(test::collar(rim, outer))), two_holes);
  // The same as narrow, but flat: a sheet with a large hole in it.
  const TriangleMesh frame = test::without_faces(test::flat_grid(20, 20), [](Index f) {
    const Index x = f / 2 % 20, y = f / 2 / 20;
    return x > 0 && x < 19 && y > 0 && y < 19;
  });
  EXPECT_EQ(defects(right_loops(frame)), (std::vector<LoopDefect>{LoopDefect::open_sheet, LoopDefect::none}));
}

// --- rims that no patch can have
// --------------------------------------------------------------------------------------------------

TEST(BoundaryLoops, AnEdgeWithoutLength) {
  TriangleMesh mesh = test::sphere_with_hole();
  const BoundaryLoop loop = loops_of(mesh)[0];
  mesh.vertices[loop.vertices.back()] = mesh.vertices[loop.vertices.front()];
  EXPECT_EQ(defects(right_loops(mesh)), std::vector<LoopDefect>{LoopDefect::edge_without_length});
}

TEST(BoundaryLoops, ARimOnALine) {
  const std::vector<Vector3> rim = {{0, 0, 0}, {3, 0, 0}, {1, 0, 0}, {0.5, 0, 0}};
  const std::vector<Vector3> outer = {{-3, 1, 0}, {5, -1, 0}, {1, 0, 3}, {0.5, 0, 5}};
  TriangleMesh mesh = test::collar(rim, outer);
  EXPECT_EQ(right_loops(mesh)[0].defect, LoopDefect::degenerate_rim);
  mesh.vertices[1].y() = 1e-30;
  EXPECT_NE(right_loops(mesh)[0].defect, LoopDefect::degenerate_rim) << "decided exactly";
}

// --- the rest
// --------------------------------------------------------------------------------------------------

TEST(BoundaryLoops, Perimeter) {
  const TriangleMesh grid = test::flat_grid(3, 2);
  EXPECT_DOUBLE_EQ(perimeter(grid, loops_of(grid)[0]), 10);
  EXPECT_DOUBLE_EQ(perimeter(test::scaled(grid, 0.25), loops_of(grid)[0]), 2.5);
}

TEST(BoundaryLoops, EveryDefectIsDescribed) {
  EXPECT_EQ(describe(LoopDefect::none), "");
  std::set<std::string> texts;
  for (LoopDefect defect :
       {LoopDefect::non_manifold_edge, LoopDefect::inconsistent_normals, LoopDefect::isolated_triangle,
        LoopDefect::open_sheet, LoopDefect::edge_without_length, LoopDefect::degenerate_rim})
    texts.insert(describe(defect));
  EXPECT_EQ(texts.size(), 6u);
  EXPECT_EQ(texts.count(""), 0u);
}

TEST(BoundaryLoops, ClosedLoopsAreOnesOfTheMesh) {
  const TriangleMesh mesh = test::rough_sphere_with_ragged_holes(3, 4, 2);
  for (const BoundaryLoop& loop : loops_of(mesh))
    for (std::size_t i = 0; i < loop.vertices.size(); ++i)
      EXPECT_TRUE(walked_by_a_face(mesh, loop.vertices[i], loop.vertices[(i + 1) % loop.vertices.size()]));
}

TEST(BoundaryLoops, CanBeCancelled) {
  const TriangleMesh mesh = test::sphere_with_hole();
  const MeshTopology topology = build_topology(mesh);
  EXPECT_THROW(
      trace_boundary_loops(mesh, topology, Progress([](double, const std::string&) { return false; })),
      Cancelled);
}

}  // namespace
}  // namespace meshcomplete
