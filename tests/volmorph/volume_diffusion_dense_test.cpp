// Diffusion against plain loops over all voxels.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "filter_volmorph/volume_diffusion.h"
#include "tests/volmorph/dense_operators.h"

namespace meshcomplete {
namespace {

// Of one step in single precision: 26 products and their sums, a division, and six where a voxel is empty.
// Weights and their sums are whole numbers, and exact. Each rounding is at most half an epsilon of a value
// within the ramp, and means make no error larger.
constexpr int roundings_in_a_step = 26 + 26 + 1 + 6;

// The same voxels get the same distances, and all else stays the same in every bit; how many got one.
std::size_t expect_same(const RangeVolume& volume, const VoxelBox& box, const DiffusionOptions& options) {
  const DenseVolume before(volume);
  const DenseVolume expected = dense_diffusion(before, box, options);
  const DenseVolume found(diffuse(volume, box, options));
  const double rounding = roundings_in_a_step * options.iterations * volume.frame().ramp *
                          double(std::numeric_limits<float>::epsilon()) / 2;
  std::size_t filled = 0, different = 0;
  double farthest = 0;
  before.for_each([&](const VoxelIndex& at, const Voxel& voxel) {
    Voxel found_here = found.at(at), wanted = expected.at(at);
    if (!same_voxel(wanted, voxel)) {
      ++filled;
      farthest = std::max(farthest, std::abs(double(found_here.distance) - double(wanted.distance)));
      found_here.distance = wanted.distance = 0;
    }
    if (!same_voxel(found_here, wanted)) ++different;
  });
  EXPECT_EQ(different, 0u);
  EXPECT_LE(farthest, rounding);
  return filled;
}

// With the line of sight and without, in the box and everywhere.
std::size_t expect_same_both_ways(const RangeVolume& volume, const VoxelBox& box, DiffusionOptions options) {
  options.normals = false;
  std::size_t filled = 0;
  for (const bool line_of_sight : {true, false}) {
    SCOPED_TRACE(line_of_sight);
    options.line_of_sight = line_of_sight;
    filled += expect_same(volume, box, options);
    filled += expect_same(volume, volume.frame().box, options);
  }
  return filled;
}

DiffusionOptions few_steps(std::uint32_t seed) {
  DiffusionOptions options;
  options.iterations = 1 + int(seed % 5);
  options.reach = 1 + int(seed / 2 % 4);
  options.empty_weight = std::array<double, 4>{0.2, 0, 0.7, 1}[seed % 4];
  return options;
}

TEST(VolumeDiffusion, equals_the_dense_one_on_random_volumes_and_boxes) {
  const VoxelBox boxes[] = {
      {{-11, -3, 5}, {9, 17, 22}}, {{0, 0, 0}, {15, 15, 15}}, {{100, -40, 7}, {122, -25, 8}}};
  std::size_t filled = 0;
  for (std::uint32_t seed = 0; seed < 12; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    DenseVolume dense = random_volume(boxes[seed % 3], seed);
    dense.frame.voxel_size = std::array<double, 3>{1, 0.3, 2}[seed / 3 % 3];
    filled +=
        expect_same_both_ways(dense.volume(), random_box(dense.frame.box, seed + 1000), few_steps(seed));
  }
  EXPECT_GT(filled, 50000u);
}

TEST(VolumeDiffusion, equals_the_dense_one_where_regions_are_uniform) {
  const VoxelBox boxes[] = {{{-20, -10, -7}, {21, 20, 17}}, {{-60, -8, -9}, {66, 9, 6}}};
  std::size_t filled = 0;
  for (std::uint32_t seed = 0; seed < 4; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const RangeVolume volume = patchy_volume(boxes[seed % 2], seed);
    DiffusionOptions options;
    options.iterations = seed % 2 == 0 ? 7 : 3;
    options.reach = seed % 2 == 0 ? 3 : 9;
    filled += expect_same_both_ways(volume, random_box(volume.frame().box, seed + 2000), options);
  }
  EXPECT_GT(filled, 5000u);
}

TEST(VolumeDiffusion, equals_the_dense_one_after_another_filler) {
  std::size_t filled = 0;
  for (std::uint32_t seed = 0; seed < 4; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const VoxelBox box{{-11, -3, 5}, {9, 17, 22}};
    const RangeVolume volume = with_filler_distances(random_volume(box, seed).volume());
    filled += expect_same_both_ways(volume, random_box(box, seed + 3000), few_steps(seed));
  }
  EXPECT_GT(filled, 5000u);
}

TEST(VolumeDiffusion, equals_the_dense_one_on_a_hole_in_a_sphere_and_on_single_values_of_blocks) {
  DiffusionOptions options;
  options.iterations = 8;
  options.reach = 6;
  const RangeVolume sphere = sphere_volume(36);
  EXPECT_GT(expect_same_both_ways(sphere, {{-18, 0, -18}, {-10, 20, 18}}, options), 1000u);
  const RangeVolume uniform = uniform_seen_volume();
  ASSERT_TRUE(uniform.grids().distance->tree().hasActiveTiles());
  EXPECT_GT(expect_same_both_ways(uniform, {{-2, 3, 3}, {40, 20, 20}}, options), 1000u);
}

}  // namespace
}  // namespace meshcomplete
