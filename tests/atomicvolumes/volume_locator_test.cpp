#include "filter_atomicvolumes/volume_locator.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <vector>

#include "filter_atomicvolumes/constraints.h"
#include "filter_atomicvolumes/lines_of_sight.h"
#include "tests/support/meshes.h"

namespace meshcomplete {
namespace test {
namespace {

/// A mesh with a hole, divided as finely as `max_depth` allows.
struct Divided {
  TriangleMesh mesh = sphere_with_hole();
  MeshTopology topology = build_topology(mesh);
  InputNeighbourhood neighbourhood{mesh};
  LatticeMesh placed{mesh, topology, neighbourhood, Lattice({-1.913, -1.847, -1.881}, 3.7)};
  SideFinder sides{mesh, topology};
  Decomposition decomposition;
  VolumeComplex complex;

  explicit Divided(int max_depth) {
    DecompositionOptions options;
    options.max_depth = max_depth;
    decomposition = decompose(placed, options);
    complex = build_complex(placed, decomposition);
  }
  VolumeLocator locator() const { return VolumeLocator(placed, decomposition, complex, sides); }
  /// Whether a line of sight through the point carves the node.
  bool is_carved(const Vector3& point, Cell node) const {
    LineOfSight line;
    line.from = point + Vector3(0.1, -0.2, 9);
    line.to = point - Vector3(0.1, -0.2, 9);
    return nodes_seen_through(placed.lattice, decomposition, complex, {line})[static_cast<std::size_t>(node)];
  }
};

TEST(VolumeLocator, FindsEveryFreeVolumeAtItsMiddle) {
  for (int max_depth : {30, 5}) {
    const Divided divided(max_depth);
    const VolumeComplex& complex = divided.complex;
    const VolumeLocator locator = divided.locator();
    const Octree& octree = divided.decomposition.octree;
    for (Index cube = 0; cube < octree.size(); ++cube)
      if (complex.cube_cells[cube] >= 0) {
        const VolumePlace place = locator.locate(divided.placed.lattice.position(octree.centre(cube)));
        EXPECT_EQ(place.kind, VolumePlace::free);
        EXPECT_EQ(place.node, complex.cube_cells[cube]);
        EXPECT_EQ(place.leaf, cube);
      }
    for (std::size_t t = 0; t < complex.free_tetrahedra.size(); ++t) {
      const auto corners = corners_of(complex, complex.free_tetrahedra[t]);
      const VolumePlace place = locator.locate((corners[0] + corners[1] + corners[2] + corners[3]) / 4);
      EXPECT_EQ(place.kind, VolumePlace::free);
      EXPECT_EQ(static_cast<std::size_t>(place.node), complex.blank_nodes + t);
      EXPECT_EQ(place.leaf, complex.free_tetrahedra[t].cube);
    }
    EXPECT_EQ(complex.convex_cells.empty(), max_depth == 30);
    for (const VolumeComplex::ConvexCell& cell : complex.convex_cells) {
      const VolumePlace place = locator.locate(cell.centre);
      EXPECT_EQ(place.kind, cell.cell >= 0             ? VolumePlace::free
                            : cell.cell == inside_cell ? VolumePlace::inside
                                                       : VolumePlace::outside);
      if (cell.cell >= 0) {
        EXPECT_EQ(place.node, cell.cell);
      }
    }
  }
}

TEST(VolumeLocator, FindsTheSideInCrossedCubes) {
  const Divided divided(30);
  const VolumeLocator locator = divided.locator();
  for (double z : {-0.7, -0.3, 0.2, 0.6}) {
    const Vector3 way = Vector3(std::sqrt(1 - z * z), 0.013, z).normalized();
    EXPECT_EQ(locator.locate(0.985 * way).kind, VolumePlace::inside);
    EXPECT_EQ(locator.locate(1.002 * way).kind, VolumePlace::outside);
  }
  EXPECT_EQ(locator.locate({7, 0, 0}).kind, VolumePlace::beyond);
}

TEST(VolumeLocator, LinesThroughMiddlesCarveEveryKindOfVolume) {
  for (int max_depth : {30, 5}) {
    const Divided divided(max_depth);
    const VolumeComplex& complex = divided.complex;
    std::size_t carved = 0, all = 0;
    for (std::size_t t = 0; t < complex.free_tetrahedra.size(); t += 7) {
      const auto corners = corners_of(complex, complex.free_tetrahedra[t]);
      carved += divided.is_carved((corners[0] + corners[1] + corners[2] + corners[3]) / 4,
                                  static_cast<Cell>(complex.blank_nodes + t));
      ++all;
    }
    // A line through the middle of a needle may graze it; through most volumes it passes.
    EXPECT_GE(4 * carved, 3 * all);
    carved = all = 0;
    for (const VolumeComplex::ConvexCell& cell : complex.convex_cells)
      if (cell.cell >= 0) {
        carved += divided.is_carved(cell.centre, cell.cell);
        ++all;
      }
    EXPECT_GE(4 * carved, 3 * all);
  }
}

// The same hint costs as much area as the faces that it costs have on average.
TEST(TieConstraints, PricesAreInTheUnitOfTheWeight) {
  const Divided divided(30);
  VolumeConstraints constraints;
  constraints.hinted_inside = {{0, 0, 1.4}};
  constraints.hint_price = 0.125;
  const PreparedConstraints prepared(divided.mesh, divided.topology, divided.neighbourhood, constraints);
  const auto price = [&](CutWeight weight) {
    const TiedConstraints tied =
        tie_constraints(divided.placed, divided.decomposition, divided.complex, weight, prepared);
    return tied.ties.at(0).price;
  };
  const double diagonal = bounding_box_diagonal(divided.mesh);
  EXPECT_NEAR(price(CutWeight::area), 0.125 * diagonal * diagonal, 1e-12);
  double area = 0, roots = 0;
  for (const VolumeFace& face : divided.complex.faces) {
    const Vector3& p = divided.complex.vertices[face.corners[0]].position;
    const double one = 0.5 * (divided.complex.vertices[face.corners[1]].position - p)
                                 .cross(divided.complex.vertices[face.corners[2]].position - p)
                                 .norm();
    area += one;
    roots += std::pow(one, 0.25);
  }
  for (const VolumeSquare& s : divided.complex.whole_squares) {
    const double side =
        static_cast<double>(divided.complex.squares[s.square].length) * divided.placed.lattice.step();
    area += side * side;
    roots += std::sqrt(side);
  }
  const double count =
      static_cast<double>(divided.complex.faces.size() + divided.complex.whole_squares.size());
  EXPECT_NEAR(price(CutWeight::unit) * area / count, price(CutWeight::area), 1e-9);
  EXPECT_NEAR(price(CutWeight::balanced) * area / roots, price(CutWeight::area), 1e-9);
}

}  // namespace
}  // namespace test
}  // namespace meshcomplete
