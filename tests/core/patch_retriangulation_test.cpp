#include "common/core/patch_retriangulation.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <numeric>
#include <utility>
#include <vector>

#include "common/core/error.h"
#include "common/core/mesh_topology.h"
#include "common/core/patch.h"
#include "common/core/triangle_intersection.h"
#include "tests/support/lid.h"

namespace meshcomplete {
namespace {

using Corners = std::array<Vector3, 3>;

class PatchRetriangulation : public test::BoxWithLid {
 protected:
  PatchRetriangulation() : rim_(collect_rim(mesh_, build_topology(mesh_), loops_.at(0))) {}

  std::size_t mend(const std::vector<Index>& tangled, int rings, const std::vector<Corners>& obstacles = {}) {
    return retriangulate(patch_, tangled, rim_, rim_.edge_length, input_, obstacles, rings);
  }

  void poke_through_the_bottom() {
    const Index poked = vertex_near(Vector3(4, 4, 0));
    patch_.move(poked, patch_.position(poked) - Vector3(0, 0, 0.8));
  }

  double longest_inner_edge() const {
    double longest = 0;
    for (Index h = 0; h < 3 * patch_.triangle_count(); ++h)
      if (!patch_.is_boundary(h)) longest = std::max(longest, patch_.length(h));
    return longest;
  }

  Rim rim_;
};

TEST_F(PatchRetriangulation, NothingTangledNothingDone) {
  const std::size_t triangles = patch_.triangle_count();
  EXPECT_EQ(mend({}, 3), 0u);
  EXPECT_EQ(patch_.triangle_count(), triangles);
}

TEST_F(PatchRetriangulation, AVertexThroughTheInput) {
  for (int rings : {0, 1}) {
    patch_ = lid();
    poke_through_the_bottom();
    const PatchCheck tangled = check();
    ASSERT_EQ(tangled.defect, PatchDefect::meets_input);
    EXPECT_EQ(mend(tangled.patch_triangles, rings), 1u) << rings;
    EXPECT_TRUE(check().passed()) << describe(check().defect);
    // The gap is flat again, and as fine as what is round it.
    for (Index v = 0; v < patch_.vertex_count(); ++v) EXPECT_NEAR(patch_.position(v).z(), 0, 1e-6);
    EXPECT_LT(longest_inner_edge(), 2.0);
  }
}

TEST_F(PatchRetriangulation, WhatIsFarFromTheTangleStays) {
  poke_through_the_bottom();
  std::vector<Vector3> far;
  for (const Vector3& p : patch_.positions())
    if ((p - Vector3(4, 4, 0)).norm() > 3.5) far.push_back(as_stored(p));
  ASSERT_EQ(mend(check().patch_triangles, 1), 1u);
  for (const Vector3& p : far)
    EXPECT_NE(std::find(patch_.positions().begin(), patch_.positions().end(), p), patch_.positions().end());
  for (Index v = 0; v < patch_.rim_size(); ++v) EXPECT_EQ(patch_.position(v), rim_.positions[v]);
  for (const Vector3& p : patch_.positions()) EXPECT_EQ(p, as_stored(p)) << "what will be stored";
}

TEST_F(PatchRetriangulation, TwoTanglesAtOnce) {
  for (const Vector3& place : {Vector3(2, 2, 0), Vector3(6, 6, 0)}) {
    const Index poked = vertex_near(place);
    patch_.move(poked, patch_.position(poked) - Vector3(0, 0, 0.8));
  }
  EXPECT_EQ(mend(check().patch_triangles, 0), 2u);
  EXPECT_TRUE(check().passed()) << describe(check().defect);
}

TEST_F(PatchRetriangulation, AFoldInThePlane) {
  const Index poked = vertex_near(Vector3(5, 3, 0)), beyond = vertex_near(Vector3(3, 5, 0));
  patch_.move(poked, patch_.position(beyond) + Vector3(0.1, 0.2, 0));
  const PatchCheck tangled = check();
  ASSERT_EQ(tangled.defect, PatchDefect::meets_itself);
  std::vector<Index> triangles = tangled.patch_triangles;
  for (int rings = 0; rings < 3 && !triangles.empty(); ++rings) {
    mend(triangles, rings);
    triangles = check().patch_triangles;
  }
  EXPECT_TRUE(check().passed()) << describe(check().defect);
}

// A spike stands in the gap: every flat filling meets it, and the patch is left as it was.
TEST_F(PatchRetriangulation, AGapWithoutAFillingIsLeft) {
  const Vector3 place = patch_.position(vertex_near(Vector3(4, 4, 0)));
  const std::vector<Corners> spike = {
      {place + Vector3(0.05, 0.02, 0.2), place + Vector3(0.1, 0.03, -0.3), place + Vector3(0.05, 0.1, -0.3)}};
  std::vector<Index> tangled;
  for (const auto& [mine, other] : improper_pairs_between(patch_corners(), spike)) tangled.push_back(mine);
  ASSERT_FALSE(tangled.empty());
  const std::vector<Triangle> before = patch_.triangles();
  EXPECT_EQ(mend(tangled, 1, spike), 0u);
  EXPECT_EQ(patch_.triangles(), before);
}

TEST_F(PatchRetriangulation, NeighbouringTangles) {
  for (const Vector3& place : {Vector3(3, 4, 0), Vector3(5, 4, 0)}) {
    const Index poked = vertex_near(place);
    patch_.move(poked, patch_.position(poked) - Vector3(0, 0, 0.8));
  }
  std::vector<Index> triangles = check().patch_triangles;
  ASSERT_FALSE(triangles.empty());
  EXPECT_GE(mend(triangles, 0), 1u);
  EXPECT_TRUE(check().passed()) << describe(check().defect);
}

// Nothing is rounded exactly here: every split is a small move.
TEST_F(PatchRetriangulation, SlantedGapsStayClean) {
  const Eigen::AngleAxisd turn(0.7, Vector3(1, 2, 3).normalized());
  for (Vector3& p : mesh_.vertices) p = as_stored(turn * p);
  for (Vector3& p : rim_.positions) p = as_stored(turn * p);
  for (Vector3& p : rim_.ring.vertices) p = as_stored(turn * p);
  std::vector<Vector3> positions;
  for (const Vector3& p : patch_.positions()) positions.push_back(as_stored(turn * p));
  PatchMesh slanted(positions, patch_.rim_size(), patch_.triangles());
  const Index poked = vertex_near(Vector3(4, 4, 0));
  slanted.move(poked, slanted.position(poked) - turn * Vector3(0, 0, 0.8));
  std::vector<Index> star;
  slanted.for_outgoing(poked, [&](Index h) { star.push_back(h / 3); });
  const TriangleMesh nothing;
  const InputNeighbourhood input(nothing);
  ASSERT_EQ(retriangulate(slanted, star, rim_, std::vector<double>(rim_.positions.size(), 0.3), input, {}, 2),
            1u);
  std::vector<Corners> triangles;
  for (const Triangle& t : slanted.triangles())
    triangles.push_back({slanted.position(t[0]), slanted.position(t[1]), slanted.position(t[2])});
  EXPECT_TRUE(improper_pairs(triangles).empty());
  for (const Corners& c : triangles) EXPECT_FALSE(collinear(c[0], c[1], c[2]));
}

/// Four corners that are not in one plane, closed along the diagonal from 0 to 2, and a bar across that
/// diagonal and below the other one.
class PatchRetriangulationOfAQuad : public ::testing::Test {
 protected:
  PatchRetriangulationOfAQuad() { rim_.positions = positions_; }
  std::size_t mend() {
    return retriangulate(patch_, {0}, rim_, {1, 1, 1, 1}, InputNeighbourhood(nothing_), bar_, 1);
  }

