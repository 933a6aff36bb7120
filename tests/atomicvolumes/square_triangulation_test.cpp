#include "filter_atomicvolumes/square_triangulation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "tests/support/complexes.h"
#include "tests/support/volumes.h"

namespace meshcomplete {
namespace {

using test::PlacedMesh;
using Point = Eigen::Vector2d;

bool is_hole(const Decomposition& d, Index cube) {
  return cube != Octree::none &&
         (d.volumes[cube].kind == VolumeKind::vertex || d.volumes[cube].kind == VolumeKind::edge);
}

/// In steps from the square's lowest corner, along the axes after its own.
Point in_square(const Vector3& steps, const LeafSquare& s) {
  const int i = (s.axis + 1) % 3, j = (s.axis + 2) % 3;
  return Point(steps[i] - static_cast<double>(s.low[static_cast<std::size_t>(i)]),
               steps[j] - static_cast<double>(s.low[static_cast<std::size_t>(j)]));
}

Vector3 steps_of(const LatticePoint& p) {
  return Vector3(static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2]));
}

Point point_of(const LatticeMesh& mesh, const VolumeVertex& v, const LeafSquare& s) {
  const Vector3 origin = mesh.lattice.position({0, 0, 0});
  return in_square((v.position - origin) / mesh.lattice.step(), s);
}

double cross(const Point& a, const Point& b) { return a.x() * b.y() - a.y() * b.x(); }

/// What of a triangle lies in the square: the section with the plane, cut off at the sides. By doubles.
struct Section {
  Point from, to;
};

std::optional<Section> section_of(const LatticeTriangle& t, const LeafSquare& s) {
  const std::size_t k = static_cast<std::size_t>(s.axis);
  std::vector<Point> ends;
  for (std::size_t m = 0; m < 3; ++m) {
    const LatticePoint &a = t[m], &b = t[(m + 1) % 3];
    if ((a[k] > s.low[k]) == (b[k] > s.low[k])) continue;
    const double share = static_cast<double>(s.low[k] - a[k]) / static_cast<double>(b[k] - a[k]);
    ends.push_back(in_square(steps_of(a) + share * (steps_of(b) - steps_of(a)), s));
  }
  if (ends.size() != 2) return std::nullopt;
  // The front on the left.
  const Vector3 u = steps_of(t[1]) - steps_of(t[0]), v = steps_of(t[2]) - steps_of(t[0]), normal = u.cross(v);
  const Point front(normal[(s.axis + 1) % 3], normal[(s.axis + 2) % 3]);
  if (cross(ends[1] - ends[0], front) < 0) std::swap(ends[0], ends[1]);
  double first = 0, last = 1;
  for (int axis = 0; axis < 2; ++axis) {
    const double start = ends[0][axis], rise = ends[1][axis] - start;
    const double at_low = -start / rise, at_high = (static_cast<double>(s.length) - start) / rise;
    first = std::max(first, std::min(at_low, at_high));
    last = std::min(last, std::max(at_low, at_high));
  }
  if (first >= last) return std::nullopt;
  return Section{ends[0] + first * (ends[1] - ends[0]), ends[0] + last * (ends[1] - ends[0])};
}

/// Every mesh triangle that crosses the square has one segment there, and nothing else has any.
void expect_sections(const LatticeMesh& mesh, const LeafSquare& s, const SquareTriangulation& square) {
  std::vector<Index> crossing;
  for (Index t = 0; t < mesh.mesh.triangles.size(); ++t)
    if (section_of(mesh.triangle(t), s)) crossing.push_back(t);
  std::vector<Index> found;
  const double tolerance = 1e-2 + 1e-9 * static_cast<double>(s.length);
  for (const SquareTriangulation::Segment& segment : square.segments) {
    found.push_back(segment.triangle);
    const std::optional<Section> section = section_of(mesh.triangle(segment.triangle), s);
    ASSERT_TRUE(section);
    ASSERT_LT((point_of(mesh, square.points[segment.from], s) - section->from).norm(), tolerance);
    ASSERT_LT((point_of(mesh, square.points[segment.to], s) - section->to).norm(), tolerance);
  }
  std::sort(found.begin(), found.end());
  ASSERT_EQ(found, crossing);
}

