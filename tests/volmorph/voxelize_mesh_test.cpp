#include "filter_volmorph/voxelize_mesh.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>

#include "common/core/error.h"
#include "filter_volmorph/winding_number.h"
#include "tests/support/cancelling.h"
#include "tests/support/meshes.h"
#include "tests/volmorph/volumes.h"

namespace meshcomplete {
namespace {

using namespace test;

VolumeSizeOptions with_voxels(double size) {
  VolumeSizeOptions options;
  options.voxel_size = size;
  return options;
}

/// Calls `visit(position, voxel)` for every voxel.
template <class Visit>
void for_each_voxel(const RangeVolume& volume, Visit&& visit) {
  DenseVolume(volume).for_each([&](const VoxelIndex& at, const Voxel& voxel) {
    visit(volume.frame().position(at.cast<double>()), voxel);
  });
}

/// The signed distance of a point from an axis-aligned cube from the origin.
double cube_distance(const Vector3& p, double side) {
  const Vector3 q = (p.array() - side / 2).abs() - side / 2;
  return q.cwiseMax(0).norm() + std::min(q.maxCoeff(), 0.0);
}

TEST(VoxelizeMesh, a_cube_has_its_exact_distances_and_states) {
  const VoxelizedMesh result = voxelize_mesh(cube(2), with_voxels(0.125));
  EXPECT_EQ(result.rim_edges, 0u);
  for_each_voxel(result.volume, [&](const Vector3& at, const Voxel& voxel) {
    const double distance = cube_distance(at, 2);
    if (std::abs(std::abs(distance) - 0.5) < 1e-9) return;
    if (std::abs(distance) > 0.5) {
      ASSERT_EQ(voxel.state, distance < 0 ? VoxelState::unseen : VoxelState::empty) << at.transpose();
      return;
    }
    ASSERT_EQ(voxel.state, VoxelState::seen) << at.transpose();
    ASSERT_NEAR(voxel.distance, distance, 1e-6) << at.transpose();
    ASSERT_EQ(voxel.weight, 1);
    ASSERT_TRUE(voxel.normal.has_value());
  });
  EXPECT_GT(result.counts.unseen, 100u);
}

TEST(VoxelizeMesh, a_torus_and_a_cavity_are_what_they_are) {
  TriangleMesh hollow = icosphere(4, 1);
  const TriangleMesh inner = icosphere(4, 0.5);
  const Index first = static_cast<Index>(hollow.vertices.size());
  for (const Vector3& p : inner.vertices) hollow.vertices.push_back(p);
  for (const Triangle& t : inner.triangles)
    hollow.triangles.push_back({t[0] + first, t[2] + first, t[1] + first});
  const auto check = [&](const TriangleMesh& mesh, auto&& distance_at) {
    for_each_voxel(voxelize_mesh(mesh, with_voxels(0.03)).volume, [&](const Vector3& at, const Voxel& voxel) {
      const double distance = distance_at(at);
      if (std::abs(std::abs(distance) - 0.12) < 0.01) return;
      ASSERT_EQ(voxel.state, std::abs(distance) < 0.12 ? VoxelState::seen
                             : distance < 0            ? VoxelState::unseen
                                                       : VoxelState::empty)
          << at.transpose();
      if (voxel.state == VoxelState::seen) {
        ASSERT_NEAR(voxel.distance, distance, 0.01);
      }
    });
  };
  check(hollow, [](const Vector3& at) { return std::max(at.norm() - 1, 0.5 - at.norm()); });
  check(torus(96, 64),
        [](const Vector3& at) { return Eigen::Vector2d(at.head<2>().norm() - 1, at.z()).norm() - 0.4; });
}

TEST(VoxelizeMesh, where_the_surface_is_missing_nothing_is_seen_and_a_membrane_divides) {
  const double angle = 0.5;
  const VoxelizedMesh result = voxelize_mesh(sphere_with_hole(5, angle), with_voxels(0.03));
  EXPECT_GT(result.rim_edges, 10u);
  const double rim = std::cos(angle);  // the hole is above
  std::size_t near_the_hole = 0;
  for_each_voxel(result.volume, [&](const Vector3& at, const Voxel& voxel) {
    const double polar = std::acos(std::min(1.0, at.z() / at.norm()));
    if (polar < angle - 0.03 && voxel.state == VoxelState::seen) {
      // What is nearest to it is the sphere all the same, elsewhere.
      ASSERT_LT(at.norm(), 0.5) << at.transpose();
    }
    if (polar > angle + 0.1) {
      const double distance = at.norm() - 1;
      if (std::abs(std::abs(distance) - 0.12) < 0.01) return;
      ASSERT_EQ(voxel.state, std::abs(distance) < 0.12 ? VoxelState::seen
                             : distance < 0            ? VoxelState::unseen
                                                       : VoxelState::empty)
          << at.transpose();
    } else if (polar < angle / 2) {
      ++near_the_hole;
      if (at.z() > 1.1) {
        ASSERT_EQ(voxel.state, VoxelState::empty) << at.transpose();
      }
      if (at.z() > 0 && at.z() < rim - 0.2) {
        ASSERT_EQ(voxel.state, VoxelState::unseen) << at.transpose();
      }
    }
  });
  EXPECT_GT(near_the_hole, 1000u);
}

TEST(VoxelizeMesh, the_winding_number_is_that_of_the_solid_angle) {
  const TriangleMesh mesh = sphere_with_hole(4, 0.5);
  const MeshTopology topology = build_topology(mesh);
  const WindingNumber winding(mesh, topology);
  EXPECT_NEAR(winding.at(Vector3::Zero()), (1 + std::cos(0.5)) / 2, 0.02);
  EXPECT_NEAR(winding.at(Vector3(0, 0, 3)), 0, 0.05);
  EXPECT_NEAR(winding.at(Vector3(0.3, 0, -0.9)), 1, 0.05);
  // Within the radius nothing changes faster than it says.
  const Vector3 middle(0.1, 0.2, -0.2);
  const double steepest = winding.steepest(middle, 0.3);
  EXPECT_GT(steepest, 0);
  EXPECT_LT(std::abs(winding.at(middle + Vector3(0, 0, 0.3)) - winding.at(middle)), 0.3 * steepest + 0.02);
  const TriangleMesh closed = icosphere(3);
  const MeshTopology all = build_topology(closed);
  EXPECT_EQ(WindingNumber(closed, all).steepest(middle, 5), 0);
}

TEST(VoxelizeMesh, is_the_same_in_every_bit_whatever_the_number_of_threads) {
  const TriangleMesh mesh = rough_sphere_with_ragged_holes(4, 3, 7);
  const DenseVolume first(voxelize_mesh(mesh, with_voxels(0.05)).volume);
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const DenseVolume second(voxelize_mesh(mesh, with_voxels(0.05)).volume);
  ASSERT_EQ(first.voxels.size(), second.voxels.size());
  for (std::size_t i = 0; i < first.voxels.size(); ++i)
    ASSERT_TRUE(same_voxel(first.voxels[i], second.voxels[i]));
}

TEST(VoxelizeMesh, moving_by_whole_voxels_moves_the_volume) {
  TriangleMesh mesh = cube(1, Vector3(0.25, 0.5, 0.125));
  const RangeVolume here = voxelize_mesh(mesh, with_voxels(0.0625)).volume;
  for (Vector3& p : mesh.vertices) p += Vector3(1, -2, 0.0625);
  const RangeVolume there = voxelize_mesh(mesh, with_voxels(0.0625)).volume;
  EXPECT_EQ(there.frame().origin, here.frame().origin + Vector3(1, -2, 0.0625));
  const DenseVolume a(here), b(there);
  for (std::size_t i = 0; i < a.voxels.size(); ++i) ASSERT_TRUE(same_voxel(a.voxels[i], b.voxels[i]));
}

TEST(VoxelizeMesh, stops_at_any_step_when_cancelled) {
  const TriangleMesh mesh = icosphere(4);
  expect_cancels_at_any_step(
      [&](const Progress& progress) { voxelize_mesh(mesh, with_voxels(0.03), progress); });
}

TEST(VoxelizeMesh, says_what_is_wrong) {
  const auto message = [](const TriangleMesh& mesh, const VolumeSizeOptions& options) -> std::string {
    try {
      voxelize_mesh(mesh, options);
    } catch (const CompletionError& error) {
      return error.what();
    }
    return "it did not fail";
  };
  EXPECT_NE(message({}, with_voxels(0.1)).find("no faces"), std::string::npos);
  TriangleMesh flat = isolated_triangle();
  flat.vertices[2] = (flat.vertices[0] + flat.vertices[1]) / 2;
  EXPECT_NE(message(flat, with_voxels(0.1)).find("no faces"), std::string::npos);
  EXPECT_NE(message(cube(), with_voxels(0)).find("voxel size"), std::string::npos);
  EXPECT_NE(message(cube(), with_voxels(1e-5)).find("GB of memory; 4 GB are allowed"), std::string::npos);
}

}  // namespace
}  // namespace meshcomplete
