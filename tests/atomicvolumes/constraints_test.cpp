#include "filter_atomicvolumes/constraints.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "tests/support/atomic_shapes.h"
#include "tests/support/atomic_solids.h"
#include "tests/support/meshes.h"

namespace meshcomplete {
namespace test {
namespace {

constexpr double pi = 3.14159265358979323846;

double distance_to_torus(const Vector3& p) {
  return std::abs(std::hypot(std::hypot(p[0], p[1]) - 1, p[2]) - 0.4);
}

/// From above down through the gap.
VolumeConstraints::View view_through_gap() {
  VolumeConstraints::View view;
  view.from = {1, 0, 5};
  for (int i = -8; i <= 8; ++i)
    for (int k = -1; k <= 1; ++k) view.seen.push_back({1 + 0.07 * i, 0.05 * k, -3});
  return view;
}

bool any_note_has(const std::vector<std::string>& notes, const std::string& text) {
  return std::any_of(notes.begin(), notes.end(),
                     [&](const std::string& note) { return note.find(text) != std::string::npos; });
}

constexpr std::uint64_t seeds[] = {1, 2, 3};

TEST(Constraints, NoneIsEmpty) {
  const TriangleMesh mesh = lumps();
  const MeshTopology topology = build_topology(mesh);
  const InputNeighbourhood neighbourhood(mesh);
  EXPECT_TRUE(PreparedConstraints(mesh, topology, neighbourhood, {}).empty());
}

// Figure 2 of the paper.
TEST(Constraints, PointsChooseTheRingInsteadOfTwoDiscs) {
  for (std::uint64_t seed : seeds) {
    VolumeConstraints constraints;
    const AtomicSolid discs = complete_by_cut(outer_half_of_torus(), constraints, seed);
    EXPECT_TRUE(discs.closed);
    EXPECT_EQ(discs.components, 1);
    EXPECT_EQ(discs.genus, 0);
    constraints.outside = {{0, 0, -0.4}, {0, 0, 0}, {0, 0, 0.4}};
    const AtomicSolid ring = complete_by_cut(outer_half_of_torus(), constraints, seed);
    EXPECT_TRUE(ring.closed);
    EXPECT_EQ(ring.components, 1);
    EXPECT_EQ(ring.genus, 1);
    EXPECT_GT(ring.area(), discs.area());
  }
}

// Figure 11 of the paper.
TEST(Constraints, OutsidePointsRemoveAHandle) {
  for (std::uint64_t seed : seeds) {
    VolumeConstraints constraints;
    EXPECT_EQ(complete_by_cut(lumps(), constraints, seed).genus, 1);
    constraints.outside = points_in_gap();
    const AtomicSolid solid = complete_by_cut(lumps(), constraints, seed, {{1, 0, 0}});
    EXPECT_TRUE(solid.closed);
    EXPECT_EQ(solid.genus, 0);
    EXPECT_EQ(solid.labels, std::vector<char>{0});
  }
}

TEST(Constraints, InsidePointsMakeAHandle) {
  const TriangleMesh wide_gap = torus_without_arc(-40, 40);
  VolumeConstraints constraints;
  EXPECT_EQ(complete_by_cut(wide_gap, constraints).genus, 0);
  for (int degrees = -40; degrees <= 40; degrees += 2)
    constraints.inside.push_back({std::cos(degrees * pi / 180), std::sin(degrees * pi / 180), 0});
  const AtomicSolid solid = complete_by_cut(wide_gap, constraints);
  EXPECT_TRUE(solid.closed);
  EXPECT_EQ(solid.genus, 1);
  EXPECT_TRUE(solid.notes.empty());
}

TEST(Constraints, CubesWithContradictingPointsAreSplit) {
  const TriangleMesh mesh = sphere_with_hole();
  const std::vector<Vector3> points = {{0.02, 0.01, 0.92}, {0.02, 0.01, 0.925}};
  for (std::uint64_t seed : seeds) {
    VolumeConstraints constraints;
    const AtomicSolid plain = complete_by_cut(mesh, constraints, seed);
    constraints.inside = {points[0]};
    const AtomicSolid one_point = complete_by_cut(mesh, constraints, seed, points);
    EXPECT_EQ(one_point.leaves, plain.leaves);
    constraints.outside = {points[1]};
    const AtomicSolid both = complete_by_cut(mesh, constraints, seed, points);
    EXPECT_EQ(both.labels, (std::vector<char>{1, 0}));
    EXPECT_TRUE(both.closed);
    EXPECT_EQ(both.genus, 0);
    EXPECT_TRUE(both.notes.empty());
    if (one_point.labels == std::vector<char>{1, 1}) {
      EXPECT_GT(both.leaves, plain.leaves);
    }
  }
}

// Beside a boundary vertex there are tetrahedra, which split only with their cube.
TEST(Constraints, HoleCubesWithContradictingPointsAreSplit) {
  const TriangleMesh mesh = sphere_with_hole();
  const MeshTopology topology = build_topology(mesh);
  int split = 0;
  for (std::size_t i = 0; i < topology.boundary_half_edges.size(); i += 5) {
    const Index h = topology.boundary_half_edges[i];
    const Vector3 rim = mesh.vertices[mesh.triangles[h / 3][h % 3]];
    // Towards the middle of the hole, so near the rim that all is in the cube of the vertex.
    const Vector3 way = (Vector3(0, 0, rim[2] + 0.04) - rim).normalized();
    VolumeConstraints constraints;
    constraints.inside = {rim + 0.006 * way};
    const AtomicSolid one = complete_by_cut(mesh, constraints, 1);
    constraints.outside = {rim + 0.0063 * way};
    const AtomicSolid both =
        complete_by_cut(mesh, constraints, 1, {constraints.inside[0], constraints.outside[0]});
    EXPECT_TRUE(both.closed);
    EXPECT_EQ(both.labels, (std::vector<char>{1, 0}));
    split += both.leaves > one.leaves;
  }
  EXPECT_GT(split, 0);
}

TEST(Constraints, PointsThatCannotBeToldApartHaveNoEffect) {
  const TriangleMesh mesh = lumps();
  const AtomicSolid plain = complete_by_cut(mesh, {}, 1);
  VolumeConstraints constraints;
  constraints.inside = constraints.outside = {{1, 0, 0}};
  const AtomicSolid same = complete_by_cut(mesh, constraints, 1);
  EXPECT_TRUE(any_note_has(same.notes, "given as inside and as outside"));
  EXPECT_EQ(same.leaves, plain.leaves);
  EXPECT_DOUBLE_EQ(same.area(), plain.area());
  constraints.outside[0][0] = std::nextafter(1.0, 2.0);  // within a cell of the greatest depth
  const AtomicSolid near = complete_by_cut(mesh, constraints, 1);
  EXPECT_TRUE(any_note_has(near.notes, "neither has an effect there"));
  EXPECT_TRUE(near.closed);
  EXPECT_EQ(near.genus, plain.genus);
}

TEST(Constraints, WhatTheMeshContradictsIsReported) {
  const TriangleMesh mesh = sphere_with_hole();
  VolumeConstraints constraints;
  constraints.inside = {{9, 0, 0}};           // beyond the octree
  constraints.outside = {{0.02, 0, -0.985}};  // just behind the surface, where no blank cube is
  const AtomicSolid solid = complete_by_cut(mesh, constraints, 1, constraints.outside);
  EXPECT_TRUE(any_note_has(
      solid.notes,
      "The point given as inside is outside according to the mesh, at (9, 0, 0); it has no effect."));
  EXPECT_TRUE(any_note_has(solid.notes, "The point given as outside is inside according to the mesh"));
  EXPECT_EQ(solid.labels, std::vector<char>{1});
  constraints.inside = {{0.02, 0, -0.985}};
  constraints.outside = {{9, 0, 0}, {0.02, 0, -1.005}};
  EXPECT_TRUE(complete_by_cut(mesh, constraints, 1).notes.empty());
}

// A crossed cube can be so large that most of it is far from the faces in it. Nothing is known there but what
// the mesh says about its own neighbourhood; points win.
TEST(Constraints, LargeCrossedCubesAreSplitForPointsFarFromTheMesh) {
  const TriangleMesh mesh = sphere_with_hole();
  int split = 0;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    const std::size_t leaves = complete_by_cut(mesh, {}, seed).leaves;
    VolumeConstraints constraints;
    constraints.inside = {{0.1, 0.8, -0.95}};    // before the mesh by 0.25
    constraints.outside = {{-0.3, 0.1, -0.65}};  // behind it by as much
    const AtomicSolid solid =
        complete_by_cut(mesh, constraints, seed, {constraints.inside[0], constraints.outside[0]});
    EXPECT_EQ(solid.labels, (std::vector<char>{1, 0}));
    EXPECT_TRUE(solid.notes.empty()) << solid.notes.front();
    EXPECT_TRUE(solid.closed);
    EXPECT_EQ(solid.genus, 0);
    EXPECT_LT(solid.leaves, leaves + 500);
    split += solid.leaves > leaves;
  }
  EXPECT_GT(split, 0) << "the points were in blank cubes anyway";
}

// The same in the tetrahedra at a rim vertex that touch a face.
TEST(Constraints, LargeHoleCubesAreSplitForPointsFarFromTheMesh) {
  const TriangleMesh mesh = sphere_with_hole(2, 0.6);
  const MeshTopology topology = build_topology(mesh);
  int split = 0;
  for (std::size_t i = 0; i < topology.boundary_half_edges.size(); i += 2) {
    const Index h = topology.boundary_half_edges[i];
    const Vector3 rim = mesh.vertices[mesh.triangles[h / 3][h % 3]];
    const Vector3 down = Vector3(rim[0], rim[1], -0.4).normalized();
    VolumeConstraints constraints;
    constraints.outside = {0.93 * (rim + 0.02 * down)};
    const std::size_t leaves = complete_by_cut(mesh, {}, 2).leaves;
    const AtomicSolid solid = complete_by_cut(mesh, constraints, 2, constraints.outside);
    EXPECT_EQ(solid.labels, std::vector<char>{0});
    EXPECT_TRUE(solid.notes.empty()) << solid.notes.front();
    EXPECT_TRUE(solid.closed);
    split += solid.leaves > leaves;
  }
  EXPECT_GT(split, 0);
}

TEST(Constraints, PointsThatAreNotFiniteAreLeftOut) {
  VolumeConstraints constraints;
  constraints.inside = {{std::nan(""), 0, 0}};
  const AtomicSolid solid = complete_by_cut(lumps(), constraints, 1);
  EXPECT_TRUE(any_note_has(solid.notes, "not finite"));
}

TEST(Constraints, AViewThroughAGapRemovesTheBridge) {
  for (std::uint64_t seed : seeds) {
    VolumeConstraints constraints;
    constraints.views = {view_through_gap()};
    const AtomicSolid solid = complete_by_cut(lumps(), constraints, seed);
    EXPECT_TRUE(solid.closed);
    EXPECT_EQ(solid.genus, 0);
    EXPECT_TRUE(solid.notes.empty());
  }
}

TEST(Constraints, AViewOfTheMeshDoesNotCarveBehindIt) {
  const TriangleMesh mesh = sphere_with_hole();
  const Vector3 in_the_middle(0.01, 0.02, 0.03);
  const AtomicSolid plain = complete_by_cut(mesh, {}, 1);
  VolumeConstraints constraints;
  constraints.views.resize(1);
  constraints.views[0].from = {0, 0, -6};
  for (int i = -9; i <= 9; ++i)
    for (int k = -9; k <= 9; ++k) constraints.views[0].seen.push_back({0.1 * i, 0.1 * k, 2});
  const AtomicSolid solid = complete_by_cut(mesh, constraints, 1, {in_the_middle});
  EXPECT_EQ(solid.labels, std::vector<char>{1});
  EXPECT_TRUE(any_note_has(solid.notes, "meet the mesh on the way"));
  EXPECT_DOUBLE_EQ(solid.area(), plain.area());
}

// Only a small volume round the point stays.
TEST(Constraints, InsidePointsWinAgainstViews) {
  VolumeConstraints constraints;
  constraints.views = {view_through_gap()};
  const std::vector<Vector3> points = {{1, 0, 0.01}, {1.05, 0, 0.06}, {0.95, 0, -0.04}};
  const AtomicSolid carved = complete_by_cut(lumps(), constraints, 1, points);
  EXPECT_EQ(carved.labels, (std::vector<char>{0, 0, 0}));
  constraints.inside = {points[0]};
  const AtomicSolid solid = complete_by_cut(lumps(), constraints, 1, points);
  EXPECT_EQ(solid.labels, (std::vector<char>{1, 0, 0}));
  EXPECT_GT(solid.leaves, carved.leaves);
  EXPECT_TRUE(any_note_has(solid.notes, "not carved"));
}

TEST(Constraints, HintsHaveAPrice) {
  VolumeConstraints constraints;
  constraints.hinted_outside = points_in_gap();
  for (const CutWeight weight : {CutWeight::area, CutWeight::balanced, CutWeight::unit}) {
    const AtomicSolid plain = complete_by_cut(lumps(), {}, 1, {{1, 0, 0}}, weight);
    constraints.hint_price = 1e-9;
    const AtomicSolid cheap = complete_by_cut(lumps(), constraints, 1, {{1, 0, 0}}, weight);
    EXPECT_EQ(cheap.labels, std::vector<char>{1});
    EXPECT_EQ(cheap.genus, plain.genus);
    constraints.hint_price = 1;
    const AtomicSolid dear = complete_by_cut(lumps(), constraints, 1, {{1, 0, 0}}, weight);
    EXPECT_EQ(dear.labels, std::vector<char>{0});
    if (weight != CutWeight::unit) {
      EXPECT_EQ(dear.genus, 0);
    }
  }
  constraints.hinted_outside.clear();
  constraints.hinted_inside = {{1, 0, 0.7}};
  EXPECT_EQ(complete_by_cut(lumps(), constraints, 1, constraints.hinted_inside).labels, std::vector<char>{1});
}

// A third of the torus is missing; its image is there.
TEST(SymmetryHints, AMissingPartFollowsItsImage) {
  const TriangleMesh mesh = torus_without_arc(10, 140);
  const Vector3 origin = Vector3::Zero();
  for (std::uint64_t seed : seeds) {
    const AtomicSolid caps = complete_by_cut(mesh, {}, seed);
    EXPECT_EQ(caps.genus, 0);
    EXPECT_GT(caps.mean(distance_to_torus), 0.1);
    // The rotation by a fifth leaves a part of the missing third on itself: its powers are needed.
    for (const Symmetry& symmetry :
         {reflection(origin, {0, 1, 0}), rotation(origin, {0, 0, 1}, 2), rotation(origin, {0, 0, 1}, 5)}) {
      VolumeConstraints constraints;
      constraints.symmetries = {symmetry};
      const AtomicSolid solid = complete_by_cut(mesh, constraints, seed);
      EXPECT_TRUE(solid.closed);
      EXPECT_EQ(solid.genus, 1);
      EXPECT_LT(solid.mean(distance_to_torus), 0.035);
    }
  }
}

// The cubes that are not divided further are cut into convex cells.
TEST(Constraints, HoldAtTheGreatestDepth) {
  for (int depth : {5, 6}) {
    DecompositionOptions options;
    options.max_depth = depth;
    const auto complete = [&](const VolumeConstraints& constraints) {
      return complete_by_cut(lumps(), constraints, 2, {{1, 0, 0}}, CutWeight::area, options);
    };
    VolumeConstraints constraints;
    EXPECT_EQ(complete(constraints).labels, std::vector<char>{1});
    constraints.outside = points_in_gap();
    EXPECT_EQ(complete(constraints).labels, std::vector<char>{0});
    EXPECT_EQ(complete(constraints).genus, 0);
    constraints.outside.clear();
    constraints.views = {view_through_gap()};
    EXPECT_EQ(complete(constraints).labels, std::vector<char>{0});
    EXPECT_EQ(complete(constraints).genus, 0);
  }
}

TEST(SymmetryHints, ALowPriceChangesNothing) {
  VolumeConstraints constraints;
  constraints.symmetries = {reflection(Vector3::Zero(), {0, 1, 0})};
  constraints.symmetry_price = 1e-6;
  const AtomicSolid solid = complete_by_cut(torus_without_arc(10, 140), constraints, 1);
  EXPECT_EQ(solid.genus, 0);
  EXPECT_LT(solid.area(), 2);
}

// A row of bumps along the x axis, closed, with its rightmost but one bump bitten off.
TEST(SymmetryHints, ATranslationRepeatsABump) {
  const auto radius = [](double x) { return 0.45 + 0.2 * std::cos(2 * pi * x); };
  const TriangleMesh whole = [&] {
    TriangleMesh mesh = uv_sphere(96, 40);
    for (Vector3& p : mesh.vertices) {
      const double x = 2.5 * (1 - 2 * std::acos(std::clamp(p[2], -1.0, 1.0)) / pi);
      const double across = std::hypot(p[0], p[1]), r = std::abs(x) > 2.499 ? 0 : radius(x);
      const double c = across > 1e-9 ? p[0] / across : 1, s = across > 1e-9 ? p[1] / across : 0;
      p = {static_cast<float>(x), static_cast<float>(r * c), static_cast<float>(r * s)};
    }
    return mesh;
  }();
  const TriangleMesh bitten = without_faces(whole, [&](Index f) {
    const Vector3 p = middle_of(whole, f);
    return std::abs(p[0] - 1) < 0.42 && p[2] > 0.02;
  });
  const auto distance = [&](const Vector3& p) { return std::abs(std::hypot(p[1], p[2]) - radius(p[0])); };
  VolumeConstraints constraints;
  const AtomicSolid cap = complete_by_cut(bitten, constraints, 1);
  constraints.symmetries = {translation({1, 0, 0})};
  const AtomicSolid bump = complete_by_cut(bitten, constraints, 1);
  EXPECT_TRUE(bump.closed);
  EXPECT_EQ(bump.genus, 0);
  EXPECT_LT(bump.mean(distance), 0.4 * cap.mean(distance));
}

TEST(SymmetryHints, WhereTheImageIsMissingTooNothingIsSuggested) {
  // The plane goes through the middle of the hole.
  VolumeConstraints constraints;
  const AtomicSolid plain = complete_by_cut(sphere_with_hole(), constraints, 1);
  constraints.symmetries = {reflection(Vector3::Zero(), {1, 0, 0})};
  const AtomicSolid solid = complete_by_cut(sphere_with_hole(), constraints, 1);
  EXPECT_EQ(solid.genus, 0);
  EXPECT_NEAR(solid.area(), plain.area(), 0.1 * plain.area());
}

// The image lies beside the mesh by a two-hundredth of its size.
TEST(SymmetryHints, AnImpreciseSymmetryLaysNoSecondSkin) {
  const TriangleMesh mesh = torus_without_arc(10, 140);
  for (double offset : {-0.012, 0.012}) {
    VolumeConstraints constraints;
    constraints.symmetries = {reflection({0, 0.5 * offset, 0}, {0, 1, 0})};
    const AtomicSolid solid = complete_by_cut(mesh, constraints, 1);
    EXPECT_TRUE(solid.closed);
    EXPECT_EQ(solid.genus, 1);
    for (const Vector3& p : solid.vertices) {
      const double angle = std::atan2(p[1], p[0]) * 180 / pi;
      EXPECT_TRUE(angle > 0 && angle < 150) << angle;
    }
  }
}

/// What the images of a point suggest.
double suggested(const TriangleMesh& mesh, const Symmetry& symmetry, const Vector3& point) {
  const MeshTopology topology = build_topology(mesh);
  const SideFinder sides(mesh, topology);
  const SymmetryHints hints(sides, {symmetry}, Vector3::Zero(), 6, 0.03);
  SymmetryHints::Starts starts;
  return hints.suggest(0, point, starts).inside;
}

TEST(SymmetryHints, ImagesFarFromTheMeshTellNothing) {
  const TriangleMesh mesh = sphere_with_hole();
  const Vector3 beyond_the_rim(0.4, 0, 0.92);
  EXPECT_EQ(suggested(mesh, translation({0, 0, 1.2}), beyond_the_rim), 0);
  EXPECT_EQ(suggested(mesh, reflection(Vector3::Zero(), {0, 0, 1}), beyond_the_rim), -1);
  EXPECT_EQ(suggested(mesh, reflection(Vector3::Zero(), {0, 0, 1}), {0.3, 0, 0.92}), 1);
  EXPECT_EQ(suggested(mesh, reflection(Vector3::Zero(), {0, 0, 1}), {0.1, 0, -0.9}), 0);
}

// Of three balls round an axis one is missing, one has a hole at the image in question, and one too; a post
// beside the axis is nearer to that image than to the point, but not as near as the hole's rim.
TEST(SymmetryHints, AnImageNearABoundaryKeepsOthersFromTelling) {
  const Vector3 up(0, 0, 1);
  const Symmetry turn = rotation(Vector3::Zero(), up, 3);
  const Vector3 point = {2, 0, 0.93};
  const Vector3 place = turn.motion * Vector3(2, 0, 0);
  TriangleMesh ball = icosphere(3, 1, place);
  ball = without_ball(ball, turn.motion * point, 0.35);
  const Vector3 post = 0.4 * (turn.motion.inverse() * point) + Vector3(0, 0, 0.5);
  const TriangleMesh mesh = join(ball, icosphere(2, 0.25, post));
  EXPECT_EQ(suggested(mesh, turn, point), 0);
  const TriangleMesh whole = join(icosphere(3, 1, place), icosphere(2, 0.25, post));
  EXPECT_EQ(suggested(whole, turn, point), 1);
}

TEST(SymmetryHints, ImagesGoRoundTheWholeTurn) {
  const Vector3 middle(0.1, 0, 0);
  const auto count = [&](const Symmetry& symmetry) { return images_under(symmetry, middle, 2).size(); };
  EXPECT_EQ(count(reflection(Vector3::Zero(), {0, 1, 1})), 1u);
  for (int fold = 2; fold <= 12; ++fold)
    EXPECT_EQ(count(rotation({0.3, 0, 0}, {0, 1, 1}, fold)), static_cast<std::size_t>(fold - 1)) << fold;
  EXPECT_EQ(count(translation({0.6, 0, 0})), 6u);  // up to 1.8 both ways
}

}  // namespace
}  // namespace test
}  // namespace meshcomplete