/// The triangles tile the square, and no side of one is crossed by the mesh.
void expect_tiling(const LatticeMesh& mesh, const LeafSquare& s, const SquareTriangulation& square) {
  const double side = static_cast<double>(s.length);
  double area = 0;
  std::set<test::Edge> sides;
  for (const auto& t : square.triangles) {
    std::array<Point, 3> p;
    for (std::size_t k = 0; k < 3; ++k) {
      p[k] = point_of(mesh, square.points[t[k]], s);
      sides.emplace(t[k], t[(k + 1) % 3]);
    }
    const double twice = cross(p[1] - p[0], p[2] - p[0]);
    ASSERT_GT(twice, -1e-9 * side * side) << "counter-clockwise";
    area += 0.5 * twice;
  }
  ASSERT_NEAR(area, side * side, 1e-9 * side * side);
  const test::Shape shape =
      test::shape_of(std::vector<Triangle>(square.triangles.begin(), square.triangles.end()));
  ASSERT_TRUE(shape.manifold);
  ASSERT_EQ(shape.euler, 1);
  for (const SquareTriangulation::Segment& segment : square.segments) {
    ASSERT_TRUE(sides.count({segment.from, segment.to})) << "a segment is a side of two triangles";
    ASSERT_TRUE(sides.count({segment.to, segment.from}));
  }
  std::set<Index> used;
  for (const auto& t : square.triangles) used.insert(t.begin(), t.end());
  ASSERT_EQ(used.size(), square.points.size());
}

/// Corners of leaves on the square's outline are points of it, and no other lattice points are, but for the
/// centre of a square that the mesh does not cross.
void expect_corners(const std::set<LatticePoint>& corners, const LeafSquare& s,
                    const SquareTriangulation& square) {
  std::set<LatticePoint> expected, found;
  const LatticeBox box = s.box();
  const std::size_t i = static_cast<std::size_t>((s.axis + 1) % 3),
                    j = static_cast<std::size_t>((s.axis + 2) % 3);
  for (const LatticePoint& p : corners)
    if (box.contains(p) &&
        (p[i] == box.low[i] || p[i] == box.high[i] || p[j] == box.low[j] || p[j] == box.high[j]))
      expected.insert(p);
  if (square.segments.empty() && expected.size() > 4) expected.insert(s.centre());
  for (const VolumeVertex& v : square.points)
    if (v.key.kind == VertexKey::lattice_point)
      found.insert({static_cast<std::int64_t>(v.key.a), static_cast<std::int64_t>(v.key.b),
                    static_cast<std::int64_t>(v.key.c)});
  ASSERT_EQ(found, expected);
}

/// Points on the rim are known, and no two points are one.
void expect_keys(const LatticeMesh& mesh, const SquareTriangulation& square) {
  std::set<std::tuple<std::uint64_t, std::uint64_t, std::uint64_t, std::uint64_t>> keys;
  for (const VolumeVertex& v : square.points) {
    ASSERT_TRUE(keys.emplace(v.key.kind, v.key.a, v.key.b, v.key.c).second);
    ASSERT_EQ(v.input, VolumeVertex::none);
    const bool boundary =
        v.key.kind == VertexKey::edge_in_plane && mesh.topology.opposite[v.key.a] == MeshTopology::boundary;
    ASSERT_EQ(v.rim_edge, boundary ? static_cast<Index>(v.key.a) : VolumeVertex::none);
  }
}

std::set<LatticePoint> corners_of(const Octree& octree) {
  std::set<LatticePoint> corners;
  for (Index leaf = 0; leaf < octree.size(); ++leaf)
    for (int place = 0; octree.is_leaf(leaf) && place < 8; ++place) {
      const LatticeBox box = octree.box(leaf);
      LatticePoint p = box.low;
      for (std::size_t k = 0; k < 3; ++k)
        if (place >> k & 1) p[k] = box.high[k];
      corners.insert(p);
    }
  return corners;
}

bool same(const SquareTriangulation& a, const SquareTriangulation& b) {
  const auto segments = [](const SquareTriangulation& s) {
    std::set<std::tuple<std::uint64_t, std::uint64_t, std::uint64_t, std::uint64_t, Index>> all;
    for (const auto& g : s.segments)
      all.emplace(s.points[g.from].key.kind, s.points[g.from].key.a, s.points[g.to].key.kind,
                  s.points[g.to].key.a, g.triangle);
    return all;
  };
  return a.points.size() == b.points.size() && a.triangles.size() == b.triangles.size() &&
         segments(a) == segments(b);
}

TEST(SquareTriangulation, ConformsToTheMeshAndToFinerLeaves) {
  std::size_t crossed = 0, with_corners = 0, rim_points = 0;
  for (const test::NamedMesh& named : test::holed_meshes()) {
    const PlacedMesh placed(named.mesh, 1);
    const Decomposition d = decompose(placed.lattice_mesh, {});
    const std::set<LatticePoint> corners = corners_of(d.octree);
    std::size_t number = 0;
    for (const LeafSquare& s : leaf_squares(d.octree)) {
      if (!(is_hole(d, s.below) || is_hole(d, s.above)) || number++ % 3 != 0) continue;
      const Index hole = is_hole(d, s.below) ? s.below : s.above, other = hole == s.below ? s.above : s.below;
      const SquareTriangulation square =
          triangulate_square(placed.lattice_mesh, d.octree, s, d.volumes[hole].triangles);
      ASSERT_NO_FATAL_FAILURE(expect_sections(placed.lattice_mesh, s, square)) << named.name;
      ASSERT_NO_FATAL_FAILURE(expect_tiling(placed.lattice_mesh, s, square)) << named.name;
      ASSERT_NO_FATAL_FAILURE(expect_corners(corners, s, square)) << named.name;
      ASSERT_NO_FATAL_FAILURE(expect_keys(placed.lattice_mesh, square)) << named.name;
      if (other != Octree::none) {
        ASSERT_TRUE(
            same(square, triangulate_square(placed.lattice_mesh, d.octree, s, d.volumes[other].triangles)))
            << "from both sides";
      }
      crossed += !square.segments.empty();
      with_corners += square.points.size() > 4 && square.segments.empty();
      for (const VolumeVertex& v : square.points) rim_points += v.rim_edge != VolumeVertex::none;
    }
  }
  EXPECT_GT(crossed, 500u);
  EXPECT_GT(with_corners, 100u);
  EXPECT_GT(rim_points, 100u);
}

