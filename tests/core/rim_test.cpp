#include "common/core/rim.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <vector>

#include "tests/support/meshes.h"
#include "tests/support/patches.h"

namespace meshcomplete {
namespace {

using test::loops_of;

Rim rim_of(const TriangleMesh& mesh, const BoundaryLoop& loop) {
  return collect_rim(mesh, build_topology(mesh), loop);
}

using Positions = std::array<double, 3>;
Positions key(const Vector3& p) { return {p.x(), p.y(), p.z()}; }

/// The corners of a face by position, the smallest first, in their cyclic order.
std::array<Positions, 3> face_key(const TriangleMesh& mesh, const Triangle& t) {
  std::array<Positions, 3> corners = {key(mesh.vertices[t[0]]), key(mesh.vertices[t[1]]),
                                      key(mesh.vertices[t[2]])};
  std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
  return corners;
}

/// Compares with all faces that have a corner on the loop; right for loops without pinched vertices.
void expect_one_ring(const TriangleMesh& mesh, const BoundaryLoop& loop, const Rim& rim) {
  const std::set<Index> on_loop(loop.vertices.begin(), loop.vertices.end());
  std::multiset<std::array<Positions, 3>> expected, found;
  std::set<std::pair<Index, Index>> chords;
  for (const Triangle& t : mesh.triangles) {
    if (std::none_of(t.begin(), t.end(), [&](Index v) { return on_loop.count(v) != 0; })) continue;
    expected.insert(face_key(mesh, t));
    for (int k = 0; k < 3; ++k) {
      const auto place = [&](Index v) {
        return static_cast<std::size_t>(std::find(loop.vertices.begin(), loop.vertices.end(), v) -
                                        loop.vertices.begin());
      };
      const std::size_t n = loop.vertices.size(), a = place(t[k]), b = place(t[(k + 1) % 3]);
      if (a < n && b < n && (a + 1) % n != b && (b + 1) % n != a)
        chords.emplace(std::min(a, b), std::max(a, b));
    }
  }
  for (const Triangle& t : rim.ring.triangles) found.insert(face_key(rim.ring, t));
  EXPECT_EQ(found, expected);
  EXPECT_EQ(ForbiddenEdges(chords.begin(), chords.end()), rim.forbidden);
}

TEST(Rim, TheRingIsEveryFaceAtTheLoop) {
  for (const TriangleMesh& mesh :
       {test::sphere_with_hole(), test::sphere_with_holes(6, 3, 0.3), test::open_cylinder(7, 1),
        test::shuffled(test::sphere_with_island(), 2), test::sphere_with_hole(1, 1.2)})
    for (const BoundaryLoop& loop : loops_of(mesh)) {
      const Rim rim = rim_of(mesh, loop);
      ASSERT_EQ(rim.positions.size(), loop.vertices.size());
      ASSERT_EQ(rim.edge_length.size(), loop.vertices.size());
      for (std::size_t i = 0; i < loop.vertices.size(); ++i) {
        EXPECT_EQ(rim.positions[i], mesh.vertices[loop.vertices[i]]);
        EXPECT_EQ(rim.ring.vertices[i], rim.positions[i]) << "the ring's first vertices are the loop's";
      }
      expect_one_ring(mesh, loop, rim);
    }
}

TEST(Rim, TheRingLooksAtBothFansOfATouchingVertex) {
  const TriangleMesh mesh = test::sphere_with_touching_holes();
  for (const BoundaryLoop& loop : loops_of(mesh)) expect_one_ring(mesh, loop, rim_of(mesh, loop));
}

TEST(Rim, TheRingEndsAtAnotherSheetThroughTheSameVertex) {
  // Two tetrahedra that share a vertex: the hole in one of them does not see the other.
  TriangleMesh mesh = test::pinched_tetrahedra();
  mesh.triangles.erase(mesh.triangles.begin());
  const std::vector<BoundaryLoop> loops = loops_of(mesh);
  ASSERT_EQ(loops.size(), 1u);
  EXPECT_EQ(rim_of(mesh, loops[0]).ring.triangles.size(), 3u);
}

// Without two of its faces a tetrahedron has a rim of four vertices, two of them joined by an edge.
TEST(Rim, ChordsOfTheInputAreForbidden) {
  TriangleMesh mesh = test::tetrahedron();
  mesh.triangles.resize(2);
  const std::vector<BoundaryLoop> loops = loops_of(mesh);
  ASSERT_EQ(loops[0].vertices.size(), 4u);
  std::vector<Index> shared;
  for (Index v : mesh.triangles[0])
    if (std::count(mesh.triangles[1].begin(), mesh.triangles[1].end(), v)) shared.push_back(v);
  ASSERT_EQ(shared.size(), 2u);
  const Rim rim = rim_of(mesh, loops[0]);
  ASSERT_EQ(rim.forbidden.size(), 1u);
  const auto [a, b] = rim.forbidden[0];
  EXPECT_LT(a, b);
  EXPECT_EQ((std::set<Index>{loops[0].vertices[a], loops[0].vertices[b]}),
            (std::set<Index>(shared.begin(), shared.end())));
}

TEST(Rim, EdgeLengthsAreThoseOfTheRing) {
  const TriangleMesh mesh = test::rough_sphere_with_ragged_holes(3, 1, 4);
  for (const BoundaryLoop& loop : loops_of(mesh)) {
    if (loop.defect != LoopDefect::none) continue;
    const Rim rim = rim_of(mesh, loop);
    double least = 1e300, greatest = 0;
    for (const Triangle& t : rim.ring.triangles)
      for (int k = 0; k < 3; ++k) {
        const double length = (rim.ring.vertices[t[k]] - rim.ring.vertices[t[(k + 1) % 3]]).norm();
        least = std::min(least, length);
        greatest = std::max(greatest, length);
      }
    for (double length : rim.edge_length) {
      EXPECT_GE(length, least);
      EXPECT_LE(length, greatest);
    }
    const Rim doubled = rim_of(test::scaled(mesh, 2), loop);
    for (std::size_t i = 0; i < rim.edge_length.size(); ++i)
      EXPECT_DOUBLE_EQ(doubled.edge_length[i], 2 * rim.edge_length[i]);
  }
}

// A tube whose one end is meshed three times as finely round the rim: the lengths follow the rim's own side.
TEST(Rim, EdgeLengthsFollowTheMeshAlongTheRim) {
  std::vector<Vector3> rim, outer;
  for (int i = 0; i <= 40; ++i) rim.emplace_back(0.25 * i, 0, 0);  // fine
  for (int i = 0; i < 10; ++i) rim.emplace_back(10, 2.0 + i, 0);   // coarse
  for (int i = 0; i < 10; ++i) rim.emplace_back(9.0 - i, 11, 0);
  for (int i = 0; i < 10; ++i) rim.emplace_back(0, 10.0 - i, 0);
  for (const Vector3& p : rim) outer.push_back(p - Vector3(0, 0, 0.5));
  const TriangleMesh mesh = test::collar(rim, outer);
  const Rim collected = rim_of(mesh, loops_of(mesh)[0]);
  EXPECT_LT(collected.edge_length[20], 0.5);
  EXPECT_GT(collected.edge_length[55], 0.8);
}

// --- several loops
// --------------------------------------------------------------------------------------------------

/// What `collect_rim` says of several loops, by the definitions: every face at a loop is in the ring (right
/// for meshes whose vertices' fans are all at the loops).
void expect_rim_of_loops(const TriangleMesh& mesh, const std::vector<BoundaryLoop>& loops) {
  const Rim rim = collect_rim(mesh, build_topology(mesh), loops);
  std::vector<Index> vertices, next;
  for (const BoundaryLoop& loop : loops) {
    const Index first = static_cast<Index>(vertices.size()), n = static_cast<Index>(loop.vertices.size());
    for (Index i = 0; i < n; ++i) {
      vertices.push_back(loop.vertices[i]);
      next.push_back(first + (i + 1) % n);
    }
  }
  EXPECT_EQ(rim.next, next);
  ASSERT_EQ(rim.positions.size(), vertices.size());
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    EXPECT_EQ(rim.positions[i], mesh.vertices[vertices[i]]);
    EXPECT_EQ(rim.ring.vertices[i], rim.positions[i]);
  }
  const auto places = [&](Index v) {
    std::vector<Index> all;
    for (Index i = 0; i < vertices.size(); ++i)
      if (vertices[i] == v) all.push_back(i);
    return all;
  };
  std::set<std::pair<Index, Index>> chords;
  std::multiset<std::array<Positions, 3>> faces, found;
  std::vector<double> sum(vertices.size(), 0), count(vertices.size(), 0);
  for (const Triangle& t : mesh.triangles) {
    bool at_loop = false;
    for (std::size_t k = 0; k < 3; ++k) {
      const Index v = t[k], w = t[(k + 1) % 3];
      at_loop |= !places(v).empty();
      for (Index end : {v, w})
        for (Index a : places(end)) {
          sum[a] += (mesh.vertices[v] - mesh.vertices[w]).norm();
          ++count[a];
        }
      for (Index a : places(v))
        for (Index b : places(w))
          if (next[a] != b && next[b] != a) chords.emplace(std::min(a, b), std::max(a, b));
    }
    if (at_loop) faces.insert(face_key(mesh, t));
  }
  for (const Triangle& t : rim.ring.triangles) found.insert(face_key(rim.ring, t));
  EXPECT_EQ(found, faces) << "each face once, however many loops it is at";
  // Means of the ring's edges at each vertex, then three rounds of averaging along the loop.
  std::vector<double> length(vertices.size());
  for (std::size_t i = 0; i < length.size(); ++i) length[i] = sum[i] / count[i];
  for (int round = 0; round < 3; ++round) {
    std::vector<double> smooth(length.size(), 0);
    for (std::size_t i = 0; i < length.size(); ++i) {
      smooth[i] += 0.5 * length[i] + 0.25 * length[next[i]];
      smooth[next[i]] += 0.25 * length[i];
    }
    length = smooth;
  }
  ASSERT_EQ(rim.edge_length.size(), length.size());
  for (std::size_t i = 0; i < length.size(); ++i) EXPECT_NEAR(rim.edge_length[i], length[i], 1e-12);
  // From the places of vertices that are there more than once to all others near by.
  for (Index a = 0; a < vertices.size(); ++a)
    for (Index b = 0; b < vertices.size(); ++b)
      if (a != b && places(vertices[a]).size() > 1 && next[a] != b && next[b] != a &&
          (rim.positions[a] - rim.positions[b]).norm() <= 16 * length[a])
        chords.emplace(std::min(a, b), std::max(a, b));
  EXPECT_EQ(rim.forbidden, ForbiddenEdges(chords.begin(), chords.end()));
}

TEST(Rim, OfSeveralLoops) {
  for (const TriangleMesh& mesh :
       {test::sphere_with_holes(6, 3, 0.3), test::sphere_with_island(), test::open_cylinder(7, 1),
        test::open_cylinder(5, 2), test::shuffled(test::sphere_with_island(), 2)})
    expect_rim_of_loops(mesh, loops_of(mesh));
}

// A tube of one row of squares: every vertex of one loop is joined to two of the other.
TEST(Rim, EdgesBetweenTwoLoopsAreForbidden) {
  const TriangleMesh mesh = test::open_cylinder(7, 1);
  const std::vector<BoundaryLoop> loops = loops_of(mesh);
  ASSERT_EQ(loops.size(), 2u);
  const Rim rim = collect_rim(mesh, build_topology(mesh), loops);
  EXPECT_EQ(rim.forbidden.size(), 14u);
  for (const auto& [a, b] : rim.forbidden) {
    EXPECT_LT(a, 7u);
    EXPECT_GE(b, 7u);
  }
  EXPECT_TRUE(rim_of(mesh, loops[0]).forbidden.empty());
}

// Two holes that touch at a vertex: it is in the list twice, and no chord may end there, or one could be the
// same edge as another from its other place.
TEST(Rim, AVertexInTwoLoopsIsThereTwice) {
  const TriangleMesh mesh = test::sphere_with_touching_holes();
  const std::vector<BoundaryLoop> loops = loops_of(mesh);
  ASSERT_EQ(loops.size(), 2u);
  expect_rim_of_loops(mesh, loops);
  const Rim rim = collect_rim(mesh, build_topology(mesh), loops);
  std::vector<std::pair<Index, Index>> twice;
  for (Index i = 0; i < rim.positions.size(); ++i)
    for (Index j = i + 1; j < rim.positions.size(); ++j)
      if (rim.positions[i] == rim.positions[j]) twice.emplace_back(i, j);
  ASSERT_EQ(twice.size(), 1u);
  const auto forbidden = [&](Index a, Index b) {
    return std::binary_search(rim.forbidden.begin(), rim.forbidden.end(),
                              std::make_pair(std::min(a, b), std::max(a, b)));
  };
  const auto [first, second] = twice[0];
  EXPECT_TRUE(forbidden(first, rim.next[second]));
  EXPECT_TRUE(forbidden(second, rim.next[first]));
  EXPECT_FALSE(forbidden(first, rim.next[first]));
  EXPECT_FALSE(forbidden(second, rim.next[second]));
  for (Index other = 0; other < rim.positions.size(); ++other)
    for (Index place : {first, second})
      if (other != place && rim.next[place] != other && rim.next[other] != place) {
        EXPECT_TRUE(forbidden(place, other));
      }
}

// Chords over more than sixteen edges do not come up, and would be many.
TEST(Rim, LongChordsAreNotListed) {
  const TriangleMesh mesh = test::sphere_with_touching_holes(2);
  const std::size_t edges = collect_rim(mesh, build_topology(mesh), loops_of(mesh)).forbidden.size();
  for (const double away : {2.5, 30.0}) {
    const TriangleMesh tube = test::translated(test::open_cylinder(5, 1, 0.2, 0.2), Vector3(0, 0, away));
    const TriangleMesh both = test::join(mesh, tube);
    const std::vector<BoundaryLoop> loops = loops_of(both);
    ASSERT_EQ(loops.size(), 4u);
    expect_rim_of_loops(both, loops);
    // Those of the tube between its own rims, and to the tube's vertices from the two places.
    EXPECT_EQ(collect_rim(both, build_topology(both), loops).forbidden.size(),
              edges + 10 + (away < 3 ? 20 : 0));
  }
}

// --- obstructed edges
// --------------------------------------------------------------------------------------------------

TEST(ObstructedEdges, NoneOnCleanMeshes) {
  for (const TriangleMesh& mesh : {test::sphere_with_holes(6), test::sphere_with_touching_holes(),
                                   test::sphere_with_island(), test::rough_sphere_with_ragged_holes(3, 3, 1)})
    for (const BoundaryLoop& loop : loops_of(mesh))
      EXPECT_TRUE(obstructed_edges(InputNeighbourhood(mesh), loop).empty());
}

TEST(ObstructedEdges, AFaceThroughAnEdgeIsFound) {
  const TriangleMesh sphere = test::sphere_with_hole();
  const BoundaryLoop loop = loops_of(sphere)[0];
  const Index edge = 5;
  const Vector3 a = sphere.vertices[loop.vertices[edge]], b = sphere.vertices[loop.vertices[edge + 1]];
  const Vector3 across = Vector3(0, 0, 1), along = 0.1 * (b - a);
  const Vector3 middle = 0.5 * (a + b);
  TriangleMesh blade;
  const Vector3 outwards = Vector3(middle.x(), middle.y(), 0).normalized();
  blade.vertices = {middle + 0.3 * outwards + along, middle - 0.3 * outwards + 0.1 * across,
                    middle - 0.3 * outwards - 0.1 * across};
  blade.triangles = {{0, 1, 2}};
  const TriangleMesh mesh = test::join(sphere, blade);
  EXPECT_EQ(obstructed_edges(InputNeighbourhood(mesh), loop), std::vector<Index>{edge});
  for (Vector3& p : blade.vertices) p += 8 * along;  // past the end of the edge
  const TriangleMesh beside = test::join(sphere, blade);
  for (Index other : obstructed_edges(InputNeighbourhood(beside), loop)) EXPECT_NE(other, edge);
}

}  // namespace
}  // namespace meshcomplete
