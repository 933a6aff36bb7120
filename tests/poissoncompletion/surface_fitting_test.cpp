#include "filter_poissoncompletion/surface_fitting.h"

#include <gtest/gtest.h>

#include <cmath>

#include "common/core/patch.h"
#include "common/core/triangle_intersection.h"
#include "filter_poissoncompletion/surface_meshing.h"
#include "tests/poissoncompletion/oracles.h"
#include "tests/support/complexes.h"
#include "tests/support/meshes.h"

namespace meshcomplete {
namespace {

using test::Oracle;

TriangleMesh meshed(const Oracle& oracle, const std::vector<Vector3>& starts, double length) {
  SurfaceMeshingOptions options;
  options.criteria.edge_length = [length](const Vector3&) { return length; };
  return mesh_surface(oracle, find_surface_points(oracle, starts, 0.5, 1e-6), options);
}

// The root mean square of the function, which is a distance, over the faces.
double distance(const TriangleMesh& mesh, const Oracle& oracle) {
  double sum = 0, area = 0;
  for (const Triangle& t : mesh.triangles) {
    const Vector3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    const double own = (b - a).cross(c - a).norm();
    constexpr int steps = 6;
    for (int i = 0; i < steps; ++i)
      for (int j = 0; i + j < steps; ++j) {
        const double u = (i + 1 / 3.0) / steps, v = (j + 1 / 3.0) / steps;
        sum += own * std::pow(oracle.value(a + u * (b - a) + v * (c - a)), 2);
        area += own;
      }
  }
  return std::sqrt(sum / area);
}

TEST(SurfaceFitting, FacesOfASphereComeNearer) {
  const Oracle oracle = test::sphere_oracle();
  const TriangleMesh before = meshed(oracle, test::icosphere(1).vertices, 0.3);
  TriangleMesh after = before;
  fit_to_surface(oracle, after);
  EXPECT_EQ(after.triangles, before.triangles);
  EXPECT_LT(distance(after, oracle), 0.45 * distance(before, oracle));
  for (const Vector3& v : after.vertices) {
    EXPECT_EQ(as_stored(v), v);
    EXPECT_GT(v.norm(), 1) << "faces cut through the ball as long as their corners are on it";
  }
  EXPECT_EQ(improper_pairs(test::corners_of(after)).size(), 0u);
}

TEST(SurfaceFitting, NothingMovesInAPlane) {
  const Oracle oracle([](const Vector3& p) { return std::abs(p[2]) - 0.25; });
  TriangleMesh slab = test::cube(1, Vector3(-0.5, -0.5, -0.25));
  for (Vector3& v : slab.vertices) v[2] = v[2] > 0 ? 0.25 : -0.25;
  const TriangleMesh before = slab;
  fit_to_surface(oracle, slab);
  for (Index v = 0; v < before.vertices.size(); ++v)
    EXPECT_LT((slab.vertices[v] - before.vertices[v]).norm(), 1e-6);
}

// Two balls with less room between them than their vertices would move into it.
TEST(SurfaceFitting, SurfacesNearToEachOtherDoNotMeet) {
  const double gap = 0.004;
  const Vector3 apart(2 + gap, 0, 0);
  const Oracle oracle = test::both(test::sphere_oracle(), test::sphere_oracle(1, apart));
  std::vector<Vector3> starts = test::icosphere(1).vertices;
  starts.emplace_back(1, 0, 0);
  for (const Vector3& v : test::icosphere(1, 1, apart).vertices) starts.push_back(v);
  starts.emplace_back(1 + gap, 0, 0);
  TriangleMesh mesh = meshed(oracle, starts, 0.4);
  ASSERT_EQ(improper_pairs(test::corners_of(mesh)).size(), 0u);
  const double before = distance(mesh, oracle);
  fit_to_surface(oracle, mesh);
  EXPECT_EQ(improper_pairs(test::corners_of(mesh)).size(), 0u);
  EXPECT_LT(distance(mesh, oracle), 0.6 * before);
}

}  // namespace
}  // namespace meshcomplete
