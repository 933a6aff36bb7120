#include "filter_atomicvolumes/crossed_cube.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>
#include <vector>

#include "common/core/disjoint_sets.h"
#include "common/core/patch.h"
#include "filter_atomicvolumes/decomposition.h"
#include "tests/support/volumes.h"

namespace meshcomplete {
namespace {

using test::PlacedMesh;

std::vector<Index> triangles_in(const LatticeMesh& mesh, const LatticeBox& box) {
  std::vector<Index> triangles;
  mesh.triangles_in(box, [&](Index t, const LatticeTriangle&) {
    triangles.push_back(t);
    return true;
  });
  std::sort(triangles.begin(), triangles.end());
  return triangles;
}

bool agree(const LatticeMesh& mesh, const LatticeBox& box) {
  return sides_agree(mesh, triangles_in(mesh, box), box);
}

/// A cube of the lattice about the one with these corners in mesh units.
LatticeBox cube_at(const LatticeMesh& mesh, const Vector3& centre, double side) {
  const LatticePoint middle = mesh.lattice.snap(centre);
  const auto half = static_cast<std::int64_t>(0.5 * side / mesh.lattice.step());
  LatticeBox box;
  for (std::size_t k = 0; k < 3; ++k) {
    box.low[k] = (middle[k] - half) / 2 * 2;
    box.high[k] = box.low[k] + half / 2 * 4;
  }
  return box;
}

/// Whether space in a cube has two sides, by flooding a grid of points: each edge of the grid that the mesh
/// crosses says what is inside. Two parts of space that are finer than the grid may be missed.
class Flood {
 public:
  Flood(const LatticeMesh& mesh, const LatticeBox& box, std::int64_t n = 10) : n_(n) {
    std::vector<LatticeTriangle> triangles;
    for (Index t : triangles_in(mesh, box)) triangles.push_back(mesh.triangle(t));
    for (std::int64_t i = 0; i < n * n * n; ++i) {
      LatticePoint p;
      const std::int64_t at[3] = {i % n, i / n % n, i / n / n};
      for (std::size_t k = 0; k < 3; ++k)
        p[k] = (box.low[k] + (box.high[k] - box.low[k]) * (2 * at[k] + 1) / (2 * n)) / 2 * 2;
      points_.push_back(p);
    }
    joined_ = DisjointSets(points_.size());
    std::vector<std::pair<std::size_t, bool>> said;
    for (std::size_t i = 0; i < points_.size(); ++i)
      for (std::size_t k = 0, stride = 1; k < 3; ++k, stride *= static_cast<std::size_t>(n))
        if (static_cast<std::int64_t>(i / stride % static_cast<std::size_t>(n)) + 1 < n)
          cross(triangles, i, i + stride, said);
    sides_.resize(points_.size());
    for (const auto& [point, inside] : said) {
      std::optional<bool>& side = sides_[joined_.root(static_cast<Index>(point))];
      contradicting_ |= side && *side != inside;
      side = inside;
    }
  }

  bool agrees() const { return !contradicting_; }
  const std::vector<LatticePoint>& points() const { return points_; }
  std::optional<bool> inside(std::size_t point) { return sides_[joined_.root(static_cast<Index>(point))]; }

 private:
  void cross(const std::vector<LatticeTriangle>& triangles, std::size_t from, std::size_t to,
             std::vector<std::pair<std::size_t, bool>>& said) {
    std::vector<std::pair<double, bool>> crossings;
    for (const LatticeTriangle& t : triangles) {
      const Passage way = passage(points_[from], points_[to], t);
      if (way == Passage::touches) return;
      if (way != Passage::none)
        crossings.emplace_back(passage_parameter(points_[from], points_[to], t), way == Passage::to_front);
    }
    if (crossings.empty()) {
      joined_.unite(static_cast<Index>(from), static_cast<Index>(to));
      return;
    }
    std::sort(crossings.begin(), crossings.end());
    said.emplace_back(from, crossings.front().second);
    said.emplace_back(to, !crossings.back().second);
    for (std::size_t i = 1; i < crossings.size(); ++i)
      contradicting_ |= crossings[i].second == crossings[i - 1].second;
  }

