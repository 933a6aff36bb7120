#include "common/core/rim_patch.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "common/core/triangle_intersection.h"
#include "filter_atomicvolumes/extraction.h"
#include "filter_atomicvolumes/labelling.h"
#include "tests/support/complexes.h"
#include "tests/support/patches.h"
#include "tests/support/volumes.h"

namespace meshcomplete {
namespace {

using test::PlacedMesh;

/// The sheets of the cut of least area, in a root of this seed.
std::vector<Sheet> sheets_of(const PlacedMesh& placed) {
  const auto division = test::divide(placed);
  if (!division) return {};
  const Labelling cut = cut_complex(placed.lattice_mesh, division->complex, CutWeight::area, {});
  return split_into_sheets(
      placed.mesh, placed.topology,
      separating(extract(placed.lattice_mesh, division->decomposition.octree, division->complex, cut)),
      placed.mesh);
}

std::vector<Index> steiner_points(const PatchMesh& mesh) {
  std::vector<Index> points;
  for (Index v = static_cast<Index>(mesh.rim_size()); v < mesh.vertex_count(); ++v)
    if (mesh.vertex_alive(v) && mesh.at_boundary(v)) points.push_back(v);
  return points;
}

/// Steiner points with a single triangle, the others next to them along the rim its other corners.
std::size_t ears(const PatchMesh& mesh) {
  std::size_t count = 0;
  for (Index v : steiner_points(mesh)) count += mesh.valence(v) == 2;
  return count;
}

TEST(RimPatch, KnowsTheRimsOfTheSheet) {
  std::size_t gone_in_all = 0;
  for (const test::NamedMesh& named : test::holed_meshes()) {
    SCOPED_TRACE(named.name);
    const PlacedMesh placed(named.mesh, 1);
    const std::vector<Sheet> sheets = sheets_of(placed);
    for (const Sheet& sheet : sheets) {
      if (sheet.closes.empty()) continue;
      const RimPatch patch = make_rim_patch(placed.mesh, placed.topology, sheet);
      std::vector<Index> vertices, faces, closed;
      for (const BoundaryLoop& loop : patch.loops) {
        ASSERT_EQ(loop.faces.size(), loop.vertices.size());
        vertices.insert(vertices.end(), loop.vertices.begin(), loop.vertices.end());
        faces.insert(faces.end(), loop.faces.begin(), loop.faces.end());
        for (std::size_t i = 0; i < loop.vertices.size(); ++i) {
          // The face at the edge from one vertex to the next walks it the other way.
          const Index from = loop.vertices[i], to = loop.vertices[(i + 1) % loop.vertices.size()];
          Index found = VolumeVertex::none;
          for (Index h = 3 * loop.faces[i]; h < 3 * loop.faces[i] + 3; ++h)
            if (placed.lattice_mesh.origin(h) == to && placed.lattice_mesh.target(h) == from) found = h;
          closed.push_back(found);
        }
      }
      std::sort(closed.begin(), closed.end());
      EXPECT_EQ(closed, sheet.closes) << "each boundary edge once";
      EXPECT_EQ(patch.rim_vertices, vertices);
      EXPECT_EQ(patch.rim_faces, faces);
      ASSERT_EQ(patch.mesh.rim_size(), vertices.size());
      for (std::size_t i = 0; i < vertices.size(); ++i) {
        EXPECT_EQ(patch.mesh.position(static_cast<Index>(i)), placed.mesh.vertices[vertices[i]]);
        EXPECT_EQ(patch.rim.positions[i], placed.mesh.vertices[vertices[i]]);
      }
      std::size_t steiner = 0;
      for (const SheetVertex& v : sheet.vertices) steiner += v.rim_edge != SheetVertex::none;
      EXPECT_GE(steiner, patch.rim_vertices.size()) << "at least one on each edge";
      // Those with a single triangle are gone, with it.
      const std::size_t gone = sheet.triangles.size() - patch.mesh.triangle_count();
      EXPECT_EQ(steiner_points(patch.mesh).size() + gone, steiner);
      EXPECT_EQ(ears(patch.mesh), 0u);
      gone_in_all += gone;
    }
  }
  EXPECT_GT(gone_in_all, 0u);
  EXPECT_LT(gone_in_all, 50u) << "few are";
}

/// A sheet with something more between every two Steiner points of one rim edge that are next to each other.
class RimPatchWithMore : public ::testing::Test {
 protected:
  RimPatchWithMore() {
    for (const Sheet& one : sheets_of(placed_))
      if (!one.closes.empty()) sheet_ = one;
    plain_ = rim_patch().mesh.triangle_count();
  }

