#include "filter_volmorph/voxel_blocks.h"

#include <gtest/gtest.h>

#include "tests/volmorph/volumes.h"

namespace meshcomplete {
namespace {

TEST(VoxelBlocks, make_the_same_volume_as_single_voxels) {
  const DenseVolume dense = random_volume({{0, 0, 0}, {23, 15, 31}}, 4);
  VoxelBlocks blocks(dense.frame);
  for (int x = 16; x >= 0; x -= 8) {  // in any order
    for (int y = 0; y < 16; y += 8) {
      for (int z = 0; z < 32; z += 8) {
        VoxelBlock block;
        block.low = {x, y, z};
        for (int i = 0; i < VoxelBlock::count; ++i) {
          const Voxel& voxel = dense.at(block.low + VoxelIndex(i / 64, i / 8 % 8, i % 8));
          block.state[static_cast<std::size_t>(i)] = voxel.state;
          block.distance[static_cast<std::size_t>(i)] = voxel.distance;
          block.weight[static_cast<std::size_t>(i)] = voxel.weight;
          if (voxel.normal) block.normal[static_cast<std::size_t>(i)] = pack_normal(*voxel.normal);
        }
        blocks.add(block);
      }
    }
  }
  const RangeVolume volume = blocks.finish();
  dense.for_each([&](const VoxelIndex& at, const Voxel& voxel) {
    ASSERT_TRUE(same_voxel(volume.at(at), voxel)) << at.transpose();
  });
}

TEST(VoxelBlocks, uniform_cubes_are_cut_at_the_box_and_need_no_leaves) {
  VolumeFrame frame;
  frame.box = {{0, 0, 0}, {1023, 511, 4095}};
  VoxelBlocks blocks(frame);
  blocks.add_empty({0, 0, 0}, 4096);
  const RangeVolume all = blocks.finish();
  EXPECT_EQ(all.counts().empty, 1024ull * 512 * 4096);
  VoxelBlocks some(frame);
  some.add_empty({128, 0, 256}, 128);
  VoxelBlock uniform;
  uniform.low = {0, 8, 0};
  uniform.state.fill(VoxelState::empty);
  some.add(uniform);
  const RangeVolume volume = some.finish();
  EXPECT_EQ(volume.counts().empty, 128ull * 128 * 128 + 512);
  EXPECT_EQ(volume.at({0, 15, 7}).state, VoxelState::empty);
  EXPECT_EQ(volume.at({0, 16, 7}).state, VoxelState::unseen);
  EXPECT_EQ(volume.grids().state->tree().leafCount(), 0u);
}

}  // namespace
}  // namespace meshcomplete
