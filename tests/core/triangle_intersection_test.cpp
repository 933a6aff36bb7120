#include "common/core/triangle_intersection.h"

#include <gtest/gtest.h>

#include <array>
#include <boost/multiprecision/cpp_int.hpp>
#include <cmath>
#include <limits>
#include <random>
#include <utility>
#include <vector>

#include "tests/support/meshes.h"

namespace meshcomplete {
namespace {

using Corners = std::array<Vector3, 3>;
using Rational = boost::multiprecision::cpp_rational;
using RationalPoint = std::array<Rational, 3>;

// --- the answer by definition, in rational arithmetic
// ---------------------------------------------------------------

RationalPoint minus(const RationalPoint& a, const RationalPoint& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
Rational dot(const RationalPoint& a, const RationalPoint& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
RationalPoint cross(const RationalPoint& a, const RationalPoint& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
RationalPoint rational(const Vector3& p) { return {Rational(p.x()), Rational(p.y()), Rational(p.z())}; }
bool is_zero(const RationalPoint& v) { return v[0] == 0 && v[1] == 0 && v[2] == 0; }

/// The part of a convex polygon (or segment, or point) where dot(normal, x - origin) >= 0.
std::vector<RationalPoint> clipped(const std::vector<RationalPoint>& polygon, const RationalPoint& normal,
                                   const RationalPoint& origin) {
  std::vector<RationalPoint> kept;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const RationalPoint &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
    const Rational p_height = dot(normal, minus(p, origin)), q_height = dot(normal, minus(q, origin));
    if (p_height >= 0) kept.push_back(p);
    if ((p_height < 0 && q_height > 0) || (p_height > 0 && q_height < 0)) {
      const Rational t = p_height / (p_height - q_height);
      RationalPoint crossing;
      for (int k = 0; k < 3; ++k) crossing[k] = p[k] + t * (q[k] - p[k]);
      kept.push_back(crossing);
    }
  }
  return kept;
}

/// Points whose convex hull is what the two triangles have in common.
std::vector<RationalPoint> common_points(const Corners& a, const Corners& b) {
  const std::array<RationalPoint, 3> t = {rational(a[0]), rational(a[1]), rational(a[2])};
  std::vector<RationalPoint> polygon = {rational(b[0]), rational(b[1]), rational(b[2])};
  const RationalPoint normal = cross(minus(t[1], t[0]), minus(t[2], t[0]));
  polygon = clipped(polygon, normal, t[0]);
  polygon = clipped(polygon, minus({0, 0, 0}, normal), t[0]);
  for (int i = 0; i < 3; ++i) polygon = clipped(polygon, cross(normal, minus(t[(i + 1) % 3], t[i])), t[i]);
  return polygon;
}

bool improper_by_definition(const Corners& a, const Corners& b) {
  std::vector<RationalPoint> shared;
  for (const Vector3& p : a)
    for (const Vector3& q : b)
      if (p == q) shared.push_back(rational(p));
  if (shared.size() == 3) return true;
  for (const RationalPoint& p : common_points(a, b)) {
    if (shared.empty()) return true;
    if (shared.size() == 1 && p != shared[0]) return true;
    if (shared.size() == 2 && !is_zero(cross(minus(shared[1], shared[0]), minus(p, shared[0])))) return true;
  }
  // Two triangles over one side cannot have more of that side's line in common than the side.
  return false;
}

bool collinear_by_definition(const Corners& t) {
  return is_zero(cross(minus(rational(t[1]), rational(t[0])), minus(rational(t[2]), rational(t[0]))));
}

// --- triangles
// ------------------------------------------------------------------------------------------------------

class Soup {
 public:
  explicit Soup(std::uint32_t seed) : random_(seed) {}
  int below(int n) { return static_cast<int>(random_() % static_cast<unsigned>(n)); }
  Vector3 grid_point(int size) { return Vector3(below(size), below(size), below(size)); }
  Corners grid_triangle(int size) { return {grid_point(size), grid_point(size), grid_point(size)}; }
  Corners proper_grid_triangle(int size) {
    Corners t = grid_triangle(size);
    while (collinear_by_definition(t)) t = grid_triangle(size);
    return t;
  }
  /// As `t`, with its first `kept` corners in random places and the others new.
  Corners neighbour(const Corners& t, int kept, int size) {
    Corners n = grid_triangle(size);
    do {
      n = grid_triangle(size);
      const int shift = below(3), other_shift = below(3);
      for (int i = 0; i < kept; ++i) n[(i + shift) % 3] = t[(i + other_shift) % 3];
      if (below(2)) std::swap(n[0], n[1]);
    } while (collinear_by_definition(n));
    return n;
  }

 private:
  std::mt19937 random_;
};

Corners mapped(const Corners& t, const std::function<Vector3(const Vector3&)>& map) {
  return {map(t[0]), map(t[1]), map(t[2])};
}

// --- tests
// ------------------------------------------------------------------------------------------------------------

// A grid of 3 or 4 points a side is full of coplanar, touching, overlapping and folded pairs.
TEST(TriangleIntersection, AgreesWithTheDefinitionOnSmallGrids) {
  Soup soup(1);
  for (int kept = 0; kept <= 3; ++kept) {
    int improper = 0;
    const int pairs = kept == 3 ? 100 : 1500;
    for (int i = 0; i < pairs; ++i) {
      const int size = 3 + soup.below(2);
      const Corners a = soup.proper_grid_triangle(size), b = soup.neighbour(a, kept, size);
      const bool expected = improper_by_definition(a, b);
      improper += expected;
      ASSERT_EQ(meet_improperly(a, b), expected) << "shared corners meant: " << kept << ", pair " << i;
      ASSERT_EQ(meet_improperly(b, a), expected) << "shared corners meant: " << kept << ", pair " << i;
    }
    EXPECT_GT(improper, pairs / 100);
    if (kept < 3) {
      EXPECT_LT(improper, pairs * 9 / 10);
    }
  }
}

TEST(TriangleIntersection, AgreesWithTheDefinitionInOnePlane) {
  Soup soup(2);
  // Integer coordinates in the plane x + 2 y - 3 z = 0, so that no projection is an axis.
  const auto into_plane = [](const Vector3& p) { return Vector3(3 * p.x() - 2 * p.y(), p.y(), p.x()); };
  int improper = 0;
  for (int i = 0; i < 1000; ++i) {
    const auto flat = [&](const Corners& t) { return mapped(t, into_plane); };
    const Corners a = flat(soup.grid_triangle(5));
    if (collinear_by_definition(a)) continue;
    Corners b = flat(soup.grid_triangle(5));
    for (int k = 0; k < i % 3; ++k) b[k] = a[(k + 1) % 3];
    if (collinear_by_definition(b)) continue;
    const bool expected = improper_by_definition(a, b);
    improper += expected;
    ASSERT_EQ(meet_improperly(a, b), expected) << i;
  }
  EXPECT_GT(improper, 150);
}

// The same, where doubles that are not exact would get the signs wrong.
TEST(TriangleIntersection, AgreesWithTheDefinitionWhereFloatingPointFails) {
  Soup soup(3);
  const std::vector<std::function<Vector3(const Vector3&)>> maps = {
      [](const Vector3& p) { return Vector3(p + Vector3(16777215, -8388608, 5000000)); },
      [](const Vector3& p) { return Vector3(p * 0x1p-100); },
      [](const Vector3& p) { return Vector3(p * 0x1p+90); },
      [](const Vector3& p) {
        return Vector3(p.x() * 0x1p-30 + p.y(), p.y() * 3 + p.z(), p.z() * 0x1p-30 + p.x());
      },
      // rounded to floats near a plane: almost coplanar
      [](const Vector3& p) {
        return Vector3(static_cast<float>(p.x() / 7), static_cast<float>(p.y() / 11),
                       static_cast<float>(p.x() / 13 + p.y() / 17));
      }};
  for (std::size_t m = 0; m < maps.size(); ++m) {
    int tested = 0;
    for (int i = 0; i < 600; ++i) {
      const int size = 3 + soup.below(2);
      const Corners grid = soup.proper_grid_triangle(size);
      const Corners a = mapped(grid, maps[m]), b = mapped(soup.neighbour(grid, i % 3, size), maps[m]);
      ASSERT_EQ(collinear(a[0], a[1], a[2]), collinear_by_definition(a));
      if (collinear_by_definition(a) || collinear_by_definition(b)) continue;
      ++tested;
      ASSERT_EQ(meet_improperly(a, b), improper_by_definition(a, b)) << "map " << m << " pair " << i;
    }
    EXPECT_GT(tested, 300) << "map " << m;
  }
}

TEST(TriangleIntersection, NamedCases) {
  const Corners base = {Vector3(0, 0, 0), Vector3(4, 0, 0), Vector3(0, 4, 0)};
  const auto meets = [&](Vector3 a, Vector3 b, Vector3 c) { return meet_improperly(base, {a, b, c}); };
  EXPECT_FALSE(meets({0, 0, 1}, {4, 0, 1}, {0, 4, 1})) << "parallel";
  EXPECT_TRUE(meets({1, 1, 0}, {1, 1, 5}, {2, 1, 5})) << "a corner touches the inside";
  EXPECT_TRUE(meets({2, 0, 0}, {2, -1, 5}, {2, -1, -5})) << "a side touches a side";
  EXPECT_TRUE(meets({4, 0, 0}, {2, 0, 0}, {2, -3, 0})) << "shared corner, overlapping sides";
  EXPECT_FALSE(meets({4, 0, 0}, {8, 0, 0}, {8, 4, 0})) << "shared corner, same plane, apart";
  EXPECT_TRUE(meets({4, 0, 0}, {0, 1, 1}, {0, 1, -1})) << "shared corner, cuts through";
  EXPECT_FALSE(meets({4, 0, 0}, {0, 0, 0}, {0, -4, 0})) << "shared side, same plane";
  EXPECT_FALSE(meets({4, 0, 0}, {0, 0, 0}, {0, 4, 1e-30})) << "shared side, almost folded flat";
  EXPECT_TRUE(meets({4, 0, 0}, {0, 0, 0}, {9, 1, 0})) << "shared side, folded flat";
  EXPECT_TRUE(meets({4, 0, 0}, {0, 0, 0}, {0, 4, 0})) << "the same triangle turned over";
  EXPECT_TRUE(meets({4, -0.0, 0}, {0, 0, -0.0}, {0, 4, 0})) << "zeros of either sign are one position";
}

TEST(TriangleIntersection, ListsWhatTestingEveryPairFinds) {
  // 30 takes the simple loop, 700 the tree, 6000 the threads.
  for (const int count : {0, 1, 2, 30, 700, 6000}) {
    Soup soup(static_cast<std::uint32_t>(count));
    const int size = 3 + static_cast<int>(2.5 * std::cbrt(count));
    std::vector<Corners> triangles;
    for (int i = 0; i < count; ++i) {
      const Vector3 at = soup.grid_point(size);
      triangles.push_back(mapped(soup.grid_triangle(4), [&](const Vector3& p) { return Vector3(p + at); }));
    }
    if (count > 20) {
      triangles[7][1].x() = std::numeric_limits<double>::infinity();
      triangles[8][2].z() = std::numeric_limits<double>::quiet_NaN();
      triangles[10] = triangles[11];
    }
    std::vector<char> left_out;
    for (const Corners& t : triangles)
      left_out.push_back(!t[0].allFinite() || !t[1].allFinite() || !t[2].allFinite() ||
                         collinear_by_definition(t));
    std::vector<std::pair<Index, Index>> expected;
    for (Index i = 0; i < triangles.size(); ++i)
      for (Index j = i + 1; j < triangles.size() && !left_out[i]; ++j) {
        // Only a speed-up: grid triangles further apart than their extent cannot meet.
        if (left_out[j] || (triangles[i][0] - triangles[j][0]).cwiseAbs().maxCoeff() > 6) continue;
        if (meet_improperly(triangles[i], triangles[j])) expected.emplace_back(i, j);
      }
    EXPECT_EQ(improper_pairs(triangles), expected) << count;
    EXPECT_EQ(count_improper_pairs(triangles), expected.size()) << count;
    for (const std::size_t limit : {0, 1, 20}) {
      const std::size_t kept = std::min(limit, expected.size());
      const std::vector<std::pair<Index, Index>> first(expected.begin(),
                                                       expected.begin() + static_cast<long>(kept));
      EXPECT_EQ(improper_pairs(triangles, limit), first) << count << " limit " << limit;
    }
    if (count > 100) {
      EXPECT_GT(expected.size(), triangles.size() / 8);
    }
  }
}

TEST(TriangleIntersection, ListsPairsBetweenTwoSoups) {
  for (const auto& [a_count, b_count] : {std::pair{0, 5}, {3, 4}, {20, 600}, {600, 20}, {300, 300}}) {
    Soup soup(9);
    std::vector<Corners> a, b;
    for (int i = 0; i < a_count; ++i) a.push_back(soup.grid_triangle(6));
    for (int i = 0; i < b_count; ++i) b.push_back(soup.grid_triangle(6));
    if (b_count > 10) {
      b[3][0].x() = std::numeric_limits<double>::quiet_NaN();
      a[2][0].x() = -std::numeric_limits<double>::infinity();
    }
    const auto left_out = [](const std::vector<Corners>& list) {
      std::vector<char> flags;
      for (const Corners& t : list)
        flags.push_back(!t[0].allFinite() || !t[1].allFinite() || !t[2].allFinite() ||
                        collinear_by_definition(t));
      return flags;
    };
    const std::vector<char> not_a = left_out(a), not_b = left_out(b);
    std::vector<std::pair<Index, Index>> expected;
    for (Index i = 0; i < a.size(); ++i)
      for (Index j = 0; j < b.size(); ++j)
        if (!not_a[i] && !not_b[j] && meet_improperly(a[i], b[j])) expected.emplace_back(i, j);
    EXPECT_EQ(improper_pairs_between(a, b), expected) << a_count << " and " << b_count;
  }
}

TEST(TriangleIntersection, CleanSurfacesAreClean) {
  for (const TriangleMesh& mesh :
       {test::icosphere(4), test::uv_sphere(40, 40), test::torus(40, 20), test::plate_with_tunnels(3),
        test::flat_grid(30, 30), test::rough_sphere(4, 0.1, 5)})
    EXPECT_TRUE(improper_pairs(test::corners_of(mesh)).empty());
}

TEST(TriangleIntersection, CountsKnownCrossings) {
  // The wall cuts four sides of the cube, and the two faces of each.
  TriangleMesh wall;
  wall.vertices = {{0.5, -1, -9}, {0.5, 3, -9}, {0.5, 0.5, 9}};
  wall.triangles = {{0, 1, 2}};
  const std::vector<Corners> both = test::corners_of(test::join(test::cube(), wall));
  const auto pairs = improper_pairs(both);
  for (const auto& [i, j] : pairs) EXPECT_EQ(j, 12u);
  EXPECT_EQ(pairs.size(), 8u);
}

}  // namespace
}  // namespace meshcomplete
