#include "common/core/patch_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "tests/support/complexes.h"

namespace meshcomplete {
namespace {

constexpr double pi = 3.14159265358979323846;

PatchMesh polygon_fan(std::size_t n) {
  std::vector<Vector3> positions;
  std::vector<Triangle> triangles;
  for (std::size_t i = 0; i < n; ++i)
    positions.emplace_back(std::cos(2 * pi * double(i) / double(n)), std::sin(2 * pi * double(i) / double(n)),
                           0.0);
  for (Index i = 1; i + 1 < n; ++i) triangles.push_back({0, i, i + 1});
  return PatchMesh(positions, n, triangles);
}

using Sides = std::map<std::pair<Index, Index>, Index>;

// What must hold between the triangles and the adjacency, by brute force. Lists the sides of the triangles, a
// half-edge for each.
void expect_adjacent(const PatchMesh& mesh, Sides& half_edges) {
  std::map<Index, std::set<Index>> neighbours;
  for (Index t = 0; t < mesh.triangle_count(); ++t) {
    if (!mesh.alive(t)) continue;
    for (Index h = 3 * t; h < 3 * t + 3; ++h) {
      ASSERT_TRUE(half_edges.emplace(std::pair(mesh.origin(h), mesh.target(h)), h).second)
          << "edge walked twice";
      neighbours[mesh.origin(h)].insert(mesh.target(h));
      neighbours[mesh.target(h)].insert(mesh.origin(h));
    }
  }
  std::set<Index> at_boundary;
  for (const auto& [ends, h] : half_edges) {
    const auto twin = half_edges.find({ends.second, ends.first});
    ASSERT_EQ(mesh.opposite(h), twin == half_edges.end() ? PatchMesh::none : twin->second);
    if (twin == half_edges.end()) at_boundary.insert({ends.first, ends.second});
  }
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    ASSERT_EQ(mesh.vertex_alive(v), neighbours.count(v) != 0);
    if (!mesh.vertex_alive(v)) continue;
    ASSERT_EQ(mesh.at_boundary(v), at_boundary.count(v) != 0);
    std::set<Index> seen;
    std::size_t visits = 0;
    mesh.for_neighbours(v, [&](Index u) {
      seen.insert(u);
      ASSERT_LE(++visits, mesh.vertex_count()) << "endless fan";
    });
    ASSERT_EQ(visits, seen.size());
    ASSERT_EQ(seen, neighbours[v]);
  }
}

// Of a disk with its whole boundary on the rim.
void expect_consistent(const PatchMesh& mesh) {
  Sides half_edges;
  ASSERT_NO_FATAL_FAILURE(expect_adjacent(mesh, half_edges));
  std::size_t boundary = 0, triangles = 0, alive = 0;
  for (const auto& [ends, h] : half_edges)
    if (mesh.is_boundary(h)) {
      ++boundary;
      ASSERT_EQ(ends.second, (ends.first + 1) % mesh.rim_size());
    }
  ASSERT_EQ(boundary, mesh.rim_size());
  for (Index t = 0; t < mesh.triangle_count(); ++t) triangles += mesh.alive(t);
  for (Index v = 0; v < mesh.vertex_count(); ++v) alive += mesh.vertex_alive(v);
  ASSERT_EQ(static_cast<long>(alive) - static_cast<long>(half_edges.size() + boundary) / 2 +
                static_cast<long>(triangles),
            1)
      << "no longer a disk";
}

TEST(PatchMesh, RandomEditsKeepTheDiskConsistent) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    std::mt19937 random(seed);
    PatchMesh mesh = polygon_fan(4 + seed);
    std::size_t splits = 0, flips = 0, collapses = 0;
    for (int step = 0; step < 400; ++step) {
      const Index h = random() % static_cast<Index>(3 * mesh.triangle_count());
      if (!mesh.alive(h / 3) || mesh.is_boundary(h)) continue;
      switch (random() % 4) {
        case 3:
          if (random() % 4 == 0) mesh.insert(h / 3, mesh.area_normal(h / 3));
          break;
        case 0:
          mesh.split(h, 0.5 * (mesh.position(mesh.origin(h)) + mesh.position(mesh.target(h))));
          ++splits;
          break;
        case 1: {
          const Index c = mesh.apex(h), d = mesh.apex(mesh.opposite(h));
          if (c == d || mesh.joined(c, d)) continue;
          mesh.flip(h);
          ++flips;
          break;
        }
        default:
          if (!mesh.can_collapse(h)) continue;
          mesh.collapse(h);
          ++collapses;
      }
      ASSERT_NO_FATAL_FAILURE(expect_consistent(mesh)) << "seed " << seed << " step " << step;
    }
    EXPECT_GT(splits, 20u);
    EXPECT_GT(flips, 20u);
    EXPECT_GT(collapses, 5u);
    mesh.compact();
    ASSERT_NO_FATAL_FAILURE(expect_consistent(mesh));
    for (Index v = 0; v < mesh.vertex_count(); ++v) ASSERT_TRUE(mesh.vertex_alive(v));
  }
}

