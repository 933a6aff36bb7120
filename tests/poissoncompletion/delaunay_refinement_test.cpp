#include "filter_poissoncompletion/delaunay_refinement.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

#include "common/core/error.h"
#include "common/core/patch.h"
#include "common/core/triangle_intersection.h"
#include "tests/poissoncompletion/oracles.h"
#include "tests/support/complexes.h"
#include "tests/support/meshes.h"

namespace meshcomplete {
namespace {

RefinementOptions uniform(double length) {
  RefinementOptions options;
  options.criteria.edge_length = [length](const Vector3&) { return length; };
  return options;
}

// Every cell turned the right way, every neighbour a neighbour.
void expect_complex(const DelaunayComplex& complex) {
  ASSERT_EQ(complex.neighbours.size(), complex.cells.size());
  ASSERT_EQ(complex.inside.size(), complex.cells.size());
  ASSERT_EQ(complex.mesh_vertex.size(), complex.vertices.size());
  ASSERT_EQ(complex.on_edge.size(), complex.vertices.size());
  std::size_t hull = 0;
  for (Index c = 0; c < complex.cells.size(); ++c) {
    const auto& v = complex.cells[c];
    const Vector3& p = complex.vertices[v[0]];
    EXPECT_GT((complex.vertices[v[1]] - p).cross(complex.vertices[v[2]] - p).dot(complex.vertices[v[3]] - p),
              0);
    for (int k = 0; k < 4; ++k) {
      const Index other = complex.neighbours[c][k];
      if (other == DelaunayComplex::none) {
        ++hull;
        continue;
      }
      Triangle mine = facet_towards_corner(v, k);
      int shared = 0;
      for (Index corner : complex.cells[other]) shared += std::count(mine.begin(), mine.end(), corner) > 0;
      EXPECT_EQ(shared, 3);
    }
  }
  EXPECT_EQ(hull, 12u) << "the far corners are a cube";
}

TEST(DelaunayRefinement, Sphere) {
  const test::Oracle oracle = test::sphere_oracle();
  const DelaunayComplex complex = refine_delaunay(oracle, test::icosphere(0).vertices, uniform(0.2));
  expect_complex(complex);
  const std::vector<Triangle> facets = separating_facets(complex);
  const test::Shape shape = test::shape_of(facets);
  EXPECT_TRUE(shape.manifold);
  EXPECT_EQ(shape.euler, 2);
  EXPECT_EQ(shape.boundary, 0u);
  for (const Triangle& t : facets) {
    const Vector3 &a = complex.vertices[t[0]], &b = complex.vertices[t[1]], &c = complex.vertices[t[2]];
    EXPECT_GT((b - a).cross(c - a).dot(a), 0) << "the outside is before a facet";
    EXPECT_LT(std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()}), 0.3 + 1e-9);
  }
  for (Index v = complex.initial_points + DelaunayComplex::far_corners; v < complex.vertices.size(); ++v) {
    EXPECT_TRUE(complex.is_new(v));
    EXPECT_EQ(as_stored(complex.vertices[v]), complex.vertices[v]);
  }
}

TEST(DelaunayRefinement, IsTheSameAgain) {
  const test::Oracle oracle = test::torus_oracle();
  const std::vector<Vector3> points = test::torus(8, 5).vertices;
  const DelaunayComplex a = refine_delaunay(oracle, points, uniform(0.2)),
                        b = refine_delaunay(oracle, points, uniform(0.2));
  EXPECT_EQ(a.cells, b.cells);
  EXPECT_TRUE(std::equal(a.vertices.begin(), a.vertices.end(), b.vertices.begin(), b.vertices.end()));
  EXPECT_EQ(a.inside, b.inside);
}

