#include "common/core/mesh_topology.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>
#include <vector>

#include "common/core/error.h"
#include "tests/support/meshes.h"

namespace meshcomplete {
namespace {

bool repeats_a_corner(const Triangle& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; }

/// Everything that the header promises, by looking at every edge on its own.
void expect_right(const TriangleMesh& mesh) {
  const MeshTopology topology = build_topology(mesh);
  std::map<std::pair<Index, Index>, std::vector<Index>> at_edge;
  std::vector<Index> degenerate, boundary, non_manifold;
  for (Index f = 0; f < mesh.triangles.size(); ++f) {
    const Triangle& t = mesh.triangles[f];
    if (repeats_a_corner(t)) {
      degenerate.push_back(f);
      continue;
    }
    for (Index k = 0; k < 3; ++k) at_edge[std::minmax(t[k], t[(k + 1) % 3])].push_back(3 * f + k);
  }
  ASSERT_EQ(topology.opposite.size(), 3 * mesh.triangles.size());
  for (const auto& [edge, half_edges] : at_edge)
    for (std::size_t i = 0; i < half_edges.size(); ++i) {
      const Index opposite = topology.opposite[half_edges[i]];
      if (half_edges.size() == 1) {
        EXPECT_EQ(opposite, MeshTopology::boundary);
        boundary.push_back(half_edges[i]);
      } else if (half_edges.size() == 2) {
        EXPECT_EQ(opposite, half_edges[1 - i]);
      } else {
        EXPECT_EQ(opposite, MeshTopology::non_manifold);
        non_manifold.push_back(half_edges[i]);
      }
    }
  for (Index f : degenerate)
    for (Index h = 3 * f; h < 3 * f + 3; ++h) EXPECT_GE(topology.opposite[h], topology.opposite.size());
  std::sort(boundary.begin(), boundary.end());
  std::sort(non_manifold.begin(), non_manifold.end());
  EXPECT_EQ(topology.degenerate_faces, degenerate);
  EXPECT_EQ(topology.boundary_half_edges, boundary);
  EXPECT_EQ(topology.non_manifold_half_edges, non_manifold);
}

TEST(MeshTopology, AgreesWithBruteForce) {
  for (const TriangleMesh& mesh :
       {test::cube(), test::torus(8, 5), test::sphere_with_holes(6), test::flat_grid(5, 3),
        test::moebius_strip(), test::isolated_triangle(), test::pinched_tetrahedra(), test::book(3),
        test::book(5), test::sphere_with_hole_and_fin(), test::unwelded(test::cube()),
        test::rough_sphere_with_ragged_holes(3, 4, 5), test::shuffled(test::sphere_with_hole(), 3)})
    expect_right(mesh);
}

// Enough vertices for several threads.
TEST(MeshTopology, AgreesWithBruteForceOnAMeshForThreads) {
  expect_right(test::shuffled(test::sphere_with_hole(5, 0.2), 7));
}

TEST(MeshTopology, FacesTurnedOverStayNeighbours) {
  TriangleMesh mesh = test::cube();
  std::swap(mesh.triangles[4][0], mesh.triangles[4][1]);
  expect_right(mesh);
  const MeshTopology topology = build_topology(mesh);
  EXPECT_TRUE(topology.boundary_half_edges.empty());
  for (Index h = 12; h < 15; ++h) {
    const auto from = [&](Index half_edge) { return mesh.triangles[half_edge / 3][half_edge % 3]; };
    EXPECT_EQ(from(h), from(topology.opposite[h])) << "both walk the edge the same way";
  }
}

TEST(MeshTopology, FacesWithARepeatedCornerAreLeftOut) {
  TriangleMesh mesh = test::cube();
  mesh.triangles.insert(mesh.triangles.begin() + 3, {2, 2, 5});
  mesh.triangles.push_back({1, 3, 1});
  mesh.triangles.push_back({4, 4, 4});
  expect_right(mesh);
  EXPECT_TRUE(build_topology(mesh).boundary_half_edges.empty()) << "the cube is still closed";
}

TEST(MeshTopology, EmptyMesh) {
  expect_right(TriangleMesh());
  expect_right(TriangleMesh{{Vector3(0, 0, 0)}, {}});
}

TEST(MeshTopology, CornerOutOfRange) {
  TriangleMesh mesh = test::cube();
  mesh.triangles[5][2] = 8;
  try {
    build_topology(mesh);
    FAIL() << "accepted a corner that does not exist";
  } catch (const CompletionError& error) {
    EXPECT_EQ(error.stage(), "reading the mesh");
    EXPECT_NE(std::string(error.what()).find("vertex 8"), std::string::npos) << error.what();
  }
}

TEST(MeshTopology, CanBeCancelled) {
  EXPECT_THROW(build_topology(test::cube(), Progress([](double, const std::string&) { return false; })),
               Cancelled);
}

// --- separate pieces
// --------------------------------------------------------------------------------------------------

std::vector<Index> faces_from_to(Index first, Index last) {
  std::vector<Index> list;
  for (Index f = first; f < last; ++f) list.push_back(f);
  return list;
}

/// A sphere with a hole, and eight faces of a sheet far from it.
class SeparatePiece : public ::testing::Test {
 protected:
  static constexpr std::size_t no_limit = 1000000;
  SeparatePiece()
      : sphere_(test::sphere_with_hole(2)),
        mesh_(test::join(sphere_, test::translated(test::flat_grid(2, 2), Vector3(0, 0, 3)))),
        topology_(build_topology(mesh_)),
        size_(static_cast<Index>(sphere_.triangles.size())) {
    for (Index h : topology_.boundary_half_edges)
      if (h / 3 < size_) rim_.push_back(h / 3);
  }
  std::size_t found(const std::vector<Index>& starts, std::size_t limit = no_limit) const {
    return separate_piece(topology_, starts, rim_, limit);
  }

