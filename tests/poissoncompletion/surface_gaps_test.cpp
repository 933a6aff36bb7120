#include "filter_poissoncompletion/surface_gaps.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <vector>

#include "common/core/mesh_topology.h"
#include "tests/support/complexes.h"
#include "tests/support/meshes.h"

namespace meshcomplete {
namespace {

/// The cap that a sphere with a hole lacks, as a patch in the making, and the sphere's rim.
class SurfaceGaps : public testing::Test {
 protected:
  SurfaceGaps() {
    const TriangleMesh whole = test::icosphere(3);
    std::set<Triangle> kept(mesh.triangles.begin(), mesh.triangles.end());
    std::vector<Index> number(whole.vertices.size(), SheetVertex::none);
    for (const Triangle& t : whole.triangles) {
      Triangle own;
      for (int k = 0; k < 3; ++k) own[k] = in_mesh(whole.vertices[t[k]]);
      if (kept.count(own) || kept.count({own[1], own[2], own[0]}) || kept.count({own[2], own[0], own[1]}))
        continue;
      Triangle facet;
      for (int k = 0; k < 3; ++k) {
        Index& v = number[t[k]];
        if (v == SheetVertex::none) {
          v = static_cast<Index>(surface.vertices.size());
          surface.vertices.push_back({whole.vertices[t[k]], own[k], SheetVertex::none, false});
        }
        facet[k] = v;
      }
      surface.triangles.push_back(facet);
    }
    rim = build_topology(mesh).boundary_half_edges;
  }

  Index in_mesh(const Vector3& position) const {
    const auto found = std::find(mesh.vertices.begin(), mesh.vertices.end(), position);
    return found == mesh.vertices.end() ? SheetVertex::none
                                        : static_cast<Index>(found - mesh.vertices.begin());
  }

  /// Mesh and surface together, by positions.
  bool closed() const {
    std::vector<Triangle> all = mesh.triangles;
    std::vector<Index> number;
    Index next = static_cast<Index>(mesh.vertices.size());
    for (const SheetVertex& v : surface.vertices)
      number.push_back(v.input == SheetVertex::none ? next++ : v.input);
    for (const Triangle& t : surface.triangles) all.push_back({number[t[0]], number[t[1]], number[t[2]]});
    const test::Shape shape = test::shape_of(all);
    return shape.manifold && shape.boundary == 0;
  }

  const TriangleMesh mesh = test::sphere_with_hole(3, 0.5);
  SeparatingSurface surface;
  std::vector<Index> rim;
};

TEST_F(SurfaceGaps, AWholeSurfaceHasNone) {
  ASSERT_TRUE(closed());
  const std::size_t before = surface.triangles.size();
  const SurfaceGapFigures figures = close_gaps(surface, mesh, rim);
  EXPECT_EQ(figures.closed + figures.left, 0u);
  EXPECT_EQ(surface.triangles.size(), before);
}

TEST_F(SurfaceGaps, MissingFacetsAreFilledIn) {
  for (std::size_t first = 0; first < surface.triangles.size(); first += 5) {
    SeparatingSurface whole = surface;
    // Those that share a corner with one: a gap of several edges, also at the rim.
    const Index corner = surface.triangles[first][0];
    auto& all = surface.triangles;
    all.erase(std::remove_if(all.begin(), all.end(),
                             [&](const Triangle& t) { return std::count(t.begin(), t.end(), corner) > 0; }),
              all.end());
    ASSERT_FALSE(closed());
    const SurfaceGapFigures figures = close_gaps(surface, mesh, rim);
    EXPECT_EQ(figures.left, 0u);
    EXPECT_GE(figures.largest, 3u);
    EXPECT_TRUE(closed()) << "round vertex " << corner;
    surface = whole;
  }
}

// A rim with nothing at all, not even its vertices in the surface.
TEST_F(SurfaceGaps, ASmallHoleWithoutAnySurface) {
  surface = {};
  const SurfaceGapFigures figures = close_gaps(surface, mesh, rim);
  EXPECT_EQ(figures.closed, 1u);
  EXPECT_EQ(figures.largest, rim.size());
  EXPECT_EQ(surface.triangles.size(), rim.size() - 2);
  EXPECT_TRUE(closed());
}

// What is missing then is no gap.
TEST_F(SurfaceGaps, AWideHoleWithoutAnySurfaceIsLeft) {
  const TriangleMesh wide = test::sphere_with_hole(4, 0.7);
  SeparatingSurface nothing;
  const SurfaceGapFigures figures = close_gaps(nothing, wide, build_topology(wide).boundary_half_edges);
  EXPECT_EQ(figures.closed, 0u);
  EXPECT_EQ(figures.left, 1u);
  EXPECT_TRUE(nothing.triangles.empty());
}

TEST_F(SurfaceGaps, NoEdgeIsMadeTwice) {
  // A strip of two triangles folded along its diagonal: the gap's other diagonal would be the mesh's own.
  TriangleMesh fold;
  fold.vertices = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0.2}, {0, 1, 0}};
  fold.triangles = {{0, 1, 2}, {0, 2, 3}};
  SeparatingSurface none;
  EXPECT_EQ(close_gaps(none, fold, build_topology(fold).boundary_half_edges).closed, 1u);
  for (const Triangle& t : none.triangles) {
    std::set<Index> corners;
    for (Index v : t) corners.insert(none.vertices[v].input);
    EXPECT_TRUE(corners.count(1) && corners.count(3)) << "the diagonal that the mesh has not";
  }
}

}  // namespace
}  // namespace meshcomplete
