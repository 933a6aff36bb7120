#include "filter_curveunfold/polygon_triangulation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <set>
#include <vector>

#include "common/core/error.h"
#include "filter_curveunfold/loop_geometry.h"

namespace meshcomplete {
namespace {

constexpr double pi = 3.14159265358979323846;

double twice_area(const Vector2& a, const Vector2& b, const Vector2& c) {
  return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

double smallest_angle(const Vector2& a, const Vector2& b, const Vector2& c) {
  const auto angle = [](const Vector2& p, const Vector2& q, const Vector2& r) {
    const Vector2 u = q - p, v = r - p;
    return std::atan2(std::abs(u.x() * v.y() - u.y() * v.x()), u.dot(v));
  };
  return std::min({angle(a, b, c), angle(b, c, a), angle(c, a, b)});
}

/// The greatest smallest angle of all triangulations. Triangles that are all counter-clockwise and fit
/// together along the polygon's numbering cover a simple polygon exactly once, so visibility need not be
/// looked at.
double best_smallest_angle(const Polygon& polygon) {
  const std::size_t n = polygon.size();
  std::vector<std::vector<double>> best(n, std::vector<double>(n, -1));
  for (std::size_t i = 0; i + 1 < n; ++i) best[i][i + 1] = pi;
  for (std::size_t span = 2; span < n; ++span)
    for (std::size_t i = 0; i + span < n; ++i)
      for (std::size_t j = i + span, k = i + 1; k < j; ++k) {
        if (!(twice_area(polygon[i], polygon[k], polygon[j]) > 0)) continue;
        best[i][j] =
            std::max(best[i][j],
                     std::min({best[i][k], best[k][j], smallest_angle(polygon[i], polygon[k], polygon[j])}));
      }
  return best[0][n - 1];
}

/// A triangulation of the polygon: right number of triangles, counter-clockwise, every rim edge once, every
/// other edge twice, areas that sum up.
void expect_triangulation(const Polygon& polygon, const std::vector<Triangle>& triangles) {
  ASSERT_EQ(triangles.size() + 2, polygon.size());
  const std::size_t n = polygon.size();
  std::set<std::pair<Index, Index>> half_edges;
  double area = 0;
  for (const Triangle& t : triangles) {
    for (Index v : t) ASSERT_LT(v, n);
    const double twice = twice_area(polygon[t[0]], polygon[t[1]], polygon[t[2]]);
    EXPECT_GT(twice, 0);
    area += 0.5 * twice;
    for (int k = 0; k < 3; ++k)
      EXPECT_TRUE(half_edges.emplace(t[k], t[(k + 1) % 3]).second) << "an edge is walked twice";
  }
  EXPECT_NEAR(area, signed_area(polygon), 1e-12 * area);
  for (Index i = 0; i < n; ++i) EXPECT_TRUE(half_edges.count({i, (i + 1) % static_cast<Index>(n)})) << i;
  std::size_t unpaired = 0;
  for (const auto& [a, b] : half_edges) unpaired += !half_edges.count({b, a});
  EXPECT_EQ(unpaired, n);
}

/// Every diagonal whose two triangles form a convex quadrilateral is locally Delaunay.
void expect_delaunay(const Polygon& polygon, const std::vector<Triangle>& triangles) {
  std::map<std::pair<Index, Index>, Index> apex;
  for (const Triangle& t : triangles)
    for (int k = 0; k < 3; ++k) apex[{t[k], t[(k + 1) % 3]}] = t[(k + 2) % 3];
  for (const auto& [edge, c] : apex) {
    const auto other = apex.find({edge.second, edge.first});
    if (other == apex.end()) continue;
    const Vector2 &p = polygon[c], &q = polygon[other->second];
    const auto angle = [&](const Vector2& o) {
      const Vector2 u = polygon[edge.first] - o, v = polygon[edge.second] - o;
      return std::atan2(std::abs(u.x() * v.y() - u.y() * v.x()), u.dot(v));
    };
    EXPECT_LE(angle(p) + angle(q), pi + 1e-9);
  }
}

/// Star-shaped, with reflex corners; coordinates are small integers.
Polygon random_star(std::size_t n, unsigned seed) {
  std::mt19937 random(seed);
  for (;;) {
    Polygon polygon;
    for (std::size_t i = 0; i < n; ++i) {
      const double t = 2 * pi * static_cast<double>(i) / static_cast<double>(n);
      const double r = 20 + random() % 80;
      polygon.emplace_back(std::round(r * std::cos(t)), std::round(r * std::sin(t)));
    }
    if (is_simple(polygon)) return polygon;
  }
}

TEST(PolygonTriangulation, MaximisesTheSmallestAngle) {
  for (std::size_t n = 3; n <= 14; ++n)
    for (unsigned seed = 1; seed <= 25; ++seed) {
      const Polygon polygon = random_star(n, seed);
      const std::vector<Triangle> triangles = triangulate_polygon(polygon);
      expect_triangulation(polygon, triangles);
      expect_delaunay(polygon, triangles);
      double least = pi;
      for (const Triangle& t : triangles)
        least = std::min(least, smallest_angle(polygon[t[0]], polygon[t[1]], polygon[t[2]]));
      EXPECT_NEAR(least, best_smallest_angle(polygon), 1e-12) << n << " points, seed " << seed;
    }
}

TEST(PolygonTriangulation, LargePolygonsAreDelaunay) {
  const Polygon polygon = random_star(400, 3);
  const std::vector<Triangle> triangles = triangulate_polygon(polygon);
  expect_triangulation(polygon, triangles);
  expect_delaunay(polygon, triangles);
}

// A comb has far more outside between its teeth than inside.
TEST(PolygonTriangulation, Comb) {
  Polygon polygon = {{0, 0}, {20, 0}};
  for (int tooth = 9; tooth >= 0; --tooth) {
    polygon.emplace_back(2 * tooth + 1.5, 10);
    polygon.emplace_back(2 * tooth + 0.75, 1);
  }
  ASSERT_TRUE(is_simple(polygon));
  expect_triangulation(polygon, triangulate_polygon(polygon));
}

TEST(PolygonTriangulation, Spiral) {
  Polygon polygon;
  for (int i = 0; i <= 60; ++i)
    polygon.emplace_back((1 + 0.1 * i) * std::cos(0.2 * i), (1 + 0.1 * i) * std::sin(0.2 * i));
  for (int i = 60; i >= 0; --i)
    polygon.emplace_back((2 + 0.1 * i) * std::cos(0.2 * i), (2 + 0.1 * i) * std::sin(0.2 * i));
  if (signed_area(polygon) < 0) std::reverse(polygon.begin(), polygon.end());
  ASSERT_TRUE(is_simple(polygon));
  const std::vector<Triangle> triangles = triangulate_polygon(polygon);
  expect_triangulation(polygon, triangles);
  expect_delaunay(polygon, triangles);
}

// Points on a side, and sides on one line, must not become triangles without area.
TEST(PolygonTriangulation, CollinearPoints) {
  Polygon square;
  for (int i = 0; i < 5; ++i) square.emplace_back(i, 0);
  for (int i = 0; i < 5; ++i) square.emplace_back(5, i);
  for (int i = 5; i > 0; --i) square.emplace_back(i, 5);
  for (int i = 5; i > 0; --i) square.emplace_back(0, i);
  expect_triangulation(square, triangulate_polygon(square));
  const Polygon triangle = {{0, 0}, {1, 0}, {2, 0}, {3, 0}, {4, 0}, {2, 3}};
  expect_triangulation(triangle, triangulate_polygon(triangle));
  const Polygon crown = {{0, 0}, {6, 0}, {6, 2}, {4, 2}, {4, 1}, {2, 1}, {2, 2}, {0, 2}};
  expect_triangulation(crown, triangulate_polygon(crown));
}

TEST(PolygonTriangulation, NearlyCollinearPointsAreDecidedExactly) {
  Polygon polygon = {{0, 0}};
  for (int i = 1; i < 30; ++i) polygon.emplace_back(i, 1e-18 * i * (i - 30));
  polygon.emplace_back(30, 0);
  polygon.emplace_back(15, 10);
  const std::vector<Triangle> triangles = triangulate_polygon(polygon);
  EXPECT_EQ(triangles.size() + 2, polygon.size());
}

TEST(PolygonTriangulation, OneTriangle) {
  expect_triangulation({{0, 0}, {1, 0}, {0, 1}}, triangulate_polygon({{0, 0}, {1, 0}, {0, 1}}));
}

TEST(PolygonTriangulation, PolygonsThatAreNotSimpleAreErrors) {
  const std::vector<Polygon> polygons = {
      {{0, 0}, {1, 1}, {1, 0}, {0, 1}},                          // a bow tie
      {{0, 0}, {1, 0}, {1, 1}, {0, 0}, {-1, 1}},                 // a point twice
      {{0, 0}, {2, 0}, {2, 2}, {1, 0}, {0, 2}},                  // a point on an edge
      {{0, 0}, {4, 0}, {4, 4}, {0, 4}, {0, 3}, {5, 3}, {0, 2}},  // out and back through a side
      {{0, 0}, {1, 0}, {2, 0}},                                  // no area
      {{0, 0}, {1, 0}},
      {{0, 0}},
      {},
  };
  for (const Polygon& polygon : polygons) {
    try {
      const std::vector<Triangle> triangles = triangulate_polygon(polygon);
      ADD_FAILURE() << "a polygon of " << polygon.size() << " points gave " << triangles.size()
                    << " triangles";
    } catch (const CompletionError& error) {
      EXPECT_EQ(error.stage(), "triangulating the unfolded rim");
    }
  }
}

}  // namespace
}  // namespace meshcomplete
