#include "common/core/surface_sampling.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <limits>
#include <vector>

#include "common/core/error.h"
#include "tests/support/meshes.h"

namespace meshcomplete {
namespace {

SamplingOptions cubes(double size) {
  SamplingOptions options;
  options.cube_size = [size](const Vector3&) { return size; };
  options.min_depth = 1;
  options.max_depth = 12;
  return options;
}

Vector3 sum_of_normals(const std::vector<OrientedSample>& samples) {
  Vector3 sum = Vector3::Zero();
  for (const OrientedSample& s : samples) sum += s.area_normal;
  return sum;
}

double area_of(const std::vector<OrientedSample>& samples) {
  double area = 0;
  for (const OrientedSample& s : samples) area += s.area_normal.norm();
  return area;
}

TEST(SurfaceSampling, TheAreaIsThere) {
  const TriangleMesh mesh = test::cube(2);
  const Lattice lattice = root_cube({&mesh}, {}, 2.2);
  for (double size : {0.5, 0.1, 0.02}) {
    const auto samples = sample_surface(mesh, lattice, cubes(size));
    EXPECT_NEAR(area_of(samples), 24, 0.1) << "cubes of " << size;
    EXPECT_LT(sum_of_normals(samples).norm(), 0.15);
    const double side = lattice.side() / static_cast<double>(1 << samples.front().depth);
    EXPECT_LE(side, size);
    EXPECT_GT(2 * side, size) << "no deeper than needed";
  }
}

// Of every hundredth part of the area a hundredth of the samples, whatever the triangles.
TEST(SurfaceSampling, SamplesAreSpreadEvenly) {
  for (const TriangleMesh& mesh : {test::uv_sphere(40, 200), test::cube(1, {-0.5, -0.5, -0.5})}) {
    const Lattice lattice = root_cube({&mesh}, {}, 2.2);
    const auto samples = sample_surface(mesh, lattice, cubes(0.02));
    std::vector<double> counts(8, 0), areas(8, 0);
    const auto octant = [](const Vector3& p) { return (p[0] > 0) + 2 * (p[1] > 0) + 4 * (p[2] > 0); };
    for (const OrientedSample& s : samples) {
      ++counts[octant(s.position)];
      areas[octant(s.position)] += s.area_normal.norm();
    }
    for (double count : counts)
      EXPECT_NEAR(count, static_cast<double>(samples.size()) / 8, 0.01 * static_cast<double>(samples.size()));
    for (double area : areas) EXPECT_NEAR(area, area_of(samples) / 8, 0.01 * area_of(samples));
  }
}

TEST(SurfaceSampling, DenserWhereTheCubesAreSmall) {
  const TriangleMesh mesh = test::cube(1);
  const Lattice lattice = root_cube({&mesh}, {}, 2.2);
  SamplingOptions options = cubes(0);
  options.cube_size = [](const Vector3& p) { return 0.01 + 0.2 * p.norm(); };
  const auto samples = sample_surface(mesh, lattice, options);
  std::size_t fine = 0;
  for (const OrientedSample& s : samples) {
    const double side = lattice.side() / static_cast<double>(1 << s.depth);
    EXPECT_LT(side, 0.015 + 0.3 * s.position.norm());
    EXPECT_NEAR(s.area_normal.norm(), side * side / options.density, 1e-12);
    fine += s.position.norm() < 0.1;
  }
  EXPECT_GT(fine, samples.size() / 20);
  EXPECT_NEAR(area_of(samples), 6, 0.15);
}

// A needle is as many samples as it has area, and no endless work.
TEST(SurfaceSampling, NeedlesAndBrokenTriangles) {
  TriangleMesh mesh = test::cube(1);
  const std::size_t whole = sample_surface(mesh, root_cube({&mesh}, {}, 2.2), cubes(0.05)).size();
  const Index first = static_cast<Index>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), {{0, 0, 0.5}, {1, 1, 0.5}, {1, 1, 0.5 + 1e-9}});
  mesh.vertices.push_back({std::numeric_limits<double>::quiet_NaN(), 0, 0});
  mesh.triangles.push_back({first, first + 1, first + 2});
  mesh.triangles.push_back({first, first + 1, first + 1});
  mesh.triangles.push_back({first, first + 1, first + 3});
  EXPECT_EQ(sample_surface(mesh, root_cube({&mesh}, {}, 2.2), cubes(0.05)).size(), whole);
}