  const std::vector<Vector3> positions_ = {{0, 0, 0}, {4, 0, 1}, {4, 4, 0}, {0, 4, 1}};
  const std::vector<Corners> bar_ = {{Vector3(1, 3, 0.2), Vector3(3, 1, 0.2), Vector3(2.1, 2.1, -0.5)}};
  const TriangleMesh nothing_;
  Rim rim_;
  PatchMesh patch_{positions_, 4, {{0, 1, 2}, {0, 2, 3}}};
};

TEST_F(PatchRetriangulationOfAQuad, TheDiagonalThatMeetsNothing) {
  ASSERT_EQ(mend(), 1u);
  EXPECT_FALSE(patch_.joined(0, 2));
  std::vector<Corners> triangles;
  for (const Triangle& t : patch_.triangles())
    triangles.push_back({patch_.position(t[0]), patch_.position(t[1]), patch_.position(t[2])});
  EXPECT_TRUE(improper_pairs_between(triangles, bar_).empty());
  EXPECT_TRUE(improper_pairs(triangles).empty());
}

// With the good diagonal forbidden there is no way.
TEST_F(PatchRetriangulationOfAQuad, NoForbiddenEdge) {
  rim_.forbidden = {{1, 3}};
  EXPECT_EQ(mend(), 0u);
  EXPECT_TRUE(patch_.joined(0, 2));
}

/// Two quads, not in one plane each, that cross. Closed along its other diagonal, from 1 to 3, the first one
/// would not meet the second one as it is, closed along the diagonal from 4 to 6. Nor may the second one
/// change to its other diagonal then, though that would crease it less.
class PatchRetriangulationOfTwoQuads : public ::testing::Test {
 protected:
  PatchRetriangulationOfTwoQuads() { rim_.positions = positions_; }

