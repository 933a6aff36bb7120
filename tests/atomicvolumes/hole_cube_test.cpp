#include "filter_atomicvolumes/hole_cube.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <unordered_map>
#include <vector>

#include "common/core/triangle_intersection.h"
#include "tests/support/complexes.h"
#include "tests/support/volumes.h"

namespace meshcomplete {
namespace {

using test::PlacedMesh;
using Corners = std::array<Vector3, 3>;

/// One hole cube: its squares, its vertices numbered, its surface.
struct Cube {
  Index leaf = 0;
  std::vector<LeafSquare> squares;
  std::vector<SquareTriangulation> triangulations;
  std::vector<std::vector<Index>> numbers;
  std::vector<VolumeVertex> vertices;
  HoleCubeSurface surface;
  Vector3 apex = Vector3::Zero();

  const Vector3& at(Index v) const { return vertices[v].position; }
  Vector3 middle(std::size_t base) const {
    const auto& c = surface.bases[base].corners;
    return 0.25 * (at(c[0]) + at(c[1]) + at(c[2]) + apex);
  }
  /// Six times the volume of a base's tetrahedron.
  double volume(std::size_t base) const {
    const auto& c = surface.bases[base].corners;
    return (at(c[1]) - at(c[0])).cross(at(c[2]) - at(c[0])).dot(at(c[0]) - apex);
  }
};

/// All hole cubes of the mesh.
class HoleCubes {
 public:
  HoleCubes(const PlacedMesh& placed) : mesh_(placed.lattice_mesh), decomposition_(decompose(mesh_, {})) {
    std::map<Index, std::size_t> number;
    for (const LeafSquare& s : leaf_squares(decomposition_.octree))
      for (Index leaf : {s.below, s.above}) {
        if (leaf == Octree::none || !is_hole(leaf)) continue;
        const auto [at, fresh] = number.emplace(leaf, cubes_.size());
        if (fresh) cubes_.emplace_back();
        cubes_[at->second].leaf = leaf;
        cubes_[at->second].squares.push_back(s);
      }
    for (Cube& cube : cubes_) build(cube);
  }

  const std::vector<Cube>& all() const { return cubes_; }
  const Volume& volume(const Cube& cube) const { return decomposition_.volumes[cube.leaf]; }
  LatticeBox box(const Cube& cube) const { return decomposition_.octree.box(cube.leaf); }

 private:
  bool is_hole(Index leaf) const {
    return decomposition_.volumes[leaf].kind == VolumeKind::vertex ||
           decomposition_.volumes[leaf].kind == VolumeKind::edge;
  }

  void build(Cube& cube) const {
    std::unordered_map<VertexKey, Index, VertexKeyHash> known;
    for (const LeafSquare& s : cube.squares) {
      cube.triangulations.push_back(
          triangulate_square(mesh_, decomposition_.octree, s, decomposition_.volumes[cube.leaf].triangles));
      cube.numbers.emplace_back();
      for (const VolumeVertex& v : cube.triangulations.back().points) {
        const auto [at, fresh] = known.emplace(v.key, static_cast<Index>(cube.vertices.size()));
        if (fresh) cube.vertices.push_back(v);
        cube.numbers.back().push_back(at->second);
      }
    }
    std::vector<CubeSquare> squares;
    for (Index i = 0; i < cube.squares.size(); ++i)
      squares.push_back({i, &cube.triangulations[i], &cube.numbers[i], cube.squares[i].below == cube.leaf});
    cube.surface = hole_cube_surface(squares);
    // Where the lattice has it, so that what is exact on the lattice is nearly so in doubles.
    if (volume(cube).kind == VolumeKind::vertex) {
      cube.apex = mesh_.lattice.position(mesh_.vertex(volume(cube).apex));
    } else {
      for (Index v : cube.surface.rim_ends) cube.apex += 0.5 * cube.at(v);
    }
  }

