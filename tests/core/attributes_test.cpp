#include "common/core/attributes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <vector>

#include "common/core/error.h"
#include "tests/support/meshes.h"
#include "tests/support/patches.h"

namespace meshcomplete {
namespace {

using test::fan_patch;
using test::loops_of;

/// A flat grid, and a patch that fills the square hole in its middle.
test::CutOut grid_with_square_cut_out(int size = 12) {
  const TriangleMesh grid = test::flat_grid(size, size);
  return test::cut_out(grid, [&](Index f) {
    Vector3 centre = Vector3::Zero();
    for (Index v : grid.triangles[f]) centre += grid.vertices[v] / 3;
    return (centre - Vector3(size / 2.0, size / 2.0, 0)).cwiseAbs().maxCoeff() < size / 4.0;
  });
}

TEST(Attributes, ConstantsStay) {
  const test::CutOut cut = grid_with_square_cut_out();
  const Eigen::MatrixXd values =
      interpolate_attributes(cut.mesh, cut.patch, 3, [](Index) { return Eigen::RowVector3d(0.3, -7, 1e6); });
  ASSERT_EQ(values.rows(), static_cast<Eigen::Index>(cut.patch.vertices.size()));
  for (Eigen::Index v = 0; v < values.rows(); ++v) EXPECT_EQ(values.row(v), Eigen::RowVector3d(0.3, -7, 1e6));
}

TEST(Attributes, LinearFunctionsAreReproducedOnAFlatGrid) {
  const test::CutOut cut = grid_with_square_cut_out();
  const auto linear = [](const Vector3& p) { return Eigen::RowVector2d(3 * p.x() - p.y() + 2, p.y()); };
  const Eigen::MatrixXd values = interpolate_attributes(
      cut.mesh, cut.patch, 2, [&](Index v) -> Eigen::RowVectorXd { return linear(cut.mesh.vertices[v]); });
  ASSERT_GT(values.rows(), 20);
  // Weights are bounded away from zero (the diagonals of squares have zero), so that it is not exact.
  for (Eigen::Index v = 0; v < values.rows(); ++v)
    EXPECT_NEAR((values.row(v) - linear(cut.patch.vertices[static_cast<std::size_t>(v)])).norm(), 0, 0.02);
}

TEST(Attributes, ValuesStayWithinTheRange) {
  const TriangleMesh sphere = test::rough_sphere(4, 0.1, 4);
  const test::CutOut cut =
      test::cut_out(sphere, [&](Index f) { return sphere.vertices[sphere.triangles[f][0]].z() > 0.3; });
  const auto rim = [](Index v) { return Eigen::RowVectorXd::Constant(1, v % 2 ? 1.0 : 0.0); };
  const Eigen::MatrixXd values = interpolate_attributes(cut.mesh, cut.patch, 1, rim);
  EXPECT_GE(values.minCoeff(), 0.0);
  EXPECT_LE(values.maxCoeff(), 1.0);
  EXPECT_GT(values.maxCoeff() - values.minCoeff(), 0.1) << "not simply a mean";
}

TEST(Attributes, EveryHoleHasItsOwnRim) {
  const TriangleMesh mesh = test::sphere_with_holes(2);
  const std::vector<BoundaryLoop> loops = loops_of(mesh);
  Patch patch = fan_patch(mesh, loops[0]);
  append(patch, fan_patch(mesh, loops[1]));
  std::map<Index, int> asked;
  const Eigen::MatrixXd values = interpolate_attributes(mesh, patch, 1, [&](Index v) {
    ++asked[v];
    return Eigen::RowVectorXd::Constant(1, mesh.vertices[v].x() > 0 ? 1.0 : 0.0);
  });
  ASSERT_EQ(values.rows(), 2);
  const Eigen::Index right = patch.vertices[0].x() > 0 ? 0 : 1;
  EXPECT_EQ(values(right, 0), 1.0);
  EXPECT_EQ(values(1 - right, 0), 0.0);
  EXPECT_EQ(asked.size(), loops[0].vertices.size() + loops[1].vertices.size());
  for (const auto& [vertex, times] : asked) EXPECT_EQ(times, 1) << "vertex " << vertex;
}

TEST(Attributes, OneBadValueDoesNotSpoilThePatch) {
  const test::CutOut cut = grid_with_square_cut_out();
  const Index bad = loops_of(cut.mesh)[1].vertices[0];
  const Eigen::MatrixXd values = interpolate_attributes(cut.mesh, cut.patch, 1, [&](Index v) {
    return Eigen::RowVectorXd::Constant(1, v == bad ? std::numeric_limits<double>::quiet_NaN() : 2.0);
  });
  for (Eigen::Index v = 0; v < values.rows(); ++v) EXPECT_EQ(values(v, 0), 2.0);
}

TEST(Attributes, NothingToInterpolate) {
  const TriangleMesh mesh = test::sphere_with_hole();
  const auto rim = [](Index) { return Eigen::RowVectorXd(Eigen::RowVectorXd::Ones(4)); };
  const Eigen::MatrixXd values =
      interpolate_attributes(mesh, test::fan_from_corner(mesh, loops_of(mesh)[0]), 4, rim);
  EXPECT_EQ(values.rows(), 0);
  EXPECT_EQ(values.cols(), 4);
  EXPECT_EQ(interpolate_attributes(mesh, fan_patch(mesh, loops_of(mesh)[0]), 0,
                                   [](Index) { return Eigen::RowVectorXd(0); })
                .rows(),
            1);
}

TEST(Attributes, RefusesAPieceWithoutRim) {
  const TriangleMesh mesh = test::cube();
  Patch bubble;
  bubble.input_vertices = 8;
  bubble.vertices = test::tetrahedron().vertices;
  for (const auto& [a, b, c] : test::tetrahedron().triangles)
    bubble.triangles.push_back({a + 8, b + 8, c + 8});
  EXPECT_THROW(interpolate_attributes(mesh, bubble, 1, [](Index) { return Eigen::RowVectorXd::Zero(1); }),
               CompletionError);
}

TEST(Attributes, NormalsOfASphere) {
  const TriangleMesh sphere = test::icosphere(4);
  const test::CutOut cut =
      test::cut_out(sphere, [&](Index f) { return sphere.vertices[sphere.triangles[f][0]].z() > 0.3; });
  const std::vector<Vector3> normals = patch_vertex_normals(cut.mesh, cut.patch);
  ASSERT_EQ(normals.size(), cut.patch.vertices.size());
  for (std::size_t v = 0; v < normals.size(); ++v) {
    EXPECT_NEAR(normals[v].norm(), 1, 1e-12);
    EXPECT_GT(normals[v].dot(cut.patch.vertices[v].normalized()), 0.9999);
  }
}

TEST(Attributes, NormalsDoNotDependOnHowAFaceIsSplit) {
  // At the corner of a cube the three sides count alike, though some have two faces there and some one.
  TriangleMesh cube = test::cube(2, Vector3(-1, -1, -1));
  const test::CutOut all = test::cut_out(cube, [](Index) { return true; });
  const std::vector<Vector3> normals = patch_vertex_normals(all.mesh, all.patch);
  ASSERT_EQ(normals.size(), 8u);
  for (std::size_t v = 0; v < 8; ++v)
    EXPECT_LT((normals[v] - all.patch.vertices[v].normalized()).norm(), 1e-12);
}

TEST(Attributes, NormalsAreUnitVectorsWhateverTheFaces) {
  Patch folded;  // two faces that cancel out, and one without area
  folded.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {5, 5, 5}, {6, 6, 6}, {7, 7, 7}};
  folded.triangles = {{0, 1, 2}, {0, 2, 1}, {3, 4, 5}};
  for (const Vector3& n : patch_vertex_normals(TriangleMesh(), folded)) EXPECT_NEAR(n.norm(), 1, 1e-12);
}

}  // namespace
}  // namespace meshcomplete
