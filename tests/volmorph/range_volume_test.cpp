#include "filter_volmorph/range_volume.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <stdexcept>

#include "tests/volmorph/volumes.h"

namespace meshcomplete {
namespace {

TEST(VoxelBox, holds_both_of_its_corners) {
  const VoxelBox box{{1, 2, 3}, {4, 2, 5}};
  EXPECT_TRUE(box.contains({1, 2, 3}));
  EXPECT_TRUE(box.contains({4, 2, 5}));
  EXPECT_FALSE(box.contains({4, 3, 5}));
  EXPECT_EQ(box.size(), VoxelIndex(4, 1, 3));
  EXPECT_TRUE(VoxelBox().empty());
  EXPECT_EQ(VoxelBox().size(), VoxelIndex::Zero());
  EXPECT_TRUE(box.common({{5, 0, 0}, {9, 9, 9}}).empty());
}

TEST(RangeVolume, gives_back_what_was_set) {
  const DenseVolume dense = random_volume({{-3, 4, 20}, {14, 17, 31}}, 1);
  const RangeVolume volume = dense.volume();
  dense.for_each([&](const VoxelIndex& at, const Voxel& voxel) {
    ASSERT_TRUE(same_voxel(volume.at(at), voxel)) << at.transpose();
  });
}

TEST(RangeVolume, counts_the_voxels_of_its_box) {
  const DenseVolume dense = random_volume({{-3, 4, 20}, {14, 17, 31}}, 2);
  VolumeCounts expected;
  dense.for_each([&](const VoxelIndex&, const Voxel& voxel) {
    ++(voxel.state == VoxelState::seen     ? expected.seen
       : voxel.state == VoxelState::unseen ? expected.unseen
                                           : expected.empty);
  });
  const VolumeCounts counts = dense.volume().counts();
  EXPECT_EQ(counts.seen, expected.seen);
  EXPECT_EQ(counts.unseen, expected.unseen);
  EXPECT_EQ(counts.empty, expected.empty);
}

TEST(RangeVolume, has_nothing_outside_its_box) {
  const RangeVolume volume = random_volume({{0, 0, 0}, {7, 7, 7}}, 3).volume();
  EXPECT_THROW(volume.at({8, 0, 0}), std::out_of_range);
  EXPECT_THROW(volume.at({0, -1, 0}), std::out_of_range);
}

TEST(RangeVolume, keeps_large_uniform_regions_as_single_values) {
  VolumeFrame frame;
  frame.box = {{0, 0, 0}, {4095, 4095, 4095}};
  const RangeVolume volume = VolumeBuilder(frame).finish();
  EXPECT_EQ(volume.counts().unseen, 4096ull * 4096 * 4096);
  EXPECT_LT(volume.memory(), 10u << 20);
}

TEST(PackedNormal, is_near_and_packs_to_itself) {
  std::mt19937 random(1);
  std::normal_distribution<float> part;
  for (int i = 0; i < 10000; ++i) {
    const Eigen::Vector3f normal = Eigen::Vector3f(part(random), part(random), part(random)).normalized();
    const std::int32_t packed = pack_normal(normal);
    const Eigen::Vector3f unpacked = unpack_normal(packed);
    EXPECT_NEAR(unpacked.norm(), 1, 1e-6);
    EXPECT_LT(std::acos(std::min(1.f, unpacked.dot(normal))) * 180 / M_PI, 0.12);
    ASSERT_EQ(pack_normal(unpacked), packed);
  }
}

}  // namespace
}  // namespace meshcomplete
