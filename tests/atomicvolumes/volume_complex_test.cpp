#include "filter_atomicvolumes/volume_complex.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>
#include <vector>

#include "common/core/error.h"
#include "filter_atomicvolumes/extraction.h"
#include "tests/support/complexes.h"
#include "tests/support/volumes.h"

namespace meshcomplete {
namespace {

using test::Division;
using test::PlacedMesh;

VolumeKind kind_of(const Division& division, Index cube) { return division.decomposition.volumes[cube].kind; }

TEST(VolumeComplex, EveryBlankLeafAndEveryFreeTetrahedronIsANode) {
  for (const test::NamedMesh& named : test::holed_meshes()) {
    const PlacedMesh placed(named.mesh, 1);
    const auto division = test::divide(placed);
    if (!division) continue;
    const VolumeComplex& complex = division->complex;
    const Octree& octree = division->decomposition.octree;
    ASSERT_EQ(complex.cube_cells.size(), octree.size());
    std::set<Cell> blank;
    for (Index cube = 0; cube < octree.size(); ++cube) {
      if (octree.is_leaf(cube) && kind_of(*division, cube) == VolumeKind::blank)
        blank.insert(complex.cube_cells[cube]);
      else
        EXPECT_EQ(complex.cube_cells[cube], unknown_cell);
    }
    EXPECT_EQ(blank.size(), complex.blank_nodes);
    EXPECT_EQ(*blank.begin(), 0);
    EXPECT_EQ(*blank.rbegin() + 1, static_cast<Cell>(complex.blank_nodes));
    EXPECT_EQ(complex.nodes, complex.blank_nodes + complex.free_tetrahedra.size());
    EXPECT_GT(complex.tetrahedra, complex.free_tetrahedra.size());
    std::set<Cell> used;
    for (const VolumeFace& face : complex.faces)
      for (Cell cell : {face.behind, face.before}) used.insert(cell);
    for (const VolumeSquare& square : complex.whole_squares)
      for (Cell cell : {square.behind, square.before}) used.insert(cell);
    used.erase(inside_cell);
    used.erase(outside_cell);
    EXPECT_EQ(used.size(), complex.nodes) << "every node has a face, and nothing is unknown";
    EXPECT_EQ(*used.rbegin() + 1, static_cast<Cell>(complex.nodes));
    for (const VolumeComplex::Tetrahedron& t : complex.free_tetrahedra) {
      const VolumeKind kind = kind_of(*division, t.cube);
      const VolumeVertex& apex = complex.vertices[t.apex];
      EXPECT_TRUE(kind == VolumeKind::vertex ? apex.input == division->decomposition.volumes[t.cube].apex
                                             : apex.rim_edge == division->decomposition.volumes[t.cube].apex);
    }
  }
}

/// The two sides of a face: the cubes there, and a point in the middle of the face.
struct Place {
  std::array<Index, 2> cubes;  // behind and before
  Vector3 middle;
};

Place place_of(const PlacedMesh& placed, const Division& division, const VolumeFace& face) {
  const auto at = [&](std::size_t k) { return division.complex.vertices[face.corners[k]].position; };
  const Vector3 middle = (at(0) + at(1) + at(2)) / 3, normal = (at(1) - at(0)).cross(at(2) - at(0));
  const double size = std::sqrt(normal.norm());
  Place place{{}, middle};
  for (std::size_t side = 0; side < 2; ++side) {
    const Vector3 p = middle + (side == 0 ? -1e-3 : 1e-3) * size * normal.normalized();
    const LatticePoint snapped = placed.lattice_mesh.lattice.snap(p);
    const bool out = *std::min_element(snapped.begin(), snapped.end()) < 0 ||
                     *std::max_element(snapped.begin(), snapped.end()) > Lattice::steps;
    place.cubes[side] = out ? Octree::none : division.decomposition.octree.find(snapped);
  }
  return place;
}

/// Labels of crossed cubes against what the closed mesh says, where the faces that were taken away are not
/// near.
class CrossedLabels {
 public:
  CrossedLabels(const test::PuncturedMesh& punctured, const PlacedMesh& placed, const Division& division)
      : punctured_(punctured), placed_(placed), division_(division) {
    std::set<std::array<Vector3, 3>, Less> kept;
    for (const Triangle& t : punctured.mesh.triangles) kept.insert(sorted(punctured.mesh, t));
    for (const Triangle& t : punctured.closed.triangles)
      if (!kept.count(sorted(punctured.closed, t))) {
        const auto snap = [&](Index v) {
          return placed.lattice_mesh.lattice.snap(punctured.closed.vertices[v]);
        };
        removed_.push_back({snap(t[0]), snap(t[1]), snap(t[2])});
      }
  }

