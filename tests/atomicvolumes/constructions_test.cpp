// The constructions of the paper, completed by the whole filter with its defaults.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "common/core/mesh_statistics.h"
#include "common/core/patch_check.h"
#include "filter_atomicvolumes/atomic_volumes.h"
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
  test::Sets sets(vertices);
  for (const Triangle& t : triangles)
    for (int k = 1; k < 3; ++k) sets.join(t[0], t[k]);
  std::map<Index, std::vector<Triangle>> parts;
  for (const Triangle& t : triangles) parts[sets.root(t[0])].push_back(t);
  std::vector<std::vector<Triangle>> list;
  for (auto& part : parts) list.push_back(std::move(part.second));
  return list;
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
  const std::vector<BoundaryLoop> loops = test::loops_of(mesh);
  const PatchCheck check =
      check_patch(InputNeighbourhood(mesh), result.completion.patch, test::pointers(loops));
  EXPECT_TRUE(check.passed()) << describe(check.defect);
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

// Figure 1: the pipe's ends are closed by themselves, and the two openings of the sphere by one tunnel round
// the pipe.
TEST(Constructions, PiercedSphere) {
  for (std::uint64_t seed : seeds) {
    AtomicVolumesOptions options;
    options.seed = seed;
    const Outcome outcome = complete(test::pierced_sphere(), options);
    EXPECT_EQ(outcome.genera, (Genera{0, 1})) << "pipe and sphere";
    EXPECT_EQ(outcome.loops_of_holes, (Loops{1, 1, 2}));
  }
}

// Figure 2: two discs, or with points outside a ring.
TEST(Constructions, OuterHalfOfATorus) {
  for (std::uint64_t seed : seeds) {
    AtomicVolumesOptions options;
    options.seed = seed;
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
  for (std::uint64_t seed : seeds) {
    AtomicVolumesOptions options;
    options.seed = seed;
    const Outcome outcome = complete(test::spiral_torus(), options);
    EXPECT_EQ(outcome.genera, Genera{1});
    EXPECT_EQ(outcome.loops_of_holes, Loops{2});
  }
}

// Figure 11: a handle, and none with points outside in the gap.
TEST(Constructions, LumpsWithAndWithoutAHandle) {
  for (std::uint64_t seed : seeds) {
    AtomicVolumesOptions options;
    options.seed = seed;
    const Outcome handle = complete(test::lumps(), options);
    EXPECT_EQ(handle.genera, Genera{1});
    EXPECT_EQ(handle.loops_of_holes, Loops{2});
    options.constraints.outside = test::points_in_gap();
    const Outcome caps = complete(test::lumps(), options);
    EXPECT_EQ(caps.genera, Genera{0});
    EXPECT_EQ(caps.loops_of_holes, (Loops{1, 1}));
  }
}

// The less areas count, the wider the gap that is bridged.
TEST(Constructions, TheWeightDecidesHowWideAGapIsBridged) {
  AtomicVolumesOptions options;
  const TriangleMesh mesh = test::torus_without_arc(-24, 24);
  EXPECT_EQ(complete(mesh, options).genera, Genera{1});
  options.weight = CutWeight::area;
  EXPECT_EQ(complete(mesh, options).genera, Genera{0});
}

}  // namespace
}  // namespace meshcomplete
