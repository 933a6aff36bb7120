#include "filter_atomicvolumes/face_cost.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "filter_atomicvolumes/labelling.h"
#include "tests/poissoncompletion/oracles.h"
#include "tests/support/volumes.h"

namespace meshcomplete {
namespace {

using test::Oracle;

TEST(FaceCost, OnlyTheWeightThatAsksForAnOracleHasOne) {
  const Oracle plane([](const Vector3& p) { return p.x(); });
  for (CutWeight weight : {CutWeight::area, CutWeight::balanced, CutWeight::unit})
    EXPECT_EQ(FaceCost(weight, &plane).closeness({0, 0, 0}, 1), 1);
  EXPECT_EQ(FaceCost(CutWeight::poisson).closeness({0, 0, 0}, 1), 1) << "without one it is the area";
  EXPECT_EQ(FaceCost(CutWeight::poisson).most(0.0625), 0.0625);
  EXPECT_LT(FaceCost(CutWeight::poisson, &plane).closeness({0, 0, 0}, 1), 0.1);
}

// The distance is the function's value over its slope: how steep it is does not matter, nor where it is.
TEST(FaceCost, GrowsWithTheDistanceFromTheZeroSet) {
  for (double slope : {1e-3, 1.0, 1e3}) {
    const Oracle plane([=](const Vector3& p) { return slope * (0.6 * p.x() + 0.8 * p.y() - 2); });
    const FaceCost cost(CutWeight::poisson, &plane);
    const auto at = [&](double distance, double size) {
      return cost.closeness((2 + distance) * Vector3(0.6, 0.8, 0) + Vector3(0, 0, 7), size);
    };
    for (double size : {0.01, 1.0}) {
      EXPECT_NEAR(at(0, size), 0.05, 1e-9) << "never for nothing";
      double last = at(0, size);
      for (double share : {0.2, 0.4, 0.6, 0.8}) {
        EXPECT_GT(at(share * size, size), last);
        EXPECT_NEAR(at(share * size, size), at(-share * size, size), 1e-9) << "either side";
        last = at(share * size, size);
      }
      EXPECT_NEAR(at(1.01 * size, size), 1, 1e-9);
      EXPECT_EQ(at(5 * size, size), 1);
    }
    EXPECT_LT(at(0.3, 1), at(0.3, 0.4)) << "in units of the face";
  }
}

TEST(FaceCost, WhereTheFunctionIsConstantNothingIsNear) {
  for (double value : {-0.5, 0.0, 0.5}) {
    const Oracle constant([=](const Vector3&) { return value; });
    EXPECT_EQ(FaceCost(CutWeight::poisson, &constant).closeness({1, 2, 3}, 0.5), 1);
  }
}

// Two caps of a sphere, and whether the middle between them is inside.
TEST(FaceCost, TheCutFollowsTheOracle) {
  const test::PlacedMesh placed(test::two_caps(3, 0.6), 1);
  const auto division = test::divide(placed);
  ASSERT_TRUE(division);
  const LatticeMesh& mesh = placed.lattice_mesh;
  const Cell middle =
      division->complex.cube_cells[division->decomposition.octree.find(mesh.lattice.snap({0, 0, 0}))];
  ASSERT_GE(middle, 0);
  const auto joins = [&](const FaceCost& cost) {
    return cut_complex(mesh, division->complex, cost, {}).is_inside(middle);
  };
  const Oracle ball([](const Vector3& p) { return p.norm() - 1; });
  const Oracle lids([](const Vector3& p) { return std::max(p.norm() - 1, 0.6 - std::abs(p.z())); });
  EXPECT_TRUE(joins({CutWeight::poisson, &ball}));
  EXPECT_FALSE(joins({CutWeight::poisson, &lids}));
  EXPECT_FALSE(joins(CutWeight::area)) << "the caps' discs have less area than the band between them";
  EXPECT_FALSE(joins(CutWeight::poisson)) << "nor is there an oracle that says so";
}

TEST(FaceCost, MeasuresAreThoseOfTheCut) {
  const Oracle ball([](const Vector3& p) { return p.norm() - 1; });
  const test::PlacedMesh placed(test::sphere_with_hole(2, 0.7), 2);
  const auto division = test::divide(placed);
  ASSERT_TRUE(division);
  const FaceMeasure plain = measure_faces(placed.lattice_mesh, division->complex, CutWeight::area);
  std::vector<FaceMeasure> near;
  for (std::size_t threads : {1, 2}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    near.push_back(measure_faces(placed.lattice_mesh, division->complex, {CutWeight::poisson, &ball}));
  }
  EXPECT_EQ(near[0].of_node, near[1].of_node);
  EXPECT_EQ(near[0].mean_area, plain.mean_area);
  EXPECT_LT(near[0].mean_cost, plain.mean_cost);
  std::size_t less = 0;
  for (std::size_t node = 0; node < plain.of_node.size(); ++node) {
    EXPECT_LE(near[0].of_node[node], plain.of_node[node] * (1 + 1e-12));
    EXPECT_GE(near[0].of_node[node], 0.05 * plain.of_node[node] * (1 - 1e-12));
    less += near[0].of_node[node] < 0.9 * plain.of_node[node];
  }
  EXPECT_GT(less, plain.of_node.size() / 10);
}

}  // namespace
}  // namespace meshcomplete
