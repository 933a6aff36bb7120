// What facets are, and which are wrong: quality, places that are no manifold, and facets over the mesh's own.
#include <gtest/gtest.h>

#include <cmath>

#include "filter_poissoncompletion/coinciding_points.h"
#include "filter_poissoncompletion/facet_quality.h"
#include "filter_poissoncompletion/non_manifold_places.h"
#include "filter_poissoncompletion/surplus_facets.h"
#include "tests/support/meshes.h"

namespace meshcomplete {
namespace {

using Facet = std::array<Vector3, 3>;

const auto nowhere = [] { return std::optional<Vector3>(); };

TEST(FacetQuality, LongEdgesComeFirst) {
  RefinementCriteria criteria;
  const Facet small = {Vector3(0, 0, 0), Vector3(1, 0, 0), Vector3(0.5, 0.9, 0)};
  EXPECT_EQ(badness(small, 1, criteria, nowhere), 0);
  EXPECT_GT(badness(small, 0.5, criteria, nowhere), 1);
  EXPECT_GT(badness(small, 0.25, criteria, nowhere), badness(small, 0.5, criteria, nowhere));
}

TEST(FacetQuality, SmallAngles) {
  RefinementCriteria criteria;
  for (double degrees : {5.0, 15.0, 26.0, 28.0, 45.0}) {
    const double angle = degrees * 3.14159265358979 / 180;
    const Facet facet = {Vector3(0, 0, 0), Vector3(1, 0, 0), Vector3(std::cos(angle), std::sin(angle), 0)};
    const double bad = badness(facet, 1, criteria, nowhere);
    EXPECT_EQ(bad > 0, degrees < 27) << degrees;
    EXPECT_LT(bad, 1);
  }
}

TEST(FacetQuality, DistanceFromTheSurface) {
  RefinementCriteria criteria;
  criteria.distance = 0.1;
  const Facet facet = {Vector3(0, 0, 0), Vector3(1, 0, 0), Vector3(0.5, 0.9, 0)};
  const auto at = [](double height) { return [height] { return std::optional(Vector3(0.5, 0.3, height)); }; };
  EXPECT_EQ(badness(facet, 1, criteria, at(0.05)), 0);
  EXPECT_GT(badness(facet, 1, criteria, at(-0.2)), 0);
  EXPECT_LT(badness(facet, 1, criteria, at(-0.2)), 0.5);
  EXPECT_EQ(badness(facet, 1, criteria, nowhere), 0);
}

TEST(NonManifoldPlaces, NoneOnClosedManifolds) {
  EXPECT_TRUE(non_manifold_places(test::icosphere(1).triangles).empty());
  EXPECT_TRUE(non_manifold_places(test::torus(8, 6).triangles).empty());
  EXPECT_TRUE(non_manifold_places({}).empty());
}

TEST(NonManifoldPlaces, EdgesAndVertices) {
  EXPECT_EQ(non_manifold_places(test::isolated_triangle().triangles).size(), 3u);
  const std::vector<Triangle> pinched = test::pinched_tetrahedra().triangles;
  const auto places = non_manifold_places(pinched);
  ASSERT_EQ(places.size(), 1u);
  EXPECT_EQ(places.front().size(), 6u);
  // Two tetrahedra on one edge.
  const std::vector<Triangle> hinged = {{0, 1, 2}, {1, 0, 3}, {0, 2, 3}, {2, 1, 3},
                                        {1, 0, 4}, {0, 1, 5}, {4, 0, 5}, {1, 4, 5}};
  const auto edges = non_manifold_places(hinged);
  ASSERT_EQ(edges.size(), 1u);
  EXPECT_EQ(edges.front(), (std::vector<Index>{0, 1, 4, 5}));
}

TEST(CoincidingPoints, FirstAtPosition) {
  const Vector3 a(1, 2, 3), b(1, 2, 4);
  EXPECT_EQ(first_at_position({a, b, a, b, a}), (std::vector<Index>{0, 1, 0, 1, 0}));
  EXPECT_TRUE(first_at_position({}).empty());
}

TEST(CoincidingPoints, RimsThatTouchAreMerged) {
  const TriangleMesh whole = test::flat_grid(2, 1);
  EXPECT_EQ(merge_rims(whole, build_topology(whole)), nullptr);
  const TriangleMesh apart = test::unwelded(whole);
  const auto merged = merge_rims(apart, build_topology(apart));
  ASSERT_NE(merged, nullptr);
  EXPECT_EQ(merged->topology.boundary_half_edges.size(), 6u);
  for (std::size_t t = 0; t < apart.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k)
      EXPECT_EQ(merged->mesh.vertices[merged->mesh.triangles[t][k]], apart.vertices[apart.triangles[t][k]]);
}

// A square hole in a flat sheet, closed, and one triangle over a corner face of the sheet beside it.
TEST(SurplusFacets, WhatLiesOverTheMeshGoes) {
  TriangleMesh mesh;  // a square frame of four triangles with a corner that has another diagonal
  mesh.vertices = {{0, 0, 0}, {1, 0, 0},   {1, 1, 0},  {0, 1, 0},
                   {2, 2, 0}, {-1, -1, 0}, {2, -1, 0}, {-1, 2, 0}};
  mesh.triangles = {{1, 0, 5}, {1, 5, 6}, {2, 1, 6}, {2, 6, 4}, {3, 2, 4}, {3, 4, 7}, {0, 3, 7}, {0, 7, 5}};
  const MeshTopology topology = build_topology(mesh);
  SeparatingSurface surface;
  for (Index v = 0; v < 4; ++v) surface.vertices.push_back({mesh.vertices[v], v});
  surface.triangles = {{0, 1, 2}, {0, 2, 3}};
  const std::vector<Triangle> right = surface.triangles;
  EXPECT_EQ(drop_surplus_facets(surface, mesh, topology), 0u);
  EXPECT_EQ(surface.triangles, right);
  surface.vertices.push_back({Vector3(1.5, 0.5, 0)});
  surface.triangles.insert(surface.triangles.begin(), {2, 1, 4});
  EXPECT_EQ(drop_surplus_facets(surface, mesh, topology), 1u);
  EXPECT_EQ(surface.triangles, right);
}

}  // namespace
}  // namespace meshcomplete
