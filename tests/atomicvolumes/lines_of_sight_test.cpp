#include "filter_atomicvolumes/lines_of_sight.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>
#include <vector>

#include "common/core/mesh_topology.h"
#include "common/core/patch_check.h"
#include "filter_atomicvolumes/nearest_side.h"
#include "tests/support/meshes.h"

namespace meshcomplete {
namespace test {
namespace {

Vector3 random_point(std::mt19937& random, double reach) {
  Vector3 p;
  for (int k = 0; k < 3; ++k) p[k] = reach * (2 * (random() * (1.0 / 4294967296.0)) - 1);
  return p;
}

TEST(LinesOfSight, EndBeforeTheMeshAndBeforeThePointSeen) {
  const TriangleMesh mesh = icosphere(4);
  const TriangleBlocks blocks(mesh);
  VolumeConstraints::View view;
  view.from = {0, 0, 5};
  view.seen = {{0, 0, -5}, {0, 0, 3}, {0, 0, 1}};
  const LinesOfSight lines = lines_of_sight(blocks, {view}, 0.1);
  ASSERT_EQ(lines.lines.size(), 3u);
  EXPECT_NEAR(lines.lines[0].to[2], 1.1, 2e-3);
  EXPECT_NEAR(lines.lines[1].to[2], 3.1, 1e-12);
  EXPECT_NEAR(lines.lines[2].to[2], 1.1, 2e-3);
  EXPECT_EQ(lines.notes.size(), 1u);
}

TEST(LinesOfSight, FromInsideAreLeftOut) {
  const TriangleMesh mesh = icosphere(4);
  const TriangleBlocks blocks(mesh);
  VolumeConstraints::View view;
  view.seen = {{0, 0, 5}, {0, 0, 0.5}, {std::nan(""), 0, 0}, {0, 0, 0}};
  const LinesOfSight lines = lines_of_sight(blocks, {view}, 0.1);
  EXPECT_EQ(lines.lines.size(), 1u);  // the one that ends before the mesh
  ASSERT_EQ(lines.notes.size(), 1u);
  EXPECT_NE(lines.notes[0].find("from behind"), std::string::npos);
}

// From very far, and exactly through vertices and edges.
TEST(LinesOfSight, DoNotSlipThroughTheMesh) {
  const TriangleMesh mesh = icosphere(3);
  const TriangleBlocks blocks(mesh);
  for (double distance : {3.0, 1e3, 1e5})
    for (const Triangle& t : mesh.triangles) {
      const Vector3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]];
      VolumeConstraints::View view;
      view.from = distance * Vector3(0.3, -0.2, 0.9).normalized();
      for (const Vector3& target : {a, Vector3(0.5 * (a + b)), Vector3(0.3 * a + 0.7 * b)})
        view.seen.push_back(view.from + (target - view.from) * (1 + 4 / distance));
      for (const LineOfSight& line : lines_of_sight(blocks, {view}, 0.01).lines) {
        const double length = (line.to - line.from).norm();
        const double past = (-line.from).dot((line.to - line.from) / length);  // beside the sphere's centre
        const double beside = (line.from + (line.to - line.from) * (past / length)).norm();
        // What ends beyond the sphere's centre has passed beside its facets.
        if (length > past + 0.2) {
          EXPECT_GT(beside, 0.97);
        }
      }
    }
}

TEST(LinesOfSight, LeavesSeenThroughAreNearTheLine) {
  const TriangleMesh mesh = sphere_with_hole();
  const MeshTopology topology = build_topology(mesh);
  const InputNeighbourhood neighbourhood(mesh);
  const LatticeMesh placed{mesh, topology, neighbourhood, Lattice({-1.913, -1.847, -1.881}, 3.7)};
  const Decomposition decomposition = decompose(placed, {});
  std::mt19937 random(5);
  std::size_t seen = 0, passed = 0;
  for (int i = 0; i < 600; ++i) {
    VolumeConstraints::View view;
    view.from = 3 * random_point(random, 1).normalized();
    view.seen = {random_point(random, 2)};
    const auto lines = lines_of_sight(neighbourhood.blocks(), {view}, 0.1).lines;
    if (lines.empty()) continue;
    const std::vector<char> marks = leaves_seen_through(placed.lattice, decomposition, lines);
    const Vector3 along = (lines[0].to - lines[0].from).normalized();
    for (Index leaf = 0; leaf < marks.size(); ++leaf) {
      const LatticeBox box = decomposition.octree.box(leaf);
      const Eigen::AlignedBox3d space(placed.lattice.position(box.low), placed.lattice.position(box.high));
      if (marks[leaf]) {
        ++seen;
        EXPECT_TRUE(decomposition.octree.is_leaf(leaf));
        EXPECT_EQ(decomposition.volumes[leaf].kind, VolumeKind::blank);
        EXPECT_FALSE(space.contains(lines[0].to));
        const double at = along.dot(space.center() - lines[0].from);
        const double beside = (space.center() - lines[0].from - at * along).norm();
        EXPECT_LE(beside, 0.5 * space.diagonal().norm());
      }
      // A line through the middle passes through at least a side's length.
      const double at = along.dot(space.center() - lines[0].from);
      const Vector3 closest = lines[0].from + at * along;
      const double side = space.sizes()[0];
      if (decomposition.octree.is_leaf(leaf) && decomposition.volumes[leaf].kind == VolumeKind::blank &&
          (closest - space.center()).norm() < 0.2 * side && at > side &&
          at + side < (lines[0].to - lines[0].from).norm()) {
        ++passed;
        EXPECT_TRUE(marks[leaf]);
      }
    }
  }
  EXPECT_GT(seen, 100u);
  EXPECT_GT(passed, 10u);
}

TEST(SideFinder, KnowsTheSidesOfACubeAtItsEdgesAndCorners) {
  const TriangleMesh mesh = cube(2, {-1, -1, -1});
  const MeshTopology topology = build_topology(mesh);
  const SideFinder sides(mesh, topology);
  std::mt19937 random(3);
  Index near = 0;
  for (int i = 0; i < 2000; ++i) {
    const Vector3 p = random_point(random, 1.6);
    const Vector3 beyond = p.cwiseAbs() - Vector3::Ones();
    const bool inside = beyond.maxCoeff() < 0;
    const double distance = inside ? -beyond.maxCoeff() : beyond.cwiseMax(0.0).norm();
    const NearestSide side = sides.nearest(p, near);
    ASSERT_TRUE(side.inside.has_value());
    EXPECT_EQ(*side.inside, inside);
    EXPECT_NEAR(side.distance, distance, 1e-12);
    Index elsewhere = static_cast<Index>(i % 12);
    const NearestSide again = sides.nearest(p, elsewhere);
    EXPECT_EQ(elsewhere, near);
    EXPECT_EQ(again.inside, side.inside);
    EXPECT_EQ(std::isinf(sides.nearest(p, elsewhere, 0.9 * distance).distance), true);
  }
}

// At an acute edge one face alone does not tell the side.
TEST(SideFinder, KnowsTheSidesOfAcuteEdges) {
  const TriangleMesh mesh = tetrahedron(1);
  const MeshTopology topology = build_topology(mesh);
  const SideFinder sides(mesh, topology);
  std::mt19937 random(4);
  for (int i = 0; i < 2000; ++i) {
    const Vector3 p = random_point(random, 2);
    Index near = 0;
    EXPECT_EQ(sides.nearest(p, near).inside, p.minCoeff() > 0 && p.sum() < 1);
  }
}

TEST(SideFinder, DoesNotKnowBeyondABoundary) {
  const TriangleMesh mesh = flat_grid(4, 4);
  const MeshTopology topology = build_topology(mesh);
  const SideFinder sides(mesh, topology);
  Index near = 0;
  EXPECT_EQ(sides.nearest({2.2, 1.7, 0.5}, near).inside, false);
  EXPECT_EQ(sides.nearest({2.2, 1.7, -0.5}, near).inside, true);
  EXPECT_FALSE(sides.nearest({-1, 1.7, -0.5}, near).inside.has_value());
  EXPECT_FALSE(sides.nearest({-1, 6, -0.5}, near).inside.has_value());
}

}  // namespace
}  // namespace test
}  // namespace meshcomplete
