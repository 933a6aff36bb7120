#include "filter_atomicvolumes/divisible_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "common/core/error.h"
#include "common/core/triangle_intersection.h"
#include "tests/support/volumes.h"

namespace meshcomplete {
namespace {

std::unique_ptr<DivisibleMesh> divisible(const TriangleMesh& mesh) {
  return make_divisible(mesh, build_topology(mesh), InputNeighbourhood(mesh));
}

/// What is at the rims of a mesh, by looking at everything.
struct Rims {
  std::set<Index> vertices;
  std::vector<int> edges;  ///< per face: on a rim

  explicit Rims(const TriangleMesh& mesh) : edges(mesh.triangles.size(), 0) {
    for (Index h : build_topology(mesh).boundary_half_edges) {
      const Triangle& t = mesh.triangles[h / 3];
      vertices.insert({t[h % 3], t[(h % 3 + 1) % 3]});
      ++edges[h / 3];
    }
  }

  /// A rim vertex of either at the same position.
  bool touch(const TriangleMesh& mesh, Index a, Index b) const {
    for (Index v : mesh.triangles[a])
      for (Index w : mesh.triangles[b])
        if (vertices.count(v) && vertices.count(w) && mesh.vertices[v] == mesh.vertices[w]) return true;
    return false;
  }
};

/// Pairs of faces that meet improperly.
std::vector<std::pair<Index, Index>> meeting(const TriangleMesh& mesh) {
  return improper_pairs(test::corners_of(mesh));
}

bool share_edge(const TriangleMesh& mesh, Index a, Index b) {
  int common = 0;
  for (Index v : mesh.triangles[a])
    for (Index w : mesh.triangles[b]) common += v == w;
  return common == 2;
}

/// All that is promised of a mesh without faces of zero area and without rim vertices at the same position.
/// Returns how many of the faces that are left out have no vertex on a rim.
std::size_t expect_folds_left_out(const TriangleMesh& mesh, const DivisibleMesh& made) {
  const Rims rims(mesh);
  EXPECT_EQ(made.mesh.vertices, mesh.vertices);
  EXPECT_EQ(made.mesh.triangles.size(), mesh.triangles.size()) << "numbers of faces stay";
  EXPECT_FALSE(made.merged);
  const std::set<Index> gone(made.left_out.begin(), made.left_out.end());
  EXPECT_TRUE(std::is_sorted(made.left_out.begin(), made.left_out.end()));
  EXPECT_EQ(gone.size(), made.left_out.size());
  std::size_t inner = 0;
  for (Index t = 0; t < mesh.triangles.size(); ++t) {
    const Triangle &now = made.mesh.triangles[t], &before = mesh.triangles[t];
    if (gone.count(t) == 0) {
      EXPECT_EQ(now, before);
      continue;
    }
    EXPECT_TRUE(now[0] == now[1] && now[1] == now[2]) << "has three equal corners";
    EXPECT_EQ(rims.edges[t], 0) << "the patch has to meet its edge";
    inner += std::none_of(before.begin(), before.end(), [&](Index v) { return rims.vertices.count(v) != 0; });
  }
  std::set<Index> meets;
  for (const auto& [a, b] : meeting(mesh)) {
    meets.insert({a, b});
    if (gone.count(a) || gone.count(b) || (rims.edges[a] && rims.edges[b])) continue;
    EXPECT_FALSE(rims.touch(mesh, a, b)) << a << " and " << b << " meet at a rim";
    for (Index left_out : gone)
      EXPECT_FALSE(share_edge(mesh, left_out, a) || share_edge(mesh, left_out, b))
          << a << " and " << b << " meet beside the gap";
  }
  for (Index t : gone) EXPECT_TRUE(meets.count(t)) << t << " is in nobody's way";
  return inner;
}

TEST(DivisibleMesh, ThereIsNoneWhereTheMeshItselfWillDo) {
  for (const test::NamedMesh& named : test::holed_meshes())
    EXPECT_EQ(divisible(named.mesh), nullptr) << named.name;
  EXPECT_EQ(divisible(test::icosphere(1)), nullptr) << "no rims";
  // What meets far from the rims is no reason, and neither are two parts that meet at one of them.
  const TriangleMesh sphere = test::sphere_with_hole(2, 0.6);
  EXPECT_EQ(divisible(test::join(sphere, test::translated(test::icosphere(2, 0.5), Vector3(0, 0, -1)))),
            nullptr);
  const Vector3 rim = sphere.vertices[*Rims(sphere).vertices.begin()];
  EXPECT_EQ(divisible(test::join(sphere, test::translated(test::icosphere(1, 0.1), rim))), nullptr);
}

TEST(DivisibleMesh, OfFacesThatMeetAtARimOneIsLeftOut) {
  std::size_t made = 0, inner = 0, number = 0;
  for (const TriangleMesh& mesh : test::folded_meshes(8)) {
    SCOPED_TRACE(number++);
    const auto result = divisible(mesh);
    const Rims rims(mesh);
    const auto pairs = meeting(mesh);
    const bool folded_at_rim = std::any_of(pairs.begin(), pairs.end(), [&](const auto& pair) {
      return rims.touch(mesh, pair.first, pair.second) &&
             !(rims.edges[pair.first] && rims.edges[pair.second]);
    });
    ASSERT_EQ(result != nullptr, folded_at_rim);
    if (!result) continue;
    EXPECT_FALSE(result->left_out.empty());
    inner += expect_folds_left_out(mesh, *result);
    ++made;
  }
  EXPECT_GT(made, 20u);
  EXPECT_LT(made, number);
  EXPECT_GT(inner, 5u) << "the gap grows beyond the faces at the rim";
}

// Both faces have an edge on the rim, which stays: there is nothing to leave out.
TEST(DivisibleMesh, FacesWithRimEdgesStay) {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {1, 1, 1}, {0.25, 0.25, -1}};
  mesh.triangles = {{0, 1, 2}, {0, 3, 4}};
  ASSERT_EQ(meeting(mesh).size(), 1u);
  EXPECT_EQ(divisible(mesh), nullptr);
}

/// A square with a face of zero area between the corners 0 and 1 and the vertex 4, and the rest of its
/// triangles.
TriangleMesh square_with_flat_face(const Vector3& fifth, const std::vector<Triangle>& others) {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}, fifth};
  mesh.triangles = {{0, 1, 4}};
  mesh.triangles.insert(mesh.triangles.end(), others.begin(), others.end());
  return mesh;
}

