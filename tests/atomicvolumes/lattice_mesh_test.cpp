#include "filter_atomicvolumes/lattice_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

#include "tests/support/volumes.h"

namespace meshcomplete {
namespace {

using test::PlacedMesh;

std::vector<Index> found(const LatticeMesh& mesh, const LatticeBox& box) {
  std::vector<Index> triangles;
  mesh.triangles_in(box, [&](Index t, const LatticeTriangle& corners) {
    EXPECT_EQ(corners, mesh.triangle(t));
    triangles.push_back(t);
    return true;
  });
  std::sort(triangles.begin(), triangles.end());
  return triangles;
}

TEST(LatticeMesh, FindsTheTrianglesThatMeetABox) {
  for (const TriangleMesh& mesh :
       {test::rough_sphere_with_ragged_holes(3, 5, 5), test::shuffled(test::torus(30, 20), 4),
        test::translated(test::sphere_with_hole(), Vector3(1000, -2000, 500))}) {
    const PlacedMesh placed(mesh, 5);
    std::mt19937_64 random(8);
    std::size_t meeting = 0;
    for (int i = 0; i < 300; ++i) {
      // Cubes of the octree, of every size, at vertices of the mesh.
      const LatticePoint p = placed.lattice_mesh.vertex(static_cast<Index>(random() % mesh.vertices.size()));
      const std::int64_t side = Lattice::cell << (random() % 30);
      LatticeBox box;
      for (std::size_t k = 0; k < 3; ++k) {
        box.low[k] = std::max<std::int64_t>(
            0, p[k] - p[k] % side + side * (static_cast<std::int64_t>(random() % 3) - 1));
        box.high[k] = box.low[k] + side;
      }
      std::vector<Index> expected;
      for (Index t = 0; t < mesh.triangles.size(); ++t)
        if (meets(placed.lattice_mesh.triangle(t), box)) expected.push_back(t);
      ASSERT_EQ(found(placed.lattice_mesh, box), expected);
      meeting += expected.size();
    }
    EXPECT_GT(meeting, 1000u);
  }
}

TEST(LatticeMesh, StopsWhenToldToAndLeavesOutRepeatedCorners) {
  TriangleMesh mesh = test::icosphere(1);
  mesh.triangles.push_back({3, 3, 4});
  const PlacedMesh placed(mesh, 5);
  const LatticeBox all{{0, 0, 0}, {Lattice::steps, Lattice::steps, Lattice::steps}};
  EXPECT_EQ(found(placed.lattice_mesh, all).size(), mesh.triangles.size() - 1);
  int visits = 0;
  placed.lattice_mesh.triangles_in(all, [&](Index, const LatticeTriangle&) { return ++visits < 5; });
  EXPECT_EQ(visits, 5);
}

TEST(LatticeMesh, HalfEdgesGoFromCornerToCorner) {
  const PlacedMesh placed(test::icosphere(0), 5);
  for (Index h = 0; h < 60; ++h) {
    EXPECT_EQ(placed.lattice_mesh.origin(h), placed.mesh.triangles[h / 3][h % 3]);
    EXPECT_EQ(placed.lattice_mesh.target(h), placed.mesh.triangles[h / 3][(h + 1) % 3 == 0 ? 0 : h % 3 + 1]);
  }
}

}  // namespace
}  // namespace meshcomplete