  void expect(Index cube, Cell cell, const Vector3& at) {
    if (cube == Octree::none || kind_of(division_, cube) != VolumeKind::crossed) return;
    const LatticeBox box = division_.decomposition.octree.box(cube);
    for (const LatticeTriangle& t : removed_)
      if (meets(t, box)) return;
    const double winding = test::winding_number(punctured_.closed, at);
    ASSERT_EQ(cell, winding > 0.5 ? inside_cell : outside_cell) << punctured_.name;
    ++(cell == inside_cell ? inside : outside);
  }

  std::size_t inside = 0, outside = 0;

 private:
  struct Less {
    bool operator()(const std::array<Vector3, 3>& a, const std::array<Vector3, 3>& b) const {
      const auto key = [](const std::array<Vector3, 3>& c) {
        std::array<double, 9> all;
        for (std::size_t i = 0; i < 9; ++i) all[i] = c[i / 3][static_cast<int>(i % 3)];
        return all;
      };
      return key(a) < key(b);
    }
  };
  static std::array<Vector3, 3> sorted(const TriangleMesh& mesh, const Triangle& t) {
    std::array<Vector3, 3> c = {mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]};
    std::sort(c.begin(), c.end(), [](const Vector3& a, const Vector3& b) {
      return std::make_tuple(a.x(), a.y(), a.z()) < std::make_tuple(b.x(), b.y(), b.z());
    });
    return c;
  }

