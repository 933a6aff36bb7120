// Every way in which a patch can be wrong, one at a time.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <set>
#include <utility>
#include <vector>

#include "common/core/patch_check.h"
#include "common/core/triangle_intersection.h"
#include "tests/support/meshes.h"
#include "tests/support/patches.h"

namespace meshcomplete {
namespace {

using test::check;
using test::corners_of;
using test::fan_patch;
using test::loops_of;
using test::pointers;

std::vector<Index> sorted(const std::set<Index>& set) { return {set.begin(), set.end()}; }

class PatchDefects : public ::testing::Test {
 protected:
  PatchDefects()
      : mesh_(test::sphere_with_hole(2, 0.8)), loops_(loops_of(mesh_)), patch_(fan_patch(mesh_, loops_[0])) {}

  Index apex() const { return patch_.input_vertices; }
  PatchCheck check() const { return test::check(mesh_, patch_, loops_); }

  TriangleMesh mesh_;
  std::vector<BoundaryLoop> loops_;
  Patch patch_;
};

TEST_F(PatchDefects, NoneAtFirst) { EXPECT_TRUE(check().passed()); }

TEST_F(PatchDefects, IndexOutOfRange) {
  patch_.triangles[3][1] = apex() + 1;
  EXPECT_EQ(check().defect, PatchDefect::bad_index);
  EXPECT_EQ(check().patch_triangles, std::vector<Index>{3});
}

TEST_F(PatchDefects, RepeatedCorner) {
  patch_.triangles.push_back({0, 0, apex()});
  EXPECT_EQ(check().defect, PatchDefect::bad_index);
}

TEST_F(PatchDefects, PatchOfAnotherMesh) {
  const TriangleMesh other = test::join(mesh_, test::cube(1, Vector3(5, 5, 5)));
  EXPECT_EQ(meshcomplete::check(other, patch_, loops_).defect, PatchDefect::bad_index);
}

TEST_F(PatchDefects, UnusedVertex) {
  patch_.vertices.push_back(Vector3(0, 0, 0.25));
  EXPECT_EQ(check().defect, PatchDefect::unused_vertex);
}

TEST_F(PatchDefects, CoordinateThatIsNoFloat) {
  patch_.vertices[0].x() = 0.1;
  EXPECT_EQ(check().defect, PatchDefect::not_finite);
  EXPECT_EQ(check().patch_triangles.size(), patch_.triangles.size());
}

TEST_F(PatchDefects, CoordinateThatIsNoNumber) {
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    patch_.vertices[0].y() = bad;
    EXPECT_EQ(check().defect, PatchDefect::not_finite);
  }
}

TEST_F(PatchDefects, NothingAtTheRim) {
  patch_.triangles.clear();
  patch_.vertices.clear();
  EXPECT_EQ(check().defect, PatchDefect::rim_not_closed);
}

TEST_F(PatchDefects, OneRimEdgeOpen) {
  patch_.triangles.pop_back();
  EXPECT_EQ(check().defect, PatchDefect::rim_not_closed);
}

TEST_F(PatchDefects, TurnedOver) {
  for (Triangle& t : patch_.triangles) std::swap(t[0], t[1]);
  EXPECT_EQ(check().defect, PatchDefect::rim_not_closed);
  EXPECT_EQ(check().patch_triangles.size(), patch_.triangles.size());
}

TEST_F(PatchDefects, RimEdgeClosedTwice) {
  patch_.triangles.push_back(patch_.triangles[2]);
  EXPECT_EQ(check().defect, PatchDefect::rim_not_closed);
  EXPECT_EQ(check().patch_triangles,
            (std::vector<Index>{2, static_cast<Index>(patch_.triangles.size() - 1)}));
}

TEST_F(PatchDefects, RimThatWasNotTargeted) {
  EXPECT_EQ(meshcomplete::check(mesh_, patch_, {}).defect, PatchDefect::edge_not_manifold);
}

TEST_F(PatchDefects, EdgeWithOneFace) {
  // A second apex beside the first one takes over one rim edge.
  patch_.vertices.push_back(as_stored(patch_.vertices[0] + Vector3(0, 0, 0.1)));
  patch_.triangles[0][2] = apex() + 1;
  const PatchCheck result = check();
  EXPECT_EQ(result.defect, PatchDefect::edge_not_manifold);
  EXPECT_EQ(std::count(result.patch_triangles.begin(), result.patch_triangles.end(), 0u), 1);
}

TEST_F(PatchDefects, EdgeWithThreeFaces) {
  const Index a = loops_[0].vertices[0];
  patch_.vertices.push_back(as_stored(patch_.vertices[0] + Vector3(0, 0, 0.1)));
  patch_.triangles.push_back({a, apex(), apex() + 1});
  EXPECT_EQ(check().defect, PatchDefect::edge_not_manifold);
}

TEST_F(PatchDefects, ClosedFansMeetAtANewVertex) {
  // A tetrahedron that hangs at the apex: two closed fans there.
  const Index n = apex();
  for (const Vector3& d : {Vector3(0, 0, 0.1), Vector3(0.1, 0, 0.1), Vector3(0, 0.1, 0.1)})
    patch_.vertices.push_back(as_stored(patch_.vertices[0] + d));
  for (const Triangle& t :
       {Triangle{n, n + 2, n + 1}, {n, n + 1, n + 3}, {n, n + 3, n + 2}, {n + 1, n + 2, n + 3}})
    patch_.triangles.push_back(t);
  EXPECT_EQ(check().defect, PatchDefect::vertex_not_manifold);
}

TEST_F(PatchDefects, ClosedFanAtAnInputVertex) {
  // The same at a vertex of the rim, and at one far from it.
  const Patch good = patch_;
  for (const Index v : {loops_[0].vertices[0], Index{0}}) {
    patch_ = good;
    const Index n = apex() + 1;
    for (const Vector3& d : {Vector3(0, 0, 0.1), Vector3(0.1, 0, 0.1), Vector3(0, 0.1, 0.1)})
      patch_.vertices.push_back(as_stored(1.5 * mesh_.vertices[v] + d));
    for (const Triangle& t : {Triangle{v, n + 1, n}, {v, n, n + 2}, {v, n + 2, n + 1}, {n, n + 1, n + 2}})
      patch_.triangles.push_back(t);
    EXPECT_EQ(check().defect, PatchDefect::vertex_not_manifold);
  }
}

TEST_F(PatchDefects, DetachedBubble) {
  const Index n = apex() + 1;
  const TriangleMesh bubble = test::scaled(test::tetrahedron(), 0.25);
  patch_.vertices.insert(patch_.vertices.end(), bubble.vertices.begin(), bubble.vertices.end());
  for (const auto& [a, b, c] : bubble.triangles) patch_.triangles.push_back({a + n, b + n, c + n});
  EXPECT_EQ(check().defect, PatchDefect::detached_piece);
  EXPECT_EQ(check().patch_triangles.size(), 4u);
}

TEST_F(PatchDefects, CoincidentNewVertices) {
  // The apex is split in two at the same place, with two faces between.
  const auto& loop = loops_[0].vertices;
  const Index half = static_cast<Index>(loop.size() / 2);
  patch_.vertices.push_back(patch_.vertices[0]);
  for (Index i = half; i < loop.size(); ++i) patch_.triangles[i][2] = apex() + 1;
  patch_.triangles.push_back({apex(), apex() + 1, loop[0]});
  patch_.triangles.push_back({apex() + 1, apex(), loop[half]});
  // The two faces between have no area, which is noticed first.
  EXPECT_EQ(check().defect, PatchDefect::degenerate_face);
  EXPECT_EQ(check().patch_triangles.size(), 2u);

  // Two holes, and both patches have their apex at the same place.
  const TriangleMesh two = test::sphere_with_holes(2);
  const std::vector<BoundaryLoop> loops = loops_of(two);
  Patch both = fan_patch(two, loops[0], Vector3::Zero());
  append(both, fan_patch(two, loops[1], Vector3::Zero()));
  EXPECT_EQ(meshcomplete::check(two, both, loops).defect, PatchDefect::coincident_vertices);
}

TEST_F(PatchDefects, NewVertexWhereAnInputVertexIs) {
  patch_.vertices[0] = mesh_.vertices[0];
  ASSERT_FALSE(std::count(loops_[0].vertices.begin(), loops_[0].vertices.end(), 0u));
  const PatchCheck result = check();
  EXPECT_EQ(result.defect, PatchDefect::coincident_vertices);
  std::vector<Index> at_vertex;
  for (Index f = 0; f < mesh_.triangles.size(); ++f)
    if (std::count(mesh_.triangles[f].begin(), mesh_.triangles[f].end(), 0u)) at_vertex.push_back(f);
  EXPECT_EQ(result.input_triangles, at_vertex);
  // The same place without faces of the input is free.
  TriangleMesh unused = mesh_;
  unused.vertices.push_back(Vector3(0, 0, 0.75));
  Patch patch = fan_patch(unused, loops_[0], Vector3(0, 0, 0.75));
  EXPECT_TRUE(meshcomplete::check(unused, patch, loops_).passed());
}

TEST_F(PatchDefects, ApexPulledThroughTheSphere) {
  patch_.vertices[0] = Vector3(0.125, 0.25, -3);
  const PatchCheck result = check();
  EXPECT_EQ(result.defect, PatchDefect::meets_input);
  std::set<Index> new_ones, old_ones;
  const TriangleMesh whole = test::with_patch(mesh_, patch_);
  const Index faces = static_cast<Index>(mesh_.triangles.size());
  for (const auto& [i, j] : improper_pairs(corners_of(whole))) {
    ASSERT_LT(i, faces);
    ASSERT_GE(j, faces);
    old_ones.insert(i);
    new_ones.insert(j - faces);
  }
  EXPECT_FALSE(new_ones.empty());
  EXPECT_EQ(result.patch_triangles, sorted(new_ones));
  EXPECT_EQ(result.input_triangles, sorted(old_ones));
}

// A caller can mend both at once: what meets the patch is listed, and what meets the input.
TEST(PatchCheck, ListsContactsWithItselfAndWithTheInput) {
  const TriangleMesh sphere = test::icosphere(3);
  const test::CutOut cut = test::cut_out(sphere, [&](Index f) {
    const Triangle& t = sphere.triangles[f];
    return std::any_of(t.begin(), t.end(), [&](Index v) { return sphere.vertices[v].z() > 0.1; });
  });
  const std::vector<BoundaryLoop> loops = loops_of(cut.mesh);
  ASSERT_TRUE(check(cut.mesh, cut.patch, loops).passed());
  Patch patch = cut.patch;
  const auto by_x = [](const Vector3& a, const Vector3& b) { return a.x() < b.x(); };
  const auto by_y = [](const Vector3& a, const Vector3& b) { return a.y() < b.y(); };
  const auto left = std::min_element(patch.vertices.begin(), patch.vertices.end(), by_x);
  const auto back = std::max_element(patch.vertices.begin(), patch.vertices.end(), by_y);
  ASSERT_NE(left, back);
  *left = Vector3(3, 0.0625, 0.5);  // through the patch on the other side
  *back = Vector3(0, 0.25, -1.5);   // through the bottom of the sphere
  std::set<Index> with_itself, with_input, met;
  const Index faces = static_cast<Index>(cut.mesh.triangles.size());
  for (const auto& [a, b] : improper_pairs(corners_of(test::with_patch(cut.mesh, patch)))) {
    if (a >= faces) {
      with_itself.insert({a - faces, b - faces});
    } else {
      with_input.insert(b - faces);
      met.insert(a);
    }
  }
  ASSERT_FALSE(with_itself.empty());
  ASSERT_FALSE(std::includes(with_itself.begin(), with_itself.end(), with_input.begin(), with_input.end()));
  const PatchCheck result = check(cut.mesh, patch, loops);
  EXPECT_EQ(result.defect, PatchDefect::meets_itself) << "what is found first";
  std::set<Index> all = with_itself;
  all.insert(with_input.begin(), with_input.end());
  EXPECT_EQ(result.patch_triangles, sorted(all));
  EXPECT_EQ(result.input_triangles, sorted(met));
}
}  // namespace
}  // namespace meshcomplete
