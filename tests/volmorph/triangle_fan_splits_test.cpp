#include <gtest/gtest.h>

#include <vector>

#include "common/core/mesh_statistics.h"
#include "common/core/vertex_splits.h"
#include "tests/support/meshes.h"

namespace meshcomplete {
namespace {

std::vector<VertexSplit> splits_of(const TriangleMesh& mesh) {
  return split_overlapping_vertices(mesh, build_topology(mesh));
}

TEST(VertexSplits, are_none_where_every_vertex_has_one_fan) {
  EXPECT_TRUE(splits_of(test::icosphere(2)).empty());
  EXPECT_TRUE(splits_of(test::sphere_with_hole()).empty());
  EXPECT_TRUE(splits_of(test::moebius_strip()).empty());
  EXPECT_TRUE(splits_of(TriangleMesh()).empty());
}

TEST(VertexSplits, take_two_tetrahedra_apart) {
  TriangleMesh mesh = test::pinched_tetrahedra();
  const TriangleMesh before = mesh;
  const std::vector<VertexSplit> splits = splits_of(mesh);
  ASSERT_EQ(splits.size(), 1u);
  EXPECT_EQ(splits[0].faces.size(), 3u);
  apply_splits(mesh, splits);
  ASSERT_EQ(mesh.vertices.size(), before.vertices.size() + 1);
  EXPECT_EQ(mesh.vertices.back(), before.vertices[splits[0].vertex]);
  const MeshStatistics statistics = measure(mesh, false);
  EXPECT_TRUE(statistics.manifold() && statistics.watertight());
  EXPECT_EQ(statistics.components, 2u);
  EXPECT_TRUE(splits_of(mesh).empty());
}

// Where holes touch, the fans have ends.
TEST(VertexSplits, know_open_fans) {
  TriangleMesh mesh = test::sphere_with_touching_holes();
  const std::vector<VertexSplit> splits = splits_of(mesh);
  ASSERT_EQ(splits.size(), 1u);
  apply_splits(mesh, splits);
  EXPECT_TRUE(measure(mesh, false).manifold());
}

TEST(VertexSplits, cut_edges_of_three_faces) {
  TriangleMesh mesh = test::book(3);
  apply_splits(mesh, splits_of(mesh));
  EXPECT_EQ(mesh.vertices.size(), 9u);
  EXPECT_TRUE(measure(mesh, false).manifold());
}

TEST(VertexSplits, leave_faces_that_name_a_vertex_twice) {
  TriangleMesh mesh = test::tetrahedron();
  mesh.triangles.push_back({0, 0, 1});
  EXPECT_TRUE(splits_of(mesh).empty());
}

}  // namespace
}  // namespace meshcomplete