// Two triangles are one task of one thread; it has to notice all the same.
TEST(SurfaceSampling, TooManySamplesAndCancelling) {
  const TriangleMesh mesh = test::flat_grid(1, 1);
  SamplingOptions options = cubes(1e-9);
  options.max_depth = 16;
  options.max_samples = 100000;
  EXPECT_THROW(sample_surface(mesh, root_cube({&mesh}, {}, 2.2), options), CompletionError);
  options.max_samples = 40000000;
  int calls = 0;
  const Progress progress([&](double, const std::string&) { return ++calls < 2; });
  EXPECT_THROW(sample_surface(mesh, root_cube({&mesh}, {}, 2.2), options, progress), Cancelled);
}

// A dozen points at every position leave no area to any of them.
TEST(SurfaceSampling, PointsWithoutAreaAreNoSamples) {
  std::vector<Vector3> points, normals(36, Vector3(0, 0, 1));
  for (int i = 0; i < 36; ++i) points.emplace_back(i / 12, i / 24, 0);
  EXPECT_TRUE(sample_points(points, normals, root_cube({}, points, 2.2), cubes(0.1)).empty());
}

TEST(SurfaceSampling, TheNumberOfThreadsDoesNotMatter) {
  const TriangleMesh mesh = test::icosphere(5);
  const Lattice lattice = root_cube({&mesh}, {}, 2.2);
  std::vector<std::vector<OrientedSample>> results;
  for (int threads : {1, 3}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    results.push_back(sample_surface(mesh, lattice, cubes(0.03)));
  }
  ASSERT_EQ(results[0].size(), results[1].size());
  for (std::size_t i = 0; i < results[0].size(); ++i)
    EXPECT_EQ(results[0][i].position, results[1][i].position);
}

// Twice as many points on one half do not make its area larger.
TEST(SurfaceSampling, PointSetsGetTheAreaThatTheyCover) {
  std::vector<Vector3> points, normals;
  for (int i = 0; i < 6000; ++i) {
    const double z = 1 - 2 * (i + 0.5) / 6000, turn = 2.399963 * i;
    if (z < 0 && i % 4 != 0) continue;
    points.emplace_back(std::sqrt(1 - z * z) * std::cos(turn), std::sqrt(1 - z * z) * std::sin(turn), z);
    normals.push_back(3 * points.back());
  }
  points.push_back({std::numeric_limits<double>::infinity(), 0, 0});
  normals.push_back({1, 0, 0});
  points.push_back({0, 0, 1.1});
  normals.push_back({0, 0, 0});
  const auto samples = sample_points(points, normals, root_cube({}, points, 2.2), cubes(0.1));
  EXPECT_EQ(samples.size() + 2, points.size());
  double upper = 0, lower = 0;
  for (const OrientedSample& s : samples) (s.position[2] > 0 ? upper : lower) += s.area_normal.norm();
  EXPECT_NEAR(upper / (2 * 3.1416), 1, 0.1);
  EXPECT_NEAR(lower / (2 * 3.1416), 1, 0.1);
}

// 10000 points on the unit sphere have an area of 0.00126 each: 2 of them leave cubes of 0.05, 9 of 0.106.
TEST(SurfaceSampling, SparsePointsAskForCoarseCubesAndSpreadNormalsFurther) {
  std::vector<Vector3> points;
  for (int i = 0; i < 10000; ++i) {
    const double z = 1 - 2 * (i + 0.5) / 10000, turn = 2.399963 * i;
    points.emplace_back(std::sqrt(1 - z * z) * std::cos(turn), std::sqrt(1 - z * z) * std::sin(turn), z);
  }
  const Lattice root(Vector3::Constant(-2), 4);
  const auto all = [&](double size, int depth, int coarsening) {
    for (const OrientedSample& s : sample_points(points, points, root, cubes(size)))
      if (s.depth != depth || s.coarsening != coarsening) return false;
    return true;
  };
  EXPECT_TRUE(all(0.2, 5, 0));   // cubes of 0.125
  EXPECT_TRUE(all(0.07, 6, 0));  // of 0.0625: the next depth at which they are no larger than 0.106
  EXPECT_TRUE(all(0.01, 7, 1));  // of 0.031, no larger than 0.05
}

TEST(SurfaceSampling, TheRootHoldsEverythingInItsMiddle) {
  const TriangleMesh mesh = test::cube(2, {10, 0, 0});
  const Lattice lattice = root_cube({&mesh}, {{11, 1, 7}}, 1.5);
  EXPECT_DOUBLE_EQ(lattice.side(), 1.5 * 7);
  EXPECT_NEAR(
      (lattice.position({Lattice::steps / 2, Lattice::steps / 2, Lattice::steps / 2}) - Vector3(11, 1, 3.5))
          .norm(),
      0, 1e-9);
  EXPECT_THROW(root_cube({}, {{1, 1, 1}}, 2), CompletionError);
}

}  // namespace
}  // namespace meshcomplete
