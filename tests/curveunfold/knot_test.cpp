#include "filter_curveunfold/knot.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <limits>

#include "filter_curveunfold/triangle_moves.h"
#include "tests/support/loop_families.h"

namespace meshcomplete {
namespace {

TEST(KnotDeterminant, of_known_knots) {
  EXPECT_EQ(knot_determinant(testing::torus_knot(60, 2, 3)), 3);
  EXPECT_EQ(knot_determinant(testing::figure_eight_knot(80)), 5);
  EXPECT_EQ(knot_determinant(testing::torus_knot(80, 2, 5)), 5);
  EXPECT_EQ(knot_determinant(testing::torus_knot(90, 2, 7)), 7);
  EXPECT_EQ(knot_determinant(testing::torus_knot(120, 3, 4)), 3);
  EXPECT_EQ(knot_determinant(testing::torus_knot(150, 3, 5)), 1);  // a knot that the determinant does not see
}

TEST(KnotDeterminant, multiplies_under_connected_sums) {
  const testing::Loop trefoil = testing::torus_knot(60, 2, 3), figure_eight = testing::figure_eight_knot(80);
  EXPECT_EQ(knot_determinant(testing::connected_sum(trefoil, figure_eight)), 15);
  testing::Loop sum = trefoil;
  for (int k = 0; k < 3; ++k) sum = testing::connected_sum(sum, trefoil);
  EXPECT_EQ(knot_determinant(sum), 81);
}

TEST(KnotDeterminant, saturates_where_int_ends) {
  testing::Loop sum = testing::figure_eight_knot(60);
  for (int k = 0; k < 14; ++k) sum = testing::connected_sum(sum, testing::figure_eight_knot(60));  // 5^15
  EXPECT_EQ(knot_determinant(sum), std::numeric_limits<int>::max());
}

TEST(KnotDeterminant, of_unknots_is_one) {
  EXPECT_EQ(knot_determinant(testing::wound_rim(60, 5)), 1);
  EXPECT_EQ(knot_determinant(testing::wound_round_cylinder(81, 3)), 1);
  for (std::uint64_t seed = 1; seed <= 10; ++seed)
    EXPECT_EQ(knot_determinant(testing::random_tangle(40, seed)), 1);
}

TEST(KnotDeterminant, does_not_depend_on_position_direction_and_mirroring) {
  const Eigen::AngleAxisd turn(1.1, Vector3(1, 2, 3).normalized());
  testing::Loop loop = testing::figure_eight_knot(70);
  for (Vector3& p : loop) p = turn * p;
  std::reverse(loop.begin(), loop.end());
  EXPECT_EQ(knot_determinant(loop), 5);
  for (Vector3& p : loop) p.x() = -p.x();
  EXPECT_EQ(knot_determinant(loop), 5);
}

TEST(KnotDeterminant, is_not_claimed_for_loops_that_touch_themselves) {
  testing::Loop loop = testing::torus_knot(60, 2, 3);
  loop[30] = loop[3];
  EXPECT_FALSE(knot_determinant(loop));
}

TEST(TriangleMoves, keep_the_knot_type) {
  for (const auto& [loop, determinant] :
       {std::pair(testing::torus_knot(200, 2, 3), 3), std::pair(testing::figure_eight_knot(200), 5),
        std::pair(testing::torus_knot(300, 3, 4), 3)}) {
    ReducedLoop reduced = unreduced(loop.size());
    reduce(loop, ReductionLimits(), reduced);
    EXPECT_LT(reduced.kept.size(), 40u);
    EXPECT_GE(reduced.kept.size(), 6u);
    EXPECT_EQ(reduced.kept.size() + reduced.removals.size(), loop.size());
    EXPECT_EQ(knot_determinant(kept_points(loop, reduced)), determinant);
  }
}

TEST(TriangleMoves, reduce_easy_unknots_to_a_triangle) {
  for (const testing::Loop& loop :
       {testing::wound_rim(100, 3), testing::saddle(100, 5, 1), testing::closed_helix(200, 5)}) {
    ReducedLoop reduced = unreduced(loop.size());
    reduce(loop, ReductionLimits(), reduced);
    EXPECT_EQ(reduced.kept.size(), 3u);
  }
}

TEST(TriangleMoves, respect_their_limits) {
  const testing::Loop loop = testing::saddle(400, 3, 0.5);
  ReductionLimits limits;
  limits.least_points = 60;
  ReducedLoop reduced = unreduced(loop.size());
  reduce(loop, limits, reduced);
  EXPECT_EQ(reduced.kept.size(), 60u);
  limits.least_points = 3;
  limits.largest_height = 1e-3;
  limits.longest_chord = 0.2;
  reduced = unreduced(loop.size());
  reduce(loop, limits, reduced);
  EXPECT_LT(reduced.kept.size(), 200u);
  const testing::Loop kept = kept_points(loop, reduced);
  for (std::size_t i = 0; i < kept.size(); ++i)
    EXPECT_LE((kept[(i + 1) % kept.size()] - kept[i]).norm(), 0.2);
}

TEST(TriangleMoves, reinserted_points_give_a_simple_polygon_in_the_loops_order) {
  const testing::Loop loop = testing::wound_rim(300, 4);
  ReducedLoop reduced = unreduced(loop.size());
  reduce(loop, ReductionLimits(), reduced);
  ASSERT_EQ(reduced.kept.size(), 3u);
  const Polygon triangle = {Vector2(0, 0), Vector2(1, 0), Vector2(0, 1)};
  Polygon polygon = reinserted(triangle, reduced);
  ASSERT_EQ(polygon.size(), loop.size());
  EXPECT_TRUE(is_simple(polygon));
  EXPECT_GT(signed_area(polygon), 0);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(polygon[reduced.kept[k]], triangle[k]);
}

}  // namespace
}  // namespace meshcomplete