// What is near the mesh is left alone, the rest is refined; nothing of what was given is lost.
TEST(DelaunayRefinement, ConfinedToTheHole) {
  const test::Oracle oracle = test::sphere_oracle();
  const TriangleMesh mesh = test::sphere_with_hole(4, 0.6);
  const TriangleBlocks blocks(mesh);
  const double radius = 0.08;
  const Cushion cushion(blocks, radius);
  std::vector<Index> all(mesh.vertices.size());
  std::iota(all.begin(), all.end(), Index(0));
  RefinementOptions options = uniform(0.075);
  options.around.emplace(ProtectedMesh{mesh, cushion, all});
  const DelaunayComplex complex = refine_delaunay(oracle, mesh.vertices, options);
  expect_complex(complex);
  std::set<Index> used;
  for (const auto& cell : complex.cells) used.insert(cell.begin(), cell.end());
  EXPECT_EQ(used.size(), complex.vertices.size());
  EXPECT_EQ(complex.initial_points, mesh.vertices.size());
  const Index first = complex.initial_points + DelaunayComplex::far_corners;
  EXPECT_GT(complex.vertices.size() - first, 100u);
  for (Index v = first; v < complex.vertices.size(); ++v) {
    EXPECT_GE(test::distance_to(mesh, complex.vertices[v]), radius);
    EXPECT_GT(complex.vertices[v][2], std::cos(0.6)) << "in the hole";
    EXPECT_NEAR(complex.vertices[v].norm(), 1, 1e-3);
  }
}

// From seeds on one hole the other one is not reached.
TEST(DelaunayRefinement, GrowsFromTheSeeds) {
  const test::Oracle oracle = test::sphere_oracle();
  const TriangleMesh mesh = test::sphere_with_holes(2, 3, 0.4);  // at both ends of the x axis
  const TriangleBlocks blocks(mesh);
  const Cushion cushion(blocks, 0.1);
  std::vector<Index> all(mesh.vertices.size());
  std::iota(all.begin(), all.end(), Index(0));
  RefinementOptions options = uniform(0.1);
  options.around.emplace(ProtectedMesh{mesh, cushion, all});
  for (const Vector3& v : mesh.vertices) options.seeds.push_back(v[0] > 0.8);
  const DelaunayComplex complex = refine_delaunay(oracle, mesh.vertices, options);
  const Index first = complex.initial_points + DelaunayComplex::far_corners;
  ASSERT_GT(complex.vertices.size(), first + 5);
  for (Index v = first; v < complex.vertices.size(); ++v) EXPECT_GT(complex.vertices[v][0], 0.8);
}

// A plate so thin that its back is in the way: its vertices come in where the front is refined.
TEST(DelaunayRefinement, BringsInTheMeshThatItComesNear) {
  const test::Oracle oracle([](const Vector3& p) {
    return std::max({std::abs(p[2] - 0.15) - 0.15, std::abs(p[0] - 5) - 5, std::abs(p[1] - 5) - 5});
  });
  TriangleMesh mesh = test::translated(test::flat_grid(10, 10), Vector3(0, 0, 0.3125));
  mesh = test::without_ball(mesh, Vector3(5, 5, 0.3125), 2.2);
  const std::size_t front = mesh.vertices.size();
  mesh = test::join(mesh, test::flipped(test::flat_grid(10, 10)));
  const TriangleBlocks blocks(mesh);
  const Cushion cushion(blocks, 0.4);
  std::vector<Index> initial(front);
  std::iota(initial.begin(), initial.end(), Index(0));
  for (std::size_t v = front; v < mesh.vertices.size(); v += 7) initial.push_back(static_cast<Index>(v));
  std::vector<Vector3> points;
  for (Index v : initial) points.push_back(mesh.vertices[v]);
  RefinementOptions options = uniform(1);
  options.around.emplace(ProtectedMesh{mesh, cushion, initial});
  const DelaunayComplex complex = refine_delaunay(oracle, points, options);
  std::size_t brought = 0;
  for (Index v = complex.initial_points + DelaunayComplex::far_corners; v < complex.vertices.size(); ++v) {
    const Index own = complex.mesh_vertex[v];
    if (own == DelaunayComplex::none) continue;
    ++brought;
    EXPECT_EQ(mesh.vertices[own], complex.vertices[v]);
  }
  EXPECT_GT(brought, 5u);
}