  RimPatch rim_patch() const { return make_rim_patch(placed_.mesh, placed_.topology, sheet_); }

  /// Calls `add` with the two points and a new one in the middle between them.
  template <class Add>
  void add_everywhere(Add add) {
    std::size_t places = 0;
    for (const auto& [edge, times] : test::boundary_of(sheet_.triangles)) {
      const Index from = times > 0 ? edge.first : edge.second, to = times > 0 ? edge.second : edge.first;
      SheetVertex tip = sheet_.vertices[from];
      if (tip.rim_edge == SheetVertex::none || sheet_.vertices[to].rim_edge != tip.rim_edge) continue;
      tip.position = 0.5 * (tip.position + sheet_.vertices[to].position);
      const Index middle = static_cast<Index>(sheet_.vertices.size());
      sheet_.vertices.push_back(tip);
      add(from, middle, to);
      ++places;
    }
    ASSERT_GT(places, 3u);
  }

  const PlacedMesh placed_{test::sphere_with_hole(2, 0.6), 1};
  Sheet sheet_;
  std::size_t plain_;  // triangles of the patch without more
};

// A triangle has no area there, and no inner corner that could be moved.
TEST_F(RimPatchWithMore, EarsOnARimEdgeAreTakenOff) {
  add_everywhere([&](Index from, Index middle, Index to) { sheet_.triangles.push_back({from, middle, to}); });
  const RimPatch patch = rim_patch();
  EXPECT_EQ(ears(patch.mesh), 0u);
  EXPECT_EQ(patch.mesh.triangle_count(), plain_);
}

// Three triangles and a corner beside the edge: what they are cut off by would lie on the mesh's own edge.
TEST_F(RimPatchWithMore, PocketsOnARimEdgeAreTakenOff) {
  add_everywhere([&](Index from, Index middle, Index to) {
    const Vector3 along = sheet_.vertices[to].position - sheet_.vertices[from].position;
    SheetVertex aside;
    aside.position = sheet_.vertices[middle].position + 0.1 * along.norm() * along.unitOrthogonal();
    const Index corner = static_cast<Index>(sheet_.vertices.size());
    sheet_.vertices.push_back(aside);
    sheet_.triangles.push_back({from, middle, corner});
    sheet_.triangles.push_back({middle, to, corner});
    sheet_.triangles.push_back({to, from, corner});
  });
  RimPatch patch = rim_patch();
  EXPECT_EQ(patch.mesh.triangle_count(), plain_);
  ASSERT_EQ(remove_steiner_points(patch, placed_.neighbourhood, {}), 0u);
  const Patch result = as_patch(patch.mesh, patch.rim_vertices, placed_.mesh);
  const PatchCheck check = check_patch(placed_.neighbourhood, result, test::pointers(patch.loops));
  EXPECT_TRUE(check.passed()) << describe(check.defect);
}

/// What is left of the holes when all sheets are rim patches without Steiner points: nothing.
void expect_completed(const PlacedMesh& placed) {
  TriangleMesh whole = placed.mesh;
  std::vector<Index> closed;
  for (const Sheet& sheet : sheets_of(placed)) {
    if (sheet.closes.empty()) continue;
    RimPatch patch = make_rim_patch(placed.mesh, placed.topology, sheet);
    ASSERT_EQ(remove_steiner_points(patch, placed.neighbourhood, {}), 0u);
    ASSERT_EQ(patch.steiner_points, 0u);
    ASSERT_TRUE(steiner_points(patch.mesh).empty());
    const Patch result = as_patch(patch.mesh, patch.rim_vertices, placed.mesh);
    const PatchCheck check = check_patch(placed.neighbourhood, result, test::pointers(patch.loops));
    ASSERT_TRUE(check.passed()) << describe(check.defect);
    closed.insert(closed.end(), sheet.closes.begin(), sheet.closes.end());
    const Index offset = static_cast<Index>(whole.vertices.size() - placed.mesh.vertices.size());
    whole.vertices.insert(whole.vertices.end(), result.vertices.begin(), result.vertices.end());
    for (Triangle t : result.triangles) {
      for (Index& v : t)
        if (v >= result.input_vertices) v += offset;
      whole.triangles.push_back(t);
    }
  }
  std::sort(closed.begin(), closed.end());
  ASSERT_EQ(closed, placed.topology.boundary_half_edges);
  EXPECT_TRUE(test::boundary_of(whole.triangles).empty());
}

// No octree must leave a Steiner point: a mesh that shares no edges with its patch is not watertight.
TEST(RimPatch, NoSteinerPointIsLeftWhereverTheOctreeLies) {
  const std::set<std::string> small = {"sphere", "cylinder", "touching holes", "sheet"};
  for (const test::NamedMesh& named : test::holed_meshes())
    for (unsigned seed = 1; seed <= (small.count(named.name) ? 20u : 3u); ++seed)
      ASSERT_NO_FATAL_FAILURE(expect_completed(PlacedMesh(named.mesh, seed)))
          << named.name << ", seed " << seed;
}

// Something in the way of the patch stays outside of its steps.
TEST(RimPatch, ObstaclesAreNotMet) {
  const PlacedMesh placed(test::sphere_with_hole(2, 0.6), 2);
  for (const Sheet& sheet : sheets_of(placed)) {
    RimPatch patch = make_rim_patch(placed.mesh, placed.topology, sheet);
    const std::vector<Index> before = steiner_points(patch.mesh);
    ASSERT_FALSE(before.empty());
    const auto met = [](const RimPatch& one, const std::vector<std::array<Vector3, 3>>& needles) {
      std::vector<std::array<Vector3, 3>> triangles;
      for (const Triangle& t : one.mesh.triangles())
        if (t[0] != PatchMesh::none)
          triangles.push_back({one.mesh.position(t[0]), one.mesh.position(t[1]), one.mesh.position(t[2])});
      return improper_pairs_between(triangles, needles).size();
    };
    // Needles that the patch does not meet yet, and meets where its points go when nobody minds.
    RimPatch heedless = patch;
    remove_steiner_points(heedless, placed.neighbourhood, {});
    std::vector<std::array<Vector3, 3>> obstacles;
    for (const Triangle& t : heedless.mesh.triangles()) {
      if (t[0] == PatchMesh::none) continue;
      const Vector3 p =
          (heedless.mesh.position(t[0]) + heedless.mesh.position(t[1]) + heedless.mesh.position(t[2])) / 3;
      const Vector3 across =
          1e-4 *
          heedless.mesh.area_normal(static_cast<Index>(&t - &heedless.mesh.triangles()[0])).normalized();
      const std::array<Vector3, 3> needle = {p - across, p + across, p + across + Vector3(1e-6, 2e-6, 3e-6)};
      if (met(patch, {needle}) == 0) obstacles.push_back(needle);
    }
    ASSERT_FALSE(obstacles.empty());
    EXPECT_GT(met(heedless, obstacles), 0u);
    remove_steiner_points(patch, placed.neighbourhood, obstacles);
    EXPECT_EQ(met(patch, obstacles), 0u);
    EXPECT_EQ(patch.steiner_points, steiner_points(patch.mesh).size());
  }
}

// Positions are those that will be stored, numbers those of the checker; gaps are left out.
TEST(RimPatch, BecomesAPatch) {
  const PlacedMesh placed(test::sphere_with_hole(2, 0.6), 3);
  const std::vector<Sheet> sheets = sheets_of(placed);
  ASSERT_EQ(sheets.size(), 1u);
  RimPatch patch = make_rim_patch(placed.mesh, placed.topology, sheets[0]);
  ASSERT_EQ(remove_steiner_points(patch, placed.neighbourhood, {}), 0u);
  const Patch result = as_patch(patch.mesh, patch.rim_vertices, placed.mesh);
  EXPECT_EQ(result.input_vertices, placed.mesh.vertices.size());
  std::size_t alive = 0, vertices = 0;
  for (Index t = 0; t < patch.mesh.triangle_count(); ++t) alive += patch.mesh.alive(t);
  for (Index v = static_cast<Index>(patch.mesh.rim_size()); v < patch.mesh.vertex_count(); ++v)
    vertices += patch.mesh.vertex_alive(v);
  EXPECT_LT(alive, patch.mesh.triangle_count()) << "some are gone";
  EXPECT_EQ(result.triangles.size(), alive);
  EXPECT_EQ(result.vertices.size(), vertices);
  for (const Vector3& p : result.vertices) EXPECT_EQ(p, as_stored(p));
  const std::set<Index> rim(patch.rim_vertices.begin(), patch.rim_vertices.end());
  for (const Triangle& t : result.triangles)
    for (Index v : t)
      EXPECT_TRUE(v < result.input_vertices ? rim.count(v) != 0 : v - result.input_vertices < vertices);
}

}  // namespace
}  // namespace meshcomplete
