#include "common/core/mesh_topology.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <vector>

#include "common/core/error.h"
#include "tests/support/meshes.h"

namespace meshcomplete {
namespace {

bool repeats_a_corner(const Triangle& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; }

/// Everything that the header promises, by looking at every edge on its own.
void expect_right(const TriangleMesh& mesh) {
  const MeshTopology topology = build_topology(mesh);
  std::map<std::pair<Index, Index>, std::vector<Index>> at_edge;
  std::vector<Index> degenerate, boundary, non_manifold;
  for (Index f = 0; f < mesh.triangles.size(); ++f) {
    const Triangle& t = mesh.triangles[f];
    if (repeats_a_corner(t)) {
      degenerate.push_back(f);
      continue;
    }
    for (Index k = 0; k < 3; ++k) at_edge[std::minmax(t[k], t[(k + 1) % 3])].push_back(3 * f + k);
  }
  ASSERT_EQ(topology.opposite.size(), 3 * mesh.triangles.size());
  for (const auto& [edge, half_edges] : at_edge)
    for (std::size_t i = 0; i < half_edges.size(); ++i) {
      const Index opposite = topology.opposite[half_edges[i]];
      if (half_edges.size() == 1) {
        EXPECT_EQ(opposite, MeshTopology::boundary);
        boundary.push_back(half_edges[i]);
      } else if (half_edges.size() == 2) {
        EXPECT_EQ(opposite, half_edges[1 - i]);
      } else {
        EXPECT_EQ(opposite, MeshTopology::non_manifold);
        non_manifold.push_back(half_edges[i]);
      }
    }
  for (Index f : degenerate)
    for (Index h = 3 * f; h < 3 * f + 3; ++h) EXPECT_GE(topology.opposite[h], topology.opposite.size());
  std::sort(boundary.begin(), boundary.end());
  std::sort(non_manifold.begin(), non_manifold.end());
  EXPECT_EQ(topology.degenerate_faces, degenerate);
  EXPECT_EQ(topology.boundary_half_edges, boundary);
  EXPECT_EQ(topology.non_manifold_half_edges, non_manifold);
}

TEST(MeshTopology, AgreesWithBruteForce) {
  for (const TriangleMesh& mesh :
       {test::cube(), test::torus(8, 5), test::sphere_with_holes(6), test::flat_grid(5, 3),
        test::moebius_strip(), test::isolated_triangle(), test::pinched_tetrahedra(), test::book(3),
        test::book(5), test::sphere_with_hole_and_fin(), test::unwelded(test::cube()),
        test::rough_sphere_with_ragged_holes(3, 4, 5), test::shuffled(test::sphere_with_hole(), 3)})
    expect_right(mesh);
}

// Enough vertices for several threads.
TEST(MeshTopology, AgreesWithBruteForceOnAMeshForThreads) {
  expect_right(test::shuffled(test::sphere_with_hole(5, 0.2), 7));
}

TEST(MeshTopology, FacesTurnedOverStayNeighbours) {
  TriangleMesh mesh = test::cube();
  std::swap(mesh.triangles[4][0], mesh.triangles[4][1]);
  expect_right(mesh);
  const MeshTopology topology = build_topology(mesh);
  EXPECT_TRUE(topology.boundary_half_edges.empty());
  for (Index h = 12; h < 15; ++h) {
    const auto from = [&](Index half_edge) { return mesh.triangles[half_edge / 3][half_edge % 3]; };
    EXPECT_EQ(from(h), from(topology.opposite[h])) << "both walk the edge the same way";
  }
}

TEST(MeshTopology, FacesWithARepeatedCornerAreLeftOut) {
  TriangleMesh mesh = test::cube();
  mesh.triangles.insert(mesh.triangles.begin() + 3, {2, 2, 5});
  mesh.triangles.push_back({1, 3, 1});
  mesh.triangles.push_back({4, 4, 4});
  expect_right(mesh);
  EXPECT_TRUE(build_topology(mesh).boundary_half_edges.empty()) << "the cube is still closed";
}

TEST(MeshTopology, EmptyMesh) {
  expect_right(TriangleMesh());
  expect_right(TriangleMesh{{Vector3(0, 0, 0)}, {}});
}

TEST(MeshTopology, CornerOutOfRange) {
  TriangleMesh mesh = test::cube();
  mesh.triangles[5][2] = 8;
  try {
    build_topology(mesh);
    FAIL() << "accepted a corner that does not exist";
  } catch (const CompletionError& error) {
    EXPECT_EQ(error.stage(), "reading the mesh");
    EXPECT_NE(std::string(error.what()).find("vertex 8"), std::string::npos) << error.what();
  }
}

TEST(MeshTopology, CanBeCancelled) {
  EXPECT_THROW(build_topology(test::cube(), Progress([](double, const std::string&) { return false; })),
               Cancelled);
}

}  // namespace
}  // namespace meshcomplete
