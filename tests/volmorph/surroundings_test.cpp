#include "filter_volmorph/surroundings.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>

#include "tests/support/cancelling.h"
#include "tests/volmorph/scans.h"
#include "tests/volmorph/volumes.h"

namespace meshcomplete {
namespace {

using namespace test;

constexpr double voxel = 0.0625;

std::vector<RangeScan> scans_of(const Solid& solid, const std::vector<Vector3>& ways, int n = 40) {
  std::vector<RangeScan> scans;
  for (const Vector3& way : ways)
    scans.push_back(scan(solid, LineOfSight::parallel(way), Vector3::Zero(), 0.05, n));
  return scans;
}

RangeVolume merged(const std::vector<RangeScan>& scans, double size = voxel) {
  ScanMergeOptions options;
  options.size.voxel_size = size;
  return merge_scans(scans, options).volume;
}

const std::vector<Vector3> two_ways = {Vector3::UnitZ(), -Vector3::UnitZ()};
const std::vector<Vector3> six_ways = {Vector3::UnitX(),  -Vector3::UnitX(), Vector3::UnitY(),
                                       -Vector3::UnitY(), Vector3::UnitZ(),  -Vector3::UnitZ()};

/// Only unseen voxels became empty, as many as it says; calls `visit(position, was, is)` for all voxels.
template <class Visit>
void compare(const RangeVolume& volume, const SurroundingsResult& result, Visit&& visit) {
  const DenseVolume before(volume), after(result.volume);
  std::uint64_t emptied = 0;
  before.for_each([&](const VoxelIndex& at, const Voxel& was) {
    const Voxel& is = after.at(at);
    if (was.state == VoxelState::unseen && is.state == VoxelState::empty) {
      ++emptied;
      ASSERT_EQ(is.distance, static_cast<float>(volume.frame().ramp));
    } else {
      ASSERT_TRUE(same_voxel(was, is));
    }
    visit(volume.frame().position(at.cast<double>()), was.state, is.state);
  });
  EXPECT_EQ(emptied, result.emptied);
}

class ScannedSphere : public testing::TestWithParam<std::size_t> {};

TEST_P(ScannedSphere, has_nothing_unseen_outside_and_all_inside) {
  const RangeVolume volume =
      merged(scans_of(sphere(Vector3::Zero(), 1), GetParam() == 2 ? two_ways : six_ways));
  const SurroundingsResult result = empty_surroundings(volume);
  EXPECT_GT(result.emptied, 100u);
  std::size_t inside = 0;
  compare(volume, result, [&](const Vector3& at, VoxelState was, VoxelState is) {
    if (was != VoxelState::unseen) return;
    // Seen from two sides, a belt at the equator is missing; the membrane bends inwards there.
    const double low = GetParam() == 2 ? 0.6 : 1;
    if (at.norm() > 1 + voxel) {
      ASSERT_EQ(is, VoxelState::empty) << at.transpose();
    }
    if (at.norm() > low - voxel) return;
    ASSERT_EQ(is, VoxelState::unseen) << at.transpose();
    ++inside;
  });
  EXPECT_GT(inside, 1000u);
  EXPECT_EQ(&volume.grids().weight->tree(), &result.volume.grids().weight->tree());
  EXPECT_EQ(&volume.grids().distance->tree(), &result.volume.grids().distance->tree());
  EXPECT_EQ(empty_surroundings(result.volume).emptied, 0u);
}

INSTANTIATE_TEST_SUITE_P(Views, ScannedSphere, testing::Values(2u, 6u));

TEST(Surroundings, what_a_single_scan_hides_stays_unseen) {
  const Vector3 normal = Vector3(0.3, 0.2, 1).normalized();
  const RangeVolume volume = merged(scans_of(half_space(Vector3::Zero(), normal), {Vector3::UnitZ()}));
  std::size_t hidden = 0;
  compare(volume, empty_surroundings(volume), [&](const Vector3& at, VoxelState was, VoxelState is) {
    // Where the nearest point of the plane is on the scan, away from its rim.
    const Vector3 foot = at - at.dot(normal) * normal;
    if (was != VoxelState::unseen || foot.head<2>().norm() > 1.7) return;
    ASSERT_EQ(is, at.dot(normal) < 0 ? VoxelState::unseen : VoxelState::empty) << at.transpose();
    ++hidden;
  });
  EXPECT_GT(hidden, 1000u);
}

TEST(Surroundings, a_membrane_spans_a_hole_that_no_scan_saw) {
  const Solid holed = part_of(sphere(Vector3::Zero(), 1), [](const Vector3& at) { return at.z() < 0.8; });
  const RangeVolume volume = merged(scans_of(holed, six_ways));
  std::size_t inside = 0, outside = 0;
  compare(volume, empty_surroundings(volume), [&](const Vector3& at, VoxelState was, VoxelState is) {
    if (was != VoxelState::unseen) return;
    if (at.norm() < 1 - voxel && at.z() < 0.7) {
      ASSERT_EQ(is, VoxelState::unseen) << at.transpose();
      ++inside;
    }
    if (at.norm() > 1 + voxel) {
      ASSERT_EQ(is, VoxelState::empty) << at.transpose();
      ++outside;
    }
  });
  EXPECT_GT(inside, 1000u);
  EXPECT_GT(outside, 100u);
}

TEST(Surroundings, space_between_two_objects_becomes_empty) {
  const Vector3 a(-0.9, 0, 0), b(0.9, 0, 0);
  const RangeVolume volume = merged(scans_of(both(sphere(a, 0.6), sphere(b, 0.5)), six_ways));
  std::size_t inside[2] = {0, 0};
  compare(volume, empty_surroundings(volume), [&](const Vector3& at, VoxelState was, VoxelState is) {
    if (was != VoxelState::unseen) return;
    const double depth[] = {0.6 - (at - a).norm(), 0.5 - (at - b).norm()};
    if (std::max(depth[0], depth[1]) < -2 * voxel) {
      ASSERT_EQ(is, VoxelState::empty) << at.transpose();
    }
    for (const int k : {0, 1}) {
      if (depth[k] < 2 * voxel) continue;
      ASSERT_EQ(is, VoxelState::unseen) << at.transpose();
      ++inside[k];
    }
  });
  EXPECT_GT(inside[0], 100u);
  EXPECT_GT(inside[1], 10u);
}

TEST(Surroundings, a_small_object_before_a_large_backdrop_keeps_its_inside) {
  // Of the observed faces it has less than a hundredth.
  const Vector3 middle(0, 0, 1.2);
  const double radius = 0.55;
  const Solid both_of_them = both(half_space(Vector3(0, 0, 0.017), Vector3::UnitZ()), sphere(middle, radius));
  const RangeVolume volume =
      merged({scan(both_of_them, LineOfSight::parallel(Vector3::UnitZ()), Vector3::Zero(), 0.047, 150)});
  std::size_t inside = 0, behind = 0;
  compare(volume, empty_surroundings(volume), [&](const Vector3& at, VoxelState was, VoxelState is) {
    if (was != VoxelState::unseen) return;
    // Where the nearest point is none of the rims: of the cap that was seen, and of its shadow.
    const Vector3 from = at - middle;
    const bool in_sphere = from.norm() < radius && from.z() > from.head<2>().norm();
    const double aside = at.head<2>().norm();
    if (!in_sphere && !(at.z() < 0 && aside > 1 && aside < 6)) return;
    ASSERT_EQ(is, VoxelState::unseen) << at.transpose();
    ++(in_sphere ? inside : behind);
  });
  EXPECT_GT(inside, 20u);
  EXPECT_GT(behind, 10000u);
}

// Of scans of the unit sphere and of noise beside it.
void expect_all_outside_emptied(const std::vector<RangeScan>& scans) {
  const RangeVolume volume = merged(scans);
  std::size_t outside = 0;
  compare(volume, empty_surroundings(volume), [&](const Vector3& at, VoxelState was, VoxelState is) {
    if (was != VoxelState::unseen || at.norm() < 1 + voxel) return;
    ASSERT_EQ(is, VoxelState::empty) << at.transpose();
    ++outside;
  });
  EXPECT_GT(outside, 1000u);
}

TEST(Surroundings, a_sliver_of_noise_decides_nothing) {
  // As below, but it is as long as the sphere is wide, and narrow.
  std::vector<RangeScan> scans = scans_of(sphere(Vector3::Zero(), 1), six_ways);
  const Solid sliver = part_of(half_space(Vector3(0, 0, 1.8), Vector3::UnitZ()),
                               [](const Vector3& at) { return std::abs(at.y() - 1.8) < 0.11; });
  scans.push_back(scan(sliver, LineOfSight::parallel(Vector3::UnitZ()), Vector3(0, 1.8, 1.8), 0.05, 20));
  expect_all_outside_emptied(scans);
}

TEST(Surroundings, a_speck_of_noise_decides_nothing) {
  // It looks down on the sphere from above, so that all below would lie behind it.
  std::vector<RangeScan> scans = scans_of(sphere(Vector3::Zero(), 1), six_ways);
  scans.push_back(scan(half_space(Vector3(1.8, 1.8, 1.8), Vector3::UnitZ()),
                       LineOfSight::parallel(Vector3::UnitZ()), Vector3(1.8, 1.8, 1.8), 0.05, 2));
  expect_all_outside_emptied(scans);
}

TEST(Surroundings, stored_distances_of_emptied_voxels_are_forgotten) {
  const RangeVolume plain = merged(scans_of(sphere(Vector3::Zero(), 1), two_ways));
  const RangeVolume volume = with_filler_distances(plain);
  const SurroundingsResult result = empty_surroundings(volume);
  EXPECT_GT(result.emptied, 100u);
  compare(volume, result, [](const Vector3&, VoxelState, VoxelState) {});
}

TEST(Surroundings, without_an_observed_surface_nothing_changes) {
  VolumeFrame frame;
  frame.box = {VoxelIndex::Zero(), VoxelIndex::Constant(20)};
  EXPECT_EQ(empty_surroundings(VolumeBuilder(frame).finish()).emptied, 0u);
}

TEST(Surroundings, are_the_same_in_every_bit_whatever_the_number_of_threads) {
  const RangeVolume volume = merged(scans_of(sphere(Vector3(0.1, 0, 0), 1), two_ways), 0.04);
  const DenseVolume first(empty_surroundings(volume).volume);
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const DenseVolume second(empty_surroundings(volume).volume);
  for (std::size_t i = 0; i < first.voxels.size(); ++i)
    ASSERT_TRUE(same_voxel(first.voxels[i], second.voxels[i]));
}

TEST(Surroundings, stop_at_any_step_when_cancelled) {
  const RangeVolume volume = merged(scans_of(sphere(Vector3::Zero(), 1), two_ways), 0.03);
  expect_cancels_at_any_step([&](const Progress& progress) { empty_surroundings(volume, progress); });
}

}  // namespace
}  // namespace meshcomplete