  const test::PuncturedMesh& punctured_;
  const PlacedMesh& placed_;
  const Division& division_;
  std::vector<LatticeTriangle> removed_;
};

TEST(VolumeComplex, SidesOfCrossedCubesAreThoseOfTheClosedMesh) {
  for (const test::PuncturedMesh& punctured : test::punctured_meshes()) {
    const PlacedMesh placed(punctured.mesh, 8);
    const auto division = test::divide(placed);
    ASSERT_TRUE(division);
    CrossedLabels labels(punctured, placed, *division);
    for (const VolumeSquare& s : division->complex.whole_squares) {
      const LeafSquare& square = division->complex.squares[s.square];
      const Vector3 middle = placed.lattice_mesh.lattice.position(square.centre());
      ASSERT_NO_FATAL_FAILURE(labels.expect(square.below, s.behind, middle));
      ASSERT_NO_FATAL_FAILURE(labels.expect(square.above, s.before, middle));
    }
    for (const VolumeFace& face : division->complex.faces) {
      const Place place = place_of(placed, *division, face);
      ASSERT_NO_FATAL_FAILURE(labels.expect(place.cubes[0], face.behind, place.middle));
      ASSERT_NO_FATAL_FAILURE(labels.expect(place.cubes[1], face.before, place.middle));
    }
    EXPECT_GT(labels.inside, 20u) << punctured.name;
    EXPECT_GT(labels.outside, 20u) << punctured.name;
  }
}

/// Two sheets, one above the other, that face the same way: between them both sides meet, and the surface
/// that joins them has to turn round between them.
TriangleMesh two_sheets(int squares) {
  const TriangleMesh below = test::rough_sheet(squares, squares, 0.1, 0, 4);
  const TriangleMesh above = test::rough_sheet(squares, squares, 0.1, 0, 5);
  return test::join(below, test::translated(above, Vector3(0, 0, 1)));
}

// Octrees at several places: in some of them a plane lies between the sheets, so that two crossed cubes agree
// in themselves and not with each other.
TEST(VolumeComplex, CrossedCubesThatDisagreeAreFound) {
  std::size_t disagreeing = 0;
  for (unsigned seed = 1; seed <= 6; ++seed) {
    const PlacedMesh placed(two_sheets(6), seed);
    Decomposition d = decompose(placed.lattice_mesh, {});
    const VolumeComplex complex = build_complex(placed.lattice_mesh, d);
    std::set<Index> expected;
    for (const VolumeSquare& s : complex.whole_squares) {
      const LeafSquare& square = complex.squares[s.square];
      if (square.below == Octree::none || square.above == Octree::none) continue;
      const bool both = d.volumes[square.below].kind == VolumeKind::crossed &&
                        d.volumes[square.above].kind == VolumeKind::crossed;
      if (both) expected.insert({square.below, square.above});
    }
    EXPECT_EQ(std::set<Index>(complex.disagreeing.begin(), complex.disagreeing.end()), expected);
    EXPECT_TRUE(std::is_sorted(complex.disagreeing.begin(), complex.disagreeing.end()));
    disagreeing += expected.size();
    const auto division = test::divide(placed);
    ASSERT_TRUE(division);
    EXPECT_TRUE(division->complex.disagreeing.empty()) << "after more splits";
  }
  EXPECT_GT(disagreeing, 10u);
}

// Where they cannot be split any more, the square between them is part of the patch, whatever the cut says.
TEST(VolumeComplex, SquaresBetweenDisagreeingCubesAreForcedAtTheLimit) {
  std::size_t forced = 0;
  for (unsigned seed = 1; seed <= 8; ++seed) {
    const PlacedMesh placed(two_sheets(3), seed);
    DecompositionOptions options;
    options.max_depth = 3;
    const auto division = test::divide(placed, options);
    if (!division) continue;
    std::vector<VolumeSquare> known;
    for (const VolumeSquare& s : division->complex.whole_squares)
      if (s.behind < 0 && s.before < 0) known.push_back(s);
    const LabelledSurface surface =
        extract(placed.lattice_mesh, division->decomposition.octree, division->complex,
                test::random_labelling(division->complex, seed, 0.5));
    std::size_t triangles = 0;
    for (const LabelledSurface::Between& b : surface.volumes)
      triangles += b.inside == inside_cell && b.outside == outside_cell;
    EXPECT_GE(triangles, 2 * known.size());
    forced += known.size();
  }
  EXPECT_GT(forced, 0u);
}

// A triangle that is not manifold with the others, or not turned like them, must not make a wrong complex
// silently: the cubes where it is are unresolved and cut into convex cells.
TEST(VolumeComplex, TangledCubesBecomeUnresolved) {
  TriangleMesh mesh = test::sphere_with_hole(2, 0.6);
  const Index h = build_topology(mesh).boundary_half_edges[0];
  const Vector3 tip = mesh.vertices[mesh.triangles[h / 3][h % 3]];
  // A blade through the faces at a boundary vertex.
  const Index first = static_cast<Index>(mesh.vertices.size());
  for (const Vector3& p : {Vector3(0.3, 0.02, -0.35), Vector3(-0.2, 0.3, -0.3), Vector3(0.05, -0.04, 0.4)})
    mesh.vertices.push_back((tip + p).cast<float>().cast<double>());
  mesh.triangles.push_back({first, first + 1, first + 2});
  const PlacedMesh placed(mesh, 3);
  DecompositionOptions options;
  options.max_depth = 8;
  const auto division = test::divide(placed, options);
  ASSERT_TRUE(division);
  const std::size_t unresolved = static_cast<std::size_t>(
      std::count_if(division->decomposition.volumes.begin(), division->decomposition.volumes.end(),
                    [](const Volume& v) { return v.kind == VolumeKind::unresolved; }));
  EXPECT_GT(unresolved, 0u);
  EXPECT_GT(division->complex.convex_cells.size(), unresolved);
}

TEST(VolumeComplex, DoesNotDependOnThreads) {
  const PlacedMesh placed(test::sphere_with_holes(6, 2, 0.4), 2);
  const auto many = test::divide(placed);
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  const auto one = test::divide(placed);
  ASSERT_TRUE(many && one);
  ASSERT_EQ(many->complex.vertices.size(), one->complex.vertices.size());
  for (std::size_t v = 0; v < one->complex.vertices.size(); ++v) {
    ASSERT_TRUE(many->complex.vertices[v].key == one->complex.vertices[v].key);
    ASSERT_EQ(many->complex.vertices[v].position, one->complex.vertices[v].position);
  }
  ASSERT_EQ(many->complex.faces.size(), one->complex.faces.size());
  for (std::size_t f = 0; f < one->complex.faces.size(); ++f) {
    ASSERT_EQ(many->complex.faces[f].corners, one->complex.faces[f].corners);
    ASSERT_EQ(many->complex.faces[f].behind, one->complex.faces[f].behind);
    ASSERT_EQ(many->complex.faces[f].before, one->complex.faces[f].before);
  }
}

TEST(VolumeComplex, CanBeCancelled) {
  const PlacedMesh placed(test::sphere_with_hole(2, 0.6), 2);
  Decomposition d = decompose(placed.lattice_mesh, {});
  EXPECT_THROW(
      build_complex(placed.lattice_mesh, d, Progress([](double, const std::string&) { return false; })),
      Cancelled);
}

}  // namespace
}  // namespace meshcomplete
