#include "common/core/patch_retriangulation.h"

#include <gtest/gtest.h>

#include <algorithm>
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
    return retriangulate(patch_, tangled, rim_, input_, obstacles, rings);
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

// A tent over a long gap with a bump of the input under its ridge: the filling along the ridge is the only one.
TEST(PatchRetriangulationOfAQuad, TheDiagonalThatMeetsNothing) {
  const std::vector<Vector3> positions = {{0, 0, 0}, {4, 0, 1}, {4, 4, 0}, {0, 4, 1}};
  const TriangleMesh nothing;
  const InputNeighbourhood input(nothing);
  Rim rim;
  rim.positions = positions;
  // Across the segment from corner 0 to corner 2, and below the one from 1 to 3.
  const std::vector<Corners> bar = {{Vector3(1, 3, 0.2), Vector3(3, 1, 0.2), Vector3(2.1, 2.1, -0.5)}};
  PatchMesh patch(positions, 4, {{0, 1, 2}, {0, 2, 3}});
  ASSERT_EQ(retriangulate(patch, {0}, rim, input, bar, 1), 1u);
  const auto joins = [&](Index a, Index b) { return patch.joined(a, b); };
  EXPECT_FALSE(joins(0, 2));
  std::vector<Corners> triangles;
  for (const Triangle& t : patch.triangles())
    triangles.push_back({patch.position(t[0]), patch.position(t[1]), patch.position(t[2])});
  EXPECT_TRUE(improper_pairs_between(triangles, bar).empty());
  EXPECT_TRUE(improper_pairs(triangles).empty());
}

// The same with the good diagonal forbidden: there is no way.
TEST(PatchRetriangulationOfAQuad, NoForbiddenEdge) {
  const std::vector<Vector3> positions = {{0, 0, 0}, {4, 0, 1}, {4, 4, 0}, {0, 4, 1}};
  const TriangleMesh nothing;
  const InputNeighbourhood input(nothing);
  Rim rim;
  rim.positions = positions;
  rim.forbidden = {{1, 3}};
  const std::vector<Corners> bar = {{Vector3(1, 3, 0.2), Vector3(3, 1, 0.2), Vector3(2.1, 2.1, -0.5)}};
  PatchMesh patch(positions, 4, {{0, 1, 2}, {0, 2, 3}});
  EXPECT_EQ(retriangulate(patch, {0}, rim, input, bar, 1), 0u);
  EXPECT_TRUE(patch.joined(0, 2));
}

TEST_F(PatchRetriangulation, CanBeCancelled) {
  poke_through_the_bottom();
  EXPECT_THROW(retriangulate(patch_, check().patch_triangles, rim_, input_, {}, 1,
                             Progress([](double, const std::string&) { return false; })),
               Cancelled);
}

}  // namespace
}  // namespace meshcomplete
