// A box and a lid on it, to tangle and to mend.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "common/core/mesh.h"
#include "common/core/patch.h"
#include "common/core/patch_check.h"
#include "common/core/patch_mesh.h"
#include "common/core/patch_remeshing.h"
#include "tests/support/meshes.h"
#include "tests/support/patches.h"

namespace meshcomplete {
namespace test {

/// A box of the given depth without a lid, 8 by 8 squares wide, and a flat lid with an edge length of about
/// one.
class BoxWithLid : public ::testing::Test {
 protected:
  explicit BoxWithLid(double depth = 0.5) : mesh_(box(depth)), input_(mesh_), patch_(lid()) {}

  static TriangleMesh box(double depth) {
    const TriangleMesh grid = flat_grid(8, 8);
    TriangleMesh mesh = grid;
    for (Vector3& p : mesh.vertices) p.z() = -depth;
    const BoundaryLoop rim = loops_of(grid)[0];
    std::vector<Vector3> high;
    for (Index v : rim.vertices) {
      high.push_back(grid.vertices[v]);
    }
    // The walls, welded to the bottom.
    const Index first = static_cast<Index>(mesh.vertices.size()), n = static_cast<Index>(rim.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), high.begin(), high.end());
    for (Index i = 0; i < n; ++i) {
      const Index j = (i + 1) % n;
      mesh.triangles.push_back({rim.vertices[i], rim.vertices[j], first + j});
      mesh.triangles.push_back({rim.vertices[i], first + j, first + i});
    }
    return mesh;
  }

  PatchMesh lid() {
    loops_ = loops_of(mesh_);
    std::vector<Vector3> rim;
    for (Index v : loops_.at(0).vertices) rim.push_back(mesh_.vertices[v]);
    // A fan at the centre, so that no triangle is flat.
    std::vector<Vector3> positions = rim;
    positions.emplace_back(4.01, 3.98, 0);
    std::vector<Triangle> triangles;
    const Index n = static_cast<Index>(rim.size());
    for (Index i = 0; i < n; ++i) triangles.push_back({i, (i + 1) % n, n});
    PatchMesh patch(positions, rim.size(), triangles);
    std::vector<double> target(positions.size(), 1.0);
    refine(patch, target, {});
    remesh(patch, target, {});
    return patch;
  }

  Index vertex_near(const Vector3& place) const {
    Index best = static_cast<Index>(patch_.rim_size());
    for (Index v = best; v < patch_.vertex_count(); ++v)
      if ((patch_.position(v) - place).norm() < (patch_.position(best) - place).norm()) best = v;
    return best;
  }

  PatchCheck check() const {
    const Index rim = static_cast<Index>(patch_.rim_size());
    Patch patch;
    patch.input_vertices = static_cast<Index>(mesh_.vertices.size());
    for (Index v = rim; v < patch_.vertex_count(); ++v)
      patch.vertices.push_back(as_stored(patch_.position(v)));
    for (Triangle t : patch_.triangles()) {
      for (Index& v : t) v = v < rim ? loops_[0].vertices[v] : patch.input_vertices + v - rim;
      patch.triangles.push_back(t);
    }
    return check_patch(input_, patch, pointers(loops_));
  }

  std::vector<std::array<Vector3, 3>> patch_corners() const {
    std::vector<std::array<Vector3, 3>> list;
    for (const Triangle& t : patch_.triangles())
      list.push_back({patch_.position(t[0]), patch_.position(t[1]), patch_.position(t[2])});
    return list;
  }

  TriangleMesh mesh_;
  std::vector<BoundaryLoop> loops_;
  InputNeighbourhood input_;
  PatchMesh patch_;
};

}  // namespace test
}  // namespace meshcomplete
