#include "common/core/guarded_patch.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "common/core/patch.h"
#include "common/core/rim.h"
#include "common/core/triangle_intersection.h"
#include "tests/support/meshes.h"
#include "tests/support/patches.h"

namespace meshcomplete {
namespace {

using Corners = std::array<Vector3, 3>;

Corners corners_of(const PatchMesh& patch, Index triangle) {
  const Triangle& t = patch.triangles()[triangle];
  return {patch.position(t[0]), patch.position(t[1]), patch.position(t[2])};
}

/// A rough sphere with a hole, the cap that was cut out of it as its patch, and something else nearby.
struct Scene {
  TriangleMesh mesh;
  BoundaryLoop loop;
  InputNeighbourhood input;
  ForbiddenEdges forbidden;
  std::vector<Corners> obstacles;
  PatchMesh patch;

  /// With `steiner` every edge of the rim is divided in the patch; its middle is exact in doubles.
  Scene(const test::CutOut& cut, bool steiner)
      : mesh(cut.mesh),
        loop(test::loops_of(mesh).at(0)),
        input(mesh),
        forbidden(collect_rim(mesh, build_topology(mesh), loop).forbidden),
        patch(editable(cut.patch, steiner)) {
    for (const Vector3& at : {Vector3(0.1, 0.05, 1.15), Vector3(-0.15, 0.1, 0.8), Vector3(0, -0.2, 1.1)})
      obstacles.push_back({at, at + Vector3(0.1, 0.02, 0.03), at + Vector3(0.02, 0.1, -0.04)});
  }

  /// A patch by itself, and a mesh far away.
  explicit Scene(PatchMesh open)
      : mesh(test::translated(test::tetrahedron(), Vector3(100, 0, 0))),
        input(mesh),
        patch(std::move(open)) {}

  PatchMesh editable(const Patch& cap, bool steiner) const {
    std::map<Index, Index> number;
    std::vector<Vector3> positions;
    for (Index v : loop.vertices) {
      number[v] = static_cast<Index>(positions.size());
      positions.push_back(mesh.vertices[v]);
    }
    const Index rim = static_cast<Index>(positions.size());
    for (Index i = 0; i < cap.vertices.size(); ++i) {
      number[cap.input_vertices + i] = static_cast<Index>(positions.size());
      positions.push_back(cap.vertices[i]);
    }
    std::vector<Triangle> triangles;
    for (Triangle t : cap.triangles) {
      for (Index& v : t) v = number.at(v);
      std::optional<std::size_t> at_rim;
      for (std::size_t k = 0; k < 3; ++k)
        if (t[k] < rim && t[(k + 1) % 3] == (t[k] + 1) % rim) at_rim = k;
      if (!steiner || !at_rim) {
        triangles.push_back(t);
        continue;
      }
      const Index a = t[*at_rim], b = t[(*at_rim + 1) % 3], c = t[(*at_rim + 2) % 3];
      const Index middle = static_cast<Index>(positions.size());
      positions.push_back(0.5 * (positions[a] + positions[b]));
      triangles.push_back({a, middle, c});
      triangles.push_back({middle, b, c});
    }
    return PatchMesh(positions, rim, triangles);
  }

  GuardedPatch guard() {
    GuardedPatch guarded(patch, input, forbidden, obstacles);
    for (const auto& [vertex, face] : resting()) guarded.rest(vertex, face);
    return guarded;
  }

  /// Steiner points, and the face on whose side each lies.
  std::map<Index, Index> resting() const {
    std::map<Index, Index> faces;
    const Index rim = static_cast<Index>(patch.rim_size());
    for (Index v = rim; v < patch.vertex_count(); ++v)
      for (Index i = 0; i < rim; ++i)
        if (patch.position(v) == 0.5 * (patch.position(i) + patch.position((i + 1) % rim)))
          faces[v] = loop.faces[i];
    return faces;
  }

