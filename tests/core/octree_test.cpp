#include "common/core/octree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>
#include <set>
#include <vector>

namespace meshcomplete {
namespace {

using Wide = unsigned __int128;

/// Split at random leaves, and along one path to the greatest depth.
Octree random_octree(unsigned seed, int splits) {
  std::mt19937 random(seed);
  Octree octree;
  std::vector<Index> leaves = {0};
  const auto split = [&](std::size_t place) {
    const Index leaf = leaves[place];
    if (octree[leaf].depth >= Lattice::depth) return;
    const Index first = octree.split(leaf);
    leaves[place] = first;
    for (Index child = first + 1; child < first + 8; ++child) leaves.push_back(child);
  };
  for (int i = 0; i < splits; ++i) split(random() % leaves.size());
  if (seed % 2 == 0)
    for (int depth = 0; depth < Lattice::depth; ++depth) {
      const auto deepest = std::max_element(
          leaves.begin(), leaves.end(), [&](Index a, Index b) { return octree[a].depth < octree[b].depth; });
      split(static_cast<std::size_t>(deepest - leaves.begin()));
    }
  return octree;
}

std::vector<Index> leaves_of(const Octree& octree) {
  std::vector<Index> leaves;
  for (Index cube = 0; cube < octree.size(); ++cube)
    if (octree.is_leaf(cube)) leaves.push_back(cube);
  return leaves;
}

std::vector<LatticePoint> corners_of(const Octree& octree, Index cube) {
  std::vector<LatticePoint> corners;
  const LatticeBox box = octree.box(cube);
  for (int place = 0; place < 8; ++place) {
    LatticePoint p = box.low;
    for (std::size_t k = 0; k < 3; ++k)
      if (place >> k & 1) p[k] = box.high[k];
    corners.push_back(p);
  }
  return corners;
}

std::set<LatticePoint> all_corners(const Octree& octree) {
  std::set<LatticePoint> corners;
  for (Index leaf : leaves_of(octree))
    for (const LatticePoint& p : corners_of(octree, leaf)) corners.insert(p);
  return corners;
}

/// Half open: every point of the root is in just one leaf.
bool holds(const LatticeBox& box, const LatticePoint& p) {
  for (std::size_t k = 0; k < 3; ++k)
    if (p[k] < box.low[k] || p[k] >= box.high[k]) return false;
  return true;
}

TEST(Octree, LeavesTileTheRoot) {
  for (unsigned seed = 1; seed <= 6; ++seed) {
    const Octree octree = random_octree(seed, 60);
    const std::vector<Index> leaves = leaves_of(octree);
    Wide sum = 0;
    for (Index leaf : leaves) {
      const LatticeBox box = octree.box(leaf);
      const std::int64_t side = Octree::side(octree[leaf].depth);
      for (std::size_t k = 0; k < 3; ++k) {
        ASSERT_EQ(box.high[k] - box.low[k], side);
        ASSERT_EQ(box.low[k] % side, 0);
        ASSERT_EQ(octree.centre(leaf)[k], box.low[k] + side / 2);
      }
      sum += Wide(side) * Wide(side) * Wide(side);
    }
    EXPECT_EQ(sum, Wide(Lattice::steps) * Wide(Lattice::steps) * Wide(Lattice::steps));
    // Equal volumes, and no two of them hold each other's middle: no overlap, no gap.
    for (Index leaf : leaves)
      for (Index other : leaves) ASSERT_EQ(holds(octree.box(leaf), octree.centre(other)), leaf == other);
  }
}

TEST(Octree, FindsTheCubeOfAPoint) {
  for (unsigned seed = 1; seed <= 4; ++seed) {
    const Octree octree = random_octree(seed, 40);
    std::mt19937_64 random(seed);
    std::vector<LatticePoint> points;
    for (int i = 0; i < 200; ++i) {
      LatticePoint p;
      for (std::int64_t& c : p) c = static_cast<std::int64_t>(random() % std::uint64_t(Lattice::steps));
      points.push_back(p);
    }
    for (const LatticePoint& p : all_corners(octree)) points.push_back(p);
    for (const LatticePoint& p : points) {
      const Index leaf = octree.find(p);
      ASSERT_TRUE(octree.is_leaf(leaf));
      if (*std::max_element(p.begin(), p.end()) < Lattice::steps) {
        ASSERT_TRUE(holds(octree.box(leaf), p));
      } else {
        ASSERT_TRUE(octree.box(leaf).contains(p)) << "on the outside of the root";
      }
      for (int depth : {0, 1, 3}) {
        const Index cube = octree.find(p, depth);
        ASSERT_LE(octree[cube].depth, depth);
        ASSERT_TRUE(octree.box(cube).contains(p));
        ASSERT_TRUE(octree[cube].depth == depth || octree.is_leaf(cube));
      }
    }
  }
}

TEST(Octree, ChildrenLieAtTheirPlaces) {
  Octree octree;
  const Index first = octree.split(0);
  ASSERT_EQ(first, 1u);
  EXPECT_FALSE(octree.is_leaf(0));
  EXPECT_EQ(octree[0].children, first);
  for (Index place = 0; place < 8; ++place) {
    EXPECT_TRUE(octree.is_leaf(first + place));
    EXPECT_EQ(octree[first + place].depth, 1);
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_EQ(octree[first + place].low[k], (place >> k & 1) ? Lattice::steps / 2 : 0);
  }
}

/// Calls `visit(start, axis, length)` for the twelve edges of every leaf.
template <class Visit>
void for_edges(const Octree& octree, Visit visit) {
  for (Index leaf : leaves_of(octree)) {
    const std::int64_t length = Octree::side(octree[leaf].depth);
    for (const LatticePoint& p : corners_of(octree, leaf))
      for (std::size_t axis = 0; axis < 3; ++axis)
        if (p[axis] == octree.box(leaf).low[axis]) visit(p, axis, length);
  }
}

TEST(Octree, MidpointsAndCornersOnEdgesAreThoseOfLeaves) {
  for (unsigned seed = 1; seed <= 4; ++seed) {
    const Octree octree = random_octree(seed, 50);
    const std::set<LatticePoint> corners = all_corners(octree);
    int with_midpoint = 0, with_more = 0;
    for_edges(octree, [&](const LatticePoint& start, std::size_t axis, std::int64_t length) {
      LatticePoint middle = start, end = start;
      middle[axis] += length / 2;
      end[axis] += length;
      if (length > Lattice::cell) {
        const bool expected = corners.count(middle) != 0;
        with_midpoint += expected;
        ASSERT_EQ(octree.has_midpoint(start, static_cast<int>(axis), length), expected);
      }
      std::vector<LatticePoint> on_edge;
      for (const LatticePoint& p : corners)
        if (p[(axis + 1) % 3] == start[(axis + 1) % 3] && p[(axis + 2) % 3] == start[(axis + 2) % 3] &&
            p[axis] >= start[axis] && p[axis] <= end[axis])
          on_edge.push_back(p);
      with_more += on_edge.size() > 3;
      ASSERT_EQ(octree.corners_on(start, static_cast<int>(axis), length), on_edge);
    });
    EXPECT_GT(with_midpoint, 50);
    EXPECT_GT(with_more, 5);
  }
}

TEST(LeafSquares, TileTheSurfaceOfEveryLeaf) {
  for (unsigned seed = 1; seed <= 4; ++seed) {
    const Octree octree = random_octree(seed, 60);
    // Covered area by leaf, axis and which of its two sides.
    std::map<std::tuple<Index, int, bool>, Wide> covered;
    for (const LeafSquare& s : leaf_squares(octree)) {
      const Wide area = Wide(s.length) * Wide(s.length);
      for (bool above : {false, true}) {
        const Index leaf = above ? s.above : s.below;
        if (leaf == Octree::none) {
          ASSERT_EQ(s.low[static_cast<std::size_t>(s.axis)], above ? Lattice::steps : 0);
          continue;
        }
        ASSERT_TRUE(octree.is_leaf(leaf));
        const LatticeBox cube = octree.box(leaf), square = s.box();
        ASSERT_TRUE(cube.contains(square.low) && cube.contains(square.high));
        const auto axis = static_cast<std::size_t>(s.axis);
        ASSERT_EQ(square.low[axis], square.high[axis]);
        ASSERT_EQ(square.low[axis], above ? cube.low[axis] : cube.high[axis]);
        covered[{leaf, s.axis, above}] += area;
      }
      const std::int64_t below =
                             s.below == Octree::none ? Lattice::steps : Octree::side(octree[s.below].depth),
                         above =
                             s.above == Octree::none ? Lattice::steps : Octree::side(octree[s.above].depth);
      ASSERT_EQ(s.length, std::min(below, above)) << "a face of the finer one";
    }
    // Full, and no square twice: then nothing overlaps, because squares lie on the grid of their size.
    for (Index leaf : leaves_of(octree))
      for (int axis = 0; axis < 3; ++axis)
        for (bool above : {false, true}) {
          const Wide side = Wide(Octree::side(octree[leaf].depth));
          ASSERT_EQ((covered[{leaf, axis, above}]), side * side);
        }
    std::set<std::tuple<LatticePoint, std::int64_t, int>> places;
    for (const LeafSquare& s : leaf_squares(octree))
      ASSERT_TRUE(places.emplace(s.low, s.length, s.axis).second) << "a square twice";
  }
}

TEST(LeafSquares, CornersGoCounterClockwiseSeenFromAbove) {
  const Octree octree = random_octree(3, 10);
  for (const LeafSquare& s : leaf_squares(octree)) {
    const std::array<LatticePoint, 4> c = s.corners();
    LatticePoint above = c[0];
    above[static_cast<std::size_t>(s.axis)] += 1;
    EXPECT_EQ(c[0], s.low);
    EXPECT_EQ(orientation(c[0], c[1], c[2], above), 1);
    EXPECT_EQ(orientation(c[0], c[2], c[3], above), 1);
    for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(2 * s.centre()[k], c[0][k] + c[2][k]);
    EXPECT_EQ(c[2], s.box().high);
  }
}

}  // namespace
}  // namespace meshcomplete
