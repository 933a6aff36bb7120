#include "common/core/corner_octree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>
#include <set>
#include <vector>

namespace meshcomplete {
namespace {

std::vector<WantedCube> random_cubes(std::size_t count, int most, unsigned seed) {
  std::mt19937_64 random(seed);
  std::vector<WantedCube> wanted;
  for (std::size_t i = 0; i < count; ++i) {
    WantedCube one;
    for (std::int64_t& x : one.point) x = static_cast<std::int64_t>(random() % Lattice::steps);
    one.depth = static_cast<int>(random() % (most + 1));
    wanted.push_back(one);
  }
  return wanted;
}

std::array<LatticePoint, 8> corner_points(const Octree& octree, Index cube) {
  std::array<LatticePoint, 8> points;
  const LatticeBox box = octree.box(cube);
  for (int c = 0; c < 8; ++c)
    for (int k = 0; k < 3; ++k) points[c][k] = c >> k & 1 ? box.high[k] : box.low[k];
  return points;
}

TEST(CornerOctree, WantedCubesAndTheirNeighboursAreThere) {
  const std::vector<WantedCube> wanted = random_cubes(60, 7, 3);
  const CornerOctree tree(wanted, 2);
  EXPECT_EQ(tree.depth(), 7);
  for (const WantedCube& one : wanted) {
    const std::int64_t side = Octree::side(one.depth);
    for (int n = 0; n < 27; ++n) {
      LatticePoint p = one.point;
      const std::array<int, 3> step = {n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1};
      for (int k = 0; k < 3; ++k) p[k] += step[k] * side;
      if (std::any_of(p.begin(), p.end(), [](std::int64_t x) { return x < 0 || x >= Lattice::steps; }))
        continue;
      EXPECT_GE(tree.octree()[tree.octree().find(p)].depth, one.depth);
    }
  }
}

TEST(CornerOctree, NeighboursDifferByOneLevel) {
  const CornerOctree tree(random_cubes(40, 9, 5), 1);
  const Octree& octree = tree.octree();
  std::size_t steps = 0;
  for (const LeafSquare& square : leaf_squares(octree)) {
    if (square.below == Octree::none || square.above == Octree::none) continue;
    const int difference = octree[square.below].depth - octree[square.above].depth;
    EXPECT_LE(std::abs(difference), 1);
    steps += difference != 0;
  }
  EXPECT_GT(steps, 100u);
}

TEST(CornerOctree, WithoutBalanceOnlyTheWantedCubesAreMade) {
  const CornerOctree tree({{{5, 5, 5}, 9}}, 1, CornerOctree::Balance::none);
  EXPECT_EQ(tree.octree().size(), 1 + 8 * 9u);
  EXPECT_EQ(tree.octree()[tree.octree().find({5, 5, 5})].depth, 9);
}

// Numbers are those of places, blocks are consecutive, and what is said of corners holds.
TEST(CornerOctree, CornersAreNumberedByPlace) {
  const CornerOctree tree(random_cubes(50, 6, 7), 2);
  const Octree& octree = tree.octree();
  std::size_t inner = 0, hanging = 0;
  for (int depth = 1; depth <= tree.depth(); ++depth) {
    const CornerOctree::Level& level = tree.level(depth);
    std::map<Index, LatticePoint> place;
    std::map<LatticePoint, int> cubes;
    std::set<LatticePoint> places;
    for (Index b = 0; b < level.corners.size(); ++b)
      for (int child = 0; child < 8; ++child) {
        const Index cube = CornerOctree::first_cube(level.first_block + b) + child;
        ASSERT_EQ(octree[cube].depth, depth);
        ASSERT_EQ(octree[tree.parent(CornerOctree::block_of(cube))].children, cube - child);
        const auto corners = tree.corners(cube);
        const auto points = corner_points(octree, cube);
        for (int c = 0; c < 8; ++c) {
          ASSERT_LT(corners[c], level.corner_count);
          const auto [it, fresh] = place.emplace(corners[c], points[c]);
          ASSERT_EQ(it->second, points[c]);
          places.insert(points[c]);
          ++cubes[points[c]];
        }
      }
    ASSERT_EQ(places.size(), level.corner_count);
    for (const auto& [number, point] : place) {
      int all = 8;
      bool outside = false;
      for (std::int64_t x : point)
        if (x == 0 || x == Lattice::steps) all /= 2, outside = true;
      EXPECT_EQ(level.inner[number] != 0, cubes[point] == all);
      EXPECT_EQ(level.outside[number] != 0, outside);
      inner += level.inner[number] != 0;
      hanging += level.inner[number] == 0;
      const auto [block, at] = level.owner[number];
      EXPECT_EQ(level.corners[block][at], number);
    }
    std::size_t grouped = 0;
    for (const std::vector<Index>& group : level.groups) {
      std::set<Index> used;
      for (Index b : group)
        for (Index corner : level.corners[b]) EXPECT_TRUE(used.insert(corner).second);
      grouped += group.size();
    }
    EXPECT_EQ(grouped, level.corners.size());
  }
  EXPECT_GT(inner, 500u);
  EXPECT_GT(hanging, 500u);
}

}  // namespace
}  // namespace meshcomplete
