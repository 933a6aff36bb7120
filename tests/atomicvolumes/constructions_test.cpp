// The constructions of the paper, completed by the whole filter with its defaults.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "common/core/disjoint_sets.h"
#include "common/core/mesh_statistics.h"
#include "common/core/patch.h"
#include "common/core/patch_check.h"
#include "common/core/triangle_intersection.h"
#include "filter_atomicvolumes/atomic_volumes.h"
#include "filter_atomicvolumes/divisible_mesh.h"
#include "tests/support/atomic_shapes.h"
#include "tests/support/complexes.h"
#include "tests/support/patches.h"
#include "tests/support/volumes.h"

namespace meshcomplete {
namespace {

/// What came of a mesh, counted by the definitions.
struct Outcome {
  std::vector<std::size_t> loops_of_holes;  ///< how many loops each hole has, ascending
  std::vector<long> genera;                 ///< of the components, ascending
};

std::vector<std::vector<Triangle>> components(const std::vector<Triangle>& triangles) {
  Index vertices = 0;
  for (const Triangle& t : triangles) vertices = std::max({vertices, t[0] + 1, t[1] + 1, t[2] + 1});
  DisjointSets sets(vertices);
  for (const Triangle& t : triangles)
    for (int k = 1; k < 3; ++k) sets.unite(t[0], t[k]);
  std::map<Index, std::vector<Triangle>> parts;
  for (const Triangle& t : triangles) parts[sets.root(t[0])].push_back(t);
  std::vector<std::vector<Triangle>> list;
  for (auto& part : parts) list.push_back(std::move(part.second));
  return list;
}

/// Of a patch that closes all holes.
void expect_passed(const TriangleMesh& mesh, const Patch& patch) {
  const PatchCheck check = test::check(mesh, patch, test::loops_of(mesh));
  EXPECT_TRUE(check.passed()) << describe(check.defect);
}

/// Closes all holes and expects that nothing is wrong with what comes out: the patch passes the check, every
/// hole is closed, mesh and patch are a closed manifold.
Outcome complete(const TriangleMesh& mesh, const AtomicVolumesOptions& options = {}) {
  Outcome outcome;
  const AtomicVolumesResult result = fill_by_atomic_volumes(mesh, {}, options);
  for (const HoleReport& hole : result.completion.report.holes) {
    EXPECT_EQ(hole.outcome, HoleOutcome::closed) << hole.reason;
    outcome.loops_of_holes.push_back(hole.loops.size());
  }
  std::sort(outcome.loops_of_holes.begin(), outcome.loops_of_holes.end());
  expect_passed(mesh, result.completion.patch);
  const TriangleMesh whole = test::with_patch(mesh, result.completion.patch);
  for (const std::vector<Triangle>& part : components(whole.triangles)) {
    const test::Shape shape = test::shape_of(part);
    EXPECT_TRUE(shape.manifold);
    EXPECT_EQ(shape.boundary, 0u);
    EXPECT_EQ(shape.euler % 2, 0);
    outcome.genera.push_back(1 - shape.euler / 2);
  }
  std::sort(outcome.genera.begin(), outcome.genera.end());
  EXPECT_TRUE(measure(whole, true).solid());
  return outcome;
}

using Genera = std::vector<long>;
using Loops = std::vector<std::size_t>;
constexpr std::uint64_t seeds[] = {1, 2, 3};

AtomicVolumesOptions with_seed(std::uint64_t seed) {
  AtomicVolumesOptions options;
  options.seed = seed;
  return options;
}

// Figure 1: the pipe's ends are closed by themselves, and the two openings of the sphere by one tunnel round
// the pipe.
TEST(Constructions, PiercedSphere) {
  for (std::uint64_t seed : seeds) {
    const Outcome outcome = complete(test::pierced_sphere(), with_seed(seed));
    EXPECT_EQ(outcome.genera, (Genera{0, 1})) << "pipe and sphere";
    EXPECT_EQ(outcome.loops_of_holes, (Loops{1, 1, 2}));
  }
}

// Figure 2: two discs, or with points outside a ring.
TEST(Constructions, OuterHalfOfATorus) {
  for (std::uint64_t seed : seeds) {
    AtomicVolumesOptions options = with_seed(seed);
    const Outcome discs = complete(test::outer_half_of_torus(), options);
    EXPECT_EQ(discs.genera, Genera{0});
    EXPECT_EQ(discs.loops_of_holes, (Loops{1, 1}));
    options.constraints.outside = test::points_in_ring();
    const Outcome ring = complete(test::outer_half_of_torus(), options);
    EXPECT_EQ(ring.genera, Genera{1});
    EXPECT_EQ(ring.loops_of_holes, Loops{2});
  }
}

// Figure 5: the patch winds between the windings of the mesh.
TEST(Constructions, SpiralTorus) {
  const Outcome outcome = complete(test::spiral_torus());
  EXPECT_EQ(outcome.genera, Genera{1});
  EXPECT_EQ(outcome.loops_of_holes, Loops{2});
}

// Figure 11: a handle, and none with points outside in the gap.
TEST(Constructions, LumpsWithAndWithoutAHandle) {
  for (std::uint64_t seed : seeds) {
    AtomicVolumesOptions options = with_seed(seed);
    const Outcome handle = complete(test::lumps(), options);
    EXPECT_EQ(handle.genera, Genera{1});
    EXPECT_EQ(handle.loops_of_holes, Loops{2});
    options.constraints.outside = test::points_in_gap();
    const Outcome caps = complete(test::lumps(), options);
    EXPECT_EQ(caps.genera, Genera{0});
    EXPECT_EQ(caps.loops_of_holes, (Loops{1, 1}));
  }
}

// The less areas count, the rather a gap is bridged instead of closed on both sides: two caps of a sphere,
// octrees at several places.
TEST(Constructions, TheWeightDecidesHowWideAGapIsBridged) {
  const TriangleMesh mesh = test::two_caps(3, 0.6);
  const auto bridged = [&](CutWeight weight) {
    int count = 0;
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
      AtomicVolumesOptions options = with_seed(seed);
      options.weight = weight;
      options.shifts = 1;
      options.remesh = false;
      options.fairing.reset();
      const Outcome outcome = complete(mesh, options);
      EXPECT_EQ(outcome.genera.size(), outcome.loops_of_holes.size());
      count += outcome.loops_of_holes.size() == 1;
    }
    return count;
  };
  EXPECT_EQ(bridged(CutWeight::area), 0) << "the caps' discs have less area than a band";
  EXPECT_GT(bridged(CutWeight::balanced), 0);
  EXPECT_EQ(bridged(CutWeight::unit), 8);
  EXPECT_EQ(bridged(CutWeight::poisson), 8) << "the reconstruction is a whole ball";
}

// --- meshes with flaws
// ----------------------------------------------------------------------------------------------

bool tried_others(const CompletionReport& report) {
  return std::any_of(report.stage_seconds.begin(), report.stage_seconds.end(),
                     [](const auto& stage) { return stage.first == "trying other octrees"; });
}

/// Whether two faces with an edge on a rim meet: neither can be left out.
bool folded_on_rims(const TriangleMesh& mesh) {
  std::vector<char> at_rim(mesh.triangles.size(), 0);
  for (Index h : build_topology(mesh).boundary_half_edges) at_rim[h / 3] = 1;
  const auto pairs = improper_pairs(test::corners_of(mesh));
  return std::any_of(pairs.begin(), pairs.end(),
                     [&](const auto& pair) { return at_rim[pair.first] && at_rim[pair.second]; });
}

// One octree only; what its patch cannot close the next ones do.
TEST(Constructions, AFoldAtARim) {
  int done = 0, by_others = 0;
  for (const TriangleMesh& mesh : test::folded_meshes(100)) {
    if (by_others >= 2) break;
    if (!make_divisible(mesh, build_topology(mesh), InputNeighbourhood(mesh)) || folded_on_rims(mesh))
      continue;
    AtomicVolumesOptions options;
    options.shifts = 1;
    const AtomicVolumesResult result = fill_by_atomic_volumes(mesh, {}, options);
    const CompletionReport& report = result.completion.report;
    ASSERT_EQ(report.holes.size(), 1u);
    EXPECT_EQ(report.holes[0].outcome, HoleOutcome::closed) << report.holes[0].reason;
    expect_passed(mesh, result.completion.patch);
    const test::Shape shape = test::shape_of(test::with_patch(mesh, result.completion.patch).triangles);
    EXPECT_TRUE(shape.manifold);
    EXPECT_EQ(shape.euler, 2);
    ++done;
    by_others += tried_others(report);
  }
  EXPECT_GT(done, 5);
  EXPECT_EQ(by_others, 2);
}

// The number of faces bridges the gap between a hole that was selected and one that was not; the least area
// does not. With the last two seeds the second octree after that bridges it by any weight, so that the first
// one has to be cut by the least area already.
TEST(Constructions, OneOfTwoHolesThatOnePatchWouldClose) {
  const TriangleMesh mesh = test::two_caps(2, 0.5);
  MeshSelection upper;
  for (const Vector3& p : mesh.vertices) upper.vertices.push_back(p.z() > 0);
  for (std::uint64_t seed : {1, 2, 17, 37}) {
    AtomicVolumesOptions options = with_seed(seed);
    options.holes.selected_only = true;
    options.weight = CutWeight::unit;
    options.shifts = 1;
    options.remesh = false;
    options.fairing.reset();
    const CompletionReport report = fill_by_atomic_volumes(mesh, upper, options).completion.report;
    EXPECT_TRUE(tried_others(report)) << "one patch would close both";
    EXPECT_EQ(report.count(HoleOutcome::closed), 1u) << "seed " << seed;
    EXPECT_EQ(report.count(HoleOutcome::skipped), 1u);
  }
}

// A vertex beside one rim is pushed through a face there, so that space round this rim cannot be divided. The
// other rim has no part in that once its patch no longer bridges the gap.
TEST(Constructions, AHoleWhosePatchWouldReachOneThatCannotBeClosed) {
  TriangleMesh mesh = test::two_caps(2, 0.5);
  constexpr Index next_to_rim = 8, beside = 5;
  mesh.vertices[next_to_rim] = as_stored(1.05 * test::middle_of(test::icosphere(2), beside));
  for (int shifts : {1, 3}) {
    AtomicVolumesOptions options;
    options.shifts = shifts;
    const CompletionReport report = fill_by_atomic_volumes(mesh, {}, options).completion.report;
    EXPECT_TRUE(tried_others(report));
    EXPECT_EQ(report.count(HoleOutcome::closed), 1u) << shifts;
    for (const HoleReport& hole : report.holes) {
      if (hole.outcome == HoleOutcome::closed) continue;
      EXPECT_NE(hole.reason.find("could not be divided"), std::string::npos) << hole.reason;
    }
  }
}

/// Two spheres, each with a hole, that touch in a vertex of both rims: two vertices at one position.
TriangleMesh touching_spheres() {
  const TriangleMesh first = test::sphere_with_hole(2, 0.6);
  TriangleMesh second = first;
  for (Vector3& p : second.vertices) p = -p;
  second = test::flipped(second);
  const Index rim = test::loops_of(first).at(0).vertices[0];
  second = test::translated(second, 2 * first.vertices[rim]);
  second.vertices[rim] = first.vertices[rim];
  return test::join(first, second);
}

TEST(Constructions, RimsThatTouchInAPosition) {
  const TriangleMesh mesh = touching_spheres();
  const MeshStatistics before = measure(mesh, true);
  ASSERT_EQ(before.duplicated_vertices, 1u);
  ASSERT_EQ(before.self_intersecting_pairs, 0u);
  for (std::uint64_t seed : seeds) {
    const Outcome outcome = complete(mesh, with_seed(seed));
    // Two lids or a band.
    EXPECT_EQ(outcome.genera, Genera(outcome.loops_of_holes.size(), 0));
    EXPECT_EQ(std::accumulate(outcome.loops_of_holes.begin(), outcome.loops_of_holes.end(), 0u), 2u);
  }
}

// The two vertices at the pole would have to become one: nothing is done, and the reason is told.
TEST(Constructions, VerticesThatAPatchWouldHaveToJoin) {
  const test::SplitPole pole;
  const AtomicVolumesResult result = fill_by_atomic_volumes(pole.mesh, {}, {});
  ASSERT_EQ(result.completion.report.holes.size(), 1u);
  const HoleReport& hole = result.completion.report.holes[0];
  EXPECT_EQ(hole.outcome, HoleOutcome::failed);
  EXPECT_NE(hole.reason.find("Merge Close Vertices"), std::string::npos) << hole.reason;
  EXPECT_TRUE(result.completion.patch.empty());
}

// A sphere in two halves whose rims lie on each other: there is nothing to be filled.
TEST(Constructions, RimsThatLieOnEachOther) {
  const TriangleMesh sphere = test::icosphere(2);
  const auto half = [&](bool upper) {
    return test::without_faces(sphere,
                               [&](Index f) { return (test::middle_of(sphere, f).z() > 0) != upper; });
  };
  const TriangleMesh halves = test::join(half(true), half(false));
  const TriangleMesh hole = test::translated(test::sphere_with_hole(2, 0.6), Vector3(3, 0, 0));
  const AtomicVolumesResult result = fill_by_atomic_volumes(test::join(halves, hole), {}, {});
  const std::vector<HoleReport>& holes = result.completion.report.holes;
  ASSERT_EQ(holes.size(), 3u);
  for (std::size_t i : {0u, 1u}) {
    EXPECT_EQ(holes[i].outcome, HoleOutcome::failed);
    EXPECT_NE(holes[i].reason.find("edges of this rim lie on each other"), std::string::npos)
        << holes[i].reason;
  }
  EXPECT_EQ(holes[2].outcome, HoleOutcome::closed) << holes[2].reason;
}

// A second sheet all but on the first one, far from the rim: no cubes are wasted on it.
TEST(Constructions, SheetsOnEachOtherFarFromTheRim) {
  const TriangleMesh cubes = test::join(test::cube(0.5, Vector3(1.5, 0, 0)),
                                        test::cube(0.25, Vector3(1.75 - 0x1p-19, 0.125, 0.125)));
  const TriangleMesh mesh = test::join(test::sphere_with_hole(3, 0.6), cubes);
  AtomicVolumesOptions options;
  options.node_budget = 30000;
  const AtomicVolumesResult result = fill_by_atomic_volumes(mesh, {}, options);
  EXPECT_EQ(result.completion.report.count(HoleOutcome::closed), 1u);
  EXPECT_LT(result.figures.leaves, 10000u);
}

// Two faces with an edge on the rim go through each other: no division of space tells their sides apart, but
// the one triangle that the rim has is clean.
TEST(Constructions, ARimOfThreeEdgesInAFoldGetsItsTriangle) {
  TriangleMesh mesh = test::icosphere(2);
  const auto [a, b, c] = mesh.triangles.back();
  mesh.triangles.pop_back();
  const auto beyond = [&](Index from, Index to) {
    for (const Triangle& t : mesh.triangles)
      for (int k = 0; k < 3; ++k)
        if (t[k] == to && t[(k + 1) % 3] == from) return t[(k + 2) % 3];
    return Index{0};
  };
  const Index p = beyond(a, b), r = beyond(c, a);
  mesh.vertices[p] = 0.5 * (mesh.vertices[c] + mesh.vertices[r]) * 1.02;
  const auto corners = [&](Index i, Index j, Index k) {
    return std::array<Vector3, 3>{mesh.vertices[i], mesh.vertices[j], mesh.vertices[k]};
  };
  ASSERT_TRUE(meet_improperly(corners(b, a, p), corners(a, c, r)));
  const AtomicVolumesResult result = fill_by_atomic_volumes(mesh, {}, {});
  ASSERT_EQ(result.completion.report.holes.size(), 1u);
  const HoleReport& hole = result.completion.report.holes.front();
  EXPECT_EQ(hole.outcome, HoleOutcome::closed) << hole.reason;
  EXPECT_EQ(hole.route, "one triangle");
  ASSERT_EQ(result.completion.patch.triangles.size(), 1u);
  expect_passed(mesh, result.completion.patch);
}

// Far from the origin floats are coarse: cubes, and the edges of patches between them, come out finer than
// what can be stored.
TEST(Constructions, HolesFarFromTheOrigin) {
  TriangleMesh mesh = test::sphere_with_holes(3);
  for (Vector3& p : mesh.vertices) p = as_stored(p + Vector3(3000, -5000, 4000));
  int moved = 0;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    AtomicVolumesOptions options = with_seed(seed);
    options.shifts = 1;
    EXPECT_EQ(complete(mesh, options).genera, Genera{0}) << "seed " << seed;
    moved += fill_by_atomic_volumes(mesh, {}, options).figures.restarts;
  }
  EXPECT_GT(moved, 0) << "some octrees are too fine";
}

// Further away the edges of cubes themselves are as short as the steps between floats, and nothing comes
// after the cubes that would make them longer.
TEST(Constructions, SurfacesOfCubesVeryFarFromTheOrigin) {
  TriangleMesh mesh = test::sphere_with_holes(1);
  for (Vector3& p : mesh.vertices) p = as_stored(p + 100000 * Vector3(0.6, -1, 0.8));
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    AtomicVolumesOptions options = with_seed(seed);
    options.shifts = 1;
    options.remesh = false;
    options.fairing.reset();
    EXPECT_EQ(complete(mesh, options).genera, Genera{0}) << "seed " << seed;
  }
}

}  // namespace
}  // namespace meshcomplete
