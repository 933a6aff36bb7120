#include "filter_volmorph/volume_slice.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "common/core/error.h"
#include "tests/support/cancelling.h"
#include "tests/volmorph/volumes.h"

namespace meshcomplete {
namespace {

const Progress silent;
using Colour = std::array<int, 3>;

Colour colour(const VolumeSlice& slice, int column, int row) {
  const std::uint8_t* pixel = slice.pixel(column, row);
  return {pixel[0], pixel[1], pixel[2]};
}

/// 2 x 3 x 4 voxels, all unseen but for three.
RangeVolume small_volume() {
  VolumeFrame frame;
  frame.box = {{10, 20, 30}, {11, 22, 33}};
  VolumeBuilder builder(frame);
  builder.set({10, 20, 30}, {VoxelState::seen, 0, 2, Eigen::Vector3f(0, 0, 1)});
  builder.set({11, 20, 31}, {VoxelState::seen, 0, 8, {}});
  builder.set({10, 22, 33}, {VoxelState::empty, 0, 0, {}});
  return builder.finish();
}

TEST(VolumeSlice, shows_x_to_the_right_and_y_upwards_along_z) {
  const VolumeSlice slice = make_slice(small_volume(), {2, 30, SliceView::states, {}}, silent);
  EXPECT_EQ(slice.width, 2);
  EXPECT_EQ(slice.height, 3);
  EXPECT_EQ(colour(slice, 0, 2), (Colour{255, 255, 255})) << "lowest x and y: bottom left";
  EXPECT_EQ(colour(slice, 1, 2), (Colour{139, 90, 43}));
  EXPECT_EQ(colour(slice, 0, 0), (Colour{139, 90, 43}));
  EXPECT_EQ(slice.counts.seen, 1u);
  EXPECT_EQ(slice.counts.unseen, 5u);
  EXPECT_EQ(slice.counts.empty, 0u);
}

TEST(VolumeSlice, shows_x_to_the_right_and_z_upwards_along_y) {
  const VolumeSlice slice = make_slice(small_volume(), {1, 20, SliceView::states, {}}, silent);
  EXPECT_EQ(slice.width, 2);
  EXPECT_EQ(slice.height, 4);
  EXPECT_EQ(colour(slice, 0, 3), (Colour{255, 255, 255}));
  EXPECT_EQ(colour(slice, 1, 2), (Colour{255, 255, 255}));
  EXPECT_EQ(slice.counts.seen, 2u);
}

TEST(VolumeSlice, shows_y_to_the_right_and_z_upwards_along_x) {
  const VolumeSlice slice = make_slice(small_volume(), {0, 10, SliceView::states, {}}, silent);
  EXPECT_EQ(slice.width, 3);
  EXPECT_EQ(slice.height, 4);
  EXPECT_EQ(colour(slice, 0, 3), (Colour{255, 255, 255}));
  EXPECT_EQ(colour(slice, 2, 0), (Colour{0, 0, 0})) << "highest y and z: top right";
  EXPECT_EQ(slice.counts.empty, 1u);
}

TEST(VolumeSlice, shows_normals_as_colours) {
  const RangeVolume volume = small_volume();
  const VolumeSlice slice = make_slice(volume, {1, 20, SliceView::normals, {}}, silent);
  EXPECT_EQ(colour(slice, 0, 3), (Colour{128, 128, 255}));
  EXPECT_EQ(colour(slice, 1, 2), (Colour{0, 0, 0})) << "seen, without a normal";
  EXPECT_EQ(colour(slice, 0, 0), (Colour{0, 0, 0}));
}

TEST(VolumeSlice, shows_weights_as_greys) {
  const RangeVolume volume = small_volume();
  EXPECT_EQ(largest_weight(volume), 8);
  const VolumeSlice slice = make_slice(volume, {1, 20, SliceView::weights, {}}, silent);
  EXPECT_EQ(colour(slice, 0, 3), (Colour{64, 64, 64}));
  EXPECT_EQ(colour(slice, 1, 2), (Colour{255, 255, 255}));
  EXPECT_EQ(colour(slice, 0, 0), (Colour{0, 0, 0}));
  const VolumeSlice given = make_slice(volume, {1, 20, SliceView::weights, 4.f}, silent);
  EXPECT_EQ(colour(given, 0, 3), (Colour{128, 128, 128}));
  EXPECT_EQ(colour(given, 1, 2), (Colour{255, 255, 255}));
  VolumeFrame frame;
  frame.box = {{0, 0, 0}, {3, 3, 3}};
  const RangeVolume unseen = VolumeBuilder(frame).finish();
  EXPECT_EQ(largest_weight(unseen), 0);
  EXPECT_EQ(colour(make_slice(unseen, {2, 0, SliceView::weights, {}}, silent), 0, 0), (Colour{0, 0, 0}));
}

TEST(VolumeSlice, agrees_with_every_voxel_of_a_random_volume) {
  const DenseVolume dense = random_volume({{-11, -3, 5}, {9, 17, 22}}, 6);
  const RangeVolume volume = dense.volume();
  for (int axis = 0; axis < 3; ++axis) {
    VolumeCounts all;
    for (int position = dense.frame.box.low[axis]; position <= dense.frame.box.high[axis]; ++position) {
      const VolumeSlice slice = make_slice(volume, {axis, position, SliceView::states, {}}, silent);
      for (int row = 0; row < slice.height; ++row)
        for (int column = 0; column < slice.width; ++column) {
          const VoxelIndex at = voxel_of_pixel(dense.frame, axis, position, column, row);
          const VoxelState state = dense.at(at).state;
          const int red = state == VoxelState::seen ? 255 : state == VoxelState::unseen ? 139 : 0;
          ASSERT_EQ(colour(slice, column, row)[0], red) << at.transpose();
        }
      all.seen += slice.counts.seen;
      all.unseen += slice.counts.unseen;
      all.empty += slice.counts.empty;
    }
    EXPECT_EQ(all.seen, volume.counts().seen);
    EXPECT_EQ(all.unseen, volume.counts().unseen);
    EXPECT_EQ(all.empty, volume.counts().empty);
  }
}

TEST(VolumeSlice, turns_a_rectangle_into_a_box_of_full_depth) {
  const VolumeFrame frame = small_volume().frame();
  const VoxelBox along_x = box_of_rectangle(frame, 0, {0, 0}, {1, 2});
  EXPECT_EQ(along_x.low, VoxelIndex(10, 20, 31));
  EXPECT_EQ(along_x.high, VoxelIndex(11, 21, 33));
  const VoxelBox along_z = box_of_rectangle(frame, 2, {1, 2}, {0, 1});
  EXPECT_EQ(along_z.low, VoxelIndex(10, 20, 30));
  EXPECT_EQ(along_z.high, VoxelIndex(11, 21, 33));
  const VoxelBox pixel = box_of_rectangle(frame, 1, {1, 3}, {1, 3});
  EXPECT_EQ(pixel.low, VoxelIndex(11, 20, 30));
  EXPECT_EQ(pixel.high, VoxelIndex(11, 22, 30));
}

TEST(VolumeSlice, refuses_what_is_out_of_range_and_says_the_range) {
  const RangeVolume volume = small_volume();
  EXPECT_THROW(make_slice(volume, {3, 0, SliceView::states, {}}, silent), CompletionError);
  EXPECT_THROW(make_slice(volume, {2, 30, SliceView::weights, 0.f}, silent), CompletionError);
  try {
    make_slice(volume, {1, 23, SliceView::states, {}}, silent);
    FAIL() << "no error";
  } catch (const CompletionError& error) {
    EXPECT_NE(std::string(error.what()).find("along y it has the voxels 20 to 22"), std::string::npos)
        << error.what();
  }
}

TEST(VolumeSlice, is_the_same_in_one_thread_and_can_be_cancelled) {
  const RangeVolume volume = sphere_volume(60);
  const SliceOptions options{0, 3, SliceView::normals, {}};
  const VolumeSlice many = make_slice(volume, options, silent);
  {
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    EXPECT_EQ(make_slice(volume, options, silent).pixels, many.pixels);
  }
  EXPECT_NE(std::count(many.pixels.begin(), many.pixels.end(), 0), std::ptrdiff_t(many.pixels.size()));
  test::expect_cancels_at_any_step([&](const Progress& progress) { make_slice(volume, options, progress); });
}

}  // namespace
}  // namespace meshcomplete