  PatchMesh patch(const std::vector<Triangle>& triangles) const { return {positions_, 8, triangles}; }
  std::size_t mend(PatchMesh& patch) {
    std::vector<Index> all(patch.triangle_count());
    std::iota(all.begin(), all.end(), 0u);
    return retriangulate(patch, all, rim_, std::vector<double>(8, 100), InputNeighbourhood(nothing_), {}, 0);
  }
  bool crossing(const PatchMesh& patch) const {
    std::vector<Corners> triangles;
    for (const auto& [a, b, c] : patch.triangles())
      triangles.push_back({positions_[a], positions_[b], positions_[c]});
    return !improper_pairs(triangles).empty();
  }

  const std::vector<Vector3> positions_ = {{0, 0, 0},          {4, 0, 4},          {4, 4, 0},
                                           {0, 4, 4},          {4.25, -1.5, 3.25}, {-1.75, 5.5, -0.75},
                                           {6.25, 3.5, -0.75}, {5.25, 2.5, 3.25}};
  const std::vector<Triangle> both_ = {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {4, 6, 7}};
  const TriangleMesh nothing_;
  Rim rim_;
};

TEST_F(PatchRetriangulationOfTwoQuads, AreAsTheySay) {
  EXPECT_TRUE(crossing(patch(both_)));
  EXPECT_FALSE(crossing(patch({{1, 2, 3}, {1, 3, 0}, {4, 5, 6}, {4, 6, 7}})));
  EXPECT_TRUE(crossing(patch({{1, 2, 3}, {1, 3, 0}, {5, 6, 7}, {5, 7, 4}})));
  PatchMesh second = patch({{4, 5, 6}, {4, 6, 7}});
  EXPECT_EQ(mend(second), 1u);
  EXPECT_TRUE(second.joined(5, 7)) << "what it would be by itself";
}

// What was taken out of the first gap is in the way no longer, and what has closed it is.
TEST_F(PatchRetriangulationOfTwoQuads, TheSecondGapKeepsClearOfTheFirstOnesFilling) {
  for (bool forbidden : {false, true}) {
    if (forbidden) rim_.forbidden = {{5, 7}};
    PatchMesh patch(positions_, 8, both_);
    EXPECT_EQ(mend(patch), 2u);
    EXPECT_TRUE(patch.joined(1, 3));
    EXPECT_TRUE(patch.joined(4, 6));
    EXPECT_FALSE(crossing(patch));
  }
}

// A disk of three strips between two corners of its rim. Both of the outer ones could be closed along the
// edge between these corners, but only one of them may.
TEST(PatchRetriangulationOfStrips, TwoGapsDoNotGetTheSameEdge) {
  const std::vector<Vector3> positions = {{0, 3, 0}, {-4, 0, 0}, {0, -3, 0},
                                          {4, 0, 0}, {-1, 0, 2}, {1, 0, 2}};
  const std::vector<Triangle> strips = {{0, 1, 4}, {1, 2, 4}, {0, 4, 5}, {4, 2, 5}, {0, 5, 3}, {5, 2, 3}};
  const std::vector<Corners> blade = {
      {Vector3(2.5, -0.25, 1.25), Vector3(2.5, 0.25, 1.25), Vector3(2.5, 0, 0.75)}};
  const TriangleMesh nothing;
  const InputNeighbourhood input(nothing);
  Rim rim;
  rim.positions.assign(positions.begin(), positions.begin() + 4);
  rim.forbidden = {{1, 4}};
  const auto mend = [&](PatchMesh& patch, const std::vector<Index>& tangled) {
    return retriangulate(patch, tangled, rim, std::vector<double>(4, 100), input, blade, 0);
  };
  PatchMesh one(positions, 4, strips);
  EXPECT_EQ(mend(one, {4, 5}), 1u);
  EXPECT_TRUE(one.joined(0, 2)) << "the second strip by itself";
  PatchMesh both(positions, 4, strips);
  EXPECT_EQ(mend(both, {0, 1, 4, 5}), 1u);
  EXPECT_TRUE(both.joined(0, 2));
  EXPECT_FALSE(both.joined(1, 4)) << "the first strip has the edge";
  EXPECT_TRUE(both.joined(3, 5)) << "the second one stays as it was";
}

TEST_F(PatchRetriangulation, CanBeCancelled) {
  poke_through_the_bottom();
  EXPECT_THROW(retriangulate(patch_, check().patch_triangles, rim_, rim_.edge_length, input_, {}, 1,
                             Progress([](double, const std::string&) { return false; })),
               Cancelled);
}

}  // namespace
}  // namespace meshcomplete
