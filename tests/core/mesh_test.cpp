#include "common/core/mesh.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/meshes.h"

namespace meshcomplete {
namespace {

TEST(Mesh, DiagonalOfTheBoundingBox) {
  EXPECT_DOUBLE_EQ(bounding_box_diagonal(test::cube(2, Vector3(-7, 3, 5))), 2 * std::sqrt(3.0));
  EXPECT_DOUBLE_EQ(bounding_box_diagonal(test::flat_grid(3, 4)), 5);
}

// A stray vertex must not decide how large the mesh is.
TEST(Mesh, UnusedVerticesDoNotCount) {
  TriangleMesh mesh = test::isolated_triangle();
  const double before = bounding_box_diagonal(mesh);
  mesh.vertices.emplace_back(1e6, 0, 0);
  EXPECT_EQ(bounding_box_diagonal(mesh), before);
}

TEST(Mesh, NothingHasNoSize) {
  EXPECT_EQ(bounding_box_diagonal(TriangleMesh()), 0);
  EXPECT_EQ(bounding_box_diagonal(TriangleMesh{{Vector3(1, 2, 3), Vector3(4, 5, 6)}, {}}), 0);
}

}  // namespace
}  // namespace meshcomplete
