#include "filter_atomicvolumes/offending_faces.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "tests/support/volumes.h"

namespace meshcomplete {
namespace {

using test::PlacedMesh;

std::vector<Index> offending(const PlacedMesh& placed, int depth) {
  DecompositionOptions options;
  options.max_depth = depth;
  return offending_faces(placed.lattice_mesh, decompose(placed.lattice_mesh, options));
}

TEST(OffendingFaces, NoneWhereAllCubesAreTrivial) {
  EXPECT_TRUE(offending(PlacedMesh(test::sphere_with_hole(2, 0.6), 1), Lattice::depth).empty());
}

TEST(OffendingFaces, AreAtTheBoundary) {
  const PlacedMesh placed(test::sphere_with_hole(3, 0.6), 1);
  std::vector<char> on_boundary(placed.mesh.vertices.size(), 0);
  for (Index h : placed.topology.boundary_half_edges) on_boundary[placed.lattice_mesh.origin(h)] = 1;
  const std::vector<Index> faces = offending(placed, 5);
  EXPECT_FALSE(faces.empty());
  EXPECT_TRUE(std::is_sorted(faces.begin(), faces.end()));
  for (Index t : faces) {
    const Triangle& corners = placed.mesh.triangles[t];
    EXPECT_TRUE(std::any_of(corners.begin(), corners.end(), [&](Index v) { return on_boundary[v]; }));
  }
}

// One short edge in a rim: the octree goes deep there and nowhere else. Without its faces it need not.
TEST(OffendingFaces, WithoutThemTheCubesAreTrivial) {
  TriangleMesh mesh = test::sphere_with_hole(2, 0.6);
  {
    const MeshTopology topology = build_topology(mesh);
    const Index h = topology.boundary_half_edges.front();
    const Index from = mesh.triangles[h / 3][h % 3], to = mesh.triangles[h / 3][(h % 3 + 1) % 3];
    const Vector3 near = mesh.vertices[from] + 1e-4 * (mesh.vertices[to] - mesh.vertices[from]);
    for (int k = 0; k < 3; ++k) mesh.vertices[to][k] = static_cast<float>(near[k]);
  }
  constexpr int depth = 9;
  std::size_t before = 0;
  for (int round = 0; round < 8; ++round) {
    const std::vector<Index> faces = offending(PlacedMesh(mesh, 2), depth);
    if (round == 0) before = faces.size();
    if (faces.empty()) break;
    mesh =
        test::without_faces(mesh, [&](Index f) { return std::binary_search(faces.begin(), faces.end(), f); });
  }
  EXPECT_GT(before, 0u);
  EXPECT_LT(before, 12u);
  EXPECT_TRUE(offending(PlacedMesh(mesh, 2), depth).empty());
}

}  // namespace
}  // namespace meshcomplete