// Other points round the middle of an edge keep it from being one undivided.
TEST(DelaunayRefinement, ProtectedEdgesAreThere) {
  const test::Oracle oracle = test::sphere_oracle(8);
  std::vector<Vector3> points = test::icosphere(1, 8).vertices;
  const Index first = static_cast<Index>(points.size());
  for (const Vector3& p : {Vector3(-2, 0, 0), Vector3(2, 0, 0), Vector3(0, 0.1, 0), Vector3(0, -0.1, 0.1),
                           Vector3(0, -0.1, -0.1)})
    points.push_back(p);
  RefinementOptions options = uniform(16);
  options.protected_edges = {{first, first + 1}};
  const DelaunayComplex complex = refine_delaunay(oracle, points, options);
  EXPECT_TRUE(complex.lost_edges.empty());
  std::set<test::Edge> edges;
  for (const auto& cell : complex.cells)
    for (Index a : cell)
      for (Index b : cell)
        if (a < b) edges.emplace(a, b);
  std::size_t divided = 0;
  for (Index edge = 0; edge < 1; ++edge) {
    const auto [a, b] = options.protected_edges[edge];
    std::map<double, Index> chain = {{0.0, a}, {4.0, b}};
    for (Index v = 0; v < complex.vertices.size(); ++v)
      if (complex.on_edge[v] == edge) {
        const double share = (complex.vertices[v] - points[a]).norm();
        EXPECT_LT((points[a] + share / 4 * (points[b] - points[a]) - complex.vertices[v]).norm(), 1e-14);
        chain[share] = v;
        ++divided;
      }
    for (auto at = chain.begin(), next = std::next(at); next != chain.end(); ++at, ++next)
      EXPECT_TRUE(edges.count({std::min(at->second, next->second), std::max(at->second, next->second)}));
  }
  EXPECT_GT(divided, 0u);
}

TEST(DelaunayRefinement, PointsAtOnePositionAreOne) {
  const test::Oracle oracle = test::sphere_oracle();
  std::vector<Vector3> points = test::icosphere(1).vertices;
  const std::size_t once = points.size();
  points.insert(points.end(), points.begin(), points.begin() + 10);
  const DelaunayComplex complex = refine_delaunay(oracle, points, uniform(2));
  EXPECT_EQ(complex.initial_points, points.size());
  for (const auto& cell : complex.cells)
    for (Index v : cell) EXPECT_TRUE(v < once || complex.is_far(v) || complex.is_new(v));
}

TEST(DelaunayRefinement, TooManyPoints) {
  RefinementOptions options = uniform(0.01);
  options.max_points = 500;
  EXPECT_THROW(refine_delaunay(test::sphere_oracle(), test::icosphere(0).vertices, options), CompletionError);
}

TEST(DelaunayRefinement, PointsThatAreNoSurface) {
  const test::Oracle oracle = test::sphere_oracle();
  EXPECT_THROW(refine_delaunay(oracle, {}, uniform(1)), CompletionError);
  EXPECT_THROW(refine_delaunay(oracle, {{1, 0, 0}}, uniform(1)), CompletionError);
  EXPECT_THROW(refine_delaunay(oracle, {{1, 0, 0}, {1, 0, 0}}, uniform(1)), CompletionError);
}

TEST(DelaunayRefinement, CanBeCancelled) {
  int calls = 0;
  const Progress progress([&](double, const std::string&) { return ++calls < 2; });
  const test::Oracle oracle([](const Vector3& p) { return p.norm() - 1; });
  EXPECT_THROW(
      {
        progress.update(0);
        for (int i = 0; i < 100; ++i)
          refine_delaunay(oracle, test::icosphere(0).vertices, uniform(0.02), progress);
      },
      Cancelled);
}

}  // namespace
}  // namespace meshcomplete
