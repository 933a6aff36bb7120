#include "filter_volmorph/volume_box.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "common/core/error.h"
#include "filter_volmorph/block_bits.h"

namespace meshcomplete {
namespace {

TEST(VoxelsBetween, are_those_whose_middles_lie_there) {
  VolumeFrame frame;
  frame.origin = {10, -20, 0.5};
  frame.voxel_size = 0.25;
  const VoxelBox box = voxels_between(frame, {10, -19.9, 0.51}, {10.25, -19.5, 0.74});
  EXPECT_EQ(box.low, VoxelIndex(0, 1, 1));
  EXPECT_EQ(box.high, VoxelIndex(1, 2, 0));
  EXPECT_TRUE(box.empty()) << "no middle between 0.51 and 0.74";
}

TEST(VoxelsBetween, agrees_with_the_positions_however_they_are_rounded) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> unit(-1, 1);
  VolumeFrame frame;
  for (int i = 0; i < 2000; ++i) {
    frame.origin = 1000 * Vector3(unit(random), unit(random), unit(random));
    frame.voxel_size = 0.7 + 0.6 * unit(random);
    const VoxelIndex low(int(random() % 2000) - 1000, 5, -7),
        high = low + VoxelIndex(int(random() % 9), 0, 3);
    const VoxelBox box =
        voxels_between(frame, frame.position(low.cast<double>()), frame.position(high.cast<double>()));
    ASSERT_EQ(box.low, low);
    ASSERT_EQ(box.high, high);
  }
}

TEST(VoxelsBetween, refuses_what_is_not_a_number_and_bears_what_is_huge) {
  VolumeFrame frame;
  frame.box = {{0, 0, 0}, {9, 9, 9}};
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(voxels_between(frame, {nan, 0, 0}, {1, 1, 1}), CompletionError);
  EXPECT_THROW(voxels_between(frame, {0, 0, 0}, {1, INFINITY, 1}), CompletionError);
  const VoxelBox huge = voxels_between(frame, Vector3::Constant(-1e300), Vector3::Constant(1e300));
  EXPECT_EQ(box_in_volume(frame, huge).high, frame.box.high);
  EXPECT_EQ(box_in_volume(frame, huge).low, frame.box.low);
}

TEST(BlockBits, know_their_neighbours) {
  std::mt19937_64 random(3);
  const VoxelBox block{{0, 0, 0}, {7, 7, 7}};
  const VoxelBox clip{{2, -9, 3}, {20, 5, 6}};
  for (int i = 0; i < 20; ++i) {
    // Random bits of the 27 blocks, a few of them set.
    std::array<BlockBits, 27> all{};
    WideBlock wide;
    BlockWithFaces faces;
    const auto number = [](const VoxelIndex& step) {
      return (step.x() + 1) * 9 + (step.y() + 1) * 3 + step.z() + 1;
    };
    for (int x = -1; x <= 1; ++x)
      for (int y = -1; y <= 1; ++y)
        for (int z = -1; z <= 1; ++z) {
          BlockBits& bits = all[number({x, y, z})];
          for (std::uint64_t& word : bits) word = random() & random() & random() & random() & random();
          wide.set({x, y, z}, bits);
        }
    faces.own = all[13];
    for (int axis = 0; axis < 3; ++axis)
      for (const int side : {0, 1})
        faces.beside[axis][side] = all[number((2 * side - 1) * VoxelIndex::Unit(axis))];
    const auto bit = [&](const VoxelIndex& at) {
      const VoxelIndex step = at.array().unaryExpr([](int n) { return n >> 3; });
      const VoxelIndex local = at - 8 * step;
      return (all[number(step)][local.x()] >> (8 * local.y() + local.z()) & 1) != 0;
    };
    const BlockBits beside = bits_beside(faces), near = wide.near(), inside = bits_in_box({0, 0, 0}, clip);
    for (int n = 0; n < 512; ++n) {
      const VoxelIndex at(n / 64, n / 8 % 8, n % 8);
      bool face = false, any = false;
      for (int x = -1; x <= 1; ++x)
        for (int y = -1; y <= 1; ++y)
          for (int z = -1; z <= 1; ++z) {
            const VoxelIndex other = at + VoxelIndex(x, y, z);
            ASSERT_EQ(wide.has(other.x(), other.y(), other.z()), bit(other));
            any = any || bit(other);
            face = face || (x * x + y * y + z * z == 1 && bit(other));
          }
      const std::uint64_t shift = n % 64;
      ASSERT_EQ(beside[at.x()] >> shift & 1, face ? 1u : 0u) << at.transpose();
      ASSERT_EQ(near[at.x()] >> shift & 1, any ? 1u : 0u) << at.transpose();
      ASSERT_EQ(inside[at.x()] >> shift & 1, clip.contains(at) ? 1u : 0u) << at.transpose();
    }
  }
  EXPECT_EQ(count_bits(bits_in_box({-8, 0, 16}, {{-9, 3, 20}, {-7, 4, 40}})), 2 * 2 * 4);
  EXPECT_TRUE(any_bit(bits_in_box({0, 0, 0}, block)));
}

}  // namespace
}  // namespace meshcomplete
