#include "common/core/patch_surroundings.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>
#include <vector>

#include "common/core/triangle_intersection.h"
#include "tests/support/lid.h"

namespace meshcomplete {
namespace {

using Corners = std::array<Vector3, 3>;

class PatchSurroundingsOfALid : public test::BoxWithLid {
 protected:
  PatchSurroundingsOfALid() {
    for (int i = 0; i < 40; ++i) obstacles_.push_back(triangle_at(place()));
    obstacles_.push_back({Vector3(4, 4, -1), Vector3(4, 4, 0), Vector3(4, 4, 1)});  // meets nothing
  }

  double uniform(double low, double high) { return low + (high - low) * random_() * 0x1p-32; }
  Vector3 place() { return {uniform(0, 8), uniform(0, 8), uniform(-0.5, 0.5)}; }
  Corners triangle_at(const Vector3& centre) {
    Corners c;
    for (Vector3& p : c) p = centre + Vector3(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1));
    return c;
  }

  /// How many triangles of the patch but `left_out`, of the input, and obstacles a triangle meets.
  std::size_t met_by(const Corners& triangle, const std::vector<Index>& left_out) const {
    const auto meets = [&](const Corners& other) {
      return !collinear(other[0], other[1], other[2]) && meet_improperly(triangle, other);
    };
    std::size_t sum = 0;
    const std::vector<Corners> patch = patch_corners();
    for (Index t = 0; t < patch.size(); ++t)
      sum += std::find(left_out.begin(), left_out.end(), t) == left_out.end() && meets(patch[t]);
    for (const Corners& other : test::corners_of(mesh_)) sum += meets(other);
    for (const Corners& other : obstacles_) sum += meets(other);
    return sum;
  }
  std::vector<Index> star_of(Index vertex) const {
    std::vector<Index> star;
    patch_.for_outgoing(vertex, [&](Index h) { star.push_back(h / 3); });
    return star;
  }
  static Box box_round(const Corners& c) { return bounding_box(c[0], c[1], c[2]); }