TEST(DivisibleMesh, FacesWithoutAreaAtARimAreLeftOut) {
  // The side from 0 to 1 is on the rim, the others are in the mesh.
  const TriangleMesh flat = square_with_flat_face({1, 0, 0}, {{0, 4, 3}, {4, 2, 3}, {4, 1, 2}});
  const auto result = divisible(flat);
  ASSERT_NE(result, nullptr);
  EXPECT_EQ(result->left_out, std::vector<Index>{0});
  EXPECT_EQ(result->mesh.triangles[0], (Triangle{0, 0, 0}));
  EXPECT_FALSE(result->merged);
  for (Index t = 1; t < 4; ++t) EXPECT_EQ(result->mesh.triangles[t], flat.triangles[t]);
  // With the vertex in the plane's inside it has an area.
  EXPECT_EQ(divisible(square_with_flat_face({1, 0.5, 0}, {{0, 4, 3}, {4, 2, 3}, {4, 1, 2}})), nullptr);
  // Here the longest side is in the mesh and the two others are the rim: without the face that would end
  // where it does not now.
  TriangleMesh ear = square_with_flat_face({1, 0, 0}, {{0, 1, 2}, {0, 2, 3}});
  ear.triangles[0] = {1, 0, 4};
  EXPECT_EQ(divisible(ear), nullptr);
}

bool has(const Triangle& t, Index vertex) { return std::count(t.begin(), t.end(), vertex) != 0; }

TEST(DivisibleMesh, RimVerticesAtTheSamePositionAreOne) {
  const test::SplitPole pole;
  const TriangleMesh& mesh = pole.mesh;
  const auto result = divisible(mesh);
  ASSERT_NE(result, nullptr);
  EXPECT_TRUE(result->merged);
  EXPECT_TRUE(result->left_out.empty());
  EXPECT_EQ(result->mesh.vertices, mesh.vertices);
  ASSERT_EQ(result->mesh.triangles.size(), mesh.triangles.size());
  std::size_t renamed = 0;
  for (Index t = 0; t < mesh.triangles.size(); ++t) {
    Triangle expected = mesh.triangles[t];
    std::replace(expected.begin(), expected.end(), pole.copy, pole.original);
    EXPECT_EQ(result->mesh.triangles[t], expected) << "the lowest number wins";
    renamed += expected != mesh.triangles[t];
  }
  EXPECT_EQ(renamed, 5u);
  // Vertices inside the mesh at the same position stay two.
  const TriangleMesh clean = test::sphere_with_touching_holes(2);
  const Vector3 rim = clean.vertices[*Rims(clean).vertices.begin()];
  EXPECT_EQ(divisible(test::join(clean, test::translated(test::tetrahedron(0.1), rim))), nullptr);
}

// Faces of the two fans that meet each other have no vertex in common, but one at the same position.
TEST(DivisibleMesh, FacesThatMeetAtCoincidentVerticesAreFound) {
  const test::SplitPole pole;
  const Rims rims(pole.mesh);
  std::size_t found = 0;
  for (const Triangle& near : pole.mesh.triangles)
    for (const Triangle& far : pole.mesh.triangles)
      for (Index v : near) {
        if (!has(near, pole.copy) || !has(far, pole.original) || rims.vertices.count(v)) continue;
        TriangleMesh mesh = pole.mesh;  // the vertex pulled over the pole and through the other fan
        mesh.vertices[v] =
            as_stored(1.02 / 3 * (mesh.vertices[far[0]] + mesh.vertices[far[1]] + mesh.vertices[far[2]]));
        const auto result = divisible(mesh);
        ASSERT_NE(result, nullptr);
        EXPECT_TRUE(result->merged);
        for (const auto& [a, b] : meeting(mesh)) {
          if (!rims.touch(mesh, a, b) || (rims.edges[a] && rims.edges[b])) continue;
          const std::vector<Index>& gone = result->left_out;
          EXPECT_TRUE(std::binary_search(gone.begin(), gone.end(), a) ||
                      std::binary_search(gone.begin(), gone.end(), b));
          const Triangle &one = mesh.triangles[a], &other = mesh.triangles[b];
          found += (has(one, pole.original) && has(other, pole.copy)) ||
                   (has(one, pole.copy) && has(other, pole.original));
        }
      }
  EXPECT_GT(found, 10u);
}

TEST(DivisibleMesh, CanBeCancelled) {
  const TriangleMesh mesh = test::SplitPole().mesh;
  EXPECT_THROW(make_divisible(mesh, build_topology(mesh), InputNeighbourhood(mesh),
                              Progress([](double, const std::string&) { return false; })),
               Cancelled);
}

}  // namespace
}  // namespace meshcomplete
