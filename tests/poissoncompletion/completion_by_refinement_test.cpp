#include "filter_poissoncompletion/completion_by_refinement.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>

#include "common/core/hole_selection.h"
#include "common/core/hole_targets.h"
#include "common/core/triangle_intersection.h"
#include "filter_poissoncompletion/cushion.h"
#include "filter_poissoncompletion/delaunay_refinement.h"
#include "filter_poissoncompletion/initial_points.h"
#include "tests/poissoncompletion/oracles.h"
#include "tests/support/complexes.h"
#include "tests/support/meshes.h"
#include "tests/support/patches.h"

namespace meshcomplete {
namespace {

using test::Oracle;

struct Case {
  std::string name;
  TriangleMesh mesh;
  Oracle oracle;
  long euler;  // of the mesh with all holes closed
};

Vector3 middle(const TriangleMesh& mesh, Index face) {
  const Triangle& t = mesh.triangles[face];
  return (mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]) / 3;
}

TriangleMesh without(const TriangleMesh& mesh, const std::function<bool(const Vector3& middle)>& remove) {
  return test::without_faces(mesh, [&](Index face) { return remove(middle(mesh, face)); });
}

std::vector<Case> cases() {
  const Oracle ball = test::sphere_oracle(), ring = test::torus_oracle();
  const TriangleMesh sphere = test::icosphere(4), inner = test::flipped(test::icosphere(4, 0.95));
  const Oracle shell([](const Vector3& p) { return std::abs(p.norm() - 0.975) - 0.025; });
  const Vector3 apart(2.5, 0.5, 0);
  const TriangleMesh holed = test::without_ball(sphere, Vector3(0, 0, 1), 0.5);
  return {
      {"one hole", holed, ball, 2},
      {"three holes", test::sphere_with_holes(3, 3, 0.4), ball, 2},
      {"island", test::sphere_with_island(4, 0.7, 0.3), ball, 2},
      {"gap", without(sphere, [](const Vector3& p) { return std::abs(p[2]) < 0.25; }), ball, 2},
      {"slit", without(sphere, [](const Vector3& p) { return p[0] > 0 && std::abs(p[2]) < 0.03; }), ball, 2},
      {"ragged", test::rough_sphere_with_ragged_holes(4, 4, 3, 0.02), ball, 2},
      {"touching holes", test::sphere_with_touching_holes(3), ball, 2},
      {"torus", test::without_ball(test::torus(48, 24), Vector3(1, 0, 0.4), 0.35), ring, 0},
      {"torus cut through", without(test::torus(48, 24), [](const Vector3& p) { return p[0] > 0.7; }), ring,
       0},
      {"thin wall", test::join(holed, inner), shell, 4},
      {"two balls", test::join(holed, test::translated(holed, apart)),
       test::both(ball, test::sphere_oracle(1, apart)), 4},
  };
}

struct Completed {
  MeshTopology topology;
  std::vector<BoundaryLoop> loops;
  RefinedCompletion result;
};

Completed complete(const TriangleMesh& mesh, const ImplicitFunction& oracle,
                   const RefinedCompletionOptions& options = {}, const HoleSelectionOptions& selection = {}) {
  Completed run;
  run.topology = build_topology(mesh);
  run.loops = trace_boundary_loops(mesh, run.topology);
  CompletionReport report;
  report.holes = select_holes(mesh, run.loops, {}, selection);
  target_islands(run.loops, report.holes);
  const InputNeighbourhood input(mesh);
  run.result = complete_by_refinement(mesh, run.topology, run.loops, input, oracle, options, report);
  return run;
}

// The upper half of a ball, open below, whose oracle knows that the bottom is flat. From its rim alone it
// could as well go on as a ball.
TEST(CompletionByRefinement, FairingKeepsAFlatBottomAboutFlat) {
  const TriangleMesh bowl = without(test::icosphere(4), [](const Vector3& p) { return p[2] < 0; });
  const Oracle half([](const Vector3& p) { return std::max(p.norm() - 1, -0.05 - p[2]); });
  const auto lowest = [&](const RefinedCompletionOptions& options) {
    const Completed run = complete(bowl, half, options);
    EXPECT_EQ(run.result.completion.report.count(HoleOutcome::closed), 1u);
    double z = 0;
    for (const Vector3& p : run.result.completion.patch.vertices) z = std::min(z, p[2]);
    return z;
  };
  RefinedCompletionOptions options;
  const double diagonal = 2 * std::sqrt(2.0);
  EXPECT_GT(lowest(options), -0.05 - (near_function + 0.01) * diagonal);
  options.finishing.near_rough.reset();
  EXPECT_LT(lowest(options), -0.5);
}

TEST(CompletionByRefinement, ClosesAllHoles) {
  for (const Case& one : cases()) {
    SCOPED_TRACE(one.name);
    const Completed run = complete(one.mesh, one.oracle);
    const CompletionReport& report = run.result.completion.report;
    EXPECT_EQ(report.count(HoleOutcome::failed), 0u);
    for (const HoleReport& hole : report.holes) EXPECT_EQ(hole.reason, "");
    const Patch& patch = run.result.completion.patch;
    const PatchCheck check = check_patch(InputNeighbourhood(one.mesh), patch, test::pointers(run.loops));
    EXPECT_TRUE(check.passed()) << describe(check.defect);
    const TriangleMesh whole = test::with_patch(one.mesh, patch);
    const test::Shape shape = test::shape_of(whole.triangles);
    EXPECT_EQ(shape.boundary, 0u);
    EXPECT_EQ(shape.euler, one.euler);
  }
}

TEST(CompletionByRefinement, PatchesAreLikeTheMeshAndOnTheSurface) {
  for (const Case& one : cases()) {
    if (one.name == "ragged") continue;  // its mesh is not on the surface
    SCOPED_TRACE(one.name);
    RefinedCompletionOptions options;
    options.finishing.fairing.reset();
    const Patch patch = complete(one.mesh, one.oracle, options).result.completion.patch;
    const TriangleMesh whole = test::with_patch(one.mesh, patch);
    const double length = test::mean_edge(one.mesh.vertices, one.mesh.triangles);
    EXPECT_NEAR(test::mean_edge(whole.vertices, patch.triangles), length, 0.2 * length);
    std::size_t small = 0, inner = 0;
    for (const Triangle& t : patch.triangles) {
      const Vector3 &a = whole.vertices[t[0]], &b = whole.vertices[t[1]], &c = whole.vertices[t[2]];
      EXPECT_LT(std::abs(one.oracle.value((a + b + c) / 3)), 2 * length * length);
      if (std::min({t[0], t[1], t[2]}) < patch.input_vertices) continue;
      ++inner;
      small += test::smallest_angle(a, b, c) < 20;
    }
    EXPECT_LE(100 * small, inner);
  }
}

// Before anything is done to it.
TEST(CompletionByRefinement, WhatIsCutOutMeetsNothing) {
  for (const Case& one : cases()) {
    if (one.name == "thin wall") continue;  // a cushion of one radius is thicker than the wall
    SCOPED_TRACE(one.name);
    const MeshTopology topology = build_topology(one.mesh);
    const std::vector<BoundaryLoop> loops = trace_boundary_loops(one.mesh, topology);
    const TriangleBlocks blocks(one.mesh);
    const double length = test::mean_edge(one.mesh.vertices, one.mesh.triangles);
    const InitialPoints points = choose_initial_points(
        one.mesh, topology, test::pointers(loops), 2, [=](const Vector3&) { return 2.5 * length; }, blocks,
        0.05);
    const Cushion cushion(blocks, 1.05 * length);
    std::vector<Vector3> positions;
    std::map<Index, Index> number;
    for (Index v : points.vertices) {
      number[v] = static_cast<Index>(positions.size());
      positions.push_back(one.mesh.vertices[v]);
    }
    RefinementOptions options;
    options.criteria.edge_length = [=](const Vector3&) { return length; };
    options.around.emplace(ProtectedMesh{one.mesh, cushion, points.vertices});
    options.seeds.assign(positions.size(), 0);
    std::fill_n(options.seeds.begin(), points.on_rims, 1);
    for (Index h : points.half_edges)
      options.protected_edges.emplace_back(number.at(one.mesh.triangles[h / 3][h % 3]),
                                           number.at(one.mesh.triangles[h / 3][(h % 3 + 1) % 3]));
    const DelaunayComplex complex = refine_delaunay(one.oracle, positions, options);
    TailoringFigures figures;
    const SeparatingSurface surface =
        tailor({one.mesh, topology, complex, points.half_edges, points.rim_edges}, figures);
    EXPECT_GT(figures.faces_met, 0u);
    std::vector<std::array<Vector3, 3>> facets;
    for (const Triangle& t : surface.triangles)
      facets.push_back({surface.vertices[t[0]].position, surface.vertices[t[1]].position,
                        surface.vertices[t[2]].position});
    EXPECT_EQ(count_improper_pairs(facets), 0u);
    // Every edge of a rim has one facet, undivided or divided; every other edge as many one way as the other.
    std::map<Index, double> closed;
    for (const auto& [edge, times] : test::boundary_of(surface.triangles)) {
      const SheetVertex &a = surface.vertices[edge.first], &b = surface.vertices[edge.second];
      EXPECT_EQ(std::abs(times), 1);
      Index half_edge = a.rim_edge != SheetVertex::none ? a.rim_edge : b.rim_edge;
      for (Index h : topology.boundary_half_edges) {
        const Triangle& t = one.mesh.triangles[h / 3];
        const std::set<Index> ends = {t[h % 3], t[(h % 3 + 1) % 3]};
        if (ends.count(a.input) && ends.count(b.input)) half_edge = h;
      }
      ASSERT_NE(half_edge, SheetVertex::none) << "open beside the rims";
      closed[half_edge] += (a.position - b.position).norm();
    }
    for (Index h : topology.boundary_half_edges) {
      const Triangle& t = one.mesh.triangles[h / 3];
      EXPECT_NEAR(closed[h], (one.mesh.vertices[t[h % 3]] - one.mesh.vertices[t[(h % 3 + 1) % 3]]).norm(),
                  1e-9);
    }
  }
}

// The cushion is as thick at the rims, and grows as far, as with the same length taken from them.
TEST(CompletionByRefinement, AGivenEdgeLengthIsAsGoodAsTheRims) {
  const TriangleMesh mesh = test::sphere_with_hole(5, 0.6);
  RefinedCompletionOptions options;
  const RefinedCompletionFigures own = complete(mesh, test::sphere_oracle(), options).result.figures;
  options.edge_length = test::mean_edge(mesh.vertices, mesh.triangles);
  const RefinedCompletionFigures given = complete(mesh, test::sphere_oracle(), options).result.figures;
  const auto inserted = [](const RefinedCompletionFigures& figures) {
    return static_cast<double>(figures.points - figures.initial_points);
  };
  EXPECT_NEAR(inserted(given) / inserted(own), 1, 0.1);
}

TEST(CompletionByRefinement, GivenEdgeLength) {
  RefinedCompletionOptions options;
  options.edge_length = 0.15;
  const TriangleMesh mesh = test::sphere_with_hole(4, 0.8);
  const Patch patch = complete(mesh, test::sphere_oracle(), options).result.completion.patch;
  const TriangleMesh whole = test::with_patch(mesh, patch);
  std::vector<Triangle> inner;
  for (const Triangle& t : patch.triangles)
    if (std::min({t[0], t[1], t[2]}) >= patch.input_vertices) inner.push_back(t);
  EXPECT_NEAR(test::mean_edge(whole.vertices, inner), 0.15, 0.03);
}

TEST(CompletionByRefinement, HolesThatAreNotAskedForStayOpen) {
  const TriangleMesh mesh = test::without_ball(test::sphere_with_hole(4, 0.7), Vector3(1, 0, 0), 0.3);
  HoleSelectionOptions selection;
  selection.keep_largest = true;
  const Completed run = complete(mesh, test::sphere_oracle(), {}, selection);
  EXPECT_EQ(run.result.completion.report.count(HoleOutcome::closed), 1u);
  EXPECT_EQ(run.result.completion.report.count(HoleOutcome::skipped), 1u);
  for (const Vector3& v : run.result.completion.patch.vertices) EXPECT_GT(v[0], 0.8);
}

// The function has the rims of two balls on one surface: what closes one closes the other.
TEST(CompletionByRefinement, WhatWouldCloseAnotherHoleIsRefused) {
  const TriangleMesh mesh =
      without(test::icosphere(4), [](const Vector3& p) { return std::abs(p[2] - 0.3) < 0.25; });
  HoleSelectionOptions selection;
  selection.keep_largest = true;
  const Completed run = complete(mesh, test::sphere_oracle(), {}, selection);
  EXPECT_TRUE(run.result.completion.patch.empty());
  ASSERT_EQ(run.result.completion.report.count(HoleOutcome::failed), 1u);
  for (const HoleReport& hole : run.result.completion.report.holes)
    EXPECT_EQ(hole.reason.empty(),
              hole.outcome != HoleOutcome::failed && hole.outcome != HoleOutcome::skipped);
}

// A function that knows nothing of the mesh: nothing is closed, nothing breaks.
TEST(CompletionByRefinement, SurfaceThatIsElsewhere) {
  const TriangleMesh mesh = test::sphere_with_hole(3, 0.6);
  for (double radius : {0.4, 1.6}) {
    const Completed run = complete(mesh, test::sphere_oracle(radius));
    const Patch& patch = run.result.completion.patch;
    if (!patch.empty()) {
      EXPECT_TRUE(check_patch(InputNeighbourhood(mesh), patch, test::pointers(run.loops)).passed());
    }
    for (const HoleReport& hole : run.result.completion.report.holes)
      EXPECT_TRUE(hole.outcome == HoleOutcome::closed || !hole.reason.empty());
  }
}

TEST(CompletionByRefinement, NothingToDo) {
  const TriangleMesh mesh = test::icosphere(2);
  EXPECT_TRUE(complete(mesh, test::sphere_oracle()).result.completion.patch.empty());
}

TEST(CompletionByRefinement, RimsThatLieOnEachOtherAreRefused) {
  const TriangleMesh mesh = test::unwelded(test::tetrahedron());
  const Completed run = complete(mesh, test::sphere_oracle(), {}, {});
  EXPECT_TRUE(run.result.completion.patch.empty());
}

}  // namespace
}  // namespace meshcomplete
