#include <gtest/gtest.h>

#include <cmath>

#include "common/core/error.h"
#include "common/core/mesh_statistics.h"
#include "filter_poissoncompletion/poisson_remeshing.h"
#include "tests/support/meshes.h"

namespace meshcomplete {
namespace {

OrientedSurfaces ball() { return {{test::icosphere(5)}, {}, {}}; }

PoissonRemeshingOptions shallow() {
  PoissonRemeshingOptions options;
  options.oracle.max_depth = 6;
  options.oracle.poisson.min_depth = 4;
  options.oracle.scale = 1.5;
  return options;
}

// Of the finest cubes.
double cube(const PoissonRemeshingOptions& options) { return 2 * options.oracle.scale / 64; }

double farthest(const TriangleMesh& mesh) {
  double most = 0;
  for (const Triangle& t : mesh.triangles) {
    const Vector3 middle = (mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]) / 3;
    most = std::max(most, std::abs(middle.norm() - 1));
  }
  return most;
}

TEST(PoissonRemeshingCriteria, FacesAreAShareOfMarchingCubes) {
  PoissonRemeshingOptions options = shallow();
  const TriangleMesh third = remesh_by_poisson(ball(), options).mesh;
  EXPECT_TRUE(measure(third, true).solid());
  // Marching cubes have a vertex on each edge that the surface crosses: 1.5 for each square of a cube's side
  // in its area, since all slopes occur evenly; and a closed mesh has twice as many faces.
  const double marching_cubes = 2 * 1.5 * 4 * 3.14159 / (cube(options) * cube(options));
  EXPECT_NEAR(static_cast<double>(third.triangles.size()), 0.3 * marching_cubes, 0.03 * marching_cubes);
  options.share = 0.15;
  const TriangleMesh fewer = remesh_by_poisson(ball(), options).mesh;
  EXPECT_TRUE(measure(fewer, true).solid());
  EXPECT_NEAR(static_cast<double>(fewer.triangles.size()) / static_cast<double>(third.triangles.size()), 0.5,
              0.1);
}

TEST(PoissonRemeshingCriteria, ADistanceThatIsGivenIsKept) {
  PoissonRemeshingOptions options = shallow();
  options.distance = 0.4 * cube(options);
  const TriangleMesh coarse = remesh_by_poisson(ball(), options).mesh;
  options.distance = 0.1 * cube(options);
  const TriangleMesh fine = remesh_by_poisson(ball(), options).mesh;
  EXPECT_GT(fine.triangles.size(), 2 * coarse.triangles.size());
  EXPECT_LT(farthest(fine), farthest(coarse));
}

TEST(PoissonRemeshingCriteria, EdgesOfOneLength) {
  PoissonRemeshingOptions options = shallow();
  options.adaptive = false;
  const TriangleMesh mesh = remesh_by_poisson(ball(), options).mesh;
  EXPECT_TRUE(measure(mesh, true).solid());
  double sum = 0, longest = 0;
  for (const Triangle& t : mesh.triangles)
    for (int k = 0; k < 3; ++k) {
      const double length = (mesh.vertices[t[k]] - mesh.vertices[t[(k + 1) % 3]]).norm();
      sum += length;
      longest = std::max(longest, length);
    }
  EXPECT_NEAR(sum / (3.0 * static_cast<double>(mesh.triangles.size())), 1.6 * cube(options),
              0.3 * cube(options));
  EXPECT_LT(longest, 2.5 * cube(options));
}

TEST(PoissonRemeshingCriteria, FittedFacesAreNearer) {
  PoissonRemeshingOptions options = shallow();
  options.share = 0.05;
  const double fitted = farthest(remesh_by_poisson(ball(), options).mesh);
  options.fitted = false;
  EXPECT_LT(fitted, 0.7 * farthest(remesh_by_poisson(ball(), options).mesh));
}

TEST(PoissonRemeshingCriteria, ShareOutOfRange) {
  PoissonRemeshingOptions options = shallow();
  for (double share : {0.0, -1.0, 11.0}) {
    options.share = share;
    EXPECT_THROW(remesh_by_poisson(ball(), options), CompletionError);
  }
}

}  // namespace
}  // namespace meshcomplete
