#include "common/core/patch_check.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include "common/core/mesh_statistics.h"
#include "common/core/triangle_intersection.h"
#include "tests/support/meshes.h"
#include "tests/support/patches.h"

namespace meshcomplete {
namespace {

using test::check;
using test::corners_of;
using test::fan_patch;
using test::loops_of;
using test::pointers;

/// Fans at the means of all loops, appended.
Patch fans(const TriangleMesh& mesh, const std::vector<BoundaryLoop>& loops) {
  Patch patch;
  patch.input_vertices = static_cast<Index>(mesh.vertices.size());
  for (const BoundaryLoop& loop : loops) append(patch, fan_patch(mesh, loop));
  return patch;
}

double uniform(std::mt19937& random) { return random() * (1.0 / 4294967296.0); }

std::vector<Index> sorted(const std::set<Index>& set) { return {set.begin(), set.end()}; }

// --- right patches
// --------------------------------------------------------------------------------------------------

TEST(PatchCheck, PassesRightPatches) {
  for (const TriangleMesh& mesh : {test::sphere_with_hole(), test::sphere_with_holes(6),
                                   test::open_cylinder(), test::shuffled(test::sphere_with_hole(), 4),
                                   test::sphere_with_hole_and_fin(), test::sphere_with_touching_holes(),
                                   test::translated(test::sphere_with_hole(2), Vector3(1000, -500, 200))}) {
    std::vector<BoundaryLoop> loops;
    for (const BoundaryLoop& loop : loops_of(mesh))
      if (loop.defect == LoopDefect::none) loops.push_back(loop);
    ASSERT_FALSE(loops.empty());
    const PatchCheck result = check(mesh, fans(mesh, loops), loops);
    EXPECT_TRUE(result.passed()) << describe(result.defect);
    EXPECT_TRUE(result.patch_triangles.empty());
    EXPECT_TRUE(result.input_triangles.empty());
  }
}

TEST(PatchCheck, PassesOneOfTwoTouchingHoles) {
  const TriangleMesh mesh = test::sphere_with_touching_holes();
  const std::vector<BoundaryLoop> loops = loops_of(mesh);
  ASSERT_EQ(loops.size(), 2u);
  for (const BoundaryLoop& loop : loops) EXPECT_TRUE(check(mesh, fan_patch(mesh, loop), {loop}).passed());
}

// Large enough for the threads, with inner vertices of every kind.
TEST(PatchCheck, PassesWhatWasCutOut) {
  const TriangleMesh sphere = test::rough_sphere(5, 0.005, 3);
  const test::CutOut cut =
      test::cut_out(sphere, [&](Index f) { return sphere.vertices[sphere.triangles[f][0]].z() > 0.1; });
  ASSERT_GT(cut.patch.triangles.size(), 8000u);
  const std::vector<BoundaryLoop> loops = loops_of(cut.mesh);
  EXPECT_TRUE(check(cut.mesh, cut.patch, loops).passed());

  // A vertex at one side is pulled through the other side of the patch: all faces concerned are listed.
  Patch moved = cut.patch;
  const auto by_x = [](const Vector3& a, const Vector3& b) { return a.x() < b.x(); };
  *std::max_element(moved.vertices.begin(), moved.vertices.end(), by_x) = Vector3(-3, 0, 0.75);
  const PatchCheck result = check(cut.mesh, moved, loops);
  EXPECT_EQ(result.defect, PatchDefect::meets_itself);
  std::set<Index> expected;
  const Index faces = static_cast<Index>(cut.mesh.triangles.size());
  for (const auto& [a, b] : improper_pairs(corners_of(test::with_patch(cut.mesh, moved))))
    if (a >= faces) expected.insert({a - faces, b - faces});
  EXPECT_EQ(result.patch_triangles, sorted(expected));
}

TEST(PatchCheck, PassesNothingForNothing) {
  const TriangleMesh mesh = test::cube();
  Patch patch;
  patch.input_vertices = 8;
  EXPECT_TRUE(check(mesh, patch, {}).passed());
  EXPECT_TRUE(check_patch(InputNeighbourhood(TriangleMesh()), Patch(), {}).passed());
}

// --- special inputs
// ---------------------------------------------------------------------------------------------------

TEST(PatchCheck, RefusesAnEdgeThatTheInputHas) {
  // Two faces of a tetrahedron: the rim is a quadrilateral, and one of its diagonals is the edge that is
  // there.
  const TriangleMesh solid = test::tetrahedron(4);
  const TriangleMesh half = test::without_faces(solid, [](Index f) { return f >= 2; });
  std::vector<BoundaryLoop> loops = loops_of(half);
  ASSERT_EQ(loops.size(), 1u);
  BoundaryLoop& loop = loops[0];
  ASSERT_EQ(loop.vertices.size(), 4u);
  const auto walks = [&](const Triangle& t, Index a, Index b) {
    for (int k = 0; k < 3; ++k)
      if ((t[k] == a && t[(k + 1) % 3] == b) || (t[k] == b && t[(k + 1) % 3] == a)) return true;
    return false;
  };
  const bool first_is_edge = walks(half.triangles[0], loop.vertices[0], loop.vertices[2]);
  if (first_is_edge) std::rotate(loop.vertices.begin(), loop.vertices.begin() + 1, loop.vertices.end());
  EXPECT_TRUE(check(half, test::fan_from_corner(half, loop), loops).passed());
  std::rotate(loop.vertices.begin(), loop.vertices.begin() + 1, loop.vertices.end());
  const PatchCheck refused = check(half, test::fan_from_corner(half, loop), loops);
  EXPECT_EQ(refused.defect, PatchDefect::edge_not_manifold);
  EXPECT_EQ(refused.patch_triangles, (std::vector<Index>{0, 1}));
  EXPECT_EQ(refused.input_triangles, (std::vector<Index>{0, 1}));
}

TEST(PatchCheck, RefusesToCoverATriangleASecondTime) {
  const TriangleMesh mesh = test::isolated_triangle();
  const std::vector<BoundaryLoop> loops = loops_of(mesh);
  const PatchCheck result = check(mesh, test::fan_from_corner(mesh, loops[0]), loops);
  EXPECT_EQ(result.defect, PatchDefect::meets_input);
  EXPECT_EQ(result.patch_triangles, std::vector<Index>{0});
  EXPECT_EQ(result.input_triangles, std::vector<Index>{0});
}

TEST(PatchCheck, RefusesToCoverAFlatSheetASecondTime) {
  const TriangleMesh mesh = test::flat_grid(3, 3);
  const std::vector<BoundaryLoop> loops = loops_of(mesh);
  EXPECT_EQ(check(mesh, fan_patch(mesh, loops[0], Vector3(1.25, 1.75, 0)), loops).defect,
            PatchDefect::meets_input);
  EXPECT_TRUE(check(mesh, fan_patch(mesh, loops[0], Vector3(1.25, 1.75, -1)), loops).passed());
}

TEST(PatchCheck, RefusesFansThatJoinTwoVisitsOfAVertex) {
  const TriangleMesh mesh = test::sphere_with_touching_holes();
  std::vector<BoundaryLoop> loops = loops_of(mesh);
  ASSERT_EQ(loops.size(), 2u);
  const auto in_both = [&](Index v) {
    return std::count(loops[1].vertices.begin(), loops[1].vertices.end(), v) > 0;
  };
  const Index pinch = *std::find_if(loops[0].vertices.begin(), loops[0].vertices.end(), in_both);
  for (BoundaryLoop& loop : loops)
    std::rotate(loop.vertices.begin(), std::find(loop.vertices.begin(), loop.vertices.end(), pinch),
                loop.vertices.end());
  // One disc over both rims: round the pinch it closes each of the two fans of the input for itself, instead
  // of filling the two gaps between them. All edges are manifold, that vertex is not.
  const std::vector<Index>&a = loops[0].vertices, &b = loops[1].vertices;
  std::vector<Index> walk = a;
  walk.insert(walk.end(), b.begin(), b.end());
  const std::size_t n = walk.size(), half_a = a.size() / 2, half_b = a.size() + b.size() / 2;
  Patch disc;
  disc.input_vertices = static_cast<Index>(mesh.vertices.size());
  disc.vertices = {Vector3(0, 0, 0.5), Vector3(0, 0.5, 0)};
  const Index c = disc.input_vertices, d = c + 1;
  for (std::size_t i = 0; i < n; ++i)
    disc.triangles.push_back({walk[i], walk[(i + 1) % n], i >= half_a && i < half_b ? d : c});
  disc.triangles.push_back({c, walk[half_a], d});
  disc.triangles.push_back({c, d, walk[half_b]});
  const PatchCheck result = check(mesh, disc, loops);
  EXPECT_EQ(result.defect, PatchDefect::vertex_not_manifold);
  EXPECT_EQ(result.patch_triangles.size(), 4u) << "two faces of each fan at the pinch";
  EXPECT_GT(measure(test::with_patch(mesh, disc), false).non_manifold_vertices, 0u);
}

TEST(PatchCheck, LeavesZeroAreaFacesOfTheInputOut) {
  // A face without area that sticks out of a rim vertex into the hole, where the patch will be.
  TriangleMesh mesh = test::sphere_with_hole(2, 0.8);
  const std::vector<BoundaryLoop> loops = loops_of(mesh);
  const Patch before = fan_patch(mesh, loops[0], Vector3(0, 0, 0.75));
  const Vector3 rim = mesh.vertices[loops[0].vertices[0]], next = mesh.vertices[loops[0].vertices[1]];
  const Vector3 inside = as_stored((rim + next + Vector3(0, 0, 0.75)) / 3);
  const Index n = static_cast<Index>(mesh.vertices.size());
  for (int k = 0; k < 3; ++k) mesh.vertices.push_back(inside + Vector3(0, 0, 0.125 * (k - 1)));
  mesh.triangles.push_back({n, n + 1, n + 2});
  const Patch patch = fan_patch(mesh, loops[0], Vector3(0, 0, 0.75));
  EXPECT_TRUE(check(mesh, patch, loops).passed());
  mesh.vertices[n + 1].x() += 0.0625;  // now it has some
  EXPECT_EQ(check(mesh, patch, loops).defect, PatchDefect::meets_input);
}

TEST(PatchCheck, IgnoresInputTrianglesThatAreNotFinite) {
  TriangleMesh mesh = test::sphere_with_hole(2, 0.8);
  const std::vector<BoundaryLoop> loops = loops_of(mesh);
  mesh.vertices.push_back(Vector3::Constant(std::numeric_limits<double>::quiet_NaN()));
  mesh.triangles.push_back({0, 1, static_cast<Index>(mesh.vertices.size() - 1)});
  EXPECT_TRUE(check(mesh, fan_patch(mesh, loops[0]), loops).passed());
}

// --- families
// -----------------------------------------------------------------------------------------------------------

// Whatever a patch is like, the check passes it exactly when the mesh with the patch has all targeted edges
// closed and no defect that the mesh without it has not.
TEST(PatchCheck, AgreesWithTheStatisticsOfTheWhole) {
  int passed = 0, failed = 0;
  std::set<PatchDefect> seen;
  for (std::uint32_t seed = 0; seed < 220; ++seed) {
    std::mt19937 random(seed);
    const TriangleMesh mesh = seed % 2 ? test::rough_sphere_with_ragged_holes(2, 2, seed, 0.05)
                                       : test::rough_sheet(12, 10, 0.2, 2, seed);
    std::vector<BoundaryLoop> loops;
    for (const BoundaryLoop& loop : loops_of(mesh))
      if (loop.defect == LoopDefect::none && random() % 4) loops.push_back(loop);
    Patch patch;
    patch.input_vertices = static_cast<Index>(mesh.vertices.size());
    for (const BoundaryLoop& loop : loops) {
      const Vector3 noise(uniform(random) - 0.5, uniform(random) - 0.5, uniform(random) - 0.5);
      const double size = std::array<double, 3>{0, 0.02, 2}[random() % 3];
      const Patch fan = fan_patch(mesh, loop);
      append(patch, random() % 4 ? fan_patch(mesh, loop, fan.vertices[0] + size * noise)
                                 : test::fan_from_corner(mesh, loop));
    }
    if (!patch.triangles.empty() && random() % 5 == 0) {  // spoil it
      const std::size_t which = random() % patch.triangles.size();
      Triangle t = patch.triangles[which];
      const Index other = patch.triangles[random() % patch.triangles.size()][0];
      switch (random() % 3) {
        case 0:
          std::swap(t[0], t[1]);
          break;
        case 1:
          patch.triangles.push_back(t);
          break;
        default:
          t[random() % 3] = other;
          break;
      }
      if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) continue;
      patch.triangles[which] = t;
    }
    const PatchCheck result = check(mesh, patch, loops);
    seen.insert(result.defect);

    std::size_t targeted = 0;
    for (const BoundaryLoop& loop : loops) targeted += loop.vertices.size();
    const MeshStatistics before = measure(mesh, true), after = measure(test::with_patch(mesh, patch), true);
    const bool right =
        after.boundary_edges + targeted == before.boundary_edges && after.non_manifold_edges == 0 &&
        after.inconsistent_edges == 0 && after.non_manifold_vertices <= before.non_manifold_vertices &&
        after.degenerate_faces == 0 && after.duplicate_faces == 0 && after.duplicated_vertices == 0 &&
        *after.self_intersecting_pairs == 0 && after.unreferenced_vertices == 0;
    ASSERT_EQ(result.passed(), right) << "seed " << seed << ": " << describe(result.defect);
    ++(right ? passed : failed);
  }
  EXPECT_GT(passed, 30);
  EXPECT_GT(failed, 30);
  EXPECT_GE(seen.size(), 5u);
}

TEST(InputNeighbourhood, FindsWhatLooksNear) {
  for (const TriangleMesh& mesh : {test::icosphere(4), test::shuffled(test::icosphere(4), 2), test::cube(),
                                   TriangleMesh(), test::isolated_triangle()}) {
    const InputNeighbourhood input(mesh);
    EXPECT_EQ(&input.mesh(), &mesh);
    std::mt19937 random(1);
    for (int i = 0; i < 30; ++i) {
      const Vector3 a(2 * uniform(random) - 1, 2 * uniform(random) - 1, 2 * uniform(random) - 1);
      const Vector3 low = a, high = i % 5 ? Vector3(a + uniform(random) * Vector3::Ones()) : a;
      std::vector<Index> expected;
      for (Index f = 0; f < mesh.triangles.size(); ++f) {
        Eigen::AlignedBox<double, 3> box;
        for (Index v : mesh.triangles[f]) box.extend(mesh.vertices[v]);
        if (box.intersects(Eigen::AlignedBox<double, 3>(low, high))) expected.push_back(f);
      }
      EXPECT_EQ(input.triangles_in_box(low, high), expected);
    }
  }
}

TEST(InputNeighbourhood, BoxesAreClosed) {
  const TriangleMesh mesh = test::flat_grid(4, 4);
  const InputNeighbourhood input(mesh);
  EXPECT_EQ(input.triangles_in_box(Vector3(2, 2, 0), Vector3(2, 2, 0)).size(), 8u)
      << "all four squares at a vertex";
  EXPECT_TRUE(input.triangles_in_box(Vector3(2, 2, 0.5), Vector3(2, 2, 1)).empty());
  EXPECT_TRUE(input.triangles_in_box(Vector3(1, 1, 1), Vector3(-1, -1, -1)).empty()) << "an empty box";
}

TEST(InputNeighbourhood, ListsTheTrianglesThatOneTriangleMeets) {
  const TriangleMesh mesh = test::rough_sphere(3, 0.1, 8);
  const auto soup = corners_of(mesh);
  const InputNeighbourhood input(mesh);
  std::mt19937 random(3);
  std::size_t total = 0;
  for (int i = 0; i < 200; ++i) {
    std::array<Vector3, 3> t;
    for (Vector3& p : t)
      p = 1.2 * Vector3(2 * uniform(random) - 1, 2 * uniform(random) - 1, 2 * uniform(random) - 1);
    for (int k = 0; k < i % 4; ++k) t[k] = mesh.vertices[mesh.triangles[random() % mesh.triangles.size()][k]];
    std::vector<Index> expected;
    for (const auto& pair : improper_pairs_between({t}, soup)) expected.push_back(pair.second);
    total += expected.size();
    EXPECT_EQ(input_triangles_met(input, t), expected);
    EXPECT_EQ(input_triangles_met(input, t, 1).size(), std::min<std::size_t>(1, expected.size()));
    EXPECT_TRUE(input_triangles_met(input, t, 0).empty());
  }
  EXPECT_GT(total, 1000u);
  EXPECT_TRUE(input_triangles_met(input, {Vector3(0, 0, 0), Vector3(0, 0, 2), Vector3(0, 0, 4)}).empty());
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(input_triangles_met(input, {Vector3(nan, 0, 0), Vector3(0, 0, 2), Vector3(0, 3, 4)}).empty());
}

}  // namespace
}  // namespace meshcomplete
