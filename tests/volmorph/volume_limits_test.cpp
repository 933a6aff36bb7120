#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "common/core/error.h"
#include "filter_volmorph/volume_check.h"
#include "filter_volmorph/volume_size.h"
#include "filter_volmorph/volume_slice.h"
#include "tests/support/meshes.h"
#include "tests/volmorph/volumes.h"

namespace meshcomplete {
namespace {

template <class Work>
std::string message_of(Work&& work) {
  try {
    work();
  } catch (const CompletionError& error) {
    return error.what();
  }
  return "it did not fail";
}

void expect_in(const std::string& part, const std::string& whole) {
  EXPECT_NE(whole.find(part), std::string::npos) << whole;
}

VolumeFrame frame_with(const VoxelIndex& size) {
  VolumeFrame frame;
  frame.box = {VoxelIndex::Zero(), size - VoxelIndex::Ones()};
  return frame;
}

TEST(VolumeSize, layers_that_are_far_apart_are_told_by_their_length_and_not_by_memory) {
  const TriangleMesh here = test::cube(), far = test::cube(1, Vector3(0, 3e6, 0));
  VolumeSizeOptions options;
  options.voxel_size = 0.5;
  const std::string apart = message_of([&] { choose_frame({&here, &far}, options); });
  expect_in("The visible layers span 6e+06 voxels of 0.5 along y; at most 1048576 are possible", apart);
  expect_in("aligned, in the same unit", apart);
  EXPECT_EQ(apart.find("memory"), std::string::npos) << apart;
  const TriangleMesh both = test::join(here, far);
  const std::string alone = message_of([&] { choose_frame({&both}, options); });
  expect_in("The mesh spans 6e+06 voxels of 0.5 along y", alone);
  const std::string before_size = "Voxels of ";
  options.voxel_size = std::stod(alone.substr(alone.rfind(before_size) + before_size.size()));
  EXPECT_LT(options.voxel_size, 6);
  const int longest = choose_frame({&both}, options).box.size().maxCoeff();
  EXPECT_LT(longest, 1 << 20);
  EXPECT_GT(longest, 1 << 19);
}

TEST(VolumeSlice, with_too_many_pixels_is_refused_before_it_is_made) {
  const RangeVolume volume = VolumeBuilder(frame_with({5000, 4000, 8})).finish();
  SliceOptions options;
  options.most_pixels = 16000000;
  const Progress silent;
  const std::string message = message_of([&] { make_slice(volume, options, silent); });
  expect_in("5000 x 4000 pixels; a layer may have 16000000", message);
  expect_in("Write images of the slices instead", message);
  options.axis = 1;
  EXPECT_EQ(make_slice(volume, options, silent).width, 5000);
  // Numbers whose product is more than an int holds, or 0 in its lowest 32 bits.
  const RangeVolume wide(frame_with({1 << 20, 1 << 20, 8}), std::make_shared<VolumeGrids>(volume.grids()));
  options.axis = 2;
  expect_in("1048576 x 1048576 pixels", message_of([&] { make_slice(wide, options, silent); }));
  options.most_pixels = 8 << 20;
  options.axis = 0;
  options.position = 5;
  EXPECT_EQ(make_slice(wide, options, silent).counts.unseen, 8u * 4000);
}

TEST(RangeVolume, counts_leaves_and_tiles_of_every_state) {
  VolumeCounts total;
  for (std::uint32_t seed = 0; seed < 4; ++seed) {
    const RangeVolume volume = patchy_volume({{-9, 3, -70}, {130, 60, 20}}, seed);
    VolumeCounts expected;
    DenseVolume(volume).for_each([&](const VoxelIndex&, const Voxel& voxel) {
      ++(voxel.state == VoxelState::seen     ? expected.seen
         : voxel.state == VoxelState::unseen ? expected.unseen
                                             : expected.empty);
    });
    const VolumeCounts counts = volume.counts();
    EXPECT_EQ(counts.seen, expected.seen);
    EXPECT_EQ(counts.unseen, expected.unseen);
    EXPECT_EQ(counts.empty, expected.empty);
    total.seen += counts.seen;
    total.unseen += counts.unseen;
    total.empty += counts.empty;
  }
  EXPECT_GT(total.seen, 0u);
  EXPECT_GT(total.unseen, 0u);
  EXPECT_GT(total.empty, 0u);
}

TEST(VolumeCheck, boxes_with_more_voxels_than_64_bits_count_are_refused) {
  EXPECT_EQ(frame_fault(frame_with({1 << 22, 1 << 21, 1 << 20})), std::nullopt);
  EXPECT_EQ(frame_fault(frame_with({1 << 28, 1 << 28, 1})), std::nullopt);
  // 2^64 would be counted as 0, and 2^66 as well.
  EXPECT_EQ(frame_fault(frame_with({1 << 22, 1 << 21, 1 << 21})), "its box is too large");
  EXPECT_EQ(frame_fault(frame_with({1 << 22, 1 << 22, 1 << 22})), "its box is too large");
  EXPECT_EQ(frame_fault(frame_with({1 << 28, 1 << 28, 1 << 9})), "its box is too large");
}

}  // namespace
}  // namespace meshcomplete