TEST(PatchMesh, KeepsTheRimWhereItIs) {
  PatchMesh mesh = polygon_fan(9);
  const std::vector<Vector3> rim(mesh.positions().begin(), mesh.positions().end());
  for (Index h = 0; h < 9; ++h)
    if (!mesh.is_boundary(h)) mesh.split(h, Vector3::Zero());
  mesh.compact();
  for (Index v = 0; v < 9; ++v) EXPECT_EQ(mesh.position(v), rim[v]);
  EXPECT_EQ(mesh.rim_size(), 9u);
}

TEST(PatchMesh, RefusesACollapseThatWouldPinch) {
  // Two inner vertices joined to each other and to all four rim vertices between them.
  std::vector<Vector3> positions = {{0, -1, 0}, {3, 0, 0}, {0, 1, 0}, {-3, 0, 0}, {-1, 0, 0}, {1, 0, 0}};
  PatchMesh mesh(positions, 4, {{0, 1, 5}, {1, 2, 5}, {2, 4, 5}, {0, 5, 4}, {2, 3, 4}, {3, 0, 4}});
  for (Index h = 0; h < 18; ++h) {
    if (mesh.is_boundary(h)) continue;
    // Pulling an inner vertex onto the rim vertex 0 or 2 would double the edge to the other inner vertex's
    // fan.
    if (mesh.origin(h) == 4 && mesh.target(h) == 5) {
      EXPECT_TRUE(mesh.can_collapse(h));
    }
    if (mesh.on_rim(mesh.origin(h))) {
      EXPECT_FALSE(mesh.can_collapse(h)) << "the rim is never removed";
    }
  }
}

// --- vertices between those of the rim
// ---------------------------------------------------------------------------------

// A disk of `outer` boundary vertices, or a ring with `inner` ones more; every third boundary vertex is on
// the rim.
PatchMesh with_steiner_points(Index outer, Index inner) {
  const Index boundary = outer + inner;
  std::vector<Index> number(boundary);
  Index rim = 0, other = (outer + 2) / 3 + (inner + 2) / 3;
  for (Index v = 0; v < boundary; ++v) number[v] = (v < outer ? v : v - outer) % 3 == 0 ? rim++ : other++;
  std::vector<Vector3> positions(boundary);
  for (Index v = 0; v < boundary; ++v) {
    const double angle = 2 * pi * (v < outer ? double(v) / outer : double(v - outer) / inner);
    positions[number[v]] = (v < outer ? 1.0 : 0.5) * Vector3(std::cos(angle), std::sin(angle), 0);
  }
  std::vector<Triangle> triangles;
  if (inner == 0)
    for (Index i = 1; i + 1 < outer; ++i) triangles.push_back({number[0], number[i], number[i + 1]});
  // Round the ring, whichever side is behind goes on.
  for (Index i = 0, j = 0; inner > 0 && i + j < boundary;) {
    const Index a = number[i % outer], b = number[outer + j % inner];
    if (std::uint64_t(i) * inner <= std::uint64_t(j) * outer)
      triangles.push_back({a, number[++i % outer], b});
    else
      triangles.push_back({a, number[outer + ++j % inner], b});
  }
  return PatchMesh(positions, rim, triangles);
}