  bool is_free(const PatchMesh& edited, Index triangle, const std::map<Index, Index>& rests) const {
    const Corners one = corners_of(edited, triangle);
    if (collinear(one[0], one[1], one[2])) return false;
    for (Index t = 0; t < edited.triangle_count(); ++t)
      if (edited.alive(t) && t != triangle && meet_improperly(one, corners_of(edited, t))) return false;
    for (const Corners& obstacle : obstacles)
      if (meet_improperly(one, obstacle)) return false;
    for (Index t = 0; t < mesh.triangles.size(); ++t) {
      bool ignored = false;
      for (Index v : edited.triangles()[triangle]) {
        const auto at = rests.find(v);
        ignored |= at != rests.end() && at->second == t;
      }
      const Triangle& f = mesh.triangles[t];
      if (!ignored && meet_improperly(one, {mesh.vertices[f[0]], mesh.vertices[f[1]], mesh.vertices[f[2]]}))
        return false;
    }
    return true;
  }

  bool is_forbidden(Index a, Index b) const {
    return std::binary_search(forbidden.begin(), forbidden.end(),
                              std::make_pair(std::min(a, b), std::max(a, b)));
  }

  /// Whether every triangle of `edited` that the patch did not have is free, and no edge is forbidden.
  bool allows(const PatchMesh& edited, const std::map<Index, Index>& rests) const {
    for (Index t = 0; t < edited.triangle_count(); ++t) {
      if (!edited.alive(t)) continue;
      const bool old =
          t < patch.triangle_count() && patch.alive(t) && corners_of(edited, t) == corners_of(patch, t);
      if (!old && !is_free(edited, t, rests)) return false;
      for (Index h = 3 * t; h < 3 * t + 3; ++h)
        if (!edited.is_boundary(h) && edited.on_rim(edited.origin(h)) && edited.on_rim(edited.target(h)) &&
            is_forbidden(edited.origin(h), edited.target(h)))
          return false;
    }
    return true;
  }
};

struct Step {
  char kind = 'm';  // move, split, flip, collapse, boundary collapse, triangle at the boundary, ear
  Index at = 0;     // vertex or half-edge
  Vector3 to = Vector3::Zero();
  bool onto_target = true;
};

Step random_step(const PatchMesh& patch, std::mt19937& random, double wildness = 1) {
  const auto uniform = [&] { return random() * 0x1p-32; };
  Step step;
  step.kind = "mmssfcbbte"[random() % 10];
  // Boundary edges are few: those steps look for one.
  do {
    step.at = static_cast<Index>(random() % (3 * patch.triangle_count()));
  } while (!patch.alive(step.at / 3) || (std::string("bte").find(step.kind) != std::string::npos &&
                                         !patch.is_boundary(step.at) && random() % 500 != 0));
  const Vector3& a = patch.position(patch.origin(step.at));
  const Vector3& b = patch.position(patch.target(step.at));
  const double reach = (b - a).norm() * wildness * (random() % 4 == 0 ? 2.0 : 0.3);
  const Vector3 offset = reach * Vector3(uniform() - 0.5, uniform() - 0.5, uniform() - 0.5);
  step.onto_target = random() % 2 == 0;
  if (step.kind == 's') step.to = 0.5 * (a + b) + offset;
  if (step.kind == 'm' || step.kind == 't' || step.kind == 'e') {
    step.at = patch.origin(step.at);
    step.to = a + offset;
  }
  return step;
}

/// Makes the step without any guard; false when the patch would not be a manifold.
bool make(PatchMesh& patch, const Step& step) {
  switch (step.kind) {
    case 'm':
      if (patch.on_rim(step.at)) return false;
      patch.move(step.at, as_stored(step.to));
      return true;
    case 's':
      if (patch.is_boundary(step.at)) return false;
      patch.split(step.at, as_stored(step.to));
      return true;
    case 'f':
      if (!can_flip(patch, step.at, {})) return false;
      patch.flip(step.at);
      return true;
    case 'c':
      if (!patch.can_collapse(step.at)) return false;
      patch.collapse(step.at);
      return true;
    case 't':
      if (!patch.can_fill_at_boundary(step.at)) return false;
      patch.move(step.at, as_stored(step.to));
      patch.fill_at_boundary(step.at);
      return true;
    case 'e':
      if (!patch.can_remove_ear(step.at)) return false;
      patch.remove_ear(step.at);
      return true;
    default:
      if (!patch.can_collapse_at_boundary(step.at, step.onto_target)) return false;
      patch.collapse_at_boundary(step.at, step.onto_target);
      return true;
  }
}

bool make(GuardedPatch& guarded, const Step& step) {
  switch (step.kind) {
    case 'm':
      return guarded.move(step.at, step.to);
    case 's':
      return guarded.split(step.at, step.to) != GuardedPatch::none;
    case 'f':
      return guarded.flip(step.at);
    case 'c':
      return guarded.collapse(step.at);
    case 't':
      return guarded.fill_at_boundary(step.at, step.to);
    case 'e':
      return guarded.remove_ear(step.at);
    default:
      return guarded.collapse_at_boundary(step.at, step.onto_target);
  }
}

void expect_same(const PatchMesh& a, const PatchMesh& b) {
  ASSERT_EQ(a.triangles(), b.triangles());
  ASSERT_EQ(a.positions(), b.positions());
  for (Index h = 0; h < 3 * a.triangle_count(); ++h)
    if (a.alive(h / 3)) {
      ASSERT_EQ(a.opposite(h), b.opposite(h));
    }
}

test::CutOut rough_cap(unsigned seed, double angle) {
  const TriangleMesh sphere = test::rough_sphere(3, 0.06, seed);
  return test::cut_out(sphere, [&](Index f) {
    Vector3 middle = Vector3::Zero();
    for (Index v : sphere.triangles[f]) middle += sphere.vertices[v];
    return middle.normalized().z() > std::cos(angle);
  });
}

/// Moves a vertex to just behind the middle of a triangle, or into it.
Step step_at(const PatchMesh& patch, Index triangle, std::mt19937& random) {
  Step step;
  do {
    step.at = static_cast<Index>(random() % patch.vertex_count());
  } while (!patch.vertex_alive(step.at));
  const Corners c = corners_of(patch, triangle);
  const double share = random() * 0x1p-32, other = (1 - share) * random() * 0x1p-32;
  const Vector3 aim = share * c[0] + other * c[1] + (1 - share - other) * c[2];
  step.to = patch.position(step.at) + 1.1 * (aim - patch.position(step.at));
  return step;
}

std::vector<Index> changed_triangles(const PatchMesh& before, const PatchMesh& after) {
  std::vector<Index> changed;
  for (Index t = 0; t < after.triangle_count(); ++t)
    if (after.alive(t) &&
        (t >= before.triangle_count() || !before.alive(t) || corners_of(before, t) != corners_of(after, t)))
      changed.push_back(t);
  return changed;
}

/// How many steps of each kind were made, refused by the guard, and impossible for a manifold.
using Counts = std::map<char, std::array<int, 3>>;

/// Each step is made just when a look at all triangles finds nothing in the way, and one that is refused
/// leaves everything as it was.
void expect_exact_answers(Scene& scene, std::mt19937& random, int steps, double wildness, Counts& counts) {
  GuardedPatch guarded = scene.guard();
  std::map<Index, Index> rests = scene.resting();
  std::vector<Index> changed;  // by the last step that was made: the next ones aim at them
  for (int i = 0; i < steps; ++i) {
    const Step step = changed.empty() || random() % 2 == 0
                          ? random_step(scene.patch, random, wildness)
                          : step_at(scene.patch, changed[random() % changed.size()], random);
    const PatchMesh before = scene.patch;
    PatchMesh edited = scene.patch;
    const bool manifold = make(edited, step);
    std::map<Index, Index> still = rests;
    if (step.kind == 't') still.erase(step.at);
    const bool allowed = manifold && scene.allows(edited, still);
    ASSERT_EQ(make(guarded, step), allowed) << "step " << i << " of kind " << step.kind;
    ASSERT_NO_FATAL_FAILURE(expect_same(scene.patch, allowed ? edited : before));
    ++counts[step.kind][allowed ? 0 : manifold ? 1 : 2];
    if (!allowed) continue;
    rests = still;
    changed = changed_triangles(before, scene.patch);
  }
}

TEST(GuardedPatch, RefusesExactlyWhatWouldMeetSomething) {
  Counts counts;
  for (unsigned seed = 1; seed <= 6; ++seed) {
    Scene scene(rough_cap(seed, 0.45), seed % 2 == 0);
    ASSERT_EQ(!scene.resting().empty(), seed % 2 == 0);
    std::mt19937 random(seed);
    ASSERT_NO_FATAL_FAILURE(expect_exact_answers(scene, random, 1000, 1, counts)) << "seed " << seed;
  }
  for (char kind : {'m', 's', 'f', 'c'}) {
    EXPECT_GT(counts[kind][0], 20) << kind;
    EXPECT_GT(counts[kind][1], 20) << kind;
  }
  for (char kind : {'b', 't'}) EXPECT_GT(counts[kind][0], 20) << kind;
  EXPECT_GT(counts['t'][1], 0);
}

/// A bumpy sheet; every other boundary vertex is on the rim.
PatchMesh open_sheet(unsigned seed) {
  const TriangleMesh sheet = test::rough_sheet(5, 5, 0.3, 0, seed);
  const std::vector<Index> outline = test::loops_of(sheet).at(0).vertices;
  std::vector<Index> number(sheet.vertices.size(), GuardedPatch::none);
  Index next = 0;
  for (std::size_t i = 0; i < outline.size(); i += 2) number[outline[i]] = next++;
  const Index rim = next;
  for (Index& n : number)
    if (n == GuardedPatch::none) n = next++;
  std::vector<Vector3> positions(number.size());
  for (std::size_t v = 0; v < number.size(); ++v) positions[number[v]] = sheet.vertices[v];
  std::vector<Triangle> triangles = sheet.triangles;
  for (Triangle& t : triangles)
    for (Index& v : t) v = number[v];
  return PatchMesh(positions, rim, triangles);
}

// Nothing is near but the patch itself, and steps lead far: what has been moved is in the way of what follows
// where it is now, and not where it was.
TEST(GuardedPatch, StepsAreInTheWayOfLaterOnes) {
  Counts counts;
  for (unsigned seed = 1; seed <= 30; ++seed) {
    Scene scene(open_sheet(seed));
    std::mt19937 random(seed);
    ASSERT_NO_FATAL_FAILURE(expect_exact_answers(scene, random, 1500, 4, counts)) << "seed " << seed;
  }
  for (char kind : {'m', 's', 'f', 'c', 'b', 't'}) {
    EXPECT_GT(counts[kind][0], 20) << kind;
    EXPECT_GT(counts[kind][1], 10) << kind;
  }
  EXPECT_GT(counts['e'][0], 20);
  EXPECT_EQ(counts['e'][1], 0) << "nothing is made that could meet anything";
}

TEST(GuardedPatch, KeepsACleanPatchClean) {
  for (unsigned seed = 1; seed <= 4; ++seed) {
    Scene scene(rough_cap(seed, 0.6), false);
    GuardedPatch guarded = scene.guard();
    std::mt19937 random(seed);
    int made = 0;
    for (int i = 0; i < 3000; ++i) made += make(guarded, random_step(scene.patch, random));
    EXPECT_GT(made, 500);
    for (Index t = 0; t < scene.patch.triangle_count(); ++t)
      if (scene.patch.alive(t)) {
        ASSERT_TRUE(guarded.is_clean(t));
      }
    PatchMesh compact = scene.patch;
    compact.compact();
    Patch patch;
    const Index rim = static_cast<Index>(compact.rim_size());
    patch.input_vertices = static_cast<Index>(scene.mesh.vertices.size());
    for (Index v = rim; v < compact.vertex_count(); ++v) patch.vertices.push_back(compact.position(v));
    for (Triangle t : compact.triangles()) {
      for (Index& v : t) v = v < rim ? scene.loop.vertices[v] : patch.input_vertices + v - rim;
      patch.triangles.push_back(t);
    }
    const PatchCheck check = check_patch(scene.input, patch, {&scene.loop});
    EXPECT_TRUE(check.passed()) << describe(check.defect);
  }
}

TEST(GuardedPatch, CleanIsWhatMeetsNothing) {
  Scene scene(rough_cap(7, 0.5), false);
  // Two vertices are pulled through the others' triangles without a guard.
  for (Index back : {1u, 2u}) {
    const Index vertex = static_cast<Index>(scene.patch.vertex_count()) - back;
    scene.patch.move(vertex, as_stored(scene.patch.position(vertex) + Vector3(0.5 - 0.9 * back, 0.3, -0.1)));
  }
  const GuardedPatch guarded = scene.guard();
  int clean = 0, unclean = 0;
  for (Index t = 0; t < scene.patch.triangle_count(); ++t) {
    const bool expected = scene.is_free(scene.patch, t, {});
    ASSERT_EQ(guarded.is_clean(t), expected);
    ++(expected ? clean : unclean);
  }
  EXPECT_GT(clean, 5);
  EXPECT_GT(unclean, 5);
}

TEST(GuardedPatch, PositionsAreRoundedToWhatIsStored) {
  Scene scene(rough_cap(3, 0.5), false);
  GuardedPatch guarded = scene.guard();
  const Index vertex = static_cast<Index>(scene.patch.vertex_count() - 1);
  const Vector3 to = scene.patch.position(vertex) + Vector3(1e-9, 1e-4, 0);
  ASSERT_TRUE(guarded.move(vertex, to));
  EXPECT_EQ(scene.patch.position(vertex), as_stored(to));
  Index half_edge = 0;
  while (scene.patch.is_boundary(half_edge)) ++half_edge;
  const Vector3 middle = 0.49999 * scene.patch.position(scene.patch.origin(half_edge)) +
                         0.50001 * scene.patch.position(scene.patch.target(half_edge));
  const Index split = guarded.split(half_edge, middle);
  ASSERT_NE(split, GuardedPatch::none);
  EXPECT_EQ(scene.patch.position(split), as_stored(middle));
  const Vector3 nowhere(std::numeric_limits<double>::quiet_NaN(), 0, 0);
  EXPECT_FALSE(guarded.move(vertex, nowhere));
  EXPECT_EQ(guarded.split(half_edge, nowhere), GuardedPatch::none);
}

// A Steiner point lies in the middle of a side of the input: its triangles would meet that face along half of
// the side, which counts as meeting for everything else.
TEST(GuardedPatch, RestingOnASideIsNotMeeting) {
  Scene scene(rough_cap(2, 0.5), true);
  GuardedPatch strict(scene.patch, scene.input, scene.forbidden, scene.obstacles);
  const GuardedPatch resting = scene.guard();
  int at_steiner_points = 0;
  for (Index t = 0; t < scene.patch.triangle_count(); ++t) {
    bool steiner = false;
    for (Index v : scene.patch.triangles()[t]) steiner |= scene.resting().count(v) != 0;
    at_steiner_points += steiner;
    EXPECT_EQ(strict.is_clean(t), !steiner);
    EXPECT_TRUE(resting.is_clean(t));
  }
  EXPECT_GT(at_steiner_points, 10);
}

// A vertex that lies on the side of a face may move through that face, until it is taken off the side.
TEST(GuardedPatch, AVertexTakenOffTheBoundaryRestsNoMore) {
  const TriangleMesh mesh{{{0, 0, 0}, {4, 0, 0}, {2, -4, 0}}, {{1, 0, 2}}};
  const InputNeighbourhood input(mesh);
  const Vector3 side(2, 0, 0), inside(2, 1, 0.5), through(2, -2, -1);
  PatchMesh patch({{0, 0, 0}, {4, 0, 0}, {2, 4, 4}, side}, 3, {{0, 3, 2}, {3, 1, 2}});
  const std::vector<Corners> obstacles = {{Vector3(0.5, 2, 0.5), {3.5, 2, 0.5}, {2, 2, 1.2}}};
  const ForbiddenEdges none;
  GuardedPatch guarded(patch, input, none, obstacles);
  guarded.rest(3, 0);
  ASSERT_TRUE(guarded.move(3, through));
  ASSERT_TRUE(guarded.move(3, side));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(guarded.fill_at_boundary(3, through)) << "the moved triangles would meet the face";
  EXPECT_FALSE(guarded.fill_at_boundary(3, {2, 5, 0.5})) << "they would meet the obstacle";
  EXPECT_FALSE(guarded.fill_at_boundary(3, {3, 0, 0})) << "a triangle without area";
  EXPECT_FALSE(guarded.fill_at_boundary(3, {nan, 0, 0}));
  EXPECT_FALSE(guarded.fill_at_boundary(2, inside)) << "on the rim";
  EXPECT_EQ(patch.triangle_count(), 2u);
  EXPECT_EQ(patch.position(3), side);
  ASSERT_TRUE(guarded.fill_at_boundary(3, inside));
  EXPECT_EQ(patch.position(3), inside);
  EXPECT_EQ(patch.triangle_count(), 3u);
  EXPECT_FALSE(guarded.move(3, through));
  EXPECT_FALSE(guarded.fill_at_boundary(3, inside)) << "an inner one now";
}

// Two corners of a square that the mesh joins elsewhere: the patch's edge may not become that diagonal, by a
// flip, by a collapse or by a triangle at the boundary.
TEST(GuardedPatch, NeverMakesAnEdgeThatTheMeshHas) {
  const TriangleMesh far = test::tetrahedron();
  const InputNeighbourhood input(far);
  const std::vector<Corners> no_obstacles;
  const std::vector<Vector3> square = {{10, 0, 0}, {14, 0, 1}, {14, 4, 0}, {10, 4, 1}};
  for (const ForbiddenEdges& forbidden : {ForbiddenEdges{{0, 2}}, ForbiddenEdges{{0, 3}}, ForbiddenEdges{}}) {
    const bool free = forbidden != ForbiddenEdges{{0, 2}};
    PatchMesh halves(square, 4, {{0, 1, 3}, {1, 2, 3}});
    GuardedPatch flips(halves, input, forbidden, no_obstacles);
    EXPECT_EQ(flips.flip(1), free);
    std::vector<Vector3> positions = square;
    positions.emplace_back(11.5, 1.75, 3);
    PatchMesh fan(positions, 4, {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}});
    GuardedPatch collapses(fan, input, forbidden, no_obstacles);
    Index half_edge = 0;
    while (fan.origin(half_edge) != 4 || fan.target(half_edge) != 2) ++half_edge;
    EXPECT_EQ(collapses.collapse(half_edge), free) << "onto 2 makes the edge 0 2";
    // The square's corner 1, not on the rim: its triangle makes the edge 0 2.
    PatchMesh open({square[0], square[3], square[2], positions[4], square[1]}, 3,
                   {{0, 4, 3}, {4, 2, 3}, {2, 1, 3}, {1, 0, 3}});
    const ForbiddenEdges renamed = forbidden == ForbiddenEdges{{0, 3}} ? ForbiddenEdges{{0, 1}} : forbidden;
    GuardedPatch fills(open, input, renamed, no_obstacles);
    EXPECT_EQ(fills.fill_at_boundary(4, {13, 1, 1.5}), free);
    EXPECT_EQ(open.triangle_count(), free ? 5u : 4u);
  }
}

}  // namespace
}  // namespace meshcomplete
