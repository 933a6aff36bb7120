// What must hold for every mesh: the input is left alone, patches are sound, and the answer does not depend
// on where the mesh lies, how its elements are numbered or how many threads there are.
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <ostream>
#include <random>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "common/core/error.h"
#include "common/core/patch_check.h"
#include "common/core/triangle_intersection.h"
#include "filter_curveunfold/curve_unfolding.h"
#include "filter_volmorph/triangle_fan.h"
#include "tests/support/loop_families.h"
#include "tests/support/meshes.h"
#include "tests/support/patches.h"

namespace meshcomplete {
namespace {

using test::loops_of;
using test::with_patch;

// --- the families
// --------------------------------------------------------------------------------------------------

/// A mesh with something that a filter can trip over.
struct Family {
  const char* name;
  std::function<TriangleMesh()> make;
  std::optional<std::size_t> closed;  ///< how many of its boundary loops get a patch; absent: some, none, all
  std::optional<std::size_t> fans = closed;  ///< the same for triangle fans
};

/// A rim that winds twice round its axis before it closes: no plane shows it as a simple polygon.
TriangleMesh wound_collar() {
  std::vector<Vector3> rim, outer;
  for (const Vector3& p : testing::wound_rim(20, 2)) rim.push_back(as_stored(p));
  for (const Vector3& p : rim) outer.push_back(as_stored(p + Vector3(0, 0, -0.02)));
  return test::collar(rim, outer);
}

/// A rim that rises and falls three times.
TriangleMesh wavy_collar() {
  std::vector<Vector3> rim, outer;
  for (const Vector3& p : testing::saddle(48, 3, 0.4)) rim.push_back(as_stored(p));
  for (const Vector3& p : rim) outer.push_back(as_stored(p + Vector3(0, 0, -1)));
  return test::collar(rim, outer);
}

/// Two pairs of faces that touch at two vertices. The only patch for either of them joins these vertices, so
/// that a patch for each would make an edge with four faces.
TriangleMesh two_tents() {
  return {{Vector3(-1, 0, 0), Vector3(1, 0, 0), Vector3(0, 1, 1), Vector3(0, 1, -1), Vector3(0, -1, 1),
           Vector3(0, -1, -1)},
          {{0, 2, 3}, {1, 3, 2}, {0, 5, 4}, {1, 4, 5}}};
}

TriangleMesh two_components() {
  return test::join(test::sphere_with_holes(3, 2),
                    test::translated(test::sphere_with_hole(2), Vector3(2.5, 0, 0)));
}

TriangleMesh noisy_rim() { return test::without_ball(test::rough_sphere(3, 0.1, 3), Vector3(0, 0, 1), 0.6); }

TriangleMesh torus_with_hole() { return test::without_ball(test::torus(24, 12), Vector3(1.4, 0, 0), 0.4); }

const std::vector<Family>& families() {
  static const std::vector<Family> list = {
      {"closed", [] { return test::icosphere(2); }, 0},
      {"one_hole", [] { return test::sphere_with_hole(3, 0.5); }, 1},
      {"six_holes", [] { return test::sphere_with_holes(6, 3, 0.3); }, 6},
      {"torus_with_hole", torus_with_hole, 1},
      {"cylinder", [] { return test::open_cylinder(24, 8); }, 2},
      {"island", [] { return test::sphere_with_island(3); }, 1},
      {"two_components", two_components, 4},
      {"noisy_rim", noisy_rim, 1},
      {"wavy_collar", wavy_collar, 2},
      {"wound_collar", wound_collar, std::nullopt, 0},
      {"two_tents", two_tents, std::nullopt, 2},
      {"touching_holes", [] { return test::sphere_with_touching_holes(); }, 2},
      {"ragged_holes", [] { return test::rough_sphere_with_ragged_holes(3, 4, 7); }, 3, 1},
      {"rough_sheet", [] { return test::rough_sheet(14, 14, 0.3, 3, 5); }, 2, 1},
      {"flat_grid", [] { return test::flat_grid(4, 3); }, 0},
      {"fin", [] { return test::sphere_with_hole_and_fin(); }, 1},
      {"book", [] { return test::book(); }, 0},
      {"moebius_strip", [] { return test::moebius_strip(); }, 0},
      {"isolated_triangle", [] { return test::isolated_triangle(); }, 0},
      {"unwelded", [] { return test::unwelded(test::sphere_with_hole(1)); }, 0},
      {"far_from_origin", [] { return test::translated(test::sphere_with_hole(), Vector3(1000, -500, 200)); },
       1},
      {"no_faces",
       [] {
         return TriangleMesh{{Vector3(1, 2, 3)}, {}};
       },
       0},
      {"nothing", [] { return TriangleMesh(); }, 0},
  };
  return list;
}

// --- what is compared
// ----------------------------------------------------------------------------------------------

using Closing = std::function<Completion(const TriangleMesh& mesh, const Progress& progress)>;

Completion by_curves(const TriangleMesh& mesh, const Progress& progress) {
  return fill_by_curve_unfolding(mesh, MeshSelection(), CurveUnfoldingOptions(), progress).completion;
}

Completion by_fans(const TriangleMesh& mesh, const Progress& progress) {
  return close_by_fans(mesh, MeshSelection(), TriangleFanOptions(), progress);
}

/// A family, a filter that closes each hole for itself, and how many it closes.
struct Case {
  std::string name;
  std::function<TriangleMesh()> make;
  std::optional<std::size_t> closed;
  Closing close;

