#include "common/core/patch_untangling.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "common/core/error.h"
#include "common/core/patch.h"
#include "common/core/triangle_intersection.h"
#include "tests/support/lid.h"

namespace meshcomplete {
namespace {

using Corners = std::array<Vector3, 3>;

class PatchUntangling : public test::BoxWithLid {
 protected:
  /// Expects that the tangle is found, taken apart, and nothing but what is near `at` moves.
  void expect_untangled(PatchDefect defect, const Vector3& at, double reach) {
    const PatchCheck tangled = check();
    ASSERT_EQ(tangled.defect, defect);
    const std::vector<Vector3> before = patch_.positions();
    std::vector<Index> triangles = tangled.patch_triangles;
    std::size_t moved = 0;
    for (int i = 0; i < 5 && !triangles.empty(); ++i) {
      moved += untangle(patch_, triangles, input_, {}, {}, i / 2, 3);
      triangles = check().patch_triangles;
    }
    EXPECT_TRUE(check().passed()) << describe(check().defect);
    EXPECT_GT(moved, 0u);
    for (Index v = 0; v < before.size(); ++v) {
      if (patch_.on_rim(v) || (before[v] - at).norm() > reach) {
        EXPECT_EQ(patch_.position(v), as_stored(before[v]));
      }
      EXPECT_EQ(patch_.position(v), as_stored(patch_.position(v))) << "what will be stored";
    }
  }
};

TEST_F(PatchUntangling, TheLidIsCleanAtFirst) {
  EXPECT_TRUE(check().passed()) << describe(check().defect);
  EXPECT_EQ(untangle(patch_, {}, input_, {}, {}, 1, 3), 0u);
}

TEST_F(PatchUntangling, AVertexThroughTheInput) {
  const Index poked = vertex_near(Vector3(4, 4, 0));
  const Vector3 at = patch_.position(poked);
  patch_.move(poked, at - Vector3(0, 0, 0.8));
  expect_untangled(PatchDefect::meets_input, at, 2.5);
}

TEST_F(PatchUntangling, AVertexThroughAnotherTriangle) {
  // Under its neighbours and through the walls of a dent beyond them.
  const Index poked = vertex_near(Vector3(3, 4, 0)), dented = vertex_near(Vector3(5, 4, 0));
  ASSERT_FALSE(patch_.joined(poked, dented));
  const Vector3 at = patch_.position(poked), dent = patch_.position(dented) - Vector3(0, 0, 0.4);
  patch_.move(dented, dent);
  patch_.move(poked, dent + Vector3(0.03, 0.05, 0.2));
  expect_untangled(PatchDefect::meets_itself, at, 4.5);
}

TEST_F(PatchUntangling, AFoldInThePlane) {
  const Index poked = vertex_near(Vector3(5, 3, 0));
  Index neighbour = poked;
  patch_.for_neighbours(poked, [&](Index v) {
    if (!patch_.on_rim(v)) neighbour = v;
  });
  ASSERT_NE(neighbour, poked);
  const Vector3 at = patch_.position(poked);
  patch_.move(poked, at + 1.4 * (patch_.position(neighbour) - at));
  expect_untangled(PatchDefect::meets_itself, at, 4.5);
}

// A spike from below, through the middle of the lid.
TEST_F(PatchUntangling, ObstaclesAreKeptClearOf) {
  const Vector3 place = patch_.position(vertex_near(Vector3(4, 4, 0)));
  const std::vector<Corners> spike = {
      {place + Vector3(0.05, 0.02, 0.2), place + Vector3(0.1, 0.03, -0.3), place + Vector3(0.05, 0.1, -0.3)}};
  const auto tangled = [&] {
    std::vector<Index> list;
    for (const auto& [mine, other] : improper_pairs_between(patch_corners(), spike)) list.push_back(mine);
    return list;
  };
  ASSERT_FALSE(tangled().empty());
  for (int i = 0; i < 5 && !tangled().empty(); ++i) untangle(patch_, tangled(), input_, spike, {}, i / 2, 3);
  EXPECT_TRUE(tangled().empty());
  EXPECT_TRUE(check().passed());
}

// Two triangles on a rim of four have nothing to move: they get a vertex.
TEST(PatchUntanglingOnARim, TrianglesWithoutAnInnerVertexGetOne) {
  const std::vector<Vector3> rim = {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}};
  PatchMesh patch(rim, 4, {{0, 1, 2}, {0, 2, 3}});
  const TriangleMesh nothing;
  const std::vector<Corners> spike = {{Vector3(2, 1.5, 0.3), Vector3(2.1, 1.5, -1), Vector3(1.9, 1.6, -1)}};
  const InputNeighbourhood input(nothing);
  const std::size_t moved = untangle(patch, {0}, input, spike, {}, 0, 5);
  EXPECT_EQ(patch.vertex_count(), 5u);
  EXPECT_GT(moved, 0u);
  std::vector<Corners> triangles;
  for (const Triangle& t : patch.triangles())
    triangles.push_back({patch.position(t[0]), patch.position(t[1]), patch.position(t[2])});
  EXPECT_TRUE(improper_pairs_between(triangles, spike).empty());
  EXPECT_TRUE(improper_pairs(triangles).empty());
  for (Index v = 0; v < 4; ++v) EXPECT_EQ(patch.position(v), rim[v]);
}

// A single triangle has no inner edge to split: it gets a vertex in its middle.
TEST(PatchUntanglingOnARim, ALoneTriangleIsSplitInThree) {
  PatchMesh patch({{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}, 3, {{0, 1, 2}});
  const TriangleMesh nothing;
  const std::vector<Corners> spike = {{Vector3(1, 1, 0.3), Vector3(1.1, 1, -1), Vector3(0.9, 1.1, -1)}};
  untangle(patch, {0}, InputNeighbourhood(nothing), spike, {}, 0, 5);
  ASSERT_EQ(patch.vertex_count(), 4u);
  ASSERT_EQ(patch.triangle_count(), 3u);
  std::vector<Corners> triangles;
  for (const Triangle& t : patch.triangles())
    triangles.push_back({patch.position(t[0]), patch.position(t[1]), patch.position(t[2])});
  EXPECT_TRUE(improper_pairs_between(triangles, spike).empty());
}

TEST_F(PatchUntangling, NoRoundsOnlyRound) {
  const Index poked = vertex_near(Vector3(4, 4, 0));
  patch_.move(poked, patch_.position(poked) - Vector3(0, 0, 0.8));
  const std::vector<Vector3> before = patch_.positions();
  EXPECT_EQ(untangle(patch_, check().patch_triangles, input_, {}, {}, 0, 0), 0u);
  for (Index v = 0; v < before.size(); ++v) EXPECT_EQ(patch_.position(v), as_stored(before[v]));
}

TEST_F(PatchUntangling, CanBeCancelled) {
  const Index poked = vertex_near(Vector3(4, 4, 0));
  patch_.move(poked, patch_.position(poked) - Vector3(0, 0, 0.8));
  EXPECT_THROW(untangle(patch_, check().patch_triangles, input_, {}, {}, 0, 3,
                        Progress([](double, const std::string&) { return false; })),
               Cancelled);
}

}  // namespace
}  // namespace meshcomplete
