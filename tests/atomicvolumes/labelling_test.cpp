#include "filter_atomicvolumes/labelling.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <set>
#include <vector>

#include "common/core/error.h"
#include "tests/support/volumes.h"

namespace meshcomplete {
namespace {

using test::Division;
using test::PlacedMesh;

constexpr double infinite = std::numeric_limits<double>::infinity();

/// What separating two cells costs, one entry for each face.
struct Price {
  Cell a, b;
  double weight;
};

double price_of(CutWeight weight, double area) {
  return weight == CutWeight::area ? area : weight == CutWeight::balanced ? std::pow(area, 0.25) : 1.0;
}

std::vector<Price> prices_of(const PlacedMesh& placed, const VolumeComplex& complex, CutWeight weight) {
  std::vector<Price> prices;
  for (const VolumeFace& face : complex.faces) {
    const auto at = [&](std::size_t k) { return complex.vertices[face.corners[k]].position; };
    const double area = 0.5 * (at(1) - at(0)).cross(at(2) - at(0)).norm();
    prices.push_back({face.behind, face.before, price_of(weight, area)});
  }
  for (const VolumeSquare& s : complex.whole_squares) {
    const double side =
        static_cast<double>(complex.squares[s.square].length) * placed.lattice_mesh.lattice.step();
    prices.push_back({s.behind, s.before, price_of(weight, side * side)});
  }
  return prices;
}

/// By definition: all faces between unlike labels, and the ties that are not followed. Faces between volumes
/// that are both known are the same for all labellings and do not count.
double weight_of(const std::vector<Price>& prices, const std::vector<NodeTie>& ties,
                 const Labelling& labels) {
  double sum = 0;
  for (const Price& p : prices)
    if ((p.a >= 0 || p.b >= 0) && p.a != unknown_cell && p.b != unknown_cell &&
        labels.is_inside(p.a) != labels.is_inside(p.b))
      sum += p.weight;
  for (const NodeTie& tie : ties)
    if (labels.is_inside(tie.node) != tie.inside) sum += tie.price;
  return sum;
}

/// The least weight when all nodes but `open` have the labels of `base`: tries all labellings of those.
double least_weight(const std::vector<Price>& prices, const std::vector<NodeTie>& ties, const Labelling& base,
                    const std::vector<Cell>& open) {
  const auto place = [&](Cell cell) { return std::find(open.begin(), open.end(), cell) - open.begin(); };
  const auto n = static_cast<std::ptrdiff_t>(open.size());
  std::vector<Price> near;
  std::vector<NodeTie> own;
  double rest = 0;
  for (const Price& p : prices) {
    if (place(p.a) < n || place(p.b) < n)
      near.push_back(p);
    else
      rest += weight_of({p}, {}, base);
  }
  for (const NodeTie& tie : ties) {
    if (place(tie.node) < n)
      own.push_back(tie);
    else
      rest += weight_of({}, {tie}, base);
  }
  double least = infinite;
  Labelling labels = base;
  for (unsigned bits = 0; bits < 1u << open.size(); ++bits) {
    for (std::size_t i = 0; i < open.size(); ++i)
      labels.inside[static_cast<std::size_t>(open[i])] = bits >> i & 1u;
    least = std::min(least, rest + weight_of(near, own, labels));
  }
  return least;
}

// All nodes but a few, which hang together, are tied to random sides; the cut of the rest is compared with
// trying everything.
TEST(Labelling, TheCutIsTheLeastOfAll) {
  for (CutWeight weight : {CutWeight::area, CutWeight::balanced, CutWeight::unit})
    for (unsigned seed = 1; seed <= 12; ++seed) {
      const PlacedMesh placed(seed % 2 == 0 ? test::open_cylinder(6, 2) : test::sphere_with_hole(1, 0.7),
                              seed);
      const auto division = test::divide(placed);
      ASSERT_TRUE(division);
      const VolumeComplex& complex = division->complex;
      const std::vector<Price> prices = prices_of(placed, complex, weight);
      std::mt19937_64 random(seed);
      std::vector<Cell> open = {static_cast<Cell>(random() % complex.nodes)};
      for (std::size_t i = 0; i < open.size() && open.size() < 11; ++i)
        for (const Price& p : prices)
          for (const auto& [cell, other] : {std::pair(p.a, p.b), std::pair(p.b, p.a)})
            if (cell == open[i] && other >= 0 && open.size() < 11 &&
                std::count(open.begin(), open.end(), other) == 0)
              open.push_back(other);
      const Labelling base = test::random_labelling(complex, seed, 0.5);
      std::vector<NodeTie> ties;
      const double typical = price_of(weight, 1e-3);
      for (Cell node = 0; node < static_cast<Cell>(complex.nodes); ++node) {
        if (std::count(open.begin(), open.end(), node) == 0)
          ties.push_back({node, base.is_inside(node), infinite});
        else if (random() % 3 == 0)
          ties.push_back(
              {node, random() % 2 == 0, weight == CutWeight::unit ? 2.0 : typical * test::uniform(random)});
      }
      const Labelling cut = cut_complex(placed.lattice_mesh, complex, weight, ties);
      ASSERT_EQ(cut.inside.size(), complex.nodes);
      for (const NodeTie& tie : ties)
        if (std::isinf(tie.price)) {
          ASSERT_EQ(cut.is_inside(tie.node), tie.inside);
        }
      const double rounding = 1e-9 * weight_of(prices, {}, base) + 1e-9;
      const double expected = least_weight(prices, ties, base, open);
      EXPECT_NEAR(cut.weight, expected, rounding);
      EXPECT_NEAR(weight_of(prices, ties, cut), expected, rounding) << "the labels are those of the cut";
    }
}

TEST(Labelling, WhatFacesCost) {
  EXPECT_EQ(FaceCost(CutWeight::area).most(0.0625), 0.0625);
  EXPECT_EQ(FaceCost(CutWeight::balanced).most(0.0625), 0.5);
  EXPECT_EQ(FaceCost(CutWeight::balanced).most(16), 2);
  EXPECT_EQ(FaceCost(CutWeight::unit).most(0.0625), 1);
  for (CutWeight weight : {CutWeight::area, CutWeight::balanced, CutWeight::unit}) {
    const PlacedMesh placed(test::sphere_with_hole(1, 0.7), 2);
    const auto division = test::divide(placed);
    ASSERT_TRUE(division);
    std::vector<double> of_node(division->complex.nodes, 0);
    double sum = 0, area = 0;
    const std::vector<Price> prices = prices_of(placed, division->complex, weight);
    for (const Price& p : prices) {
      sum += p.weight;
      for (Cell cell : {p.a, p.b})
        if (cell >= 0) of_node[static_cast<std::size_t>(cell)] += p.weight;
    }
    for (const Price& p : prices_of(placed, division->complex, CutWeight::area)) area += p.weight;
    const double count = static_cast<double>(prices.size());
    const FaceMeasure measure = measure_faces(placed.lattice_mesh, division->complex, weight);
    EXPECT_NEAR(measure.mean_cost, sum / count, 1e-9);
    EXPECT_NEAR(measure.mean_area, area / count, 1e-9);
    ASSERT_EQ(measure.of_node.size(), of_node.size());
    for (std::size_t i = 0; i < of_node.size(); ++i) EXPECT_NEAR(measure.of_node[i], of_node[i], 1e-9);
  }
}

TEST(Labelling, NoOtherLabellingWeighsLess) {
  for (const test::NamedMesh& named : test::holed_meshes()) {
    const PlacedMesh placed(named.mesh, 1);
    const auto division = test::divide(placed);
    if (!division) continue;
    const std::vector<Price> prices = prices_of(placed, division->complex, CutWeight::area);
    const Labelling cut = cut_complex(placed.lattice_mesh, division->complex, CutWeight::area, {});
    const double least = weight_of(prices, {}, cut);
    EXPECT_NEAR(cut.weight, least, 1e-9 * least);
    // One node, or a few, on the other side.
    std::mt19937_64 random(3);
    Labelling other = cut;
    for (int i = 0; i < 200; ++i) {
      if (i % 5 == 0) other = cut;
      char& label = other.inside[random() % other.inside.size()];
      label = label == 0;
      EXPECT_GE(weight_of(prices, {}, other), least * (1 - 1e-9));
    }
  }
}

// A round hole in a sphere: about a disk. As if by hand: the area of the lid is not less than that of the
// flat disk, and not more than a stair of it.
TEST(Labelling, ARoundHoleGetsALid) {
  const PlacedMesh placed(test::sphere_with_hole(3, 0.6), 5);
  const auto division = test::divide(placed);
  ASSERT_TRUE(division);
  const Labelling cut = cut_complex(placed.lattice_mesh, division->complex, CutWeight::area, {});
  const double radius = std::sin(0.6), disk = 3.14159 * radius * radius;
  EXPECT_GT(cut.weight, disk);
  EXPECT_LT(cut.weight, 2 * disk);
}

TEST(Labelling, TiesMoveTheCut) {
  const PlacedMesh placed(test::open_cylinder(9, 3), 5);
  const auto division = test::divide(placed);
  ASSERT_TRUE(division);
  const LatticeMesh& mesh = placed.lattice_mesh;
  // A blank leaf in the middle of the cylinder is inside, unless somebody pays for the opposite.
  const Index cube = division->decomposition.octree.find(mesh.lattice.snap(Vector3(0, 0, 1)));
  const Cell cell = division->complex.cube_cells[cube];
  ASSERT_GE(cell, 0);
  const Labelling free = cut_complex(mesh, division->complex, CutWeight::area, {});
  EXPECT_TRUE(free.is_inside(cell));
  const Labelling cheap = cut_complex(mesh, division->complex, CutWeight::area, {{cell, false, 1e-6}});
  EXPECT_TRUE(cheap.is_inside(cell));
  EXPECT_NEAR(cheap.weight, free.weight + 1e-6, 1e-9);
  const Labelling forced = cut_complex(mesh, division->complex, CutWeight::area, {{cell, false, infinite}});
  EXPECT_FALSE(forced.is_inside(cell));
  EXPECT_GT(forced.weight, free.weight);
  const Labelling bought = cut_complex(mesh, division->complex, CutWeight::area,
                                       {{cell, false, forced.weight - free.weight + 1e-3}});
  EXPECT_FALSE(bought.is_inside(cell));
  EXPECT_THROW(cut_complex(mesh, division->complex, CutWeight::area, {},
                           Progress([](double, const std::string&) { return false; })),
               Cancelled);
}

// Going against a hint never costs more than the hint, also where the cut counts faces.
TEST(Labelling, PricesNeedNotBeWholeFaces) {
  const PlacedMesh placed(test::sphere_with_hole(2, 0.6), 3);
  const auto division = test::divide(placed);
  ASSERT_TRUE(division);
  const auto cut = [&](const std::vector<NodeTie>& ties) {
    return cut_complex(placed.lattice_mesh, division->complex, CutWeight::unit, ties);
  };
  const Labelling plain = cut({});
  EXPECT_EQ(plain.weight, std::round(plain.weight));
  std::size_t dearer = 0;
  for (std::size_t node = 0; node < division->complex.nodes; node += 17) {
    const Labelling hinted = cut({{static_cast<Cell>(node), !plain.inside[node], 0.25}});
    EXPECT_LE(hinted.weight, plain.weight + 0.25);
    dearer += hinted.weight > plain.weight;
  }
  EXPECT_GT(dearer, 0u);
}

TEST(Labelling, KnownCellsKeepTheirSides) {
  Labelling labelling;
  labelling.inside = {1, 0};
  EXPECT_TRUE(labelling.is_inside(0));
  EXPECT_FALSE(labelling.is_inside(1));
  EXPECT_TRUE(labelling.is_inside(inside_cell));
  EXPECT_FALSE(labelling.is_inside(outside_cell));
}

}  // namespace
}  // namespace meshcomplete