  const LatticeMesh& mesh_;
  Decomposition decomposition_;
  std::vector<Cube> cubes_;
};

/// Calls `test(mesh, cubes)` for every mesh of the family.
template <class Test>
void for_meshes(Test test) {
  for (const test::NamedMesh& named : test::holed_meshes()) {
    const PlacedMesh placed(named.mesh, 2);
    SCOPED_TRACE(named.name);
    test(placed, HoleCubes(placed));
  }
}

TEST(HoleCube, SurfacesAreSpheres) {
  for_meshes([](const PlacedMesh&, const HoleCubes& cubes) {
    ASSERT_GT(cubes.all().size(), 10u);
    for (const Cube& cube : cubes.all()) {
      std::vector<Triangle> triangles;
      for (const auto& base : cube.surface.bases) triangles.push_back(base.corners);
      const test::Shape shape = test::shape_of(triangles);
      ASSERT_TRUE(shape.manifold);
      ASSERT_EQ(shape.boundary, 0u);
      ASSERT_EQ(shape.euler, 2);
      ASSERT_EQ(shape.components, 1u);
      ASSERT_FALSE(cube.surface.contradicting);
      ASSERT_EQ(cube.surface.across.size(), 3 * triangles.size());
      for (Index h = 0; h < cube.surface.across.size(); ++h) {
        const Index from = triangles[h / 3][h % 3], to = triangles[h / 3][(h % 3 + 1) % 3];
        const Triangle& other = triangles[cube.surface.across[h]];
        const auto place =
            static_cast<std::size_t>(std::find(other.begin(), other.end(), to) - other.begin());
        ASSERT_LT(place, 3u);
        ASSERT_EQ(other[(place + 1) % 3], from) << "the other triangle walks the side the other way";
      }
    }
  });
}

TEST(HoleCube, TetrahedraFillTheCube) {
  for_meshes([](const PlacedMesh& placed, const HoleCubes& cubes) {
    for (const Cube& cube : cubes.all()) {
      const LatticeBox box = cubes.box(cube);
      const double side = placed.lattice_mesh.lattice.step() * static_cast<double>(box.high[0] - box.low[0]);
      double sum = 0;
      for (std::size_t b = 0; b < cube.surface.bases.size(); ++b) {
        ASSERT_GT(cube.volume(b), 0);
        sum += cube.volume(b) / 6;
      }
      ASSERT_NEAR(sum, side * side * side, 1e-8 * side * side * side);
    }
  });
}

/// Whether a triangle and the tetrahedron over a base meet; the tetrahedron is made smaller by a little,
/// since its corners on the mesh are rounded.
bool meets_shrunk(const Cube& cube, std::size_t base, const Corners& triangle) {
  const auto& c = cube.surface.bases[base].corners;
  std::array<Vector3, 4> corners = {cube.at(c[0]), cube.at(c[1]), cube.at(c[2]), cube.apex};
  const Vector3 middle = cube.middle(base);
  for (Vector3& p : corners) p += 1e-3 * (middle - p);
  for (int i = 0; i < 4; ++i) {
    Corners face;
    for (int k = 0, n = 0; k < 4; ++k)
      if (k != i) face[static_cast<std::size_t>(n++)] = corners[static_cast<std::size_t>(k)];
    for (std::size_t k = 0; k < 3; ++k) {
      if (segment_meets_triangle(triangle[k], triangle[(k + 1) % 3], face)) return true;
      if (segment_meets_triangle(face[k], face[(k + 1) % 3], triangle)) return true;
    }
  }
  return false;
}

/// The height of a tetrahedron over its base; of slivers nothing can be said in doubles.
double height(const Cube& cube, std::size_t base) {
  const auto& c = cube.surface.bases[base].corners;
  const double longest =
      std::max({(cube.at(c[1]) - cube.at(c[0])).norm(), (cube.at(c[2]) - cube.at(c[1])).norm(),
                (cube.at(c[0]) - cube.at(c[2])).norm()});
  return cube.volume(base) / (longest * longest);
}

TEST(HoleCube, TheMeshCrossesNoTetrahedron) {
  std::size_t tested = 0, slivers = 0;
  for_meshes([&](const PlacedMesh& placed, const HoleCubes& cubes) {
    const LatticeMesh& mesh = placed.lattice_mesh;
    for (const Cube& cube : cubes.all())
      for (Index t : cubes.volume(cube).triangles) {
        Corners corners;
        for (std::size_t k = 0; k < 3; ++k) corners[k] = mesh.lattice.position(mesh.triangle(t)[k]);
        for (std::size_t b = 0; b < cube.surface.bases.size(); ++b) {
          ++tested;
          if (height(cube, b) < 1e5 * mesh.lattice.step()) {
            ++slivers;
            continue;
          }
          ASSERT_FALSE(meets_shrunk(cube, b, corners));
        }
      }
  });
  EXPECT_GT(tested, 20000u);
  EXPECT_LT(slivers, tested / 50);
}

/// Where an inner edge of the mesh, or its surface, goes through the cube's surface.
bool on_mesh(const VolumeVertex& v) {
  return v.key.kind != VertexKey::lattice_point && v.rim_edge == VolumeVertex::none;
}

TEST(HoleCube, RimEndsAreWhereTheBoundaryLeaves) {
  for_meshes([](const PlacedMesh& placed, const HoleCubes& cubes) {
    for (const Cube& cube : cubes.all()) {
      std::set<Index> expected, found;
      for (Index h : placed.topology.boundary_half_edges) {
        const Index a = placed.lattice_mesh.origin(h), b = placed.lattice_mesh.target(h);
        const Volume& volume = cubes.volume(cube);
        if (volume.kind == VolumeKind::vertex ? a == volume.apex || b == volume.apex : h == volume.apex)
          expected.insert(h);
      }
      for (Index v : cube.surface.rim_ends) found.insert(cube.vertices[v].rim_edge);
      ASSERT_EQ(found, expected);
      ASSERT_EQ(cube.surface.rim_ends.size(),
                cubes.volume(cube).kind == VolumeKind::vertex ? expected.size() : 2u);
    }
  });
}

TEST(HoleCube, WhatTouchesTheMeshInsideItIsFixed) {
  std::size_t walls = 0;
  for_meshes([&](const PlacedMesh&, const HoleCubes& cubes) {
    for (const Cube& cube : cubes.all()) {
      std::set<test::Edge> segments;
      for (std::size_t i = 0; i < cube.triangulations.size(); ++i)
        for (const auto& s : cube.triangulations[i].segments)
          segments.insert(std::minmax({cube.numbers[i][s.from], cube.numbers[i][s.to]}));
      for (std::size_t b = 0; b < cube.surface.bases.size(); ++b) {
        const auto& corners = cube.surface.bases[b].corners;
        const bool touches =
            std::any_of(corners.begin(), corners.end(), [&](Index v) { return on_mesh(cube.vertices[v]); });
        bool walled = false;
        for (std::size_t k = 0; k < 3; ++k) {
          const bool wall = segments.count(std::minmax({corners[k], corners[(k + 1) % 3]})) != 0;
          ASSERT_EQ(cube.surface.walled[3 * b + k] != 0, wall);
          walled |= wall;
        }
        walls += walled;
        ASSERT_EQ(cube.surface.sides[b] != Side::free, touches || walled);
      }
    }
  });
  EXPECT_GT(walls, 1000u);
}

// A point of each fixed tetrahedron, close to where it touches the mesh: the closed mesh winds round it or
// not.
TEST(HoleCube, FixedSidesAreThoseOfTheClosedMesh) {
  std::size_t inside = 0, outside = 0;
  for (const test::PuncturedMesh& punctured : test::punctured_meshes()) {
    const PlacedMesh placed(punctured.mesh, 3);
    const HoleCubes cubes(placed);
    for (const Cube& cube : cubes.all())
      for (std::size_t b = 0; b < cube.surface.bases.size(); ++b) {
        const Side side = cube.surface.sides[b];
        if (side == Side::free || height(cube, b) < 1e6 * placed.lattice_mesh.lattice.step()) continue;
        for (Index v : cube.surface.bases[b].corners) {
          if (!on_mesh(cube.vertices[v])) continue;
          const Vector3 sample = cube.at(v) + 1e-3 * (cube.middle(b) - cube.at(v));
          ASSERT_NEAR(test::winding_number(punctured.closed, sample), side == Side::inside ? 1 : 0, 1e-3)
              << punctured.name;
          ++(side == Side::inside ? inside : outside);
          break;
        }
      }
  }
  EXPECT_GT(inside, 500u);
  EXPECT_GT(outside, 500u);
}

// One face at the rim is turned over: cubes that hold it and others do not know which side is inside.
TEST(HoleCube, FacesTurnedOverContradict) {
  TriangleMesh mesh = test::sphere_with_hole(2, 0.6);
  const Index face = build_topology(mesh).boundary_half_edges[3] / 3;
  std::swap(mesh.triangles[face][0], mesh.triangles[face][1]);
  const PlacedMesh placed(mesh, 1);
  const HoleCubes cubes(placed);
  std::size_t contradicting = 0;
  for (const Cube& cube : cubes.all()) {
    const std::vector<Index>& triangles = cubes.volume(cube).triangles;
    const bool mixed = triangles.size() > 1 && std::binary_search(triangles.begin(), triangles.end(), face);
    EXPECT_EQ(cube.surface.contradicting, mixed);
    contradicting += mixed;
  }
  EXPECT_GE(contradicting, 2u);
}

// Without one of its squares.
TEST(HoleCube, ASurfaceThatIsNotClosedIsRefused) {
  const PlacedMesh placed(test::sphere_with_hole(2, 0.6), 1);
  const HoleCubes cubes(placed);
  const Cube& cube = cubes.all().front();
  std::vector<CubeSquare> squares;
  for (Index i = 0; i + 1 < cube.squares.size(); ++i)
    squares.push_back({i, &cube.triangulations[i], &cube.numbers[i], cube.squares[i].below == cube.leaf});
  EXPECT_ANY_THROW(hole_cube_surface(squares));
}

}  // namespace
}  // namespace meshcomplete
