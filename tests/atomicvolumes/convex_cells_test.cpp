#include "filter_atomicvolumes/convex_cells.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <utility>
#include <vector>

#include "common/core/rim_patch.h"
#include "common/core/sheets.h"
#include "filter_atomicvolumes/extraction.h"
#include "tests/support/complexes.h"
#include "tests/support/volumes.h"

namespace meshcomplete {
namespace {

using test::Division;
using test::PlacedMesh;

constexpr Index none = VolumeVertex::none;

DecompositionOptions to_depth(int depth) {
  DecompositionOptions options;
  options.max_depth = depth;
  return options;
}

// Coordinates of about 2^38, times each other, in cells of a cube: what rounding leaves of a volume.
constexpr double volume_error = 1e-9;

// Calls `visit` for the cells of each cube that is cut.
template <class Visit>
void for_cut_cubes(const PlacedMesh& placed, int depth, Visit&& visit) {
  const Decomposition decomposition = decompose(placed.lattice_mesh, to_depth(depth));
  for (Index cube = 0; cube < decomposition.octree.size(); ++cube)
    if (decomposition.octree.is_leaf(cube) && decomposition.volumes[cube].kind == VolumeKind::unresolved) {
      const LatticeBox box = decomposition.octree.box(cube);
      const auto& triangles = decomposition.volumes[cube].triangles;
      visit(box, triangles, cut_into_cells(placed.lattice_mesh, box, triangles));
    }
}

TEST(ConvexCells, FillTheCube) {
  std::size_t cubes = 0;
  for (const test::NamedMesh& named : test::holed_meshes()) {
    const PlacedMesh placed(named.mesh, 1);
    for_cut_cubes(placed, 3, [&](const LatticeBox& box, const std::vector<Index>&, const ConvexCells& cells) {
      ++cubes;
      const double side = static_cast<double>(box.high[0] - box.low[0]), whole = side * side * side;
      double sum = 0;
      for (double volume : cell_volumes(cells)) {
        EXPECT_GT(volume, -volume_error * whole) << named.name;
        sum += volume;
      }
      EXPECT_NEAR(sum, whole, volume_error * whole) << named.name;
    });
  }
  EXPECT_GT(cubes, 50u);
}

// Two cells meet in whole facets, and a facet's sides are shared by what lies round them.
TEST(ConvexCells, AreConforming) {
  const PlacedMesh placed(test::rough_sphere_with_ragged_holes(2, 4, 3), 2);
  for_cut_cubes(placed, 3, [&](const LatticeBox&, const std::vector<Index>&, const ConvexCells& cells) {
    const CellComplex& complex = cells.complex;
    for (Index c = 0; c < complex.cells().size(); ++c) {
      std::map<Index, int> uses;
      for (Index f : complex.cells()[c].facets) {
        const CellComplex::Facet& facet = complex.facets()[f];
        EXPECT_TRUE(facet.cells[0] == c || facet.cells[1] == c);
        ASSERT_EQ(facet.corners.size(), facet.sides.size());
        for (std::size_t i = 0; i < facet.sides.size(); ++i) {
          const auto& ends = complex.edges()[facet.sides[i]].ends;
          const Index from = facet.corners[i], to = facet.corners[(i + 1) % facet.corners.size()];
          EXPECT_TRUE((ends[0] == from && ends[1] == to) || (ends[0] == to && ends[1] == from));
          uses[facet.sides[i]] += (ends[0] == from) == (facet.cells[0] == c) ? 1 : -1;
        }
        for (Index v : facet.corners)
          EXPECT_EQ(side_of(complex.planes()[facet.plane], complex.points()[v]), 0);
      }
      for (const auto& [edge, sum] : uses) EXPECT_EQ(sum, 0) << "the surface of a cell is not closed";
    }
  });
}

TEST(ConvexCells, TheMeshCrossesNone) {
  std::mt19937_64 random(5);
  for (const test::NamedMesh& named : test::holed_meshes()) {
    const PlacedMesh placed(named.mesh, 1);
    for_cut_cubes(placed, 3,
                  [&](const LatticeBox& box, const std::vector<Index>& triangles, const ConvexCells& cells) {
                    const CellComplex& complex = cells.complex;
                    const double side = static_cast<double>(box.high[0] - box.low[0]);
                    // Whether the point is inside a cell by more than rounding.
                    const auto well_inside = [&](Index cell, const Vector3& p) {
                      for (Index f : complex.cells()[cell].facets) {
                        const auto& plane = complex.planes()[complex.facets()[f].plane].rounded;
                        const Vector3 normal(plane[0], plane[1], plane[2]);
                        const double height = (normal.dot(p) + plane[3]) / normal.norm();
                        if ((complex.facets()[f].cells[0] == cell ? height : -height) < 1e-6 * side)
                          return false;
                      }
                      return true;
                    };
                    for (Index t : triangles)
                      for (int sample = 0; sample < 20; ++sample) {
                        double u = test::uniform(random), v = test::uniform(random);
                        if (u + v > 1) {
                          u = 1 - u;
                          v = 1 - v;
                        }
                        const LatticeTriangle c = placed.lattice_mesh.triangle(t);
                        Vector3 p;
                        for (int k = 0; k < 3; ++k)
                          p[k] = static_cast<double>(c[0][k] - cells.centre[k]) +
                                 u * static_cast<double>(c[1][k] - c[0][k]) +
                                 v * static_cast<double>(c[2][k] - c[0][k]);
                        for (Index cell = 0; cell < complex.cells().size(); ++cell)
                          EXPECT_FALSE(well_inside(cell, p)) << named.name;
                      }
                  });
  }
}

// The boundary half-edge on which the edge between two vertices of the surface lies.
Index rim_of(const PlacedMesh& placed, const VolumeVertex& a, const VolumeVertex& b) {
  for (Index h : placed.topology.boundary_half_edges) {
    const auto on = [&](const VolumeVertex& v) {
      return v.rim_edge == h || v.input == placed.lattice_mesh.origin(h) ||
             v.input == placed.lattice_mesh.target(h);
    };
    if (on(a) && on(b)) return h;
  }
  return none;
}

// Where the boundary of the surface is not the mesh's, each edge once and against its face.
std::size_t defects(const PlacedMesh& placed, const LabelledSurface& surface) {
  std::size_t count = 0;
  std::map<Index, std::map<Index, int>> ends;  // of each half-edge: arrivals less departures at the vertices
  for (const auto& [edge, times] : test::boundary_of(surface.triangles)) {
    const VolumeVertex &a = surface.vertices[edge.first], &b = surface.vertices[edge.second];
    const Index h = rim_of(placed, a, b);
    if (h == none) {
      ++count;
      continue;
    }
    ends[h][edge.first] -= times;
    ends[h][edge.second] += times;
  }
  for (Index h : placed.topology.boundary_half_edges) {
    int right = 0;
    for (const auto& [v, sum] : ends[h]) {
      if (sum == 0) continue;
      const Index input = surface.vertices[v].input;
      right += (sum == 1 && input == placed.lattice_mesh.origin(h)) ||
               (sum == -1 && input == placed.lattice_mesh.target(h));
      count += sum != 1 && sum != -1;
    }
    count += right != 2;
  }
  return count;
}

std::vector<LabelledSurface> surfaces_of(const PlacedMesh& placed, const Division& division) {
  std::vector<Labelling> labellings = {
      cut_complex(placed.lattice_mesh, division.complex, CutWeight::area, {})};
  for (double share : {0.0, 0.3, 0.7, 1.0})
    labellings.push_back(test::random_labelling(division.complex, 7, share));
  std::vector<LabelledSurface> surfaces;
  for (const Labelling& labelling : labellings)
    surfaces.push_back(
        extract(placed.lattice_mesh, division.decomposition.octree, division.complex, labelling));
  return surfaces;
}

TEST(ConvexCells, AnyLabellingClosesAllHoles) {
  std::size_t cells = 0;
  for (const test::NamedMesh& named : test::holed_meshes())
    for (int depth : {2, 4, 5, 6, 8}) {
      const PlacedMesh placed(named.mesh, static_cast<std::uint64_t>(depth));
      const auto division = test::divide(placed, to_depth(depth));
      ASSERT_TRUE(division) << named.name;
      cells += division->complex.convex_cells.size();
      for (const LabelledSurface& surface : surfaces_of(placed, *division))
        EXPECT_EQ(defects(placed, surface), 0u) << named.name << ", depth " << depth;
    }
  EXPECT_GT(cells, 10000u);
}

// What the filter makes of them: pieces whose rims are the mesh's own edges, and that meet nothing.
TEST(ConvexCells, PatchesAreClean) {
  for (const test::NamedMesh& named : test::holed_meshes())
    for (int depth : {3, 5, 7}) {
      const PlacedMesh placed(named.mesh, 3);
      const auto division = test::divide(placed, to_depth(depth));
      ASSERT_TRUE(division) << named.name;
      const LabelledSurface surface =
          extract(placed.lattice_mesh, division->decomposition.octree, division->complex,
                  cut_complex(placed.lattice_mesh, division->complex, CutWeight::area, {}));
      std::size_t closed = 0;
      for (const Sheet& sheet :
           split_into_sheets(placed.mesh, placed.topology, separating(surface), placed.mesh)) {
        ASSERT_EQ(sheet.flaw, Sheet::Flaw::none) << named.name << ", depth " << depth;
        if (sheet.closes.empty()) continue;
        closed += sheet.closes.size();
        RimPatch patch = make_rim_patch(placed.mesh, placed.topology, sheet);
        EXPECT_EQ(remove_steiner_points(patch, placed.neighbourhood, {}), 0u)
            << named.name << ", depth " << depth;
        std::vector<const BoundaryLoop*> loops;
        for (const BoundaryLoop& loop : patch.loops) loops.push_back(&loop);
        const PatchCheck check =
            check_patch(placed.neighbourhood, as_patch(patch.mesh, patch.rim_vertices, placed.mesh), loops);
        EXPECT_EQ(check.defect, PatchDefect::none)
            << named.name << ", depth " << depth << ": " << describe(check.defect);
      }
      EXPECT_EQ(closed, placed.topology.boundary_half_edges.size()) << named.name << ", depth " << depth;
    }
}

// Every point of a cut cube lies in a cell, and those of a mesh's triangles between two of unlike sides.
TEST(ConvexCells, HoldThePointsOfTheirCube) {
  const PlacedMesh placed(test::sphere_with_hole(2, 0.6), 1);
  const auto division = test::divide(placed, to_depth(4));
  ASSERT_TRUE(division);
  const auto& cells = division->complex.convex_cells;
  ASSERT_FALSE(cells.empty());
  for (std::size_t i = 0; i < cells.size(); ++i) {
    EXPECT_TRUE(cells[i].holds(cells[i].centre));
    EXPECT_TRUE(i == 0 || cells[i - 1].cube <= cells[i].cube);
    for (std::size_t j = 0; j < cells.size(); ++j)
      EXPECT_TRUE(i == j || !cells[j].holds(cells[i].centre)) << "two cells hold a point";
  }
}

// Two sheets that face the same way in one cube: between them is a cell that would be inside and outside.
TEST(ConvexCells, ContradictingSheetsAreSeparated) {
  const TriangleMesh two =
      test::join(test::rough_sheet(6, 6, 0.05, 0, 1),
                 test::translated(test::rough_sheet(6, 6, 0.05, 0, 2), Vector3(0.2, 0.3, 0.4)));
  for (int depth : {2, 3, 4}) {
    const PlacedMesh placed(two, 4);
    const auto division = test::divide(placed, to_depth(depth));
    ASSERT_TRUE(division);
    for_cut_cubes(placed, depth, [](const LatticeBox&, const std::vector<Index>&, const ConvexCells& cells) {
      EXPECT_EQ(cells.contradicting, 0u);
    });
    for (const LabelledSurface& surface : surfaces_of(placed, *division))
      EXPECT_EQ(defects(placed, surface), 0u) << "depth " << depth;
  }
}

// The faces round a boundary vertex intersect each other: the cube round it is cut at any depth, beside finer
// ones.
TEST(ConvexCells, TangledStarsAreCut) {
  TriangleMesh mesh;
  mesh.vertices = {Vector3(0, 0, 0),  Vector3(1, 0, 0.25),     Vector3(0, 1, 0.125),    Vector3(-1, 0, -0.25),
                   Vector3(0, -1, 0), Vector3(1, -0.25, -0.5), Vector3(0.75, 0.5, 0.75)};
  for (Index i = 1; i < 6; ++i) mesh.triangles.push_back({0, i, i + 1});
  std::size_t cut = 0;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const PlacedMesh placed(mesh, seed);
    const auto division = test::divide(placed);
    ASSERT_TRUE(division);
    cut += division->complex.convex_cells.size();
    for (const VolumeComplex::ConvexCell& cell : division->complex.convex_cells)
      EXPECT_EQ(division->decomposition.volumes[cell.cube].kind, VolumeKind::unresolved);
  }
  EXPECT_GT(cut, 0u);
}

}  // namespace
}  // namespace meshcomplete
