#include "common/core/completion_oracle.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "common/core/error.h"
#include "tests/support/cancelling.h"
#include "tests/support/meshes.h"

namespace meshcomplete {
namespace {

/// The oracle of a mesh all of whose holes are to be closed.
PoissonOracle oracle_of(const TriangleMesh& mesh, const PoissonOracleOptions& options = {},
                        const OrientedSurfaces& guides = {}, const HoleSelectionOptions& holes = {}) {
  const OpenMesh open = find_holes(mesh, {}, holes);
  return make_completion_oracle(mesh, open, InputNeighbourhood(mesh), guides, options);
}

/// Where a way from inside leaves the surface.
std::optional<double> height(const ImplicitFunction& field, const Vector3& way) {
  const auto at = crossing(field, 0.3 * way, 1.6 * way, 1e-9);
  return at ? std::optional<double>(at->norm()) : std::nullopt;
}

std::string message_of(const PoissonOracleOptions& options) {
  try {
    check_options(options);
  } catch (const CompletionError& error) {
    return error.what();
  }
  return "";
}

TEST(CompletionOracle, GoesThroughTheMeshAndRoundOverTheHole) {
  const PoissonOracle oracle = oracle_of(test::sphere_with_hole(4, 0.5));
  EXPECT_LT(oracle.field.value({0, 0, 0}), 0);
  EXPECT_GT(oracle.field.value({0, 0, 1.5}), 0);
  for (const Vector3& way : {Vector3(1, 0, 0), Vector3(0, -1, 0), Vector3(0, 0.6, -0.8)})
    EXPECT_NEAR(height(oracle.field, way).value_or(0), 1, 0.02);
  const double flat = std::cos(0.5);
  const double lid = height(oracle.field, {0, 0, 1}).value_or(0);
  EXPECT_GT(lid, flat + 0.01) << "a flat lid would not go on as the mesh does";
  EXPECT_LT(lid, 1.02);
}

TEST(CompletionOracle, CubesAreAsLargeAsTheEdgesAtTheRimAndGrowAwayFromIt) {
  std::vector<double> at_rim;
  for (int subdivisions : {3, 4}) {
    const PoissonOracle oracle = oracle_of(test::sphere_with_hole(subdivisions, 0.5));
    const double edge = 1.1 / std::exp2(subdivisions);  // of an icosphere, nearly
    const double near = oracle.field.leaf_size({std::sin(0.55), 0, std::cos(0.55)});
    EXPECT_LT(near, 1.2 * edge);
    EXPECT_GT(near, 0.3 * edge);
    at_rim.push_back(near);
    const double far = oracle.field.leaf_size({0, 0, -1});
    EXPECT_GE(far, near);
    EXPECT_LT(far, 0.5) << "a cube for every eighth of the distance";
  }
  EXPECT_LT(at_rim[1], at_rim[0]);
}

TEST(CompletionOracle, WhatIsNotToBeClosedIsNotFine) {
  const TriangleMesh two =
      test::join(test::sphere_with_hole(3, 0.8),
                 test::translated(test::scaled(test::sphere_with_hole(3, 0.8), 0.125), Vector3(3, 0, 0)));
  HoleSelectionOptions small_only;
  small_only.keep_largest = true;
  const PoissonOracle all = oracle_of(two), one = oracle_of(two, {}, {}, small_only);
  EXPECT_LT(one.figures.cubes, all.figures.cubes);
  const Vector3 large_rim(-std::sin(0.8), 0, std::cos(0.8));
  EXPECT_LT(all.field.leaf_size(large_rim), one.field.leaf_size(large_rim));
}

// A shell with walls far thinner than its edges.
TEST(CompletionOracle, ThinWallsGetFinerCubes) {
  const auto shell = [](double inner) {
    return test::join(test::sphere_with_hole(3, 0.5),
                      test::flipped(test::scaled(test::sphere_with_hole(3, 0.5), inner)));
  };
  PoissonOracleOptions options;
  options.scale = 1.8;  // one size of cubes lies between half an edge and an edge
  const PoissonOracle thin = oracle_of(shell(0.9375), options), thick = oracle_of(shell(0.75), options);
  const Vector3 rim(std::sin(0.6), 0, std::cos(0.6));
  EXPECT_LE(thin.field.leaf_size(rim), thick.field.leaf_size(rim) / 2);
  EXPECT_LT(thin.field.value(0.96875 * rim), 0) << "inside the wall";
  EXPECT_GT(thin.field.value(0.85 * rim), 0) << "in the hollow";
}

TEST(CompletionOracle, GuidesSayHowTheMeshGoesOn) {
  const TriangleMesh mesh = test::sphere_with_hole(4, 0.6);
  OrientedSurfaces guides;
  // A lid at the height 0.5, far below where the sphere would go on.
  for (int i = -4; i <= 4; ++i)
    for (int j = -4; j <= 4; ++j) {
      guides.points.push_back({0.06 * i, 0.06 * j, 0.5});
      guides.normals.push_back({0, 0, 1});
    }
  const double without = height(oracle_of(mesh).field, {0, 0, 1}).value_or(0);
  const double with = height(oracle_of(mesh, {}, guides).field, {0, 0, 1}).value_or(0);
  EXPECT_GT(without, 0.8);
  EXPECT_NEAR(with, 0.5, 0.1);
}

TEST(CompletionOracle, AMaximumDepthIsKept) {
  PoissonOracleOptions options;
  options.max_depth = 5;
  const PoissonOracle coarse = oracle_of(test::sphere_with_hole(4, 0.5), options);
  EXPECT_EQ(coarse.figures.depth, 5);
  EXPECT_GT(oracle_of(test::sphere_with_hole(4, 0.5)).figures.depth, 5);
  EXPECT_EQ(coarse.figures.samples, coarse.samples.size());
  EXPECT_GT(coarse.figures.samples, 0u);
  EXPECT_EQ(coarse.figures.cubes, coarse.field.octree().octree().size());
}

TEST(CompletionOracle, MoreSamplesAndAnotherInterpolation) {
  PoissonOracleOptions options;
  options.density = 16;
  const PoissonOracle dense = oracle_of(test::sphere_with_hole(3, 0.5), options);
  EXPECT_GT(dense.figures.samples, 2 * oracle_of(test::sphere_with_hole(3, 0.5)).figures.samples);
  options.interpolation = FieldInterpolation::tetrahedral;
  const PoissonOracle other = oracle_of(test::sphere_with_hole(3, 0.5), options);
  int differing = 0;
  for (int i = 0; i < 50; ++i) {
    const Vector3 p(0.013 * i, 0.4, 0.9 - 0.007 * i);
    differing += other.field.value(p) != dense.field.value(p);
  }
  EXPECT_GT(differing, 40);
}

TEST(CompletionOracle, OptionsOutOfRange) {
  EXPECT_EQ(message_of({}), "");
  PoissonOracleOptions o;
  o.poisson.min_depth = 0;
  EXPECT_EQ(message_of(o), "MinDepth must lie between 1 and 8.");
  o.poisson.min_depth = 9;
  EXPECT_EQ(message_of(o), "MinDepth must lie between 1 and 8.");
  o = {};
  for (int depth : {o.poisson.min_depth - 1, 17}) {
    o.max_depth = depth;
    EXPECT_EQ(message_of(o),
              "MaxDepth must lie between MinDepth and 16, or be 0 for one that is chosen automatically.");
  }
  for (double scale : {1.0, 10.5, std::nan("")}) {
    o = {};
    o.scale = scale;
    EXPECT_EQ(message_of(o), "Scale must lie above 1 and be at most 10.");
  }
  for (double density : {0.0, -1.0, std::nan("")}) {
    o = {};
    o.density = density;
    EXPECT_EQ(message_of(o), "Samples must be positive.");
  }
  for (double screening : {-1.0, std::nan("")}) {
    o = {};
    o.poisson.screening = screening;
    EXPECT_EQ(message_of(o), "Screening must not be negative.");
  }
}

TEST(CompletionOracle, NothingToSampleOrToClose) {
  EXPECT_THROW(make_oracle(nullptr, {}, {[](const Vector3&) { return 0.1; }, 0.1}, {}), CompletionError);
  EXPECT_THROW(oracle_of(test::icosphere(2)), CompletionError) << "no hole says how fine it has to be";
}

TEST(CompletionOracle, TheNumberOfThreadsDoesNotMatter) {
  const TriangleMesh mesh = test::rough_sphere_with_ragged_holes(3, 3, 2, 0.05);
  std::vector<std::vector<double>> values;
  for (std::size_t threads : {1, 2}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    const PoissonOracle oracle = oracle_of(mesh);
    values.emplace_back();
    for (const OrientedSample& sample : oracle.samples) {
      values.back().push_back(sample.position[0]);
      values.back().push_back(oracle.field.value(1.05 * sample.position));
    }
  }
  EXPECT_EQ(values[0], values[1]);
}

TEST(CompletionOracle, CanBeCancelledAtAnyStep) {
  const TriangleMesh mesh = test::sphere_with_hole(3, 0.5);
  const OpenMesh open = find_holes(mesh, {}, {});
  const InputNeighbourhood input(mesh);
  test::expect_cancels_at_any_step(
      [&](const Progress& progress) { make_completion_oracle(mesh, open, input, {}, {}, progress); });
}

}  // namespace
}  // namespace meshcomplete
