#include "common/core/mesh_statistics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <string>
#include <vector>

#include "tests/support/meshes.h"

namespace meshcomplete {
namespace {

constexpr double pi = 3.14159265358979323846;

TEST(MeshStatistics, Cube) {
  const MeshStatistics s = measure(test::cube(2), true);
  EXPECT_EQ(s.vertices, 8u);
  EXPECT_EQ(s.faces, 12u);
  EXPECT_EQ(s.components, 1u);
  EXPECT_EQ(s.unreferenced_vertices, 0u);
  EXPECT_EQ(s.duplicated_vertices, 0u);
  EXPECT_TRUE(s.boundary_loops.empty());
  EXPECT_TRUE(s.orientable);
  EXPECT_EQ(s.genus, 0);
  EXPECT_EQ(s.self_intersecting_pairs, 0u);
  EXPECT_EQ(s.volume, 8.0);
  EXPECT_TRUE(s.watertight());
  EXPECT_TRUE(s.manifold());
  EXPECT_TRUE(s.solid());
}

TEST(MeshStatistics, IntersectionsAreCountedOnRequestOnly) {
  const MeshStatistics s = measure(test::cube(), false);
  EXPECT_FALSE(s.self_intersecting_pairs.has_value());
  EXPECT_TRUE(s.watertight());
  EXPECT_FALSE(s.solid());
}

TEST(MeshStatistics, NothingAtAll) {
  const MeshStatistics s = measure(TriangleMesh(), true);
  EXPECT_EQ(s.faces, 0u);
  EXPECT_EQ(s.genus, 0);
  EXPECT_FALSE(s.watertight());
  EXPECT_FALSE(s.solid());
  EXPECT_FALSE(describe(s).empty());
}

TEST(MeshStatistics, ClosedSurfacesAreSolids) {
  for (const TriangleMesh& mesh :
       {test::icosphere(3), test::uv_sphere(12, 16), test::torus(24, 12), test::tetrahedron(),
        test::plate_with_tunnels(2), test::rough_sphere(3, 0.1, 1),
        test::join(test::cube(), test::icosphere(1, 1, Vector3(5, 0, 0))),
        test::shuffled(test::torus(24, 12), 7)}) {
    const MeshStatistics s = measure(mesh, true);
    EXPECT_TRUE(s.solid());
    EXPECT_EQ(s.unreferenced_vertices, 0u);
    EXPECT_FALSE(measure(test::flipped(mesh), true).solid()) << "inside out";
  }
}

TEST(MeshStatistics, Volume) {
  EXPECT_NEAR(measure(test::icosphere(5), false).volume, 4 * pi / 3, 0.01);
  EXPECT_NEAR(measure(test::torus(200, 100), false).volume, 2 * pi * pi * 0.16, 0.01);
  EXPECT_EQ(measure(test::plate_with_tunnels(2), false).volume, 13.0);
  EXPECT_EQ(measure(test::flipped(test::cube()), false).volume, -1.0);
  EXPECT_EQ(measure(test::cube(1, Vector3(1 << 20, 1 << 20, -(1 << 20))), false).volume, 1.0);
}

TEST(MeshStatistics, GenusOfHandles) {
  EXPECT_EQ(measure(test::torus(12, 8), false).genus, 1);
  for (int tunnels = 0; tunnels < 5; ++tunnels)
    EXPECT_EQ(measure(test::plate_with_tunnels(tunnels), false).genus, tunnels);
  EXPECT_EQ(measure(test::join(test::torus(12, 8), test::plate_with_tunnels(3)), false).genus, 4);
}

TEST(MeshStatistics, GenusWithHolesIsThatOfTheCappedSurface) {
  const TriangleMesh torus = test::torus(24, 12);
  const TriangleMesh open = test::without_ball(torus, Vector3(1, 0, 0.5), 0.3);
  const MeshStatistics s = measure(open, false);
  EXPECT_EQ(s.boundary_loops.size(), 1u);
  EXPECT_EQ(s.genus, 1);
  EXPECT_EQ(measure(test::sphere_with_holes(5), false).genus, 0);
  EXPECT_EQ(measure(test::flat_grid(3, 4), false).genus, 0);
}

TEST(MeshStatistics, BoundaryLoops) {
  EXPECT_EQ(measure(test::flat_grid(3, 4), false).boundary_loops, std::vector<std::size_t>{14});
  EXPECT_EQ(measure(test::open_cylinder(24, 3), false).boundary_loops, (std::vector<std::size_t>{24, 24}));
  EXPECT_EQ(measure(test::sphere_with_holes(4), false).boundary_loops.size(), 4u);
  EXPECT_EQ(measure(test::isolated_triangle(), false).boundary_loops, std::vector<std::size_t>{3});
  const MeshStatistics s = measure(test::sphere_with_island(), false);
  EXPECT_EQ(s.components, 2u);
  ASSERT_EQ(s.boundary_loops.size(), 2u);
  EXPECT_GT(s.boundary_loops[0], s.boundary_loops[1]);
  EXPECT_EQ(s.boundary_loops[0] + s.boundary_loops[1], s.boundary_edges);
  EXPECT_FALSE(s.watertight());
}

TEST(MeshStatistics, HolesThatTouchAreOneLoopThroughTheFans) {
  const MeshStatistics s = measure(test::sphere_with_touching_holes(), true);
  EXPECT_EQ(s.boundary_loops.size(), 1u);
  EXPECT_EQ(s.non_manifold_vertices, 1u);
  EXPECT_FALSE(s.manifold());
  EXPECT_EQ(s.genus, 0);
}

TEST(MeshStatistics, Pinched) {
  const MeshStatistics s = measure(test::pinched_tetrahedra(), true);
  EXPECT_EQ(s.non_manifold_vertices, 1u);
  EXPECT_EQ(s.components, 2u) << "a vertex does not connect";
  EXPECT_EQ(s.genus, 0);
  EXPECT_EQ(s.self_intersecting_pairs, 0u) << "a shared vertex is no intersection";
  EXPECT_TRUE(s.watertight());
  EXPECT_FALSE(s.solid());
}

TEST(MeshStatistics, Moebius) {
  const MeshStatistics s = measure(test::moebius_strip(), true);
  EXPECT_FALSE(s.orientable);
  EXPECT_FALSE(s.genus.has_value());
  EXPECT_EQ(s.inconsistent_edges, 1u);
  EXPECT_EQ(s.boundary_loops.size(), 1u);
  EXPECT_TRUE(s.manifold());
}

TEST(MeshStatistics, OneFaceTurnedOverIsOrientableStill) {
  TriangleMesh mesh = test::cube();
  std::swap(mesh.triangles[5][0], mesh.triangles[5][1]);
  const MeshStatistics s = measure(mesh, true);
  EXPECT_EQ(s.inconsistent_edges, 3u);
  EXPECT_TRUE(s.orientable);
  EXPECT_EQ(s.genus, 0);
  EXPECT_FALSE(s.watertight());
}

TEST(MeshStatistics, NonManifoldEdges) {
  for (const int pages : {3, 4, 7}) {
    const MeshStatistics s = measure(test::book(pages), true);
    EXPECT_EQ(s.non_manifold_edges, 1u);
    EXPECT_EQ(s.non_manifold_vertices, 0u) << "all faces at the edge are one fan";
    EXPECT_EQ(s.components, 1u) << "and one component";
    EXPECT_EQ(s.boundary_edges, 2u * static_cast<unsigned>(pages));
    EXPECT_FALSE(s.genus.has_value());
    EXPECT_FALSE(s.manifold());
  }
  EXPECT_EQ(measure(test::sphere_with_hole_and_fin(), true).non_manifold_edges, 1u);
  // Two books that share a page's outer corner only: two fans there.
  const TriangleMesh book = test::book();
  TriangleMesh two = test::join(book, test::translated(book, Vector3(5, 0, 0)));
  for (Triangle& t : two.triangles) std::replace(t.begin(), t.end(), Index{7}, Index{2});
  EXPECT_EQ(measure(two, false).non_manifold_vertices, 1u);
  EXPECT_EQ(measure(two, false).unreferenced_vertices, 1u);
}

TEST(MeshStatistics, DegenerateAndDuplicateFaces) {
  const MeshStatistics zero = measure(test::cube_with_zero_area_face(), true);
  EXPECT_EQ(zero.degenerate_faces, 1u);
  EXPECT_EQ(zero.self_intersecting_pairs, 2u)
      << "faces beside the split edge, which the face without area hides";
  EXPECT_TRUE(zero.watertight());
  EXPECT_FALSE(zero.solid());

  TriangleMesh mesh = test::cube();
  mesh.triangles.push_back({3, 3, 5});
  mesh.triangles.push_back({1, 1, 1});
  MeshStatistics s = measure(mesh, true);
  EXPECT_EQ(s.degenerate_faces, 2u);
  EXPECT_EQ(s.genus, 0) << "faces with a repeated corner are no part of the surface";
  EXPECT_TRUE(s.watertight());

  const auto [a, b, c] = mesh.triangles[4];
  mesh.triangles = test::cube().triangles;
  mesh.triangles.push_back({b, c, a});
  mesh.triangles.push_back({c, b, a});
  s = measure(mesh, true);
  EXPECT_EQ(s.duplicate_faces, 2u);
  EXPECT_EQ(s.non_manifold_edges, 3u);
  EXPECT_GE(*s.self_intersecting_pairs, 3u);
}

TEST(MeshStatistics, Vertices) {
  const MeshStatistics soup = measure(test::unwelded(test::cube()), true);
  EXPECT_EQ(soup.vertices, 36u);
  EXPECT_EQ(soup.duplicated_vertices, 28u);
  EXPECT_EQ(soup.components, 12u);
  EXPECT_EQ(soup.boundary_loops.size(), 12u);
  EXPECT_EQ(soup.self_intersecting_pairs, 0u) << "corners at one position are shared";

  TriangleMesh mesh = test::cube();
  mesh.vertices.insert(mesh.vertices.end(), 3, mesh.vertices[0]);
  const MeshStatistics s = measure(mesh, true);
  EXPECT_EQ(s.unreferenced_vertices, 3u);
  EXPECT_EQ(s.duplicated_vertices, 0u) << "those that no face uses do not count";
  EXPECT_TRUE(s.solid());
}

TEST(MeshStatistics, CrossingCubes) {
  // A cube pushed into a corner of another one: the cut is a hexagon, each side of it in a side of either
  // cube, and it passes a diagonal of one of the sides six times.
  const TriangleMesh mesh = test::join(test::cube(4), test::cube(4, Vector3(1, 1.5, 2.25)));
  const MeshStatistics s = measure(mesh, true);
  EXPECT_EQ(s.self_intersecting_pairs, 12u);
  EXPECT_TRUE(s.watertight());
  EXPECT_FALSE(s.solid());
}

TEST(MeshStatistics, CoordinatesThatAreNotFinite) {
  TriangleMesh mesh = test::cube();
  mesh.vertices[7].x() = std::numeric_limits<double>::quiet_NaN();
  const MeshStatistics s = measure(mesh, true);
  EXPECT_GE(s.degenerate_faces, 3u);
  EXPECT_TRUE(s.watertight());
  EXPECT_FALSE(s.solid());
}

bool mentions(const std::vector<std::string>& lines, const std::string& text) {
  return std::any_of(lines.begin(), lines.end(),
                     [&](const std::string& line) { return line.find(text) != std::string::npos; });
}

TEST(MeshStatistics, DescriptionSaysIt) {
  const std::vector<std::string> sphere = describe(measure(test::sphere_with_holes(2), true));
  EXPECT_TRUE(mentions(sphere, "Boundary loops: 2 (edges: "));
  EXPECT_TRUE(mentions(sphere, "Genus: 0"));
  EXPECT_TRUE(mentions(sphere, "Watertight: no"));
  EXPECT_TRUE(mentions(sphere, "Self-intersecting pairs of faces: 0"));
  EXPECT_TRUE(mentions(describe(measure(test::moebius_strip(), false)), "Genus: undefined"));
  EXPECT_TRUE(mentions(describe(measure(test::moebius_strip(), false)), "not counted"));
  EXPECT_TRUE(mentions(describe(measure(test::cube(3), true)), "Volume: 27"));
  for (const std::string& line : sphere) EXPECT_EQ(line.find('\n'), std::string::npos);
}

}  // namespace
}  // namespace meshcomplete
