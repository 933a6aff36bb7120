#include "filter_curveunfold/curve_unfolding.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "common/core/error.h"
#include "common/core/mesh_statistics.h"
#include "common/core/patch_check.h"
#include "common/core/triangle_intersection.h"
#include "filter_curveunfold/loop_geometry.h"
#include "tests/support/loop_families.h"
#include "tests/support/meshes.h"
#include "tests/support/patches.h"

namespace meshcomplete {
namespace {

using test::loops_of;

CurveUnfoldingResult fill(const TriangleMesh& mesh, const CurveUnfoldingOptions& options = {}) {
  return fill_by_curve_unfolding(mesh, {}, options);
}

const std::vector<HoleReport>& holes(const CurveUnfoldingResult& result) {
  return result.completion.report.holes;
}

bool mentions(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// Selects one loop and asks for nothing else.
CurveUnfoldingResult fill_loop(const TriangleMesh& mesh, const BoundaryLoop& loop,
                               CurveUnfoldingOptions options = {}) {
  MeshSelection selection;
  selection.vertices.assign(mesh.vertices.size(), 0);
  for (Index v : loop.vertices) selection.vertices[v] = 1;
  options.holes.selected_only = true;
  return fill_by_curve_unfolding(mesh, selection, options);
}

/// What the report says is what the patch has, and the patch closes what the report says, by the exact check.
void expect_adds_up(const TriangleMesh& mesh, const CurveUnfoldingResult& result) {
  const std::vector<BoundaryLoop> loops = loops_of(mesh);
  ASSERT_EQ(holes(result).size(), loops.size());
  EXPECT_EQ(result.times.size(), loops.size());
  std::size_t vertices = 0, faces = 0;
  std::vector<const BoundaryLoop*> closed;
  for (std::size_t i = 0; i < loops.size(); ++i) {
    const HoleReport& hole = holes(result)[i];
    EXPECT_EQ(hole.loops, std::vector<std::size_t>{i});
    EXPECT_EQ(hole.edges, loops[i].vertices.size());
    vertices += hole.vertices_added;
    faces += hole.faces_added;
    if (hole.outcome == HoleOutcome::closed) {
      closed.push_back(&loops[i]);
      EXPECT_EQ(hole.reason, "");
      EXPECT_NE(hole.route, "");
      // A disk: Euler's formula.
      EXPECT_EQ(hole.faces_added, hole.edges + 2 * hole.vertices_added - 2);
    } else {
      EXPECT_NE(hole.reason, "");
      EXPECT_EQ(hole.route, "");
      EXPECT_EQ(hole.faces_added, 0u);
    }
  }
  const Patch& patch = result.completion.patch;
  EXPECT_EQ(patch.input_vertices, mesh.vertices.size());
  EXPECT_EQ(patch.vertices.size(), vertices);
  EXPECT_EQ(patch.triangles.size(), faces);
  const PatchCheck check = check_patch(InputNeighbourhood(mesh), patch, closed);
  EXPECT_TRUE(check.passed()) << describe(check.defect);
}

void expect_all_closed(const TriangleMesh& mesh, const CurveUnfoldingOptions& options = {}) {
  const CurveUnfoldingResult result = fill(mesh, options);
  expect_adds_up(mesh, result);
  for (const HoleReport& hole : holes(result))
    EXPECT_EQ(hole.outcome, HoleOutcome::closed) << hole.edges << " edges: " << hole.reason;
}

// --- the catalogue
// --------------------------------------------------------------------------------------------------

TEST(CurveUnfolding, ClosesEveryHole) {
  for (const TriangleMesh& mesh :
       {test::sphere_with_hole(), test::sphere_with_hole(3, 1.5), test::sphere_with_holes(6),
        test::open_cylinder(), test::open_cylinder(5, 1), test::sphere_with_touching_holes(),
        test::shuffled(test::sphere_with_holes(3), 9),
        test::without_ball(test::torus(32, 16), Vector3(1.4, 0, 0), 0.5),
        test::without_ball(test::uv_sphere(16, 24), Vector3(0, 0, 1), 0.3),
        test::translated(test::sphere_with_hole(), Vector3(500, 0, -300)),
        test::scaled(test::sphere_with_hole(), 1e-6), test::scaled(test::sphere_with_hole(), 1e6)})
    expect_all_closed(mesh);
}

TEST(CurveUnfolding, TheResultIsWatertight) {
  for (const TriangleMesh& mesh :
       {test::sphere_with_holes(6), test::open_cylinder(), test::sphere_with_hole(2, 1.2)}) {
    const CurveUnfoldingResult result = fill(mesh);
    const MeshStatistics statistics = measure(test::with_patch(mesh, result.completion.patch), true);
    EXPECT_TRUE(statistics.solid());
    EXPECT_EQ(statistics.genus, 0);
  }
}

TEST(CurveUnfolding, RaggedHoles) {
  std::size_t asked = 0, closed = 0;
  for (std::uint32_t seed = 1; seed <= 8; ++seed) {
    const TriangleMesh mesh = test::rough_sphere_with_ragged_holes(3, 4, seed);
    const CurveUnfoldingResult result = fill(mesh);
    expect_adds_up(mesh, result);
    closed += result.completion.report.count(HoleOutcome::closed);
    asked += holes(result).size() - result.completion.report.count(HoleOutcome::skipped);
  }
  EXPECT_EQ(closed, asked);
}

TEST(CurveUnfolding, NothingToDo) {
  for (const TriangleMesh& mesh : {test::cube(), test::torus(8, 5), TriangleMesh()}) {
    const CurveUnfoldingResult result = fill(mesh);
    EXPECT_TRUE(holes(result).empty());
    EXPECT_TRUE(result.completion.patch.empty());
    EXPECT_EQ(result.completion.patch.input_vertices, mesh.vertices.size());
  }
}

TEST(CurveUnfolding, SheetsAndSingleTrianglesAreSkipped) {
  const TriangleMesh mesh = test::join(test::join(test::flat_grid(4, 3), test::isolated_triangle()),
                                       test::translated(test::sphere_with_hole(2, 0.7), Vector3(20, 0, 0)));
  const CurveUnfoldingResult result = fill(mesh);
  expect_adds_up(mesh, result);
  ASSERT_EQ(holes(result).size(), 3u);
  EXPECT_EQ(holes(result)[0].outcome, HoleOutcome::skipped);
  EXPECT_EQ(holes(result)[0].reason, describe(LoopDefect::open_sheet));
  EXPECT_EQ(holes(result)[1].outcome, HoleOutcome::skipped);
  EXPECT_EQ(holes(result)[1].reason, describe(LoopDefect::isolated_triangle));
  EXPECT_EQ(holes(result)[2].outcome, HoleOutcome::closed);
}

TEST(CurveUnfolding, AnIslandThatIsNearlyFlatIsASheet) {
  const TriangleMesh mesh = test::sphere_with_island();
  const CurveUnfoldingResult result = fill(mesh);
  expect_adds_up(mesh, result);
  ASSERT_EQ(holes(result).size(), 2u);
  EXPECT_EQ(result.completion.report.count(HoleOutcome::closed), 1u);
  EXPECT_EQ(result.completion.report.count(HoleOutcome::skipped), 1u);
}

TEST(CurveUnfolding, DefectiveLoopsFailWithTheirReason) {
  const TriangleMesh mesh =
      test::join(test::moebius_strip(), test::translated(test::book(), Vector3(9, 0, 0)));
  const CurveUnfoldingResult result = fill(mesh);
  expect_adds_up(mesh, result);
  EXPECT_EQ(result.completion.report.count(HoleOutcome::failed), holes(result).size());
  EXPECT_EQ(holes(result)[0].reason, describe(LoopDefect::inconsistent_normals));
}

TEST(CurveUnfolding, HoleOptionsAreObeyed) {
  const TriangleMesh mesh = test::sphere_with_holes(3);
  CurveUnfoldingOptions options;
  options.holes.max_edges = 3;
  EXPECT_EQ(fill(mesh, options).completion.report.count(HoleOutcome::skipped), 3u);
  const std::vector<BoundaryLoop> loops = loops_of(mesh);
  const CurveUnfoldingResult one = fill_loop(mesh, loops[1]);
  expect_adds_up(mesh, one);
  EXPECT_EQ(holes(one)[0].reason, "not selected");
  EXPECT_EQ(holes(one)[1].outcome, HoleOutcome::closed);
  EXPECT_EQ(holes(one)[2].reason, "not selected");
}

// --- rims of any shape
// --------------------------------------------------------------------------------------------------

TEST(CurveUnfolding, TwistedRims) {
  struct Rim {
    const char* name;
    std::vector<Vector3> points;
    Vector3 away;
  };
  const std::vector<Rim> rims = {
      {"saddle", testing::saddle(40, 2, 0.5), {0, 0, -0.1}},
      {"crown", testing::saddle(60, 3, 1.0), {0, 0, -0.1}},
      {"armpit",
       testing::sampled(60,
                        [](double t) {
                          // Two wings folded down nearly onto each other.
                          const double x = std::cos(t), y = 0.6 * std::sin(t);
                          return Vector3(0.25 * std::sin(2 * x), y, -1.2 * std::abs(x) * std::abs(x));
                        }),
       {0, 0, 0.05}},
      {"wound round a cylinder", testing::wound_round_cylinder(60, 2), {0, 0, 0}},
      {"rough", testing::rough_rim(100, 3), {0, 0, 0}},
  };
  for (const Rim& rim : rims) {
    std::vector<Vector3> outer;
    for (const Vector3& p : rim.points)
      outer.push_back(rim.away.isZero() ? Vector3(0.97 * p) : Vector3(p + rim.away));
    const TriangleMesh mesh = test::collar(rim.points, outer);
    const std::vector<BoundaryLoop> loops = loops_of(mesh);
    ASSERT_EQ(loops.size(), 2u) << rim.name;
    const CurveUnfoldingResult result = fill_loop(mesh, loops[0]);
    expect_adds_up(mesh, result);
    EXPECT_EQ(holes(result)[0].outcome, HoleOutcome::closed) << rim.name << ": " << holes(result)[0].reason;
  }
}

TEST(CurveUnfolding, KnottedRimsAreRefused) {
  std::vector<Vector3> rim, outer;
  for (const Vector3& p : testing::torus_knot(60, 2, 3)) {
    rim.push_back(p);
    const Vector3 core = 2 * Vector3(p.x(), p.y(), 0).normalized();
    outer.push_back(core + 1.2 * (p - core));
  }
  const TriangleMesh ribbon = test::collar(rim, outer);
  const TriangleMesh mesh =
      test::join(ribbon, test::translated(test::sphere_with_hole(2, 0.7), Vector3(10, 0, 0)));
  const CurveUnfoldingResult result = fill(mesh);
  expect_adds_up(mesh, result);
  ASSERT_EQ(holes(result).size(), 3u);
  for (int i : {0, 1}) {
    EXPECT_EQ(holes(result)[i].outcome, HoleOutcome::failed);
    EXPECT_TRUE(mentions(holes(result)[i].reason, "knotted (determinant 3)")) << holes(result)[i].reason;
  }
  EXPECT_EQ(holes(result)[2].outcome, HoleOutcome::closed) << "the others are closed all the same";
}

// --- options
// --------------------------------------------------------------------------------------------------

TEST(CurveUnfolding, EnergiesAndWeights) {
  const TriangleMesh mesh = test::sphere_with_hole(3, 0.6);
  for (const auto& [energy, route] :
       {std::pair(SurfaceEnergy::membrane, "projected, membrane"),
        std::pair(SurfaceEnergy::thin_plate, "projected, thin plate"),
        std::pair(SurfaceEnergy::normal_variation, "projected, normal variation")})
    for (LaplacianWeights weights : {LaplacianWeights::uniform, LaplacianWeights::cotangent}) {
      CurveUnfoldingOptions options;
      options.energy = energy;
      options.weights = weights;
      const CurveUnfoldingResult result = fill(mesh, options);
      expect_adds_up(mesh, result);
      EXPECT_EQ(holes(result)[0].route, route);
      double lowest = 2, highest = 0;
      for (const Vector3& p : result.completion.patch.vertices) {
        lowest = std::min(lowest, p.norm());
        highest = std::max(highest, p.norm());
      }
      if (energy == SurfaceEnergy::membrane) {
        EXPECT_LT(lowest, 0.9);
      } else {
        EXPECT_GT(lowest, 0.94);
        EXPECT_LT(highest, 1.06);
      }
    }
}

TEST(CurveUnfolding, UnfoldingMethods) {
  const TriangleMesh mesh = test::sphere_with_hole(2, 0.7);
  CurveUnfoldingOptions options;
  options.unfolding.method = UnfoldMethod::annealing;
  const CurveUnfoldingResult annealed = fill(mesh, options);
  expect_adds_up(mesh, annealed);
  EXPECT_EQ(holes(annealed)[0].route, "annealed, thin plate");
  EXPECT_EQ(annealed.times[0].restarts, 1) << "a loop with a simple projection takes one run";
  options.unfolding.method = UnfoldMethod::descent;
  const CurveUnfoldingResult descended = fill(mesh, options);
  expect_adds_up(mesh, descended);
  EXPECT_EQ(holes(descended)[0].outcome, HoleOutcome::closed);
}

TEST(CurveUnfolding, TheEdgeLengthAskedFor) {
  const TriangleMesh mesh = test::sphere_with_hole(3, 0.6);
  std::size_t before = 0;
  for (double length : {0.2, 0.1, 0.05}) {
    CurveUnfoldingOptions options;
    options.edge_length = length;
    const CurveUnfoldingResult result = fill(mesh, options);
    expect_adds_up(mesh, result);
    const std::size_t faces = result.completion.patch.triangles.size();
    if (before > 0) {
      EXPECT_GT(faces, 2 * before);
      EXPECT_LT(faces, 6 * before);
    }
    before = faces;
  }
}

TEST(CurveUnfolding, TheUnfoldedLayer) {
  const TriangleMesh mesh =
      test::join(test::sphere_with_holes(4), test::translated(test::flat_grid(3, 3), Vector3(5, 0, 0)));
  EXPECT_TRUE(fill(mesh).unfolded.triangles.empty()) << "only when asked for";
  CurveUnfoldingOptions options;
  options.unfolded_layer = true;
  const CurveUnfoldingResult result = fill(mesh, options);
  const TriangleMesh& sheet = result.unfolded;
  for (const Vector3& p : sheet.vertices) {
    EXPECT_EQ(p.z(), 0);
    EXPECT_EQ(p, as_stored(p));
  }
  const MeshStatistics statistics = measure(sheet, true);
  EXPECT_EQ(statistics.components, 4u) << "one piece per closed hole";
  EXPECT_EQ(statistics.self_intersecting_pairs, 0u) << "side by side";
  EXPECT_EQ(statistics.degenerate_faces, 0u);
  EXPECT_EQ(statistics.unreferenced_vertices, 0u);
  std::vector<std::size_t> edges;
  for (const HoleReport& hole : holes(result))
    if (hole.outcome == HoleOutcome::closed) edges.push_back(hole.edges);
  std::sort(edges.rbegin(), edges.rend());
  EXPECT_EQ(statistics.boundary_loops, edges);
  for (const Triangle& t : sheet.triangles)
    EXPECT_GT(
        (sheet.vertices[t[1]] - sheet.vertices[t[0]]).cross(sheet.vertices[t[2]] - sheet.vertices[t[0]]).z(),
        0);
  double left = 0;
  for (const BoundaryLoop& loop : loops_of(sheet)) {  // in the order of the holes, from left to right
    Eigen::AlignedBox3d box;
    for (Index v : loop.vertices) box.extend(sheet.vertices[v]);
    EXPECT_GE(box.min().x(), left);
    left = box.max().x();
  }
}

void expect_refused(const std::function<void(CurveUnfoldingOptions&)>& spoil) {
  CurveUnfoldingOptions options;
  spoil(options);
  try {
    fill(test::sphere_with_hole(1, 1.0), options);
    ADD_FAILURE() << "accepted";
  } catch (const CompletionError& error) {
    EXPECT_EQ(error.stage(), "reading the parameters");
    EXPECT_NE(std::string(error.what()), "");
  }
}

TEST(CurveUnfolding, OptionsOutOfRangeAreErrors) {
  const double infinity = std::numeric_limits<double>::infinity();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (double length : {0.0, -1.0, infinity, nan}) expect_refused([&](auto& o) { o.edge_length = length; });
  for (int restarts : {0, -1, 10001}) expect_refused([&](auto& o) { o.unfolding.restarts = restarts; });
  for (double distance : {0.0, 1e-10, 0.011, nan})
    expect_refused([&](auto& o) { o.unfolding.min_distance = distance; });
  for (double cooling : {0.0, 1.0, -0.5, nan})
    expect_refused([&](auto& o) { o.unfolding.cooling = cooling; });
  for (double temperature : {0.0, -1.0, infinity, nan})
    expect_refused([&](auto& o) { o.unfolding.start_temperature = temperature; });
}

TEST(CurveUnfolding, OptionsThatContradictTheSelectionAreErrors) {
  CurveUnfoldingOptions options;
  options.holes.selected_only = true;
  EXPECT_THROW(fill(test::sphere_with_hole(1, 1.0), options), CompletionError);
}

// --- together
// --------------------------------------------------------------------------------------------------

// Two spheres face each other with their holes; where each would bulge out the other one bulges too.
TEST(CurveUnfolding, PatchesThatWouldMeetAreSeparated) {
  const TriangleMesh lower = test::sphere_with_hole(3, 0.6);
  TriangleMesh upper = lower;
  for (Vector3& p : upper.vertices) p = as_stored(Vector3(p.x(), -p.y(), 1.8 - p.z()));
  const TriangleMesh mesh = test::join(lower, upper);
  // Each alone takes the plain route.
  for (const BoundaryLoop& loop : loops_of(mesh)) {
    const CurveUnfoldingResult alone = fill_loop(mesh, loop);
    EXPECT_EQ(alone.completion.report.count(HoleOutcome::closed), 1u);
  }
  const CurveUnfoldingResult result = fill(mesh);
  expect_adds_up(mesh, result);
  EXPECT_EQ(result.completion.report.count(HoleOutcome::closed), 2u);
  EXPECT_EQ(holes(result)[0].route, "projected, thin plate") << "the first one keeps its patch";
  EXPECT_NE(holes(result)[1].route, holes(result)[0].route);
}

// A slab cut out of a ball: two rims so close to each other that only flat caps fit between them.
TEST(CurveUnfolding, BothPatchesYieldWhereOneIsNotEnough) {
  const TriangleMesh lower = test::sphere_with_hole(3, 0.6);
  TriangleMesh upper = lower;
  for (Vector3& p : upper.vertices) p = as_stored(Vector3(p.x(), -p.y(), 1.66 - p.z()));
  const TriangleMesh mesh = test::join(lower, upper);
  const CurveUnfoldingResult result = fill(mesh);
  expect_adds_up(mesh, result);
  EXPECT_EQ(result.completion.report.count(HoleOutcome::closed), 2u);
  for (const HoleReport& hole : holes(result))
    EXPECT_NE(hole.route.find("membrane"), std::string::npos) << hole.route << hole.reason;
}

// Three tubes that end short of one place, from three sides: each end by itself is closed by a dome that
// meets both of the others.
TEST(CurveUnfolding, ThreePatchesThatWouldMeetEachOther) {
  const double pi = std::acos(-1.0);
  const auto placed = [&](int k, const Vector3& p) {
    const Vector3 out = p + Vector3(0, 0, 0.65);
    const double turn = 2 * pi * k / 3;
    return as_stored(Vector3(std::cos(turn) * out.z() - std::sin(turn) * out.x(),
                             std::sin(turn) * out.z() + std::cos(turn) * out.x(), out.y()));
  };
  TriangleMesh mesh;
  for (int k = 0; k < 3; ++k) {
    TriangleMesh tube = test::open_cylinder(24, 8);
    for (Vector3& p : tube.vertices) p = placed(k, p);
    mesh = test::join(mesh, tube);
  }
  ASSERT_EQ(count_improper_pairs(test::corners_of(mesh)), 0u);
  std::vector<std::vector<std::array<Vector3, 3>>> alone;
  for (const BoundaryLoop& loop : loops_of(mesh)) {
    if (mesh.vertices[loop.vertices[0]].norm() > 1.5) continue;
    const CurveUnfoldingResult result = fill_loop(mesh, loop);
    alone.emplace_back();
    for (const Triangle& t : result.completion.patch.triangles)
      alone.back().push_back(corners(mesh, result.completion.patch, t));
  }
  ASSERT_EQ(alone.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_FALSE(improper_pairs_between(alone[i], alone[(i + 1) % 3]).empty());
  const CurveUnfoldingResult result = fill(mesh);
  expect_adds_up(mesh, result);
  EXPECT_EQ(result.completion.report.count(HoleOutcome::closed), 6u);
}

TEST(CurveUnfolding, StagesAreTimed) {
  const CurveUnfoldingResult result = fill(test::sphere_with_holes(2));
  const auto& stages = result.completion.report.stage_seconds;
  ASSERT_EQ(stages.size(), 3u);
  EXPECT_EQ(stages[0].first, "finding the holes");
  EXPECT_EQ(stages[1].first, "closing the holes");
  EXPECT_EQ(stages[2].first, "comparing the patches");
  for (const auto& [stage, seconds] : stages) EXPECT_GE(seconds, 0) << stage;
  for (const HoleTimes& times : result.times)
    EXPECT_GT(times.unfolding + times.embedding + times.checking, 0);
}

TEST(CurveUnfolding, ProgressNeverGoesBackAndEndsAtOne) {
  double last = 0;
  bool ordered = true;
  fill_by_curve_unfolding(test::sphere_with_holes(4), {}, {},
                          Progress([&](double fraction, const std::string&) {
                            ordered &= fraction >= last;
                            last = fraction;
                            return true;
                          }));
  EXPECT_TRUE(ordered);
  EXPECT_EQ(last, 1);
}

TEST(CurveUnfolding, CanBeCancelledAtAnyTime) {
  const TriangleMesh mesh = test::sphere_with_holes(6);
  int calls = 0;
  fill_by_curve_unfolding(mesh, {}, {}, Progress([&](double, const std::string&) { return ++calls > 0; }));
  ASSERT_GE(calls, 2);
  for (int stop = 1; stop <= std::min(calls - 1, 4); ++stop) {
    int call = 0;
    bool cancelled = false;
    try {
      fill_by_curve_unfolding(mesh, {}, {},
                              Progress([&](double, const std::string&) { return ++call < stop; }));
    } catch (const Cancelled&) {
      cancelled = true;
    }
    // How often it is called depends on the time it takes.
    EXPECT_EQ(cancelled, call >= stop) << stop;
  }
}

}  // namespace
}  // namespace meshcomplete