std::set<Triangle> triangles_of(const PatchMesh& mesh) {
  std::set<Triangle> all;
  for (Index t = 0; t < mesh.triangle_count(); ++t) {
    if (!mesh.alive(t)) continue;
    Triangle corners = mesh.triangles()[t];
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
    all.insert(corners);
  }
  return all;
}

test::Shape shape_of(const std::set<Triangle>& triangles) {
  return test::shape_of(std::vector<Triangle>(triangles.begin(), triangles.end()));
}

std::set<Triangle> merged(const PatchMesh& mesh, Index dead, Index gone, Index kept) {
  std::set<Triangle> all;
  for (Index t = 0; t < mesh.triangle_count(); ++t) {
    if (!mesh.alive(t) || t == dead) continue;
    Triangle corners = mesh.triangles()[t];
    std::replace(corners.begin(), corners.end(), gone, kept);
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
    all.insert(corners);
  }
  return all;
}

// Tries both ends of a boundary half-edge, compares the answer and the outcome with merging the two vertices
// in the bare list of triangles.
void collapse_if_possible(PatchMesh& mesh, Index h, bool onto_target, std::map<std::string, int>& cases) {
  const Index gone = onto_target ? mesh.origin(h) : mesh.target(h),
              kept = onto_target ? mesh.target(h) : mesh.origin(h), apex = mesh.apex(h);
  const bool can = mesh.can_collapse_at_boundary(h, onto_target);
  if (!mesh.is_boundary(h) || mesh.on_rim(gone)) {
    ASSERT_FALSE(can);
    return;
  }
  const std::set<Triangle> before = triangles_of(mesh), after = merged(mesh, h / 3, gone, kept);
  const test::Shape old_shape = shape_of(before), new_shape = shape_of(after);
  ASSERT_TRUE(old_shape.manifold);
  const bool good = new_shape.manifold && after.size() + 1 == before.size() &&
                    new_shape.euler == old_shape.euler && new_shape.boundary + 1 == old_shape.boundary;
  const bool at_corner = mesh.is_boundary(PatchMesh::next(h)) || mesh.is_boundary(PatchMesh::previous(h));
  ASSERT_EQ(can, good && !at_corner);
  if (!can) {
    ++cases[at_corner ? "refused at a corner" : "refused"];
    return;
  }
  ++cases[mesh.on_rim(kept) ? "onto the rim" : "onto another"];
  ++cases[mesh.at_boundary(apex) ? "apex at the boundary" : "apex inside"];
  mesh.collapse_at_boundary(h, onto_target);
  ASSERT_EQ(triangles_of(mesh), after);
  ASSERT_FALSE(mesh.vertex_alive(gone));
  Sides half_edges;
  expect_adjacent(mesh, half_edges);
}

TEST(PatchMesh, CollapsesAtTheBoundaryKeepAManifold) {
  std::map<std::string, int> cases;
  for (unsigned seed = 1; seed <= 40; ++seed) {
    std::mt19937 random(seed);
    PatchMesh mesh = with_steiner_points(6 + seed, seed % 2 == 0 ? 3 + seed / 2 : 0);
    for (int step = 0; step < 150; ++step) {
      const Index h = random() % static_cast<Index>(3 * mesh.triangle_count());
      if (!mesh.alive(h / 3)) continue;
      const Index choice = random() % 8;
      if (choice == 0) {
        mesh.insert(h / 3, Vector3::Zero());
      } else if (mesh.is_boundary(h)) {
        ASSERT_NO_FATAL_FAILURE(collapse_if_possible(mesh, h, choice % 2 == 0, cases)) << "seed " << seed;
      } else if (choice < 4) {
        const Index c = mesh.apex(h), d = mesh.apex(mesh.opposite(h));
        if (c != d && !mesh.joined(c, d)) mesh.flip(h);
      } else if (choice < 5) {
        mesh.split(h, Vector3::Zero());
      } else if (mesh.can_collapse(h)) {
        mesh.collapse(h);
      }
      Sides half_edges;
      ASSERT_NO_FATAL_FAILURE(expect_adjacent(mesh, half_edges)) << "seed " << seed << " step " << step;
    }
  }
  for (const char* name : {"onto the rim", "onto another", "apex at the boundary", "apex inside", "refused",
                           "refused at a corner"})
    EXPECT_GT(cases[name], 20) << name;
}

