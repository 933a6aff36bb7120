#include "common/core/patch_mesh.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <random>
#include <set>

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

// Everything that must hold between the triangles and the adjacency, by brute force.
void expect_consistent(const PatchMesh& mesh) {
  std::map<std::pair<Index, Index>, Index> half_edges;
  std::map<Index, std::set<Index>> neighbours;
  std::size_t triangles = 0;
  for (Index t = 0; t < mesh.triangle_count(); ++t) {
    if (!mesh.alive(t)) continue;
    ++triangles;
    for (Index h = 3 * t; h < 3 * t + 3; ++h) {
      ASSERT_TRUE(half_edges.emplace(std::pair(mesh.origin(h), mesh.target(h)), h).second)
          << "edge walked twice";
      neighbours[mesh.origin(h)].insert(mesh.target(h));
      neighbours[mesh.target(h)].insert(mesh.origin(h));
    }
  }
  std::size_t boundary = 0;
  for (const auto& [ends, h] : half_edges) {
    const auto twin = half_edges.find({ends.second, ends.first});
    if (twin == half_edges.end()) {
      ASSERT_TRUE(mesh.is_boundary(h));
      ++boundary;
      ASSERT_EQ(ends.second, (ends.first + 1) % mesh.rim_size());
    } else {
      ASSERT_EQ(mesh.opposite(h), twin->second);
    }
  }
  ASSERT_EQ(boundary, mesh.rim_size());
  std::size_t alive = 0;
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    if (!mesh.vertex_alive(v)) continue;
    ++alive;
    std::set<Index> seen;
    std::size_t visits = 0;
    mesh.for_neighbours(v, [&](Index u) {
      seen.insert(u);
      ASSERT_LE(++visits, mesh.vertex_count()) << "endless fan";
    });
    ASSERT_EQ(visits, seen.size());
    ASSERT_EQ(seen, neighbours[v]);
  }
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

}  // namespace
}  // namespace meshcomplete
