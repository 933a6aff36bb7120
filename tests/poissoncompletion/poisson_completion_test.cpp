#include "filter_poissoncompletion/poisson_completion.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "common/core/error.h"
#include "tests/poissoncompletion/oracles.h"
#include "tests/support/cancelling.h"
#include "tests/support/complexes.h"
#include "tests/support/meshes.h"
#include "tests/support/patches.h"

namespace meshcomplete {
namespace {

PoissonCompletionResult complete(const TriangleMesh& mesh, const PoissonCompletionOptions& options = {}) {
  return complete_by_poisson(mesh, {}, options);
}

/// A sphere without a cap, small enough to be completed often.
TriangleMesh holed() { return test::sphere_with_hole(3, 0.6); }

/// How far the patch reaches beyond a height.
double top(const Patch& patch) {
  double most = -1;
  for (const Vector3& v : patch.vertices) most = std::max(most, v.z());
  return most;
}

void expect_closed(const TriangleMesh& mesh, const PoissonCompletionResult& result) {
  for (const HoleReport& hole : result.completion.report.holes)
    EXPECT_EQ(hole.outcome, HoleOutcome::closed) << hole.reason;
  const Patch& patch = result.completion.patch;
  const PatchCheck check = test::check(mesh, patch, test::loops_of(mesh));
  EXPECT_TRUE(check.passed()) << describe(check.defect);
  const TriangleMesh whole = test::with_patch(mesh, patch);
  EXPECT_EQ(test::shape_of(whole.triangles).boundary, 0u);
}

std::string message_of(const PoissonCompletionOptions& options) {
  try {
    check_options(options);
  } catch (const CompletionError& error) {
    EXPECT_THROW(complete(holed(), options), CompletionError) << "the completion refuses what the check does";
    return error.what();
  }
  return "";
}

TEST(PoissonCompletion, ClosesHolesAndKeepsTheMesh) {
  const TriangleMesh mesh = test::sphere_with_holes(3, 3, 0.4), before = mesh;
  const PoissonCompletionResult result = complete(mesh);
  expect_closed(mesh, result);
  EXPECT_EQ(mesh.vertices, before.vertices);
  EXPECT_EQ(mesh.triangles, before.triangles);
  EXPECT_EQ(result.completion.patch.input_vertices, mesh.vertices.size());
  for (const Vector3& v : result.completion.patch.vertices) {
    EXPECT_EQ(as_stored(v), v);
    EXPECT_NEAR(v.norm(), 1, 0.03);
  }
}

TEST(PoissonCompletion, TheReportHasFiguresAndStages) {
  const PoissonCompletionResult result = complete(holed());
  const CompletionReport& report = result.completion.report;
  for (const char* name :
       {"samples", "octree cubes", "octree depth", "initial points", "Delaunay vertices", "Delaunay cells"}) {
    const auto figure = std::find_if(report.figures.begin(), report.figures.end(),
                                     [&](const auto& one) { return one.first == name; });
    ASSERT_NE(figure, report.figures.end()) << name;
    EXPECT_GT(figure->second, 0) << name;
  }
  for (const char* name : {"finding the holes", "building the oracle", "refining the surface"})
    EXPECT_TRUE(std::any_of(report.stage_seconds.begin(), report.stage_seconds.end(), [&](const auto& stage) {
      return stage.first == name;
    })) << name;
  EXPECT_EQ(result.figures.oracle.samples, static_cast<std::size_t>(named(result.figures)[0].second));
}

TEST(PoissonCompletion, NothingToDoBuildsNoOracle) {
  const PoissonCompletionResult result = complete(test::icosphere(2));
  EXPECT_TRUE(result.completion.patch.empty());
  EXPECT_EQ(result.figures.oracle.samples, 0u);
  EXPECT_TRUE(result.completion.report.holes.empty());
}

TEST(PoissonCompletion, OptionsOutOfRange) {
  EXPECT_EQ(message_of({}), "");
  for (int rings : {0, 101}) {
    PoissonCompletionOptions o;
    o.refinement.rings = rings;
    EXPECT_EQ(message_of(o), "Rings must lie between 1 and 100.");
  }
  for (double length : {0.0, -1.0, std::nan("")}) {
    PoissonCompletionOptions o;
    o.refinement.edge_length = length;
    EXPECT_EQ(message_of(o), "EdgeLength must be positive, or 0 for that of the mesh round the hole.");
    o = {};
    o.refinement.cushion_radius = length;
    EXPECT_EQ(message_of(o), "CushionRadius must be positive, or 0 for one that goes with the edge length.");
  }
  PoissonCompletionOptions o;
  o.oracle.scale = 1;
  EXPECT_EQ(message_of(o), "Scale must lie above 1 and be at most 10.") << "those of the oracle, too";
}

TEST(PoissonCompletion, AnEdgeLengthIsKeptTo) {
  const TriangleMesh mesh = holed();
  PoissonCompletionOptions options;
  for (double length : {0.2, 0.1}) {
    options.refinement.edge_length = length;
    const PoissonCompletionResult result = complete(mesh, options);
    expect_closed(mesh, result);
    const TriangleMesh whole = test::with_patch(mesh, result.completion.patch);
    EXPECT_NEAR(test::mean_edge(whole.vertices, result.completion.patch.triangles), length, 0.3 * length);
  }
}

TEST(PoissonCompletion, OnlyHolesThatAreAskedFor) {
  const TriangleMesh mesh = test::join(holed(), test::translated(test::sphere_with_hole(3, 0.4), {3, 0, 0}));
  PoissonCompletionOptions options;
  options.holes.keep_largest = true;
  const PoissonCompletionResult result = complete(mesh, options);
  EXPECT_EQ(result.completion.report.count(HoleOutcome::closed), 1u);
  EXPECT_EQ(result.completion.report.count(HoleOutcome::skipped), 1u);
  for (const Vector3& v : result.completion.patch.vertices) EXPECT_GT(v.x(), 1.5);
}

TEST(PoissonCompletion, RingsAreInTheTriangulation) {
  PoissonCompletionOptions options;
  std::vector<std::size_t> points;
  for (int rings : {1, 3, 100}) {
    options.refinement.rings = rings;
    options.refinement.sample_share = 0;
    const PoissonCompletionResult result = complete(holed(), options);
    expect_closed(holed(), result);
    points.push_back(result.figures.refinement.initial_points);
  }
  EXPECT_LE(points[0], points[1]);
  EXPECT_LT(points[1], points[2]);
  EXPECT_EQ(points[2], holed().vertices.size());
}

// Without fairing the patch is on the function's surface: a guide far below the rim pulls it down.
TEST(PoissonCompletion, GuidesPullThePatch) {
  const TriangleMesh mesh = holed();
  PoissonCompletionOptions options;
  options.refinement.finishing.fairing.reset();
  const double free = top(complete(mesh, options).completion.patch);
  for (int i = -3; i <= 3; ++i)
    for (int j = -3; j <= 3; ++j) {
      options.guides.points.push_back({0.08 * i, 0.08 * j, 0.6});
      options.guides.normals.push_back({0, 0, 1});
    }
  const PoissonCompletionResult guided = complete(mesh, options);
  expect_closed(mesh, guided);
  EXPECT_GT(free, 0.88);
  EXPECT_LT(top(guided.completion.patch), free - 0.02);
  const bool dent =
      std::any_of(guided.completion.patch.vertices.begin(), guided.completion.patch.vertices.end(),
                  [](const Vector3& v) { return v.head<2>().norm() < 0.2 && v.z() < 0.75; });
  EXPECT_TRUE(dent);
}

TEST(PoissonCompletion, FairingIsAChoice) {
  const TriangleMesh mesh = holed();
  PoissonCompletionOptions options;
  options.refinement.finishing.fairing.reset();
  const PoissonCompletionResult cut_out = complete(mesh, options);
  expect_closed(mesh, cut_out);
  options.refinement.finishing.fairing = SurfaceEnergy::membrane;
  const PoissonCompletionResult flat = complete(mesh, options);
  expect_closed(mesh, flat);
  EXPECT_LT(top(flat.completion.patch), top(cut_out.completion.patch) - 0.02) << "a membrane is a flat lid";
}

TEST(PoissonCompletion, ACoarseOracleIsACoarseOctree) {
  PoissonCompletionOptions options;
  options.oracle.max_depth = options.oracle.poisson.min_depth = 4;
  const PoissonCompletionResult coarse = complete(holed(), options), usual = complete(holed());
  EXPECT_EQ(coarse.figures.oracle.depth, 4);
  EXPECT_GT(usual.figures.oracle.depth, 4) << "as deep as the edges at the rim ask for";
  EXPECT_GT(usual.figures.oracle.cubes, coarse.figures.oracle.cubes);
  expect_closed(holed(), coarse);
}

TEST(PoissonCompletion, TheNumberOfThreadsDoesNotMatter) {
  const TriangleMesh mesh = test::rough_sphere_with_ragged_holes(3, 3, 2, 0.05);
  std::vector<Patch> patches;
  for (std::size_t threads : {1, 2}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    patches.push_back(complete(mesh).completion.patch);
  }
  EXPECT_FALSE(patches[0].empty());
  EXPECT_EQ(patches[0].vertices, patches[1].vertices);
  EXPECT_EQ(patches[0].triangles, patches[1].triangles);
}

TEST(PoissonCompletion, CanBeCancelledAtAnyStep) {
  const TriangleMesh mesh = holed();
  test::expect_cancels_at_any_step(
      [&](const Progress& progress) { complete_by_poisson(mesh, {}, {}, progress); });
}

}  // namespace
}  // namespace meshcomplete