// Until none is left: a triangulation of nothing but the rim and the inside.
TEST(PatchMesh, CollapsesTakeAllSteinerPointsOut) {
  for (Index inner : {0u, 9u}) {
    PatchMesh mesh = with_steiner_points(12, inner);
    if (inner == 0) mesh.insert(4, Vector3::Zero());
    const test::Shape before = shape_of(triangles_of(mesh));
    for (bool again = true; again;) {
      again = false;
      for (Index h = 0; h < 3 * mesh.triangle_count(); ++h)
        for (bool onto_target : {false, true})
          if (mesh.alive(h / 3) && mesh.can_collapse_at_boundary(h, onto_target)) {
            mesh.collapse_at_boundary(h, onto_target);
            again = true;
          }
    }
    const test::Shape after = shape_of(triangles_of(mesh));
    EXPECT_TRUE(after.manifold);
    EXPECT_EQ(after.euler, before.euler);
    std::size_t left = 0;
    for (Index v = static_cast<Index>(mesh.rim_size()); v < mesh.vertex_count(); ++v)
      left += mesh.vertex_alive(v) && mesh.at_boundary(v);
    EXPECT_EQ(left, inner == 0 ? 2u : 0u) << "only the tips of ears";
    const Index vertices = static_cast<Index>(mesh.rim_size());
    mesh.compact();
    EXPECT_EQ(mesh.rim_size(), vertices);
    EXPECT_EQ(shape_of(triangles_of(mesh)).euler, before.euler);
  }
}

/// The half-edges of the boundary that arrive at a vertex and leave it, by looking at all.
std::pair<Index, Index> along_boundary(const PatchMesh& mesh, Index vertex) {
  std::pair<Index, Index> found(PatchMesh::none, PatchMesh::none);
  for (Index h = 0; h < 3 * mesh.triangle_count(); ++h) {
    if (!mesh.alive(h / 3) || !mesh.is_boundary(h)) continue;
    if (mesh.target(h) == vertex) found.first = h;
    if (mesh.origin(h) == vertex) found.second = h;
  }
  return found;
}

// Compares the answer and the outcome with one triangle more in the bare list of triangles.
void fill_if_possible(PatchMesh& mesh, Index vertex, std::map<std::string, int>& cases) {
  const bool can = mesh.can_fill_at_boundary(vertex);
  if (mesh.on_rim(vertex) || !mesh.at_boundary(vertex)) {
    ASSERT_FALSE(can);
    ++cases[mesh.on_rim(vertex) ? "on the rim" : "inside"];
    return;
  }
  const auto [in, out] = along_boundary(mesh, vertex);
  ASSERT_EQ(mesh.arriving_along_boundary(vertex), in);
  ASSERT_EQ(mesh.leaving_along_boundary(vertex), out);
  const std::set<Triangle> before = triangles_of(mesh);
  const Index a = mesh.origin(in), b = mesh.target(out);
  Triangle added = {a, b, vertex};
  const bool joined = std::any_of(before.begin(), before.end(), [&](const Triangle& t) {
    return std::count(t.begin(), t.end(), a) != 0 && std::count(t.begin(), t.end(), b) != 0;
  });
  ASSERT_EQ(can, !joined);
  ++cases[can ? "filled" : "refused"];
  if (!can) return;
  std::rotate(added.begin(), std::min_element(added.begin(), added.end()), added.end());
  std::set<Triangle> after = before;
  after.insert(added);
  const test::Shape old_shape = shape_of(before), new_shape = shape_of(after);
  ASSERT_TRUE(new_shape.manifold);
  ASSERT_EQ(new_shape.euler, old_shape.euler);
  ASSERT_EQ(new_shape.boundary + 1, old_shape.boundary);
  const Index number = mesh.fill_at_boundary(vertex);
  ASSERT_EQ(number + 1, mesh.triangle_count());
  ASSERT_EQ(triangles_of(mesh), after);
  ASSERT_FALSE(mesh.at_boundary(vertex));
  Sides half_edges;
  expect_adjacent(mesh, half_edges);
}

