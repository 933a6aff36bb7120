#include "filter_curveunfold/hole_filler.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <vector>

#include "common/core/error.h"
#include "common/core/triangle_intersection.h"
#include "filter_curveunfold/loop_geometry.h"
#include "tests/support/loop_families.h"
#include "tests/support/meshes.h"
#include "tests/support/patches.h"

namespace meshcomplete {
namespace {

using Obstacles = std::vector<std::array<Vector3, 3>>;

/// A mesh with what the filler wants to know about it.
struct Scene {
  explicit Scene(TriangleMesh m)
      : mesh(std::move(m)),
        topology(build_topology(mesh)),
        neighbourhood(mesh),
        loops(test::loops_of(mesh)) {}

  FilledHole fill(std::size_t loop = 0, const Obstacles& obstacles = {},
                  const Progress& progress = Progress()) const {
    return fill_hole({mesh, topology, neighbourhood, options}, loops.at(loop), obstacles, progress);
  }
  bool passes(const Patch& patch, std::size_t loop = 0) const {
    return check_patch(neighbourhood, patch, {&loops.at(loop)}).passed();
  }

  TriangleMesh mesh;
  MeshTopology topology;
  InputNeighbourhood neighbourhood;
  std::vector<BoundaryLoop> loops;
  CurveUnfoldingOptions options;
};

Obstacles corners_of(const TriangleMesh& mesh, const Patch& patch) {
  Obstacles list;
  for (const Triangle& t : patch.triangles) list.push_back(corners(mesh, patch, t));
  return list;
}

bool mentions(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(HoleFiller, APlainHole) {
  const Scene scene(test::sphere_with_hole(3, 0.5));
  const FilledHole filled = scene.fill();
  EXPECT_TRUE(scene.passes(filled.patch));
  EXPECT_EQ(filled.patch.input_vertices, scene.mesh.vertices.size());
  EXPECT_EQ(filled.route, "projected, thin plate");
  EXPECT_EQ(filled.reason, "");
  const std::size_t edges = scene.loops[0].vertices.size();
  EXPECT_EQ(filled.polygon.size(), edges);
  EXPECT_EQ(filled.flat.size(), edges - 2);
  EXPECT_TRUE(is_simple(filled.polygon));
  EXPECT_EQ(filled.times.restarts, 0);
  EXPECT_EQ(filled.times.steps, 0u);
  EXPECT_GE(filled.times.unfolding, 0);
  EXPECT_GT(filled.times.embedding, 0);
  EXPECT_GT(filled.times.checking, 0);
}

TEST(HoleFiller, ThePolygonIsAsLongAsTheRim) {
  for (double factor : {1.0, 32.0}) {
    const Scene scene(test::scaled(test::sphere_with_hole(3, 0.5), factor));
    const FilledHole filled = scene.fill();
    double length = 0;
    for (std::size_t i = 0; i < filled.polygon.size(); ++i)
      length += (filled.polygon[(i + 1) % filled.polygon.size()] - filled.polygon[i]).norm();
    EXPECT_NEAR(length, perimeter(scene.mesh, scene.loops[0]), 0.02 * length);
  }
}

TEST(HoleFiller, PositionsAreWhatIsStored) {
  const Scene scene(test::translated(test::sphere_with_hole(3, 0.5), Vector3(100.1, 0, -7)));
  for (const Vector3& p : scene.fill().patch.vertices) EXPECT_EQ(p, as_stored(p));
}

TEST(HoleFiller, TheEnergyAskedForIsTakenFirst) {
  for (const auto& [energy, route] :
       {std::pair(SurfaceEnergy::membrane, "projected, membrane"),
        std::pair(SurfaceEnergy::thin_plate, "projected, thin plate"),
        std::pair(SurfaceEnergy::normal_variation, "projected, normal variation")}) {
    Scene scene(test::sphere_with_hole(3, 0.5));
    scene.options.energy = energy;
    EXPECT_EQ(scene.fill().route, route);
  }
}

TEST(HoleFiller, BothUnfoldingMethods) {
  Scene scene(test::sphere_with_hole(2, 0.7));
  scene.options.unfolding.method = UnfoldMethod::descent;
  const FilledHole descended = scene.fill();
  EXPECT_TRUE(scene.passes(descended.patch));
  scene.options.unfolding.method = UnfoldMethod::annealing;
  const FilledHole annealed = scene.fill();
  EXPECT_TRUE(scene.passes(annealed.patch));
  EXPECT_TRUE(mentions(annealed.route, "annealed")) << annealed.route;
  EXPECT_GE(annealed.times.restarts, 1);
}

// One flat triangulation does not serve it: its patch would pass through itself.
TEST(HoleFiller, ALongRimWoundRoundACylinderIsDivided) {
  std::vector<Vector3> outer;
  const std::vector<Vector3> rim = testing::wound_round_cylinder(200, 2);
  for (const Vector3& p : rim) outer.push_back(0.97 * p);
  const Scene scene(test::collar(rim, outer));
  bool divided = false;
  for (std::size_t loop = 0; loop < scene.loops.size(); ++loop) {
    const FilledHole filled = scene.fill(loop);
    EXPECT_EQ(filled.reason, "");
    EXPECT_TRUE(scene.passes(filled.patch, loop));
    if (!mentions(filled.route, "divided by a chord")) continue;
    divided = true;
    // Its sides, one beside the other; the points of the chord belong to both.
    EXPECT_GT(filled.polygon.size(), rim.size());
    // Each has two triangles fewer than points.
    ASSERT_GE(filled.polygon.size(), filled.flat.size() + 4) << "two sides at least";
    EXPECT_EQ((filled.polygon.size() - filled.flat.size()) % 2, 0u);
    std::set<Index> corners;
    for (const Triangle& t : filled.flat) corners.insert(t.begin(), t.end());
    EXPECT_EQ(corners.size(), filled.polygon.size()) << "every side is there";
  }
  EXPECT_TRUE(divided);
}

// No projection of it is simple.
TEST(HoleFiller, ARimWoundRoundACylinderIsUntangled) {
  std::vector<Vector3> outer;
  const std::vector<Vector3> rim = testing::wound_round_cylinder(60, 2);
  for (const Vector3& p : rim) outer.push_back(0.97 * p);
  const Scene scene(test::collar(rim, outer));
  ASSERT_EQ(scene.loops[0].vertices.size(), 60u);
  const FilledHole filled = scene.fill();
  EXPECT_EQ(filled.reason, "");
  EXPECT_TRUE(scene.passes(filled.patch));
  EXPECT_TRUE(mentions(filled.route, "untangled")) << filled.route;
  EXPECT_GT(filled.times.steps, 0u);
}

TEST(HoleFiller, AKnotIsRefused) {
  std::vector<Vector3> rim, outer;
  for (const Vector3& p : testing::torus_knot(60, 2, 3)) {
    rim.push_back(p);
    const Vector3 core = 2 * Vector3(p.x(), p.y(), 0).normalized();
    outer.push_back(core + 1.2 * (p - core));
  }
  const Scene scene(test::collar(rim, outer));
  for (std::size_t loop : {0u, 1u}) {
    const FilledHole filled = scene.fill(loop);
    EXPECT_TRUE(filled.patch.empty());
    EXPECT_EQ(filled.route, "");
    EXPECT_TRUE(mentions(filled.reason, "knotted (determinant 3)")) << filled.reason;
  }
}

// Two rims at one place with a vertex each: opened by a flap.
TEST(HoleFiller, ARimThatPassesOnePlaceTwice) {
  TriangleMesh mesh = test::sphere_with_touching_holes(3);
  const std::vector<BoundaryLoop> loops = test::loops_of(mesh);
  ASSERT_EQ(loops.size(), 2u);
  Index shared = 0;
  for (Index v : loops[0].vertices)
    if (std::count(loops[1].vertices.begin(), loops[1].vertices.end(), v)) shared = v;
  // The faces of one fan get a vertex of their own.
  std::vector<Index> fan = {loops[0].faces[static_cast<std::size_t>(
      std::find(loops[0].vertices.begin(), loops[0].vertices.end(), shared) - loops[0].vertices.begin())]};
  const MeshTopology topology = build_topology(mesh);
  for (std::size_t i = 0; i < fan.size(); ++i)
    for (Index h = 3 * fan[i]; h < 3 * fan[i] + 3; ++h) {
      const Triangle& t = mesh.triangles[fan[i]];
      const bool at_shared = t[h % 3] == shared || t[(h % 3 + 1) % 3] == shared;
      const Index opposite = topology.opposite[h];
      if (!at_shared || opposite >= MeshTopology::non_manifold) continue;
      if (std::find(fan.begin(), fan.end(), opposite / 3) == fan.end()) fan.push_back(opposite / 3);
    }
  for (Index f : fan)
    for (Index& v : mesh.triangles[f])
      if (v == shared) v = static_cast<Index>(mesh.vertices.size());
  mesh.vertices.push_back(mesh.vertices[shared]);

  const Scene scene(mesh);
  ASSERT_EQ(scene.loops.size(), 1u) << "one rim now, and it passes the place twice";
  const FilledHole filled = scene.fill();
  EXPECT_EQ(filled.reason, "");
  EXPECT_TRUE(scene.passes(filled.patch));
  EXPECT_TRUE(mentions(filled.route, "opened where the rim touches itself")) << filled.route;
}

// --- in the way
// --------------------------------------------------------------------------------------------------

TEST(HoleFiller, ObstaclesAreAvoided) {
  const Scene scene(test::sphere_with_hole(3, 0.6));
  const Obstacles ceiling = {{Vector3(-3, -3, 0.93), Vector3(3, -3, 0.93), Vector3(0, 5, 0.93)}};
  const FilledHole free = scene.fill();
  ASSERT_FALSE(improper_pairs_between(corners_of(scene.mesh, free.patch), ceiling).empty())
      << "the thin plate would go through it";
  const FilledHole filled = scene.fill(0, ceiling);
  EXPECT_EQ(filled.reason, "");
  EXPECT_TRUE(scene.passes(filled.patch));
  EXPECT_TRUE(improper_pairs_between(corners_of(scene.mesh, filled.patch), ceiling).empty());
  EXPECT_NE(filled.route, free.route) << "what was done about it is said";
}

TEST(HoleFiller, TheInputIsAvoided) {
  // A ball below the hole, higher than the rim's plane: a membrane would touch it, a thin plate goes over it.
  const TriangleMesh mesh =
      test::join(test::sphere_with_hole(3, 0.6), test::icosphere(2, 0.1, Vector3(0, 0, 0.78)));
  Scene scene(mesh);
  ASSERT_EQ(scene.loops.size(), 1u);
  for (SurfaceEnergy energy : {SurfaceEnergy::membrane, SurfaceEnergy::thin_plate}) {
    scene.options.energy = energy;
    const FilledHole filled = scene.fill();
    EXPECT_EQ(filled.reason, "");
    EXPECT_TRUE(scene.passes(filled.patch));
  }
}

TEST(HoleFiller, WhatCannotBeClosedSaysWhy) {
  // A blade through the hole, from far above to far below and nearly as wide as it is.
  Scene scene(test::sphere_with_hole(2, 0.6));
  scene.options.edge_length = 0.5;  // few vertices, few tries
  const Obstacles blade = {{Vector3(0.02, -0.4, 0), Vector3(0, 0.4, 0), Vector3(0.01, 0.4, 30)},
                           {Vector3(0.02, -0.4, 0.001), Vector3(0.01, 0.39, 30), Vector3(0.03, -0.4, 30)}};
  const FilledHole filled = scene.fill(0, blade);
  EXPECT_TRUE(filled.patch.empty());
  EXPECT_EQ(filled.reason, "the patch meets the patch of another hole");
  EXPECT_EQ(filled.route, "");
}

TEST(HoleFiller, TooManyVerticesAreAReasonAndNoException) {
  Scene scene(test::sphere_with_hole(2, 0.7));
  scene.options.edge_length = 1e-5;
  const FilledHole filled = scene.fill();
  EXPECT_TRUE(filled.patch.empty());
  EXPECT_TRUE(mentions(filled.reason, "longer edges")) << filled.reason;
}

TEST(HoleFiller, TheSameTwice) {
  const Scene scene(test::without_ball(test::rough_sphere(3, 0.1, 3), Vector3(0, 0, 1), 0.6));
  const FilledHole first = scene.fill(), second = scene.fill();
  EXPECT_FALSE(first.patch.empty());
  EXPECT_EQ(first.patch.vertices, second.patch.vertices);
  EXPECT_EQ(first.patch.triangles, second.patch.triangles);
  EXPECT_EQ(first.route, second.route);
}

TEST(HoleFiller, CanBeCancelled) {
  const Scene scene(test::sphere_with_hole());
  EXPECT_THROW(scene.fill(0, {}, Progress([](double, const std::string&) { return false; })), Cancelled);
}

}  // namespace
}  // namespace meshcomplete