  Completion fill(const TriangleMesh& mesh, const Progress& progress = Progress()) const {
    return close(mesh, progress);
  }
};

void PrintTo(const Case& param, std::ostream* out) { *out << param.name; }

std::vector<Case> cases(const std::vector<Family>& families) {
  std::vector<Case> list;
  for (const Family& family : families) {
    list.push_back({family.name, family.make, family.closed, by_curves});
    list.push_back({std::string(family.name) + "_fan", family.make, family.fans, by_fans});
  }
  return list;
}

std::size_t closed_holes(const Completion& result) { return result.report.count(HoleOutcome::closed); }

std::string what_happened(const Completion& result) {
  std::string text;
  for (const HoleReport& hole : result.report.holes)
    text +=
        std::to_string(hole.edges) + " edges: " + name(hole.outcome) + ", " + hole.route + hole.reason + "\n";
  return text;
}

bool same(const TriangleMesh& a, const TriangleMesh& b) {
  return a.vertices == b.vertices && a.triangles == b.triangles;
}

/// What became of each hole, whatever the order: edges, outcome, and why it was skipped. (Why the last try
/// for a hole failed, after many others, may depend on the rounding.)
using Fate = std::tuple<std::size_t, HoleOutcome, std::string>;
std::vector<Fate> fates(const Completion& result) {
  std::vector<Fate> list;
  for (const HoleReport& hole : result.report.holes)
    list.emplace_back(hole.edges, hole.outcome,
                      hole.outcome == HoleOutcome::skipped ? hole.reason : std::string());
  std::sort(list.begin(), list.end());
  return list;
}

/// How far apart two patches with the same triangles are; infinite when the triangles differ.
double distance(const Patch& a, const Patch& b) {
  if (a.triangles != b.triangles || a.vertices.size() != b.vertices.size())
    return std::numeric_limits<double>::infinity();
  double greatest = 0;
  for (std::size_t i = 0; i < a.vertices.size(); ++i)
    greatest = std::max(greatest, (a.vertices[i] - b.vertices[i]).norm());
  return greatest;
}

TriangleMesh transformed(TriangleMesh mesh, const std::function<Vector3(const Vector3&)>& map) {
  for (Vector3& p : mesh.vertices) p = map(p);
  return mesh;
}

/// Coordinates rounded to multiples of 2^-12, so that moving the mesh by whole numbers up to 2000 is exact.
TriangleMesh on_coarse_grid(const TriangleMesh& mesh) {
  return transformed(mesh, [](const Vector3& p) { return Vector3((p * 4096).array().round() / 4096); });
}

class CompletionProperty : public ::testing::TestWithParam<Case> {};

/// What takes many runs on one mesh: without the family for which every way is tried in vain.
class CompletionInvariance : public CompletionProperty {};

std::vector<Family> quick_families() {
  std::vector<Family> list = families();
  list.erase(std::remove_if(list.begin(), list.end(),
                            [](const Family& family) { return std::string(family.name) == "wound_collar"; }),
             list.end());
  return list;
}

std::string name_of(const ::testing::TestParamInfo<Case>& info) { return info.param.name; }

INSTANTIATE_TEST_SUITE_P(Families, CompletionProperty, ::testing::ValuesIn(cases(families())), name_of);
INSTANTIATE_TEST_SUITE_P(Families, CompletionInvariance, ::testing::ValuesIn(cases(quick_families())),
                         name_of);

// --- the result
// ----------------------------------------------------------------------------------------------------

TEST_P(CompletionProperty, PatchIsSoundAndInputIsLeftAlone) {
  const TriangleMesh mesh = GetParam().make();
  const TriangleMesh before = mesh;
  const Completion result = GetParam().fill(mesh);
  EXPECT_TRUE(same(mesh, before));
  EXPECT_EQ(closed_holes(result), GetParam().closed.value_or(closed_holes(result))) << what_happened(result);

  // The loops with their holes closed: the report is in their order.
  const std::vector<BoundaryLoop> loops = loops_of(mesh);
  const std::vector<HoleReport>& holes = result.report.holes;
  ASSERT_EQ(holes.size(), loops.size());
  std::vector<const BoundaryLoop*> rims;
  std::size_t vertices = 0, faces = 0;
  for (std::size_t i = 0; i < loops.size(); ++i) {
    EXPECT_EQ(holes[i].edges, loops[i].faces.size());
    EXPECT_EQ(holes[i].reason.empty(), holes[i].outcome == HoleOutcome::closed) << holes[i].reason;
    EXPECT_EQ(holes[i].faces_added > 0, holes[i].outcome == HoleOutcome::closed);
    if (holes[i].outcome == HoleOutcome::closed) rims.push_back(&loops[i]);
    vertices += holes[i].vertices_added;
    faces += holes[i].faces_added;
  }
  const Patch& patch = result.patch;
  EXPECT_EQ(patch.input_vertices, mesh.vertices.size());
  EXPECT_EQ(patch.vertices.size(), vertices);
  EXPECT_EQ(patch.triangles.size(), faces);
  for (const Vector3& p : patch.vertices) EXPECT_EQ(p, as_stored(p));

  if (patch.empty()) return;
  const PatchCheck check = check_patch(InputNeighbourhood(mesh), patch, rims);
  EXPECT_TRUE(check.passed()) << describe(check.defect);
  // Counted anew, without the check: no pair of faces meets that did not meet before.
  EXPECT_EQ(count_improper_pairs(test::corners_of(with_patch(mesh, patch))),
            count_improper_pairs(test::corners_of(mesh)));
}

TEST_P(CompletionProperty, SecondRunFindsNothingToDo) {
  const TriangleMesh mesh = GetParam().make();
  const Completion first = GetParam().fill(mesh);
  const Completion second = GetParam().fill(with_patch(mesh, first.patch));
  EXPECT_TRUE(second.patch.empty());
  std::vector<Fate> open = fates(first);
  open.erase(std::remove_if(open.begin(), open.end(),
                            [](const Fate& fate) { return std::get<1>(fate) == HoleOutcome::closed; }),
             open.end());
  EXPECT_EQ(fates(second), open);
}

// --- what must not matter
// ------------------------------------------------------------------------------------------

TEST_P(CompletionProperty, ThreadsDoNotMatter) {
  const TriangleMesh mesh = GetParam().make();
  const auto with_threads = [&](std::size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    return GetParam().fill(mesh);
  };
  const Completion one = with_threads(1), two = with_threads(2);
  EXPECT_EQ(distance(one.patch, two.patch), 0);
  EXPECT_EQ(fates(one), fates(two));
}

TEST_P(CompletionInvariance, ScalingByPowersOfTwoIsExact) {
  const TriangleMesh mesh = GetParam().make();
  const Completion plain = GetParam().fill(mesh);
  for (const double factor : {0x1p-12, 0x1p10}) {
    Completion scaled = GetParam().fill(test::scaled(mesh, factor));
    for (Vector3& p : scaled.patch.vertices) p /= factor;
    EXPECT_EQ(distance(plain.patch, scaled.patch), 0) << factor;
    EXPECT_EQ(fates(plain), fates(scaled)) << factor;
  }
}

TEST_P(CompletionInvariance, MovingChangesNothingButTheRounding) {
  const TriangleMesh mesh = on_coarse_grid(GetParam().make());
  const Completion plain = GetParam().fill(mesh);
  for (const Vector3& offset : {Vector3(17, -5, 3), Vector3(-1024, 512, 0)}) {
    const Completion moved =
        GetParam().fill(transformed(mesh, [&](const Vector3& p) { return Vector3(p + offset); }));
    EXPECT_EQ(fates(plain), fates(moved)) << offset.transpose();
    Patch expected = plain.patch;
    for (Vector3& p : expected.vertices) p = as_stored(p + offset);
    // The new place is rounded to floats, and so was the old one.
    const double spacing = std::ldexp(1.0, std::ilogb(offset.cwiseAbs().maxCoeff() + 2) - 23);
    EXPECT_LE(distance(expected, moved.patch), 2 * spacing) << offset.transpose();
  }
}

TEST_P(CompletionInvariance, QuarterTurnsKeepEveryFate) {
  const TriangleMesh mesh = GetParam().make();
  const Completion plain = GetParam().fill(mesh);
  const std::vector<std::function<Vector3(const Vector3&)>> turns = {
      [](const Vector3& p) { return Vector3(-p.y(), p.x(), p.z()); },
      [](const Vector3& p) { return Vector3(p.x(), -p.z(), p.y()); },
      [](const Vector3& p) { return Vector3(p.z(), p.y(), -p.x()); },
  };
  for (const auto& turn : turns) {
    const Completion turned = GetParam().fill(transformed(mesh, turn));
    EXPECT_EQ(fates(plain), fates(turned)) << what_happened(plain) << what_happened(turned);
    // The sums are rounded differently, and ties (test meshes are symmetric) broken differently.
    const double faces = static_cast<double>(plain.patch.triangles.size());
    EXPECT_NEAR(static_cast<double>(turned.patch.triangles.size()), faces, 0.1 * faces + 4);
  }
}

TEST_P(CompletionInvariance, NumberingDoesNotMatter) {
  const TriangleMesh mesh = GetParam().make();
  const Completion plain = GetParam().fill(mesh);
  for (const std::uint32_t seed : {1u, 2u})
    EXPECT_EQ(fates(plain), fates(GetParam().fill(test::shuffled(mesh, seed)))) << seed;
}

// --- cancelling
// ----------------------------------------------------------------------------------------------------

TEST_P(CompletionProperty, CancellingThrowsAndLeavesNothingBehind) {
  const TriangleMesh mesh = GetParam().make();
  const TriangleMesh before = mesh;
  const Completion whole = GetParam().fill(mesh);
  int calls = 0;
  GetParam().fill(mesh, Progress([&](double, const std::string&) { return ++calls, true; }));
  ASSERT_GE(calls, 1);
  std::mt19937 random(11);
  for (int round = 0; round < 3; ++round) {
    const int last = round == 0 ? 1 : 1 + static_cast<int>(random() % static_cast<unsigned>(calls));
    int count = 0;
    bool asked = false, thrown = false;
    try {
      GetParam().fill(mesh, Progress([&](double, const std::string&) {
                        asked = ++count >= last;  // how often the receiver is called depends on the clock
                        return !asked;
                      }));
    } catch (const Cancelled&) {
      thrown = true;
    }
    EXPECT_EQ(thrown, asked) << "call " << last << " of " << calls;
    EXPECT_LE(count, last);
    EXPECT_TRUE(same(mesh, before));
  }
  EXPECT_EQ(distance(GetParam().fill(mesh).patch, whole.patch), 0);
}

// --- options
// -------------------------------------------------------------------------------------------------------

TEST(CompletionOptions, OutOfRangeIsRefusedWithAMessage) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  const std::vector<std::pair<const char*, std::function<void(CurveUnfoldingOptions&)>>> wrong = {
      {"edge length 0", [](auto& o) { o.edge_length = 0; }},
      {"edge length negative", [](auto& o) { o.edge_length = -1; }},
      {"edge length not a number", [=](auto& o) { o.edge_length = nan; }},
      {"edge length infinite", [=](auto& o) { o.edge_length = infinity; }},
      {"no restarts", [](auto& o) { o.unfolding.restarts = 0; }},
      {"too many restarts", [](auto& o) { o.unfolding.restarts = 10001; }},
      {"least distance 0", [](auto& o) { o.unfolding.min_distance = 0; }},
      {"least distance too large", [](auto& o) { o.unfolding.min_distance = 0.1; }},
      {"least distance not a number", [=](auto& o) { o.unfolding.min_distance = nan; }},
      {"cooling 0", [](auto& o) { o.unfolding.cooling = 0; }},
      {"cooling 1", [](auto& o) { o.unfolding.cooling = 1; }},
      {"cooling not a number", [=](auto& o) { o.unfolding.cooling = nan; }},
      {"temperature 0", [](auto& o) { o.unfolding.start_temperature = 0; }},
      {"temperature not a number", [=](auto& o) { o.unfolding.start_temperature = nan; }},
      {"temperature infinite", [=](auto& o) { o.unfolding.start_temperature = infinity; }},
      {"two edges", [](auto& o) { o.holes.max_edges = 2; }},
      {"perimeter 0", [](auto& o) { o.holes.max_perimeter = 0; }},
      {"perimeter not a number", [=](auto& o) { o.holes.max_perimeter = nan; }},
      {"selected, with nothing selected", [](auto& o) { o.holes.selected_only = true; }},
  };
  const TriangleMesh mesh = test::sphere_with_hole(1);
  for (const auto& [what, spoil] : wrong) {
    CurveUnfoldingOptions options;
    spoil(options);
    try {
      fill_by_curve_unfolding(mesh, MeshSelection(), options);
      ADD_FAILURE() << what << " was taken";
    } catch (const CompletionError& error) {
      EXPECT_FALSE(std::string(error.what()).empty()) << what;
      EXPECT_FALSE(error.stage().empty()) << what;
    }
  }
}

}  // namespace
}  // namespace meshcomplete