  const TriangleMesh sphere_;
  const TriangleMesh mesh_;
  const MeshTopology topology_;
  const Index size_;        // faces of the sphere
  std::vector<Index> rim_;  // faces at its hole
};

// A flood may end at faces that an earlier one came to: they are no border.
TEST_F(SeparatePiece, NoneAmongWhatIsJoined) {
  std::vector<Index> starts = faces_from_to(0, size_);
  std::mt19937 random(1);
  for (int i = 0; i < 20; ++i) {
    EXPECT_EQ(found(starts), 0u);
    EXPECT_EQ(found(starts, 5), 0u) << "too large, and no part of it a piece either";
    std::shuffle(starts.begin(), starts.end(), random);
  }
  EXPECT_EQ(found({}), 0u);
}

TEST_F(SeparatePiece, ThePieceIsCounted) {
  for (Index f = size_; f < size_ + 8; ++f) {
    EXPECT_EQ(found({f}), 8u);
    EXPECT_EQ(found({0, f}), 8u) << "after a face that is joined";
    EXPECT_EQ(found({rim_[0], f, 0}), 8u);
  }
  EXPECT_EQ(separate_piece(topology_, {size_}, {}, no_limit), 8u);
  EXPECT_EQ(separate_piece(topology_, {0}, {size_}, no_limit), size_) << "the sphere is none of the sheet's";
}

TEST_F(SeparatePiece, UpToTheLimit) {
  for (Index f = size_; f < size_ + 8; ++f) {
    EXPECT_EQ(found({f}, 8), 8u);
    EXPECT_EQ(found({f}, 7), 0u);
  }
}

TEST(SeparatePieceElsewhere, WhatEndsAtANonManifoldEdgeIsNone) {
  const TriangleMesh mesh = test::sphere_with_hole_and_fin();
  const MeshTopology topology = build_topology(mesh);
  ASSERT_EQ(topology.non_manifold_half_edges.size(), 3u);
  const Index fin = static_cast<Index>(mesh.triangles.size() - 1);
  EXPECT_EQ(separate_piece(topology, {fin}, {0}, mesh.triangles.size()), 0u);
  EXPECT_EQ(separate_piece(topology, {fin, 1, fin - 1}, {}, mesh.triangles.size()), 0u);
}

TEST(SeparatePieceElsewhere, ADegenerateFaceIsNone) {
  TriangleMesh mesh = test::join(test::cube(), test::isolated_triangle());
  mesh.triangles.push_back({2, 2, 5});
  const MeshTopology topology = build_topology(mesh);
  EXPECT_EQ(separate_piece(topology, {13}, {0}, 100), 0u);
  EXPECT_EQ(separate_piece(topology, {13, 12}, {0}, 100), 1u) << "the triangle";
}

}  // namespace
}  // namespace meshcomplete
