#include "filter_curveunfold/embedding.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

#include "common/core/error.h"
#include "common/core/mesh_topology.h"
#include "filter_curveunfold/loop_geometry.h"
#include "filter_curveunfold/polygon_triangulation.h"
#include "filter_curveunfold/unfold.h"
#include "tests/support/meshes.h"
#include "tests/support/patches.h"

namespace meshcomplete {
namespace {

Rim rim_of(const TriangleMesh& mesh, std::size_t loop = 0) {
  return collect_rim(mesh, build_topology(mesh), test::loops_of(mesh).at(loop));
}

std::vector<Triangle> flat_triangulation(const Rim& rim) {
  const Unfolding unfolding = unfold(rim.positions);
  return triangulate_polygon(unfolding.polygon);
}

template <class Visit>
void for_inner_edges(const PatchMesh& patch, Visit visit) {
  for (Index h = 0; h < 3 * patch.triangle_count(); ++h)
    if (!patch.is_boundary(h) && h < patch.opposite(h)) visit(h);
}

double mean_inner_edge(const PatchMesh& patch) {
  double sum = 0, count = 0;
  for_inner_edges(patch, [&](Index h) {
    sum += patch.length(h);
    ++count;
  });
  return sum / count;
}

/// A compact disk whose boundary is the rim, edge by edge.
void expect_disk_on(const Rim& rim, const PatchMesh& patch) {
  ASSERT_EQ(patch.rim_size(), rim.positions.size());
  for (Index v = 0; v < patch.rim_size(); ++v) EXPECT_EQ(patch.position(v), rim.positions[v]);
  std::size_t boundary = 0;
  for (Index h = 0; h < 3 * patch.triangle_count(); ++h) {
    ASSERT_TRUE(patch.alive(h / 3)) << "compact";
    if (!patch.is_boundary(h)) continue;
    ++boundary;
    EXPECT_EQ(patch.target(h), (patch.origin(h) + 1) % patch.rim_size()) << "rim edges are never split";
  }
  EXPECT_EQ(boundary, rim.positions.size());
  const long edges = static_cast<long>(3 * patch.triangle_count() + boundary) / 2;
  EXPECT_EQ(static_cast<long>(patch.vertex_count()) - edges + static_cast<long>(patch.triangle_count()), 1);
  for (Index v = 0; v < patch.vertex_count(); ++v) EXPECT_TRUE(patch.vertex_alive(v));
  for (const auto& [a, b] : rim.forbidden) EXPECT_FALSE(patch.joined(a, b));
}

constexpr SurfaceEnergy energies[] = {SurfaceEnergy::membrane, SurfaceEnergy::thin_plate,
                                      SurfaceEnergy::normal_variation};

TEST(Embedding, PatchesAreDisksOfTheResolutionAround) {
  for (SurfaceEnergy energy : energies)
    for (LaplacianWeights weights : {LaplacianWeights::uniform, LaplacianWeights::cotangent}) {
      const Rim rim = rim_of(test::sphere_with_hole(3, 0.6));
      EmbeddingOptions options;
      options.energy = energy;
      options.weights = weights;
      const PatchMesh patch = embed(rim, flat_triangulation(rim), options);
      expect_disk_on(rim, patch);
      const auto [least, greatest] = std::minmax_element(rim.edge_length.begin(), rim.edge_length.end());
      for_inner_edges(patch, [&](Index h) {
        EXPECT_GT(patch.length(h), 0.3 * *least);
        EXPECT_LT(patch.length(h), 2 * *greatest);
      });
      EXPECT_NEAR(mean_inner_edge(patch), 0.5 * (*least + *greatest), 0.25 * *greatest);
      for (Index v = 0; v < patch.vertex_count(); ++v) EXPECT_LE(patch.valence(v), 12u);
      double worst_angle = 4;
      for (Index h = 0; h < 3 * patch.triangle_count(); ++h)
        worst_angle = std::min(
            worst_angle, angle_between(patch.position(patch.target(h)) - patch.position(patch.origin(h)),
                                       patch.position(patch.apex(h)) - patch.position(patch.origin(h))));
      EXPECT_GT(worst_angle, 0.2) << "radians";
    }
}

TEST(Embedding, TheThinPlateContinuesTheSphere) {
  for (int subdivisions : {3, 4})
    for (double angle : {0.4, 0.7}) {
      const Rim rim = rim_of(test::sphere_with_hole(subdivisions, angle));
      const PatchMesh patch = embed(rim, flat_triangulation(rim), {});
      const double sagitta = 1 - std::cos(angle);
      for (const Vector3& p : patch.positions()) EXPECT_NEAR(p.norm(), 1, 0.15 * sagitta) << angle;
      EmbeddingOptions flat;
      flat.energy = SurfaceEnergy::membrane;
      const PatchMesh membrane = embed(rim, flat_triangulation(rim), flat);
      double lowest = 1;
      for (const Vector3& p : membrane.positions()) lowest = std::min(lowest, p.norm());
      EXPECT_LT(lowest, 1 - 0.5 * sagitta) << "a membrane does not bulge";
    }
}

TEST(Embedding, AFlatHoleIsFilledFlat) {
  const TriangleMesh sheet = test::without_ball(test::flat_grid(16, 16), Vector3(8, 8, 0), 4.2);
  const Rim rim = rim_of(sheet, 1);
  for (SurfaceEnergy energy : energies) {
    EmbeddingOptions options;
    options.energy = energy;
    const PatchMesh patch = embed(rim, flat_triangulation(rim), options);
    expect_disk_on(rim, patch);
    EXPECT_GT(patch.vertex_count(), patch.rim_size());
    for (const Vector3& p : patch.positions()) EXPECT_NEAR(p.z(), 0, 1e-9);
    for (Index t = 0; t < patch.triangle_count(); ++t) EXPECT_GT(patch.area_normal(t).z(), 0);
  }
}

TEST(Embedding, TheEdgeLengthAskedFor) {
  const Rim rim = rim_of(test::sphere_with_hole(3, 0.6));
  const std::vector<Triangle> flat = flat_triangulation(rim);
  for (double length : {0.2, 0.1, 0.05, 0.025}) {
    EmbeddingOptions options;
    options.edge_length = length;
    const PatchMesh patch = embed(rim, flat, options);
    expect_disk_on(rim, patch);
    if (length <= 0.1) {  // longer ones are limited by the rim's own edges
      EXPECT_NEAR(mean_inner_edge(patch), length, 0.2 * length);
    }
  }
}

TEST(Embedding, ResolutionDividesTheEdgeLength) {
  const Rim rim = rim_of(test::sphere_with_hole(3, 0.6));
  const std::vector<Triangle> flat = flat_triangulation(rim);
  EmbeddingOptions options;
  const double once = mean_inner_edge(embed(rim, flat, options));
  options.resolution = 2;
  EXPECT_NEAR(mean_inner_edge(embed(rim, flat, options)), 0.5 * once, 0.1 * once);
}

// From a thousand vertices on the first solve is done with longer edges. The patch has the resolution of the
// mesh around all the same, everywhere, and goes on with its curvature.
TEST(Embedding, LargePatchesHaveTheResolutionAround) {
  constexpr double angle = 0.9;
  const Rim rim = rim_of(test::sphere_with_hole(5, angle));
  const PatchMesh patch = embed(rim, flat_triangulation(rim), {});
  expect_disk_on(rim, patch);
  EXPECT_GT(patch.vertex_count(), 2000u);
  double length = 0;
  for (double at : rim.edge_length) length += at / static_cast<double>(rim.edge_length.size());
  EXPECT_NEAR(mean_inner_edge(patch), length, 0.1 * length);
  std::size_t edges = 0, uneven = 0;
  for_inner_edges(patch, [&](Index h) {
    ++edges;
    uneven += patch.length(h) < 0.6 * length || patch.length(h) > 1.5 * length;
  });
  EXPECT_LT(uneven, edges / 100);
  for (const Vector3& p : patch.positions()) EXPECT_NEAR(p.norm(), 1, 0.15 * (1 - std::cos(angle)));
}

TEST(Embedding, SmallRims) {
  const Rim triangle = [] {
    TriangleMesh mesh = test::tetrahedron();
    mesh.triangles.pop_back();
    return rim_of(mesh);
  }();
  const PatchMesh lid = embed(triangle, {{0, 1, 2}}, {});
  EXPECT_EQ(lid.triangle_count(), 1u);
  EXPECT_EQ(lid.vertex_count(), 3u);

  // The other two faces of a tetrahedron: their common edge is taken, so that the patch needs a vertex.
  TriangleMesh half = test::tetrahedron();
  half.triangles.resize(2);
  const Rim quad = rim_of(half);
  ASSERT_EQ(quad.forbidden.size(), 1u);
  for (const std::vector<Triangle>& flat :
       {std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}}, std::vector<Triangle>{{0, 1, 3}, {1, 2, 3}}})
    expect_disk_on(quad, embed(quad, flat, {}));
}

TEST(Embedding, ScalingByPowersOfTwoCommutesToTheBit) {
  const TriangleMesh mesh = test::sphere_with_hole(3, 0.5);
  const Rim rim = rim_of(mesh), large = rim_of(test::scaled(mesh, 1024));
  const std::vector<Triangle> flat = flat_triangulation(rim);
  for (SurfaceEnergy energy : energies) {
    EmbeddingOptions options;
    options.energy = energy;
    const PatchMesh one = embed(rim, flat, options), other = embed(large, flat, options);
    EXPECT_EQ(one.triangles(), other.triangles());
    ASSERT_EQ(one.vertex_count(), other.vertex_count());
    for (Index v = 0; v < one.vertex_count(); ++v)
      EXPECT_EQ(Vector3(1024 * one.position(v)), other.position(v));
  }
}

TEST(Embedding, CanBeCancelled) {
  const Rim rim = rim_of(test::sphere_with_hole(3, 0.6));
  const std::vector<Triangle> flat = flat_triangulation(rim);
  EXPECT_THROW(embed(rim, flat, {}, Progress([](double, const std::string&) { return false; })), Cancelled);
}

}  // namespace
}  // namespace meshcomplete