  std::int64_t n_;
  std::vector<LatticePoint> points_;
  DisjointSets joined_{0};
  std::vector<std::optional<bool>> sides_;
  bool contradicting_ = false;
};

/// Bumpy sheets one above the other; those of which the bit is set face down.
TriangleMesh sheets(int count, unsigned down) {
  TriangleMesh mesh;
  for (int i = 0; i < count; ++i) {
    TriangleMesh sheet = test::rough_sheet(6, 6, 0.2, 0, 3 + static_cast<unsigned>(i));
    sheet = test::translated(sheet, Vector3(-3, -3, i));
    mesh = test::join(mesh, (down >> i & 1u) ? test::flipped(sheet) : sheet);
  }
  return mesh;
}

// The paper's figure 4, with up to five sheets: what lies between two of them must be on one side of both.
TEST(CrossedCube, ParallelSheetsAgreeWhenTheyFaceInTurns) {
  int agreeing = 0, contradicting = 0;
  for (int count = 1; count <= 5; ++count)
    for (unsigned down = 0; down < 1u << count; ++down) {
      const PlacedMesh placed(sheets(count, down), down);
      bool expected = true;
      for (int i = 1; i < count; ++i) expected &= (down >> i & 1u) != (down >> (i - 1) & 1u);
      // Wide enough for all, or cut short above and below.
      for (double side : {5.0, static_cast<double>(count) - 0.5}) {
        const LatticeBox box = cube_at(placed.lattice_mesh, Vector3(0.1, 0, 0.5 * (count - 1)), side);
        EXPECT_EQ(agree(placed.lattice_mesh, box), expected) << count << " sheets, " << down;
      }
      ++(expected ? agreeing : contradicting);
    }
  EXPECT_EQ(agreeing, 10);
  EXPECT_EQ(contradicting, 52);
}

TEST(CrossedCube, SheetsThatIntersectDoNotContradict) {
  TriangleMesh tilted = test::flat_grid(6, 6);
  for (Vector3& p : tilted.vertices) p = Vector3(p.x() - 3, p.y() - 3, 0.5 * (p.x() - 3) + 0.0625);
  TriangleMesh flat = test::translated(test::flat_grid(6, 6), Vector3(-3, -3, 0));
  for (bool turned : {false, true}) {
    const PlacedMesh placed(test::join(flat, turned ? test::flipped(tilted) : tilted), 3);
    EXPECT_TRUE(agree(placed.lattice_mesh, cube_at(placed.lattice_mesh, Vector3(0, 0, 0), 3)));
    const bool apart = agree(placed.lattice_mesh, cube_at(placed.lattice_mesh, Vector3(1.9, 0, 0.5), 1.7));
    EXPECT_EQ(apart, turned) << "where they do not meet";
  }
}

/// A large sphere round three small ones, and a tiny one in the first of those; a bit set turns one over.
TriangleMesh spheres(unsigned turned) {
  const std::vector<TriangleMesh> parts = {
      test::icosphere(2, 1), test::icosphere(1, 0.35, Vector3(0.5, 0, 0)),
      test::icosphere(1, 0.25, Vector3(-0.4, 0.4, 0.1)), test::icosphere(1, 0.2, Vector3(-0.2, -0.5, -0.3)),
      test::icosphere(1, 0.15, Vector3(0.5, 0, 0.05))};
  TriangleMesh mesh;
  for (std::size_t i = 0; i < parts.size(); ++i)
    mesh = test::join(mesh, (turned >> i & 1u) ? test::flipped(parts[i]) : parts[i]);
  return mesh;
}

TEST(CrossedCube, NestedSpheresAgreeWhenTheirNormalsAlternate) {
  for (unsigned turned = 0; turned < 32; ++turned) {
    const PlacedMesh placed(spheres(turned), turned);
    const auto side = [&](int i) { return turned >> i & 1u; };
    const bool expected =
        side(1) != side(0) && side(2) != side(0) && side(3) != side(0) && side(4) != side(1);
    EXPECT_EQ(agree(placed.lattice_mesh, cube_at(placed.lattice_mesh, Vector3::Zero(), 2.2)), expected)
        << turned;
    // Part of them only, cut open by the cube.
    const LatticeBox part = cube_at(placed.lattice_mesh, Vector3(0.5, 0.05, 0), 0.6);
    EXPECT_EQ(agree(placed.lattice_mesh, part), side(4) != side(1)) << turned;
  }
}

/// Looks for a segment in the cube along which the mesh is crossed twice in the same direction.
bool has_witness(const LatticeMesh& mesh, const LatticeBox& box, std::mt19937_64& random) {
  std::vector<LatticeTriangle> triangles;
  for (Index t : triangles_in(mesh, box)) triangles.push_back(mesh.triangle(t));
  const auto point_near = [&](const LatticeTriangle& t) {
    LatticePoint p;
    const double u = test::uniform(random), v = (1 - u) * test::uniform(random);
    for (std::size_t k = 0; k < 3; ++k) {
      const double at = u * static_cast<double>(t[0][k]) + v * static_cast<double>(t[1][k]) +
                        (1 - u - v) * static_cast<double>(t[2][k]);
      p[k] = std::clamp(static_cast<std::int64_t>(at) / 2 * 2, box.low[k], box.high[k]);
    }
    return p;
  };
  for (int tries = 0; tries < 20000; ++tries) {
    const LatticePoint a = point_near(triangles[random() % triangles.size()]),
                       b = point_near(triangles[random() % triangles.size()]);
    std::vector<std::pair<double, bool>> crossings;
    bool touches = false;
    for (const LatticeTriangle& t : triangles) {
      const Passage way = passage(a, b, t);
      touches |= way == Passage::touches;
      if (way == Passage::to_front || way == Passage::to_back)
        crossings.emplace_back(passage_parameter(a, b, t), way == Passage::to_front);
    }
    if (touches) continue;
    std::sort(crossings.begin(), crossings.end());
    for (std::size_t i = 1; i < crossings.size(); ++i)
      if (crossings[i].second == crossings[i - 1].second) return true;
  }
  return false;
}

// Random cubes against the flood, where pieces are many and of any shape.
TEST(CrossedCube, AgreesWithAFlood) {
  std::mt19937_64 random(5);
  int agreeing = 0, contradicting = 0;
  for (unsigned turned : {0u, 14u, 6u, 30u, 16u, 17u, 31u}) {
    const PlacedMesh placed(spheres(turned), turned);
    for (int i = 0; i < 25; ++i) {
      const Vector3 centre(test::uniform(random) * 2 - 1, test::uniform(random) * 2 - 1,
                           test::uniform(random) * 2 - 1);
      const LatticeBox box = cube_at(placed.lattice_mesh, centre, 0.2 + 0.8 * test::uniform(random));
      if (triangles_in(placed.lattice_mesh, box).empty()) continue;
      Flood flood(placed.lattice_mesh, box);
      const bool found = agree(placed.lattice_mesh, box);
      // What the flood says is wrong is wrong; it may only miss a part of space.
      if (!flood.agrees()) {
        EXPECT_FALSE(found);
      } else if (!found) {
        EXPECT_TRUE(has_witness(placed.lattice_mesh, box, random));
      }
      ++(found ? agreeing : contradicting);
      if (!found) continue;
      const std::vector<Index> triangles = triangles_in(placed.lattice_mesh, box);
      for (std::size_t p = 0; p < flood.points().size(); p += 37) {
        const std::optional<bool> expected = flood.inside(p);
        if (expected) {
          EXPECT_EQ(is_inside(placed.lattice_mesh, triangles, box, flood.points()[p]), expected);
        }
      }
    }
  }
  EXPECT_GT(agreeing, 40);
  EXPECT_GT(contradicting, 20);
}

/// A strip that winds round the y axis, its front outwards (paper, figure 5).
TriangleMesh spiral(int segments, double turns) {
  TriangleMesh mesh;
  for (int i = 0; i <= segments; ++i) {
    const double angle = 6.283185307179586 * turns * i / segments, radius = 0.3 + 0.12 * angle / 6.283;
    for (double y : {-1.0, -0.3, 0.4, 1.0})
      mesh.vertices.push_back(as_stored(Vector3(radius * std::cos(angle), y, radius * std::sin(angle))));
  }
  for (Index i = 0; i < static_cast<Index>(segments); ++i)
    for (Index j = 0; j < 3; ++j) {
      const Index a = 4 * i + j;
      mesh.triangles.push_back({a, a + 1, a + 5});
      mesh.triangles.push_back({a, a + 5, a + 4});
    }
  return mesh;
}

// In a spiral every winding contradicts the next: no crossed cube may hold two.
TEST(CrossedCube, NoCubeOfASpiralHoldsTwoWindings) {
  const PlacedMesh placed(spiral(60, 3.0), 2);
  const Decomposition d = decompose(placed.lattice_mesh, {});
  int crossed = 0;
  for (Index cube = 0; cube < d.octree.size(); ++cube) {
    if (!d.octree.is_leaf(cube) || d.volumes[cube].kind != VolumeKind::crossed) continue;
    ++crossed;
    std::vector<Index> segments;
    for (Index t : d.volumes[cube].triangles) segments.push_back(t / 6);
    std::sort(segments.begin(), segments.end());
    for (std::size_t i = 1; i < segments.size(); ++i)
      ASSERT_LT(segments[i] - segments[i - 1], 10u) << "from one winding to the next";
  }
  EXPECT_GT(crossed, 200);
}

TEST(CrossedCube, InsideIsWhereTheClosedMeshWindsRound) {
  for (const test::PuncturedMesh& punctured : test::punctured_meshes()) {
    const PlacedMesh placed(punctured.closed, 6);
    std::mt19937_64 random(9);
    int inside = 0, outside = 0;
    const double reach = punctured.name == "torus" ? 1.4 : 1.0;
    for (int i = 0; i < 60; ++i) {
      const Vector3 centre = reach * Vector3(test::uniform(random) * 2 - 1, test::uniform(random) * 2 - 1,
                                             test::uniform(random) - 0.5);
      const LatticeBox box = cube_at(placed.lattice_mesh, centre, 0.4);
      const std::vector<Index> triangles = triangles_in(placed.lattice_mesh, box);
      if (triangles.empty()) continue;
      ASSERT_TRUE(sides_agree(placed.lattice_mesh, triangles, box));
      // Corners, as for whole squares, and a point within.
      for (const LatticePoint& p : {box.low, box.high, LatticePoint{box.low[0], box.high[1], box.low[2]},
                                    LatticePoint{box.low[0] + 2 * (box.high[0] - box.low[0]) / 6,
                                                 box.low[1] + 1000000, box.high[2]}}) {
        const double winding =
            test::winding_number(punctured.closed, placed.lattice_mesh.lattice.position(p));
        const std::optional<bool> found = is_inside(placed.lattice_mesh, triangles, box, p);
        ASSERT_TRUE(found);
        ASSERT_EQ(*found, winding > 0.5) << punctured.name;
        ++(*found ? inside : outside);
      }
    }
    EXPECT_GT(inside, 10) << punctured.name;
    EXPECT_GT(outside, 10) << punctured.name;
  }
}

}  // namespace
}  // namespace meshcomplete
