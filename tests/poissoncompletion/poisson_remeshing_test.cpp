#include "filter_poissoncompletion/poisson_remeshing.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <string>
#include <vector>

#include "common/core/error.h"
#include "common/core/patch.h"
#include "common/core/triangle_intersection.h"
#include "tests/poissoncompletion/oracles.h"
#include "tests/support/cancelling.h"
#include "tests/support/complexes.h"
#include "tests/support/meshes.h"

namespace meshcomplete {
namespace {

/// Coarse enough to be meshed often.
PoissonRemeshingOptions coarse() {
  PoissonRemeshingOptions options;
  options.oracle.max_depth = 6;
  return options;
}

OrientedSurfaces surface_of(const TriangleMesh& mesh) { return {{mesh}, {}, {}}; }

/// How far the middles of triangles are from a sphere of radius 1, at most.
double deviation(const TriangleMesh& mesh) {
  double most = 0;
  for (const Triangle& t : mesh.triangles)
    most = std::max(
        most, std::abs(((mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]) / 3).norm() - 1));
  return most;
}

void expect_solid(const TriangleMesh& mesh, std::size_t components, long euler) {
  const test::Shape shape = test::shape_of(mesh.triangles);
  EXPECT_TRUE(shape.manifold);
  EXPECT_EQ(shape.boundary, 0u);
  EXPECT_EQ(shape.components, components);
  EXPECT_EQ(shape.euler, euler);
  EXPECT_EQ(improper_pairs(test::corners_of(mesh)).size(), 0u);
  double volume = 0;
  for (const Triangle& t : mesh.triangles)
    volume += mesh.vertices[t[0]].dot(mesh.vertices[t[1]].cross(mesh.vertices[t[2]])) / 6;
  EXPECT_GT(volume, 0) << "the outside is before the triangles";
  for (const Vector3& v : mesh.vertices) EXPECT_EQ(as_stored(v), v);
}

std::string message_of(const PoissonRemeshingOptions& options) {
  try {
    check_options(options);
  } catch (const CompletionError& error) {
    EXPECT_THROW(remesh_by_poisson(surface_of(test::icosphere(1)), options), CompletionError);
    return error.what();
  }
  return "";
}

TEST(PoissonRemeshing, AMeshWithAHoleIsClosed) {
  const PoissonRemeshingResult result =
      remesh_by_poisson(surface_of(test::sphere_with_hole(4, 0.4)), coarse());
  expect_solid(result.mesh, 1, 2);
  EXPECT_LT(deviation(result.mesh), 0.06);
  EXPECT_EQ(result.oracle.depth, 6);
  EXPECT_GT(result.oracle.samples, 0u);
  ASSERT_EQ(result.stage_seconds.size(), 3u);
  EXPECT_EQ(result.stage_seconds[0].first, "building the oracle");
}

TEST(PoissonRemeshing, PointsWithNormals) {
  OrientedSurfaces cloud;
  cloud.points = test::icosphere(4).vertices;
  for (const Vector3& p : cloud.points) cloud.normals.push_back(3 * p);
  expect_solid(remesh_by_poisson(cloud, coarse()).mesh, 1, 2);
}

TEST(PoissonRemeshing, SeveralSurfacesAndEveryComponent) {
  OrientedSurfaces both = surface_of(test::icosphere(3));
  both.meshes.push_back(test::translated(test::icosphere(3, 0.5), {2.25, 0, 0}));
  expect_solid(remesh_by_poisson(both, coarse()).mesh, 2, 4);
  expect_solid(remesh_by_poisson(surface_of(test::torus(32, 16)), coarse()).mesh, 1, 0);
}

TEST(PoissonRemeshing, EdgesOfOneLength) {
  PoissonRemeshingOptions options = coarse();
  options.adaptive = false;
  for (double length : {0.3, 0.15}) {
    options.edge_length = length;
    const TriangleMesh mesh = remesh_by_poisson(surface_of(test::icosphere(3)), options).mesh;
    EXPECT_NEAR(test::mean_edge(mesh.vertices, mesh.triangles), length, 0.25 * length);
    for (const Triangle& t : mesh.triangles)
      EXPECT_GT(test::smallest_angle(mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]), 24.9);
  }
}

TEST(PoissonRemeshing, ASmallerDistanceTakesMoreTriangles) {
  PoissonRemeshingOptions options = coarse();
  std::vector<std::size_t> counts;
  std::vector<double> errors;
  for (double distance : {0.05, 0.005}) {
    options.distance = distance;
    const TriangleMesh mesh = remesh_by_poisson(surface_of(test::icosphere(4)), options).mesh;
    counts.push_back(mesh.triangles.size());
    errors.push_back(deviation(mesh));
  }
  EXPECT_GT(counts[1], 2 * counts[0]);
  EXPECT_LT(errors[1], errors[0]);
}

TEST(PoissonRemeshing, WithoutADepthItHasEightLevels) {
  PoissonRemeshingOptions options;
  options.oracle.scale = 10;  // the more of the cube is empty, the fewer of its parts are that small
  options.edge_length = 0.4;
  options.distance = 0.1;
  EXPECT_EQ(remesh_by_poisson(surface_of(test::icosphere(2)), options).oracle.depth, 8);
}

TEST(PoissonRemeshing, OptionsOutOfRange) {
  EXPECT_EQ(message_of({}), "");
  for (double length : {0.0, -1.0, std::nan("")}) {
    PoissonRemeshingOptions o;
    o.edge_length = length;
    EXPECT_EQ(message_of(o), "EdgeLength must be positive, or 0 for one that goes with the octree.");
    o = {};
    o.distance = length;
    EXPECT_EQ(message_of(o), "Distance must be positive, or 0 for one that goes with the octree.");
  }
  for (double angle : {-0.1, 30.1, std::nan("")}) {
    PoissonRemeshingOptions o;
    o.smallest_angle = angle;
    EXPECT_EQ(message_of(o), "Angle must lie between 0 and 30 degrees.");
  }
  PoissonRemeshingOptions o;
  o.oracle.density = 0;
  EXPECT_EQ(message_of(o), "Samples must be positive.") << "those of the oracle, too";
}

TEST(PoissonRemeshing, NothingToReconstruct) {
  EXPECT_THROW(remesh_by_poisson({}, coarse()), CompletionError);
  TriangleMesh flat;
  flat.vertices = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  flat.triangles = {{0, 1, 2}};
  EXPECT_THROW(remesh_by_poisson(surface_of(flat), coarse()), CompletionError);
}

TEST(PoissonRemeshing, TheNumberOfThreadsDoesNotMatter) {
  std::vector<TriangleMesh> meshes;
  for (std::size_t threads : {1, 2}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    meshes.push_back(remesh_by_poisson(surface_of(test::rough_sphere(3, 0.1, 1)), coarse()).mesh);
  }
  EXPECT_EQ(meshes[0].vertices, meshes[1].vertices);
  EXPECT_EQ(meshes[0].triangles, meshes[1].triangles);
}

TEST(PoissonRemeshing, CanBeCancelledAtAnyStep) {
  const OrientedSurfaces surface = surface_of(test::icosphere(3));
  test::expect_cancels_at_any_step(
      [&](const Progress& progress) { remesh_by_poisson(surface, coarse(), progress); });
}

}  // namespace
}  // namespace meshcomplete
