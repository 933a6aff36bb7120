#include "common/core/dynamic_box_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <vector>

namespace meshcomplete {
namespace {

class RandomBoxes {
 public:
  explicit RandomBoxes(unsigned seed) : random_(seed) {}

  double uniform() { return static_cast<double>(random_() >> 11) * 0x1p-53; }
  std::size_t below(std::size_t n) { return random_() % n; }

  /// Sizes from 2^-40 to 2^20, some boxes flat or points, most of them crowded about the origin.
  Box box() {
    const double size = below(8) == 0 ? 0 : std::ldexp(1 + uniform(), static_cast<int>(below(60)) - 40);
    const double spread = std::ldexp(1.0, static_cast<int>(below(30)) - 25);
    Box box;
    for (std::size_t k = 0; k < 3; ++k) {
      box.low[k] = spread * (uniform() - 0.5);
      box.high[k] = box.low[k] + (below(5) == 0 ? 0 : size * uniform());
    }
    return box;
  }

 private:
  std::mt19937_64 random_;
};

std::vector<Index> visited(const DynamicBoxTree& grid, const Box& box) {
  std::vector<Index> found;
  EXPECT_TRUE(grid.visit(box, [&](Index number) {
    found.push_back(number);
    return true;
  }));
  std::sort(found.begin(), found.end());
  return found;
}

std::vector<Index> expected(const std::map<Index, Box>& boxes, const Box& box) {
  std::vector<Index> found;
  for (const auto& [number, one] : boxes)
    if (one.meets(box)) found.push_back(number);
  return found;
}

// Boxes come, go and are replaced; every question is compared with looking at all of them.
TEST(DynamicBoxTree, FindsTheBoxesThatMeetAGivenOne) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    RandomBoxes random(seed);
    DynamicBoxTree grid;
    std::map<Index, Box> boxes;
    std::size_t found = 0;
    for (int step = 0; step < 3000; ++step) {
      const Index number = static_cast<Index>(random.below(300));
      switch (random.below(4)) {
        case 0:
          grid.remove(number);
          boxes.erase(number);
          break;
        case 1: {
          // Moved a little, so that it often stays in its cell.
          const auto at = boxes.find(number);
          if (at == boxes.end()) break;
          for (std::size_t k = 0; k < 3; ++k)
            at->second.high[k] += 1e-3 * random.uniform() * (at->second.high[k] - at->second.low[k]);
          grid.set(number, at->second);
          break;
        }
        default:
          boxes[number] = random.box();
          grid.set(number, boxes[number]);
      }
      ASSERT_EQ(grid.holds(number), boxes.count(number) != 0);
      const Box question = random.box();
      const std::vector<Index> answer = expected(boxes, question);
      ASSERT_EQ(visited(grid, question), answer) << "seed " << seed << " step " << step;
      found += answer.size();
    }
    EXPECT_GT(found, 3000u);
  }
}

TEST(DynamicBoxTree, StopsWhenToldTo) {
  DynamicBoxTree grid;
  const Box unit{{0, 0, 0}, {1, 1, 1}};
  for (Index i = 0; i < 10; ++i) grid.set(i, unit);
  int visits = 0;
  EXPECT_FALSE(grid.visit(unit, [&](Index) { return ++visits < 4; }));
  EXPECT_EQ(visits, 4);
  for (Index i = 0; i < 10; ++i) grid.remove(i);
  EXPECT_TRUE(grid.visit(unit, [&](Index) { return false; })) << "nothing is left";
  grid.remove(3);
  grid.remove(1000);
  EXPECT_FALSE(grid.holds(3));
  EXPECT_FALSE(grid.holds(1000));
}

TEST(DynamicBoxTree, TouchingIsMeeting) {
  DynamicBoxTree grid;
  grid.set(7, {{0, 0, 0}, {1, 1, 1}});
  EXPECT_EQ(visited(grid, {{1, 1, 1}, {2, 2, 2}}), std::vector<Index>{7});
  EXPECT_TRUE(visited(grid, {{1, std::nextafter(1.0, 2.0), 1}, {2, 2, 2}}).empty());
}

// Of boxes in one place the cells at every size may have the same number: growing changes the size only.
TEST(DynamicBoxTree, ABoxMayGrowAndShrinkInPlace) {
  DynamicBoxTree grid;
  const auto cube = [](double low, double side) {
    return Box{{low, low, low}, {low + side, low + side, low + side}};
  };
  for (Index i = 0; i < 3000; ++i) grid.set(i, cube(i, 0.01));  // so that cells are looked up
  for (double side : {0.01, 30.0, 0.001, 900.0, 0.01}) {
    grid.set(0, cube(0, side));
    for (double at : {0.0, 0.009, 20.5, 800.5}) {
      const std::vector<Index> found = visited(grid, cube(at, 1e-4));
      EXPECT_EQ(std::count(found.begin(), found.end(), 0u), at <= side) << side << " " << at;
    }
  }
}

// Points far from the origin: the cells of their size have no numbers that 64 bits could hold.
TEST(DynamicBoxTree, FindsPointsFarFromTheOrigin) {
  DynamicBoxTree grid;
  std::map<Index, Box> boxes;
  const auto point = [](double x, double y, double z) { return Box{{x, y, z}, {x, y, z}}; };
  // So many that the grid looks at cells rather than at all that it holds.
  for (Index i = 0; i < 20000; ++i)
    boxes[i] = point(8 + std::ldexp(double(i) - 10000, -49), 1e-12 * double(i % 7), 1e9);
  for (const auto& [number, box] : boxes) grid.set(number, box);
  for (Index i : {0u, 5000u, 9999u, 10000u, 10001u, 19999u}) {
    Box question = boxes[i];
    question.low[0] -= 0x1p-50;
    ASSERT_EQ(visited(grid, question), expected(boxes, question)) << i;
    ASSERT_FALSE(expected(boxes, question).empty());
  }
}

}  // namespace
}  // namespace meshcomplete
