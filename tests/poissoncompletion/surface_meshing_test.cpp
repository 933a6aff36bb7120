#include "filter_poissoncompletion/surface_meshing.h"

#include <gtest/gtest.h>

#include <cmath>

#include "common/core/error.h"
#include "common/core/patch.h"
#include "common/core/triangle_intersection.h"
#include "tests/poissoncompletion/oracles.h"
#include "tests/support/complexes.h"
#include "tests/support/meshes.h"

namespace meshcomplete {
namespace {

using test::Oracle;

std::vector<Vector3> few_points(const TriangleMesh& near, std::size_t every, const Oracle& oracle) {
  std::vector<Vector3> starts;
  for (std::size_t i = 0; i < near.vertices.size(); i += every) starts.push_back(1.1 * near.vertices[i]);
  return find_surface_points(oracle, starts, 1, 1e-6);
}

SurfaceMeshingOptions uniform(double length) {
  SurfaceMeshingOptions options;
  options.criteria.edge_length = [length](const Vector3&) { return length; };
  return options;
}

void expect_good(const TriangleMesh& mesh, const Oracle& oracle, double length, double deviation) {
  for (const Vector3& v : mesh.vertices) {
    EXPECT_EQ(as_stored(v), v);
    EXPECT_LT(std::abs(oracle.value(v)), 2e-3 * length);
  }
  for (const Triangle& t : mesh.triangles) {
    const Vector3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    EXPECT_GT(test::smallest_angle(a, b, c), 26.9);
    EXPECT_LT(std::abs(oracle.value((a + b + c) / 3)), deviation);
  }
  EXPECT_EQ(improper_pairs(test::corners_of(mesh)).size(), 0u);
  EXPECT_NEAR(test::mean_edge(mesh.vertices, mesh.triangles), length, 0.2 * length);
}

TEST(SurfaceMeshing, Sphere) {
  const Oracle oracle = test::sphere_oracle();
  const TriangleMesh mesh = mesh_surface(oracle, few_points(test::icosphere(1), 4, oracle), uniform(0.15));
  const test::Shape shape = test::shape_of(mesh.triangles);
  EXPECT_TRUE(shape.manifold);
  EXPECT_EQ(shape.boundary, 0u);
  EXPECT_EQ(shape.components, 1u);
  EXPECT_EQ(shape.euler, 2);
  expect_good(mesh, oracle, 0.15, 0.15 * 0.15 / 2);
  double volume = 0;
  for (const Triangle& t : mesh.triangles)
    volume += mesh.vertices[t[0]].dot(mesh.vertices[t[1]].cross(mesh.vertices[t[2]])) / 6;
  EXPECT_NEAR(volume, 4.18879, 0.1) << "the outside is before the triangles";
}

TEST(SurfaceMeshing, Torus) {
  const Oracle oracle = test::torus_oracle();
  std::vector<Vector3> starts = test::torus(12, 8, 1, 0.35).vertices;
  const TriangleMesh mesh =
      mesh_surface(oracle, find_surface_points(oracle, starts, 0.5, 1e-6), uniform(0.12));
  const test::Shape shape = test::shape_of(mesh.triangles);
  EXPECT_TRUE(shape.manifold);
  EXPECT_EQ(shape.boundary, 0u);
  EXPECT_EQ(shape.euler, 0);
  expect_good(mesh, oracle, 0.12, 0.12 * 0.12);
}

TEST(SurfaceMeshing, EveryComponentThatHasPoints) {
  const Vector3 apart(3, 0, 0);
  const Oracle oracle = test::both(test::sphere_oracle(), test::sphere_oracle(0.25, apart));
  std::vector<Vector3> starts = test::icosphere(0).vertices;
  for (const Vector3& v : test::icosphere(0, 0.3, apart).vertices) starts.push_back(v);
  const TriangleMesh mesh =
      mesh_surface(oracle, find_surface_points(oracle, starts, 0.5, 1e-6), uniform(0.2));
  const test::Shape shape = test::shape_of(mesh.triangles);
  EXPECT_TRUE(shape.manifold);
  EXPECT_EQ(shape.components, 2u);
  EXPECT_EQ(shape.euler, 4);
}

// Two balls that just overlap: coarse facets there are no manifold.
TEST(SurfaceMeshing, NarrowNeckIsManifold) {
  const Vector3 apart(1.99, 0, 0);
  const Oracle oracle = test::both(test::sphere_oracle(), test::sphere_oracle(1, apart));
  std::vector<Vector3> starts = test::icosphere(1).vertices;
  for (const Vector3& v : test::icosphere(1, 1, apart).vertices) starts.push_back(v);
  SurfaceMeshingOptions options = uniform(0.4);
  options.criteria.smallest_angle = 0;
  const TriangleMesh mesh = mesh_surface(oracle, find_surface_points(oracle, starts, 0.5, 1e-6), options);
  const test::Shape shape = test::shape_of(mesh.triangles);
  EXPECT_TRUE(shape.manifold);
  EXPECT_EQ(shape.boundary, 0u);
}

// A flat box with round ends: few triangles where it is flat.
TEST(SurfaceMeshing, AdaptsToCurvature) {
  const Oracle oracle([](const Vector3& p) {
    const double x = std::max(std::abs(p[0]) - 1, 0.0), y = std::max(std::abs(p[1]) - 1, 0.0);
    return std::sqrt(x * x + y * y + p[2] * p[2]) - 0.3;
  });
  std::vector<Vector3> starts;
  for (int i = -3; i <= 3; ++i)
    for (int j = -3; j <= 3; ++j)
      for (double z : {-0.4, 0.4}) starts.emplace_back(i / 3.0, j / 3.0, z);
  SurfaceMeshingOptions options = uniform(1);
  options.criteria.distance = 0.004;
  const TriangleMesh mesh = mesh_surface(oracle, find_surface_points(oracle, starts, 0.5, 1e-6), options);
  EXPECT_TRUE(test::shape_of(mesh.triangles).manifold);
  EXPECT_EQ(test::shape_of(mesh.triangles).euler, 2);
  double flat = 0, round = 0, flat_area = 0, round_area = 0;
  for (const Triangle& t : mesh.triangles) {
    const Vector3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    const Vector3 middle = (a + b + c) / 3;
    EXPECT_LT(std::abs(oracle.value(middle)), 0.02);
    const bool is_flat = std::max(std::abs(middle[0]), std::abs(middle[1])) < 1;
    (is_flat ? flat : round) += 1;
    (is_flat ? flat_area : round_area) += 0.5 * (b - a).cross(c - a).norm();
  }
  EXPECT_GT(round / round_area, 3 * flat / flat_area);
}

TEST(SurfaceMeshing, VerticesForTheDistanceAreLimited) {
  const Oracle oracle = test::torus_oracle();
  const std::vector<Vector3> points =
      find_surface_points(oracle, test::torus(12, 8, 1, 0.35).vertices, 0.5, 1e-6);
  SurfaceMeshingOptions options = uniform(1);
  options.criteria.distance = 1e-4;
  options.vertices_for_distance = 1000;
  const TriangleMesh mesh = mesh_surface(oracle, points, options);
  EXPECT_GE(mesh.vertices.size(), 950u);
  EXPECT_LE(mesh.vertices.size(), 1050u);
  for (const Triangle& t : mesh.triangles)
    EXPECT_GT(test::smallest_angle(mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]), 26.9);
}

TEST(SurfaceMeshing, TooManyPoints) {
  const Oracle oracle = test::sphere_oracle();
  SurfaceMeshingOptions options = uniform(0.05);
  options.max_points = 100;
  EXPECT_THROW(mesh_surface(oracle, few_points(test::icosphere(1), 4, oracle), options), CompletionError);
}

TEST(SurfaceMeshing, NoPoint) {
  EXPECT_THROW(mesh_surface(test::sphere_oracle(), {}, uniform(0.1)), CompletionError);
}

TEST(SurfacePoints, AreOnTheSurfaceWithinReach) {
  const Oracle oracle = test::sphere_oracle();
  const std::vector<Vector3> found =
      find_surface_points(oracle, {Vector3(0, 0, 0.1), Vector3(2, 2, 2), Vector3(0.9, 0, 0)}, 1, 1e-9);
  ASSERT_EQ(found.size(), 2u);
  EXPECT_LT((found[0] - Vector3(0, 0, 1)).norm(), 1e-6);
  EXPECT_LT((found[1] - Vector3(1, 0, 0)).norm(), 1e-6);
}

}  // namespace
}  // namespace meshcomplete