  std::mt19937 random_{5};
  std::vector<Corners> obstacles_;
};

TEST_F(PatchSurroundingsOfALid, CountsWhatATriangleMeets) {
  PatchSurroundings surroundings(patch_, input_, obstacles_);
  std::size_t most = 0;
  for (int i = 0; i < 200; ++i) {
    const Corners c = triangle_at(place());
    surroundings.collect(box_round(c), [](Index t) { return t == 3; });
    const std::size_t count = met_by(c, {3});
    EXPECT_EQ(surroundings.met_by(c), count);
    EXPECT_EQ(surroundings.met_by(c, 1), std::min<std::size_t>(count, 1));
    most = std::max(most, count);
  }
  EXPECT_GT(most, 5u);
  // Added by hand, until the next time.
  const Corners high = {Vector3(0, 0, 9), Vector3(1, 0, 9), Vector3(0, 1, 9)};
  const Corners through = {Vector3(0.2, 0.2, 8), Vector3(0.3, 0.2, 8), Vector3(0.2, 0.3, 10)};
  surroundings.collect(box_round(through), [](Index) { return false; });
  surroundings.add(high);
  EXPECT_EQ(surroundings.met_by(through), 1u);
  surroundings.collect(box_round(through), [](Index) { return false; });
  EXPECT_EQ(surroundings.met_by(through), 0u);
}

// In focus only what is near is looked through; for a box that reaches further, all is.
TEST_F(PatchSurroundingsOfALid, FocusChangesNoCount) {
  PatchSurroundings surroundings(patch_, input_, obstacles_);
  for (const Vector3& at : {Vector3(1, 1, 0), Vector3(4, 4, 0), Vector3(7, 3, 0)}) {
    surroundings.focus({star_of(vertex_near(at))[0]});
    for (int i = 0; i < 100; ++i) {
      const Vector3 near = at + Vector3(uniform(-1, 1), uniform(-1, 1), uniform(-0.5, 0.5));
      for (const Corners& c : {triangle_at(near), triangle_at(place())}) {
        surroundings.collect(box_round(c), [](Index t) { return t == 5; });
        EXPECT_EQ(surroundings.met_by(c), met_by(c, {5}));
      }
    }
  }
}

TEST_F(PatchSurroundingsOfALid, TrianglesMadeAfterTheFocusAreSeen) {
  PatchSurroundings surroundings(patch_, input_, obstacles_);
  const Index middle = vertex_near(Vector3(4, 4, 0));
  surroundings.focus(star_of(middle));
  // A peak over the middle of an edge: its triangles are lifted, and two of them are new.
  Index edge = PatchMesh::none;
  patch_.for_outgoing(middle, [&](Index h) { edge = h; });
  const Vector3 peak =
      0.5 * (patch_.position(middle) + patch_.position(patch_.target(edge))) + Vector3(0, 0, 3);
  const std::size_t before = patch_.triangle_count();
  patch_.split(edge, peak);
  ASSERT_EQ(patch_.triangle_count(), before + 2);
  const Vector3 side(0.3, 0.3, -0.5);
  const Corners c = {peak - side, peak + side, peak + Vector3(0.3, -0.3, -0.5)};
  const std::size_t count = met_by(c, {});
  ASSERT_GT(count, met_by(c, {static_cast<Index>(before), static_cast<Index>(before + 1)}));
  surroundings.collect(box_round(c), [](Index) { return false; });
  EXPECT_EQ(surroundings.met_by(c), count);
}

TEST_F(PatchSurroundingsOfALid, CountsWhatAStarMeets) {
  PatchSurroundings surroundings(patch_, input_, obstacles_);
  std::size_t most_each_other = 0;
  for (int i = 0; i < 100; ++i) {
    const Index vertex = vertex_near(place());
    const std::vector<Index> star = star_of(vertex);
    // In the plane of the lid the star is folded onto itself.
    const double up = i % 2 == 0 ? 0.0 : uniform(-0.8, 0.8);
    const Vector3 start = patch_.position(vertex), step(uniform(-2, 2), uniform(-2, 2), up);
    surroundings.collect_round(star, step.norm());
    patch_.move(vertex, start + step);
    std::size_t expected = 0, each_other = 0;
    const std::vector<Corners> patch = patch_corners();
    for (std::size_t j = 0; j < star.size(); ++j) {
      expected += met_by(patch[star[j]], star);
      for (std::size_t k = 0; k < j; ++k) each_other += meet_improperly(patch[star[j]], patch[star[k]]);
    }
    expected += each_other;
    most_each_other = std::max(most_each_other, each_other);
    EXPECT_EQ(surroundings.met_by_star(star), expected);
    for (std::size_t enough : {1, 3})
      EXPECT_EQ(surroundings.met_by_star(star, enough), std::min(expected, enough));
    patch_.move(vertex, start);
  }
  EXPECT_GT(most_each_other, 0u);
}

TEST_F(PatchSurroundingsOfALid, DegenerateTrianglesAreWorstInAStar) {
  obstacles_.clear();
  PatchSurroundings surroundings(patch_, input_, obstacles_);
  const Index vertex = vertex_near(Vector3(4, 4, 0));
  const std::vector<Index> star = star_of(vertex);
  surroundings.collect_round(star, 0);
  EXPECT_EQ(surroundings.met_by_star(star), 0u);
  const Index neighbour = patch_.target(3 * star[0] + (patch_.origin(3 * star[0]) == vertex ? 0 : 1));
  ASSERT_NE(neighbour, vertex);
  surroundings.collect_round(star, 2);
  patch_.move(vertex, patch_.position(neighbour));  // two triangles have no area now
  EXPECT_GE(surroundings.met_by_star(star), 2 * PatchSurroundings::degenerate_cost);
  EXPECT_EQ(surroundings.met_by_star(star, 7), 7u);
}

// More triangles of the input than are remembered: the input itself is asked.
TEST(PatchSurroundings, LargeNeighbourhoods) {
  const TriangleMesh mesh = test::rough_sheet(40, 40, 0.3, 0, 2);
  const InputNeighbourhood input(mesh);
  const PatchMesh patch({{0, 0, 9}, {1, 0, 9}, {0, 1, 9}}, 3, {{0, 1, 2}});
  PatchSurroundings surroundings(patch, input, {});
  const Corners large = {Vector3(-1, -1, 0.01), Vector3(50, 1, -0.02), Vector3(1, 50, 0.03)};
  const Box box = bounding_box(large[0], large[1], large[2]);
  ASSERT_GT(mesh.triangles.size(), 2000u);
  std::size_t expected = 0;
  for (const Corners& other : test::corners_of(mesh)) expected += meet_improperly(large, other);
  ASSERT_GT(expected, 100u);
  surroundings.collect(box, [](Index) { return false; });
  EXPECT_EQ(surroundings.met_by(large), expected);
  EXPECT_EQ(surroundings.met_by(large, 10), 10u);
  // What is no triangle of the input counts on top of it.
  surroundings.add({Vector3(20, 20, -1), Vector3(21, 20, -1), Vector3(20, 21, 1)});
  EXPECT_EQ(surroundings.met_by(large), expected + 1);
}

}  // namespace
}  // namespace meshcomplete