// Compares the answer and the outcome with the bare list of triangles without the one at the vertex.
void remove_ear_if_possible(PatchMesh& mesh, Index vertex, std::map<std::string, int>& cases) {
  std::set<Triangle> after;
  std::vector<Index> at_vertex;
  for (Index t = 0; t < mesh.triangle_count(); ++t) {
    const Triangle& c = mesh.triangles()[t];
    if (mesh.alive(t) && std::count(c.begin(), c.end(), vertex)) at_vertex.push_back(t);
  }
  bool hangs_together = false;
  for (Index k = 0; at_vertex.size() == 1 && k < 3; ++k)
    hangs_together |= !mesh.is_boundary(3 * at_vertex[0] + k);
  ASSERT_EQ(mesh.can_remove_ear(vertex), hangs_together && !mesh.on_rim(vertex));
  if (!mesh.can_remove_ear(vertex)) return;
  ++cases["ear"];
  after = triangles_of(mesh);
  Triangle gone = mesh.triangles()[at_vertex[0]];
  std::rotate(gone.begin(), std::min_element(gone.begin(), gone.end()), gone.end());
  after.erase(gone);
  mesh.remove_ear(vertex);
  ASSERT_EQ(triangles_of(mesh), after);
  ASSERT_FALSE(mesh.vertex_alive(vertex));
}

TEST(PatchMesh, TrianglesAtTheBoundaryKeepAManifold) {
  std::map<std::string, int> cases;
  for (unsigned seed = 1; seed <= 40; ++seed) {
    std::mt19937 random(seed);
    PatchMesh mesh = with_steiner_points(6 + seed, seed % 2 == 0 ? 3 + seed / 2 : 0);
    for (int step = 0; step < 60; ++step) {
      const Index h = random() % static_cast<Index>(3 * mesh.triangle_count());
      if (!mesh.alive(h / 3)) continue;
      const Index choice = random() % 6;
      if (choice < 3) {
        ASSERT_NO_FATAL_FAILURE(fill_if_possible(mesh, mesh.origin(h), cases)) << "seed " << seed;
        ASSERT_NO_FATAL_FAILURE(remove_ear_if_possible(mesh, mesh.origin(h), cases)) << "seed " << seed;
      } else if (mesh.is_boundary(h)) {
        if (mesh.can_collapse_at_boundary(h, true)) mesh.collapse_at_boundary(h, true);
      } else if (choice < 5) {
        const Index c = mesh.apex(h), d = mesh.apex(mesh.opposite(h));
        if (c != d && !mesh.joined(c, d)) mesh.flip(h);
      } else {
        mesh.split(h, Vector3::Zero());
      }
      Sides half_edges;
      ASSERT_NO_FATAL_FAILURE(expect_adjacent(mesh, half_edges)) << "seed " << seed << " step " << step;
    }
  }
  for (const char* name : {"on the rim", "inside", "filled", "refused"}) EXPECT_GT(cases[name], 20) << name;
  EXPECT_GT(cases["ear"], 5);
}

// Its neighbours are joined already, by the third side of its only triangle.
TEST(PatchMesh, TheTipOfAnEarStaysAtTheBoundary) {
  PatchMesh mesh({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, 3, {{0, 1, 2}, {0, 2, 3}});
  EXPECT_EQ(mesh.arriving_along_boundary(3), 4u) << "from 2";
  EXPECT_EQ(mesh.leaving_along_boundary(3), 5u) << "to 0";
  EXPECT_FALSE(mesh.can_fill_at_boundary(3)) << "2 and 0 are joined";
  EXPECT_TRUE(mesh.can_remove_ear(3));
  EXPECT_FALSE(mesh.can_remove_ear(1)) << "on the rim";
  const PatchMesh alone({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}}, 2, {{0, 1, 2}});
  EXPECT_FALSE(alone.can_remove_ear(2)) << "nothing would be left";
  EXPECT_FALSE(mesh.can_fill_at_boundary(1)) << "on the rim";
  PatchMesh fan({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.3, 0.3, 0}}, 4,
                {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}});
  ASSERT_TRUE(fan.can_fill_at_boundary(4));
  EXPECT_EQ(fan.fill_at_boundary(4), 3u);
  EXPECT_EQ(fan.triangles()[3], (Triangle{3, 0, 4}));
}

}  // namespace
}  // namespace meshcomplete
