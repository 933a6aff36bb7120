#include "filter_curveunfold/pinched_rim.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <set>
#include <vector>

#include "common/core/mesh_topology.h"
#include "common/core/patch.h"
#include "tests/support/meshes.h"
#include "tests/support/patches.h"

namespace meshcomplete {
namespace {

/// A flat grid with two square holes that touch at a corner; the vertex there is two, one for each side, so
/// that the rim is one loop of eight that passes the place twice.
TriangleMesh touching_squares() {
  const TriangleMesh grid = test::flat_grid(4, 4);
  TriangleMesh mesh = test::without_faces(grid, [](Index f) { return f / 2 == 5 || f / 2 == 10; });
  const Index middle = static_cast<Index>(
      std::find(mesh.vertices.begin(), mesh.vertices.end(), Vector3(2, 2, 0)) - mesh.vertices.begin());
  const Index twin = static_cast<Index>(mesh.vertices.size());
  mesh.vertices.push_back(mesh.vertices[middle]);
  for (Triangle& t : mesh.triangles) {
    const double x = (mesh.vertices[t[0]].x() + mesh.vertices[t[1]].x() + mesh.vertices[t[2]].x()) / 3;
    for (Index& v : t)
      if (v == middle && x > 2) v = twin;
  }
  return mesh;
}

Rim pinched_rim(const TriangleMesh& mesh) {
  for (const BoundaryLoop& loop : test::loops_of(mesh))
    if (loop.vertices.size() == 8) return collect_rim(mesh, build_topology(mesh), loop);
  throw std::logic_error("no loop of eight");
}

std::vector<Index> at(const Rim& rim, const Vector3& place) {
  std::vector<Index> list;
  for (Index v = 0; v < rim.positions.size(); ++v)
    if (rim.positions[v] == place) list.push_back(v);
  return list;
}

TEST(PinchedRim, IsFoundByPosition) {
  EXPECT_TRUE(is_pinched(pinched_rim(touching_squares())));
  const TriangleMesh sphere = test::sphere_with_touching_holes();
  for (const BoundaryLoop& loop : test::loops_of(sphere))
    EXPECT_FALSE(is_pinched(collect_rim(sphere, build_topology(sphere), loop)))
        << "two loops, each passes once";
}

TEST(PinchedRim, ARimThatIsNotPinchedComesBackAsItIs) {
  const TriangleMesh mesh = test::sphere_with_hole();
  const Rim rim = collect_rim(mesh, build_topology(mesh), test::loops_of(mesh)[0]);
  const OpenedRim opened = open_pinches(rim, 0.2);
  EXPECT_EQ(opened.rim.positions, rim.positions);
  EXPECT_EQ(opened.rim.ring.vertices, rim.ring.vertices);
  EXPECT_EQ(opened.rim.ring.triangles, rim.ring.triangles);
  EXPECT_EQ(opened.rim.forbidden, rim.forbidden);
  EXPECT_TRUE(opened.corners.empty());
  EXPECT_TRUE(opened.flaps.empty());
  for (Index v = 0; v < rim.positions.size(); ++v) EXPECT_EQ(opened.vertex_of[v], v);
}

TEST(PinchedRim, OneFlapOverOneOfTheTwins) {
  const Rim rim = pinched_rim(touching_squares());
  const std::vector<Index> twins = at(rim, Vector3(2, 2, 0));
  ASSERT_EQ(twins.size(), 2u);
  for (double height : {0.2, -0.2, 0.07}) {
    const OpenedRim opened = open_pinches(rim, height);
    EXPECT_FALSE(is_pinched(opened.rim));
    ASSERT_EQ(opened.corners.size(), 1u);
    EXPECT_EQ(opened.corners[0], as_stored(opened.corners[0]));
    EXPECT_LT(height * opened.corners[0].z(), 0) << "positive heights are behind the surface";
    EXPECT_LT((opened.corners[0] - Vector3(2, 2, 0)).norm(), 2 * std::abs(height))
        << "a small flap: edges have length 1";
    ASSERT_EQ(opened.flaps.size(), 2u);

    const Index covered =
        at(opened.rim, Vector3(2, 2, 0)) == std::vector<Index>{twins[0]} ? twins[1] : twins[0];
    EXPECT_EQ(opened.rim.positions[covered], opened.corners[0]);
    EXPECT_EQ(opened.rim.ring.vertices[covered], opened.corners[0]);
    EXPECT_EQ(opened.vertex_of[covered], 8u);
    for (Index v = 0; v < 8; ++v) {
      if (v == covered) continue;
      EXPECT_EQ(opened.vertex_of[v], v);
      EXPECT_EQ(opened.rim.positions[v], rim.positions[v]);
    }
    // The two flaps walk the covered vertex's rim edges the way the rim runs, and share the edge to the
    // corner.
    const Index before = (covered + 7) % 8, after = (covered + 1) % 8;
    EXPECT_EQ(opened.flaps[0], (Triangle{before, covered, 8}));
    EXPECT_EQ(opened.flaps[1], (Triangle{covered, after, 8}));
  }
}

// The flaps lie over the surface, not over the hole: the hole stays as large as it is.
TEST(PinchedRim, TheFlapLeansOntoTheSurface) {
  const OpenedRim opened = open_pinches(pinched_rim(touching_squares()), 0.2);
  const Vector3 c = opened.corners[0];
  const bool in_hole = (c.x() > 2) == (c.y() > 2);  // the holes are at the lower left and the upper right
  EXPECT_FALSE(in_hole) << c.transpose();
}

TEST(PinchedRim, EdgesOnTopOfEachOtherAreForbidden) {
  const Rim rim = pinched_rim(touching_squares());
  const std::vector<Index> twins = at(rim, Vector3(2, 2, 0));
  const OpenedRim opened = open_pinches(rim, 0.2);
  EXPECT_TRUE(std::is_sorted(opened.rim.forbidden.begin(), opened.rim.forbidden.end()));
  EXPECT_EQ(std::adjacent_find(opened.rim.forbidden.begin(), opened.rim.forbidden.end()),
            opened.rim.forbidden.end());
  const std::set<std::pair<Index, Index>> forbidden(opened.rim.forbidden.begin(), opened.rim.forbidden.end());
  for (int i : {0, 1})
    for (Index step : {1u, 7u}) {
      const Index a = twins[i], b = (twins[1 - i] + step) % 8;
      EXPECT_TRUE(forbidden.count(std::minmax(a, b))) << a << " " << b;
    }
  for (const auto& pair : rim.forbidden) EXPECT_TRUE(forbidden.count(pair)) << "what was forbidden stays so";
}

TEST(PinchedRim, SeveralPinches) {
  // A rim that passes one place three times and another one twice.
  Rim rim;
  const Vector3 a(0, 0, 0), b(5, 0, 0);
  rim.positions = {a, {1, 1, 0}, {2, 0, 0.5}, a, {0, 3, 0}, b, {-3, 0, 1}, a, {4, -2, 0}, b, {0, -4, 0}};
  rim.ring.vertices = rim.positions;
  const Index n = static_cast<Index>(rim.positions.size());
  for (Index v = 0; v < n; ++v) {
    rim.ring.vertices.push_back(rim.positions[v] + Vector3(0.3, 0.1 * v, -1));
    rim.ring.triangles.push_back({(v + 1) % n, v, n + v});
    rim.edge_length.push_back(1);
  }
  const OpenedRim opened = open_pinches(rim, 0.2);
  EXPECT_FALSE(is_pinched(opened.rim));
  EXPECT_EQ(opened.corners.size(), 3u);
  EXPECT_EQ(opened.flaps.size(), 6u);
  std::set<Index> used(opened.vertex_of.begin(), opened.vertex_of.end());
  EXPECT_EQ(used.size(), n);
  EXPECT_EQ(*used.rbegin(), n + 2);
}

}  // namespace
}  // namespace meshcomplete