// --- on a lattice of our own, one mesh unit a step
// -----------------------------------------------------------------

constexpr std::int64_t middle = Lattice::steps / 2;

/// Triangles near the middle of the root, given by their corners' distances from it, which must be odd.
TriangleMesh near_middle(const std::vector<std::array<double, 3>>& corners) {
  TriangleMesh mesh;
  for (const auto& c : corners)
    mesh.vertices.push_back(Vector3(c[0], c[1], c[2]) + Vector3::Constant(static_cast<double>(middle)));
  for (Index v = 0; v < mesh.vertices.size(); v += 3) mesh.triangles.push_back({v, v + 1, v + 2});
  return mesh;
}

/// The square of the eight children of the root that lies at high x and y, in the plane z = middle.
SquareTriangulation triangulated(const TriangleMesh& mesh) {
  const MeshTopology topology = build_topology(mesh);
  const InputNeighbourhood neighbourhood(mesh);
  const LatticeMesh placed{mesh, topology, neighbourhood,
                           Lattice(Vector3::Zero(), static_cast<double>(Lattice::steps))};
  Octree octree;
  octree.split(0);
  for (const LeafSquare& s : leaf_squares(octree))
    if (s.axis == 2 && s.low == LatticePoint{middle, middle, middle}) {
      std::vector<Index> all(mesh.triangles.size());
      std::iota(all.begin(), all.end(), 0u);
      return triangulate_square(placed, octree, s, all);
    }
  throw std::logic_error("no such square");
}

TEST(SquareTriangulation, AVertexOfTheMeshOnALineOfTheOctreeIsACoincidence) {
  // The side from the first to the second corner meets the plane where x is exactly that of the square's
  // side.
  EXPECT_THROW(triangulated(near_middle({{-101, 301, -101}, {101, 501, 101}, {3001, 701, -501}})),
               Coincidence);
  EXPECT_NO_THROW(triangulated(near_middle({{-101, 301, -101}, {103, 501, 101}, {3001, 701, -501}})));
  // The plane of the triangle goes through the corner of the square: x = y.
  EXPECT_THROW(triangulated(near_middle({{-901, -901, 5}, {901, 901, 7}, {-501, -501, -901}})), Coincidence);
  EXPECT_NO_THROW(triangulated(near_middle({{-901, -903, 5}, {901, 901, 7}, {-501, -501, -901}})));
}

// Edges of faces that share neither edge nor vertex cross in the plane: another octree would not help if the
// faces lie on each other.
TEST(SquareTriangulation, TwoEdgesThroughOnePointAreTangled) {
  EXPECT_THROW(triangulated(near_middle({{401, 401, -101},
                                         {601, 601, 101},
                                         {401, 901, -301},
                                         {601, 401, -101},
                                         {401, 601, 101},
                                         {901, 401, -301}})),
               TangledCube);
}

TEST(SquareTriangulation, CrossingTrianglesAreTangled) {
  const std::vector<std::array<double, 3>> one = {
      {301, 1001, -5001}, {5001, 1201, -5001}, {2001, 1101, 5001}};
  const std::vector<std::array<double, 3>> two = {
      {1901, 301, -5001}, {2101, 5001, -5001}, {2001, 1501, 5001}};
  std::vector<std::array<double, 3>> both = one;
  both.insert(both.end(), two.begin(), two.end());
  EXPECT_NO_THROW(triangulated(near_middle(one)));
  EXPECT_NO_THROW(triangulated(near_middle(two)));
  EXPECT_THROW(triangulated(near_middle(both)), TangledCube);
}

TEST(SquareTriangulation, ATriangleThatMissesTheSquareLeavesItAlone) {
  const SquareTriangulation square =
      triangulated(near_middle({{-301, 301, -101}, {-101, 501, 103}, {-3001, 701, -501}}));
  EXPECT_TRUE(square.segments.empty());
  EXPECT_EQ(square.points.size(), 4u);
  EXPECT_EQ(square.triangles.size(), 2u);
}

}  // namespace
}  // namespace meshcomplete
