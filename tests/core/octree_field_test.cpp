#include "common/core/octree_field.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <memory>
#include <random>
#include <vector>

namespace meshcomplete {
namespace {

constexpr double step = 1.0 / static_cast<double>(Lattice::steps);

double uniform(std::mt19937_64& random) { return static_cast<double>(random() >> 11) * 0x1p-53; }

std::vector<WantedCube> wanted(int count, int most, std::mt19937_64& random) {
  std::vector<WantedCube> cubes;
  for (int i = 0; i < count; ++i) {
    WantedCube one;
    for (std::int64_t& x : one.point) x = static_cast<std::int64_t>(random() % Lattice::steps);
    one.depth = 1 + static_cast<int>(random() % most);
    cubes.push_back(one);
  }
  return cubes;
}

/// The field on the unit cube whose corners have the function's values. Corners on coarser leaves' faces and
/// edges get the means that the field asks for, when the tree is balanced.
OctreeField field_of(std::shared_ptr<const CornerOctree> tree, FieldInterpolation interpolation,
                     const std::function<double(const LatticePoint&)>& function, bool balanced) {
  std::vector<std::vector<double>> values(tree->depth());
  for (int d = 1; d <= tree->depth(); ++d) {
    const CornerOctree::Level& level = tree->level(d);
    values[d - 1].resize(level.corner_count);
    for (std::size_t i = 0; i < level.corner_count; ++i) {
      const auto [block, place] = level.owner[i];
      const Index parent = tree->parent(level.first_block + block);
      LatticePoint p = tree->octree()[parent].low;
      std::array<double, 3> share;
      for (int k = 0, at = place; k < 3; ++k, at /= 3) {
        p[k] += at % 3 * Octree::side(d);
        share[k] = at % 3 / 2.0;
      }
      if (balanced && d > 1 && !level.inner[i]) {
        double sum = 0;
        const auto corners = tree->corners(parent);
        for (int c = 0; c < 8; ++c) {
          double weight = 1;
          for (int k = 0; k < 3; ++k) weight *= c >> k & 1 ? share[k] : 1 - share[k];
          sum += weight * values[d - 2][corners[c]];
        }
        values[d - 1][i] = sum;
      } else {
        values[d - 1][i] = function(p);
      }
    }
  }
  return OctreeField(Lattice(Vector3::Zero(), 1), tree, std::move(values), 0, interpolation);
}

double scrambled(const LatticePoint& p) {
  std::uint64_t h = 1;
  for (std::int64_t x : p) h = (h ^ static_cast<std::uint64_t>(x)) * 0x9e3779b97f4a7c15ull, h ^= h >> 29;
  return static_cast<double>(h >> 11) * 0x1p-53;
}

/// The greatest difference between values on both sides of faces, edges and corners between leaves: pairs of
/// points a step apart, where any two corners differ by less than 1.
double greatest_jump(const OctreeField& field, std::mt19937_64& random) {
  const Octree& octree = field.octree().octree();
  double worst = 0;
  std::vector<Index> leaves;
  for (Index cube = 1; cube < octree.size(); ++cube)
    if (octree.is_leaf(cube)) leaves.push_back(cube);
  for (int i = 0; i < 60000; ++i) {
    const LatticeBox box = octree.box(leaves[random() % leaves.size()]);
    Vector3 p, q;
    const unsigned on_plane = 1 + random() % 7;  // a face, an edge or a corner
    for (int k = 0; k < 3; ++k) {
      double x =
          static_cast<double>(box.low[k]) + uniform(random) * static_cast<double>(box.high[k] - box.low[k]);
      if (on_plane >> k & 1) x = static_cast<double>(random() & 1 ? box.low[k] : box.high[k]);
      p[k] = (x - uniform(random)) * step;
      q[k] = (x + uniform(random)) * step;
    }
    worst = std::max(worst, std::abs(field.value(p) - field.value(q)));
  }
  return worst;
}

// The smallest leaf has 2^29 steps at depth 9: values that are continuous change by some 1e-8 in a step.
constexpr double continuous = 1e-7;

TEST(OctreeField, TrilinearIsContinuousOnBalancedTrees) {
  std::mt19937_64 random(1);
  for (int round = 0; round < 3; ++round) {
    const auto tree = std::make_shared<CornerOctree>(wanted(12, 8, random), 1);
    EXPECT_LT(greatest_jump(field_of(tree, FieldInterpolation::trilinear, scrambled, true), random),
              continuous);
  }
}

TEST(OctreeField, TetrahedralIsContinuousBetweenLeavesOfAnyDepths) {
  std::mt19937_64 random(2);
  for (int round = 0; round < 3; ++round) {
    const auto tree = std::make_shared<CornerOctree>(wanted(12, 9, random), 1, CornerOctree::Balance::none);
    EXPECT_LT(greatest_jump(field_of(tree, FieldInterpolation::tetrahedral, scrambled, false), random),
              continuous);
    EXPECT_GT(greatest_jump(field_of(tree, FieldInterpolation::trilinear, scrambled, false), random), 0.01)
        << "the trees are such that continuity takes care";
  }
}

TEST(OctreeField, LinearFunctionsComeOutExactly) {
  std::mt19937_64 random(3);
  const auto tree = std::make_shared<CornerOctree>(wanted(20, 7, random), 2);
  const Vector3 slope(0.3, -0.7, 0.2);
  const auto linear = [&](const LatticePoint& p) {
    return 0.1 + step * (slope[0] * static_cast<double>(p[0]) + slope[1] * static_cast<double>(p[1]) +
                         slope[2] * static_cast<double>(p[2]));
  };
  for (const FieldInterpolation kind : {FieldInterpolation::trilinear, FieldInterpolation::tetrahedral}) {
    const OctreeField field = field_of(tree, kind, linear, true);
    for (int i = 0; i < 1000; ++i) {
      const Vector3 p(uniform(random), uniform(random), uniform(random));
      EXPECT_NEAR(field.value(p), 0.1 + slope.dot(p), 1e-12);
    }
  }
}

TEST(OctreeField, OutsideTheRootTheNearestPointCounts) {
  std::mt19937_64 random(4);
  const auto tree = std::make_shared<CornerOctree>(wanted(5, 4, random), 1);
  for (const FieldInterpolation kind : {FieldInterpolation::trilinear, FieldInterpolation::tetrahedral}) {
    const OctreeField field = field_of(tree, kind, scrambled, true);
    EXPECT_NEAR(field.value({0.3, 1.7, -2}), field.value({0.3, 1, 0}), continuous);
    EXPECT_NEAR(field.value({9, 9, 9}), field.value({1, 1, 1}), continuous);
  }
}

TEST(OctreeField, LeafSize) {
  const auto tree = std::make_shared<CornerOctree>(std::vector<WantedCube>{{{1, 1, 1}, 5}}, 1);
  const OctreeField field = field_of(tree, FieldInterpolation::trilinear, scrambled, true);
  EXPECT_DOUBLE_EQ(field.leaf_size({0.01, 0.01, 0.01}), 1.0 / 32);
  EXPECT_DOUBLE_EQ(field.leaf_size({0.9, 0.9, 0.9}), 1.0 / 2);
}

}  // namespace
}  // namespace meshcomplete
