#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "common/core/closest_point.h"
#include "common/core/error.h"
#include "filter_volmorph/voxelize_mesh.h"
#include "tests/support/meshes.h"
#include "tests/volmorph/volumes.h"

namespace meshcomplete {
namespace {

VolumeSizeOptions voxels_of(double size) {
  VolumeSizeOptions options;
  options.voxel_size = size;
  return options;
}

/// Regular, so wide from tip to tip.
TriangleMesh octahedron(double width) {
  TriangleMesh mesh;
  const double r = width / 2;
  mesh.vertices = {{r, 0, 0}, {-r, 0, 0}, {0, r, 0}, {0, -r, 0}, {0, 0, r}, {0, 0, -r}};
  for (const Index x : {0u, 1u})
    for (const Index y : {2u, 3u})
      for (const Index z : {4u, 5u})
        mesh.triangles.push_back((x + y + z) % 2 == 0 ? Triangle{x, y, z} : Triangle{x, z, y});
  return mesh;
}

/// Distance and state of every voxel, from every face of a closed convex mesh.
void expect_exact(const TriangleMesh& mesh, const RangeVolume& volume) {
  const VolumeFrame& frame = volume.frame();
  std::size_t seen = 0;
  DenseVolume(volume).for_each([&](const VoxelIndex& index, const Voxel& voxel) {
    const Vector3 at = frame.position(index.cast<double>());
    double distance = std::numeric_limits<double>::infinity();
    bool inside = true;
    for (const Triangle& t : mesh.triangles) {
      const Vector3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
      distance = std::min(distance, (closest_point(at, a, b, c).position - at).norm());
      inside = inside && (b - a).cross(c - a).dot(at - a) < 0;
    }
    if (std::abs(distance - frame.ramp) < 1e-9 * frame.ramp) return;
    const VoxelState expected = distance < frame.ramp ? VoxelState::seen
                                : inside              ? VoxelState::unseen
                                                      : VoxelState::empty;
    ASSERT_EQ(voxel.state, expected) << index.transpose() << ", distance " << distance;
    if (voxel.state != VoxelState::seen) return;
    ++seen;
    ASSERT_NEAR(voxel.distance, inside ? -distance : distance, 1e-5 * frame.ramp) << index.transpose();
  });
  EXPECT_GT(seen, 100u);
}

TEST(VoxelizeMesh, large_tilted_faces_have_their_exact_distances) {
  const TriangleMesh mesh = octahedron(60);
  expect_exact(mesh, voxelize_mesh(mesh, voxels_of(1)).volume);
  VolumeSizeOptions wide_ramp = voxels_of(1.3);
  wide_ramp.ramp = 13;
  expect_exact(mesh, voxelize_mesh(mesh, wide_ramp).volume);
}

TEST(VoxelizeMesh, needles_at_any_angle_have_their_exact_distances) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> part(-1, 1);
  for (int round = 0; round < 6; ++round) {
    TriangleMesh mesh = octahedron(2);
    Eigen::Matrix3d change;
    do {
      change = Eigen::Matrix3d::NullaryExpr([&] { return part(random); });
    } while (change.determinant() < 0.1);
    const Eigen::DiagonalMatrix<double, 3> stretch(40, 10, round < 3 ? 10 : 0.7);
    for (Vector3& p : mesh.vertices) p = change * (stretch * p);
    expect_exact(mesh, voxelize_mesh(mesh, voxels_of(1)).volume);
  }
}

TEST(VoxelizeMesh, only_blocks_near_the_faces_count_and_not_those_in_their_boxes) {
  VolumeSizeOptions options = voxels_of(1);
  options.max_memory = 60e6;  // the boxes of the faces hold 250 MB of blocks
  const VoxelizedMesh made = voxelize_mesh(octahedron(300), options);
  EXPECT_LT(static_cast<double>(made.volume.memory()), options.max_memory);
  const double radius = 150, ramp = 4;
  // Layers on both sides of the faces, whose area is sqrt(12) by that of the square of an edge; voxels lie in
  // some 14 planes of them, one more or less.
  EXPECT_NEAR(static_cast<double>(made.counts.seen), 2 * ramp * std::sqrt(12) * 2 * radius * radius,
              0.1 * static_cast<double>(made.counts.seen));
  EXPECT_NEAR(static_cast<double>(made.counts.unseen), 4. / 3 * std::pow(radius - ramp * std::sqrt(3), 3),
              0.01 * static_cast<double>(made.counts.unseen));
  options.max_memory = 20e6;
  EXPECT_THROW(voxelize_mesh(octahedron(300), options), CompletionError);
}

}  // namespace
}  // namespace meshcomplete
