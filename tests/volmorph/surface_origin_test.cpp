#include "filter_volmorph/surface_origin.h"

#include <gtest/gtest.h>

#include "filter_volmorph/surface_extraction.h"
#include "filter_volmorph/volume_diffusion.h"
#include "tests/volmorph/volumes.h"

namespace meshcomplete {
namespace {

// A ball that is open where x is below -0.8 of its radius.
class OriginsOfABall : public testing::Test {
 protected:
  const RangeVolume volume = sphere_volume(32);

  // Faces of the opening have their middle there, within a voxel.
  static double height(const TriangleMesh& surface, std::size_t face) {
    double sum = 0;
    for (const Index v : surface.triangles[face]) sum += surface.vertices[v].x() / 3;
    return sum;
  }
};

TEST_F(OriginsOfABall, OpeningsAreTheBoundaryOfUnseenUntilTheyAreFilled) {
  const TriangleMesh closed = extract_surface(volume, {});
  const SurfaceOrigins before = surface_origins(volume, closed);
  ASSERT_EQ(before.faces.size(), closed.triangles.size());
  EXPECT_GT(before.count(SurfaceOrigin::boundary), 0u);
  EXPECT_GT(before.count(SurfaceOrigin::observed), before.count(SurfaceOrigin::boundary));
  EXPECT_EQ(before.count(SurfaceOrigin::filled), 0u);
  double opening = -1e9;
  for (std::size_t f = 0; f < closed.triangles.size(); ++f)
    if (before.faces[f] != SurfaceOrigin::observed) opening = std::max(opening, height(closed, f));
  for (std::size_t f = 0; f < closed.triangles.size(); ++f)
    if (before.faces[f] == SurfaceOrigin::observed) {
      EXPECT_GT(height(closed, f), opening - 3) << f;
    }

  const RangeVolume filled = diffuse(volume, volume.frame().box, {});
  const TriangleMesh cap = extract_surface(filled, {});
  const SurfaceOrigins after = surface_origins(filled, cap);
  EXPECT_EQ(after.count(SurfaceOrigin::boundary), 0u);
  EXPECT_GT(after.count(SurfaceOrigin::filled), 0u);
}

TEST_F(OriginsOfABall, WeightsAreTheVolumesAndZeroWhereNothingWasObserved) {
  const TriangleMesh closed = extract_surface(volume, {});
  const SurfaceOrigins origins = surface_origins(volume, closed);
  const DenseVolume dense(volume);
  float least = 1e9f, largest = 0;
  dense.for_each([&](const VoxelIndex&, const Voxel& voxel) {
    if (voxel.state != VoxelState::seen) return;
    least = std::min(least, voxel.weight);
    largest = std::max(largest, voxel.weight);
  });
  ASSERT_EQ(origins.weights.size(), closed.vertices.size());
  for (std::size_t f = 0; f < closed.triangles.size(); ++f) {
    bool all = true;
    for (const Index v : closed.triangles[f]) {
      const float weight = origins.weights[v];
      EXPECT_TRUE(weight == 0 || (weight >= least && weight <= largest)) << weight;
      all = all && weight > 0;
    }
    EXPECT_EQ(all, origins.faces[f] == SurfaceOrigin::observed);
  }
}

TEST_F(OriginsOfABall, WhatOnlyScannersSawIsObserved) {
  ExtractionOptions options;
  options.observed_only = true;
  const TriangleMesh open = extract_surface(volume, options);
  const SurfaceOrigins origins = surface_origins(volume, open);
  EXPECT_EQ(origins.count(SurfaceOrigin::observed), open.triangles.size());
}

}  // namespace
}  // namespace meshcomplete
