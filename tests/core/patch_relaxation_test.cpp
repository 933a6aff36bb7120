#include "common/core/patch_relaxation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "common/core/patch_remeshing.h"

namespace meshcomplete {
namespace {

/// A flat disk of about 300 vertices.
PatchMesh disk() {
  constexpr double pi = 3.14159265358979323846;
  std::vector<Vector3> rim;
  std::vector<Triangle> triangles;
  for (int i = 0; i < 60; ++i) rim.emplace_back(std::cos(pi * i / 30), std::sin(pi * i / 30), 0);
  for (Index i = 1; i + 1 < rim.size(); ++i) triangles.push_back({0, i, i + 1});
  PatchMesh patch(rim, rim.size(), triangles);
  std::vector<double> target(rim.size(), 0.1);
  refine(patch, target, {});
  remesh(patch, target, {});
  return patch;
}

Index vertex_near(const PatchMesh& patch, const Vector3& place) {
  Index best = static_cast<Index>(patch.rim_size());
  for (Index v = best; v < patch.vertex_count(); ++v)
    if ((patch.position(v) - place).norm() < (patch.position(best) - place).norm()) best = v;
  return best;
}

std::vector<Index> triangles_at(const PatchMesh& patch, Index vertex) {
  std::vector<Index> list;
  patch.for_outgoing(vertex, [&](Index h) { list.push_back(h / 3); });
  return list;
}

/// Edges to the nearest of the corners, for every vertex.
std::vector<int> distances(const PatchMesh& patch, const std::vector<Index>& triangles) {
  std::vector<int> distance(patch.vertex_count(), 1000);
  for (Index t : triangles)
    for (Index v : patch.triangles()[t]) distance[v] = 0;
  for (bool changed = true; changed;) {
    changed = false;
    for (const Triangle& t : patch.triangles())
      for (Index a : t)
        for (Index b : t)
          if (distance[a] > distance[b] + 1) {
            distance[a] = distance[b] + 1;
            changed = true;
          }
  }
  return distance;
}

TEST(PatchRelaxation, AnOvershootIsFlattened) {
  PatchMesh patch = disk();
  const Index poked = vertex_near(patch, Vector3(0, 0, 0));
  patch.move(poked, patch.position(poked) + Vector3(0, 0, 2));
  relax_around(patch, triangles_at(patch, poked), 1, 60);
  for (const Vector3& p : patch.positions()) EXPECT_NEAR(p.z(), 0, 0.02);
}

TEST(PatchRelaxation, OnlyVerticesWithinTheRingsMove) {
  for (int rings : {0, 1, 2, 3}) {
    PatchMesh patch = disk();
    const Index poked = vertex_near(patch, Vector3(0.4, 0, 0));
    patch.move(poked, patch.position(poked) + Vector3(0, 0, 0.5));
    const std::vector<Index> tangled = {triangles_at(patch, poked)[0]};
    const std::vector<int> distance = distances(patch, tangled);
    const std::vector<Vector3> before = patch.positions();
    relax_around(patch, tangled, rings, 3);
    bool farthest_moved = false;
    for (Index v = 0; v < before.size(); ++v) {
      if (distance[v] > rings || patch.on_rim(v)) {
        EXPECT_EQ(patch.position(v), before[v]) << "rings " << rings << ", distance " << distance[v];
      } else if (distance[v] == rings) {
        farthest_moved |= patch.position(v) != before[v];
      }
    }
    EXPECT_TRUE(farthest_moved) << rings;
  }
}

TEST(PatchRelaxation, TheRimStays) {
  PatchMesh patch = disk();
  std::vector<Index> all(patch.triangle_count());
  for (Index t = 0; t < all.size(); ++t) all[t] = t;
  const std::vector<Vector3> before = patch.positions();
  relax_around(patch, all, 2, 10);
  for (Index v = 0; v < patch.rim_size(); ++v) EXPECT_EQ(patch.position(v), before[v]);
}

// The membrane: after many sweeps over everything each vertex is at the mean of its neighbours.
TEST(PatchRelaxation, ManySweepsReachTheMembrane) {
  PatchMesh patch = disk();
  for (Index v = 0; v < patch.vertex_count(); ++v)
    if (!patch.on_rim(v)) patch.move(v, Vector3(0.1 * std::sin(v), 0.1 * std::cos(v), std::sin(2.0 * v)));
  std::vector<Index> all(patch.triangle_count());
  for (Index t = 0; t < all.size(); ++t) all[t] = t;
  relax_around(patch, all, 0, 1000);
  for (Index v = static_cast<Index>(patch.rim_size()); v < patch.vertex_count(); ++v) {
    Vector3 sum = Vector3::Zero();
    patch.for_neighbours(v, [&](Index u) { sum += patch.position(u); });
    EXPECT_LT((sum / static_cast<double>(patch.valence(v)) - patch.position(v)).norm(), 1e-9);
  }
}

TEST(PatchRelaxation, NothingTangledNothingDone) {
  PatchMesh patch = disk();
  const std::vector<Vector3> before = patch.positions();
  relax_around(patch, {}, 5, 10);
  relax_around(patch, {0, 1, 2}, 5, 0);
  EXPECT_EQ(patch.positions(), before);
}

}  // namespace
}  // namespace meshcomplete
