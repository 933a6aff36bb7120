#include "filter_volmorph/volume_operators.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <string>

#include "common/core/error.h"
#include "tests/support/cancelling.h"
#include "tests/volmorph/dense_operators.h"

namespace meshcomplete {
namespace {

const Progress silent;

struct Pair {
  OperatorResult (*sparse)(const RangeVolume&, const VoxelBox&, const Progress&);
  DenseVolume (*dense)(const DenseVolume&, const VoxelBox&);
  const char* name;
};

constexpr Pair erosion{erode, dense_erosion, "e"};
constexpr Pair dilation{dilate, dense_dilation, "d"};
constexpr Pair expansion{expand_isosurface, dense_expansion, "x"};

/// Applies the operators one after another in both ways; the number of voxels that they changed.
std::uint64_t expect_same(const RangeVolume& volume, const VoxelBox& box,
                          const std::vector<Pair>& operators) {
  RangeVolume sparse = volume;
  DenseVolume dense(volume);
  std::uint64_t changed = 0;
  for (const Pair& pair : operators) {
    const OperatorResult result = pair.sparse(sparse, box, silent);
    const DenseVolume expected = pair.dense(dense, box);
    EXPECT_EQ(count_differences(DenseVolume(result.volume), expected), 0u) << pair.name;
    EXPECT_EQ(result.changed, count_differences(dense, expected)) << pair.name;
    sparse = result.volume;
    dense = expected;
    changed += result.changed;
  }
  return changed;
}

void expect_same_alone_and_in_sequence(const RangeVolume& volume, const VoxelBox& box) {
  for (const Pair& pair : {erosion, dilation, expansion}) expect_same(volume, box, {pair});
  expect_same(volume, box, {dilation, dilation, erosion, expansion, erosion, dilation, expansion});
}

TEST(VolumeOperators, equal_the_dense_ones_on_random_volumes_and_boxes) {
  const VoxelBox boxes[] = {
      {{-11, -3, 5}, {9, 17, 22}}, {{0, 0, 0}, {15, 15, 15}}, {{100, -40, 7}, {122, -25, 8}}};
  for (std::uint32_t seed = 0; seed < 30; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const VoxelBox& box = boxes[seed % 3];
    expect_same_alone_and_in_sequence(random_volume(box, seed).volume(), random_box(box, seed + 1000));
  }
}

TEST(VolumeOperators, equal_the_dense_ones_where_regions_are_uniform) {
  const VoxelBox boxes[] = {
      {{-30, -10, -7}, {40, 33, 25}}, {{-140, -8, -9}, {150, 20, 15}}, {{0, 120, 3}, {63, 183, 66}}};
  std::uint64_t changed = 0;
  for (std::uint32_t seed = 0; seed < 12; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const VoxelBox& box = boxes[seed % 3];
    const RangeVolume volume = patchy_volume(box, seed);
    const VoxelBox part = random_box(box, seed + 2000);
    for (const Pair& pair : {erosion, dilation, expansion}) changed += expect_same(volume, part, {pair});
    changed += expect_same(volume, box, {dilation, expansion, erosion, erosion});
  }
  EXPECT_GT(changed, 10000u);
}

TEST(VolumeOperators, equal_the_dense_ones_at_distances_of_a_filler) {
  for (std::uint32_t seed = 0; seed < 6; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const VoxelBox box{{-11, -3, 5}, {9, 17, 22}};
    const RangeVolume volume = with_filler_distances(random_volume(box, seed).volume());
    expect_same_alone_and_in_sequence(volume, random_box(box, seed + 3000));
    expect_same_alone_and_in_sequence(volume, box);
  }
}

TEST(VolumeOperators, know_single_values_of_seen_blocks) {
  const RangeVolume volume = uniform_seen_volume();
  ASSERT_TRUE(volume.grids().normal->tree().hasActiveTiles());
  EXPECT_GT(expect_same(volume, volume.frame().box, {expansion, dilation, erosion, expansion}), 0u);
}

TEST(VolumeOperators, work_on_single_voxels) {
  const DenseVolume dense = random_volume({{-9, -9, -9}, {2, 2, 2}}, 5);
  const RangeVolume volume = dense.volume();
  std::uint64_t changed = 0;
  for (int i = -9; i <= 2; ++i) {
    const VoxelIndex at(i, i / 2, -8 - i / 3);
    for (const Pair& pair : {erosion, dilation, expansion}) changed += expect_same(volume, {at, at}, {pair});
  }
  EXPECT_GT(changed, 0u);
}

TEST(VolumeOperators, keep_every_bit_of_seen_voxels_when_they_erode_and_dilate) {
  const DenseVolume dense = random_volume({{-11, -3, 5}, {19, 17, 22}}, 77);
  RangeVolume volume = dense.volume();
  for (const char letter : std::string("deeddedeedd"))
    volume = (letter == 'e' ? erode : dilate)(volume, dense.frame.box, silent).volume;
  const DenseVolume after(volume);
  std::uint64_t seen = 0, changed = 0;
  dense.for_each([&](const VoxelIndex& at, const Voxel& voxel) {
    if (after.at(at).state != voxel.state) ++changed;
    if (voxel.state != VoxelState::seen) return;
    ++seen;
    EXPECT_TRUE(same_voxel(after.at(at), voxel)) << at.transpose();
  });
  EXPECT_GT(seen, 1000u);
  EXPECT_GT(changed, 1000u);
}

/// A volume of 512^3, unseen where all numbers are below 256: tiles of 128^3.
RangeVolume tiles_volume() {
  VolumeFrame frame;
  frame.box = {{0, 0, 0}, {511, 511, 511}};
  VolumeBuilder builder(frame);
  builder.fill(frame.box, VoxelState::empty);
  builder.fill({{0, 0, 0}, {255, 255, 255}}, VoxelState::unseen);
  return builder.finish();
}

TEST(VolumeOperators, find_the_boundaries_between_tiles_without_filling_them) {
  const RangeVolume volume = tiles_volume();
  ASSERT_EQ(volume.grids().state->tree().leafCount(), 0u);
  const OperatorResult eroded = erode(volume, volume.frame().box, silent);
  const std::uint64_t n = 256, m = 255;
  EXPECT_EQ(eroded.changed, n * n * n - m * m * m);
  EXPECT_EQ(eroded.volume.counts().unseen, m * m * m);
  EXPECT_LE(eroded.volume.grids().state->tree().leafCount(), 3u * 32 * 32);
  const OperatorResult dilated = dilate(volume, volume.frame().box, silent);
  EXPECT_EQ(dilated.changed, 3 * n * n);
  EXPECT_EQ(dilated.volume.counts().unseen, n * n * n + 3 * n * n);
  EXPECT_LE(dilated.volume.grids().state->tree().leafCount(), 3u * 32 * 32);
}

TEST(VolumeOperators, change_nothing_beyond_the_box_between_tiles) {
  const RangeVolume volume = tiles_volume();
  const VoxelBox box{{250, 100, 3}, {260, 109, 3}};
  const OperatorResult eroded = erode(volume, box, silent);
  EXPECT_EQ(eroded.changed, 10u);
  EXPECT_EQ(eroded.volume.at({255, 100, 3}).state, VoxelState::empty);
  const OperatorResult dilated = dilate(volume, box, silent);
  EXPECT_EQ(dilated.changed, 10u);
  EXPECT_EQ(dilated.volume.at({256, 109, 3}).state, VoxelState::unseen);
  EXPECT_LE(dilated.volume.grids().state->tree().leafCount(), 4u);
}

TEST(VolumeOperators, do_not_take_what_is_outside_the_volume_for_empty) {
  VolumeFrame frame;
  frame.box = {{0, 0, 0}, {127, 127, 127}};
  const RangeVolume volume = VolumeBuilder(frame).finish();
  EXPECT_EQ(erode(volume, frame.box, silent).changed, 0u);
  frame.box = {{-3, 5, 1}, {30, 19, 12}};
  const RangeVolume odd = VolumeBuilder(frame).finish();
  EXPECT_EQ(erode(odd, {{-100, -100, -100}, {100, 100, 100}}, silent).changed, 0u);
}

TEST(VolumeOperators, give_back_single_values_where_a_region_becomes_uniform) {
  VolumeFrame frame;
  frame.box = {{0, 0, 0}, {127, 127, 127}};
  VolumeBuilder builder(frame);
  builder.set({64, 64, 64}, {VoxelState::empty, 0, 0, {}});
  const OperatorResult result = dilate(builder.finish(), frame.box, silent);
  EXPECT_EQ(result.changed, 1u);
  EXPECT_EQ(result.volume.grids().state->tree().leafCount(), 0u);
}

TEST(VolumeOperators, share_the_grids_that_they_do_not_change) {
  const RangeVolume volume = random_volume({{-11, -3, 5}, {19, 17, 22}}, 3).volume();
  const VolumeGrids& before = volume.grids();
  const RangeVolume eroded = erode(volume, volume.frame().box, silent).volume;
  EXPECT_NE(eroded.grids().state, before.state);
  EXPECT_EQ(eroded.grids().distance, before.distance);
  EXPECT_EQ(eroded.grids().weight, before.weight);
  EXPECT_EQ(eroded.grids().normal, before.normal);

  const RangeVolume filled = with_filler_distances(volume);
  const RangeVolume dilated = dilate(filled, volume.frame().box, silent).volume;
  EXPECT_NE(dilated.grids().distance, filled.grids().distance);
  EXPECT_EQ(dilated.grids().weight, before.weight);

  const RangeVolume expanded = expand_isosurface(volume, volume.frame().box, silent).volume;
  EXPECT_NE(expanded.grids().state, before.state);
  EXPECT_NE(expanded.grids().normal, before.normal);

  const RangeVolume nothing = erode(tiles_volume(), {{300, 300, 300}, {400, 400, 400}}, silent).volume;
  EXPECT_EQ(erode(nothing, {{300, 300, 300}, {400, 400, 400}}, silent).volume.grids().state,
            nothing.grids().state);
}

TEST(VolumeOperators, expand_a_plane_by_one_ring) {
  VolumeFrame frame;
  frame.box = {{-8, -8, -8}, {8, 8, 8}};
  VolumeBuilder builder(frame);
  const Voxel flat{VoxelState::seen, 0.5f, 2, Eigen::Vector3f(0, 0, 1)};
  for (int x = -1; x <= 1; ++x)
    for (int y = -1; y <= 1; ++y) builder.set({x, y, 0}, flat);
  const OperatorResult result = expand_isosurface(builder.finish(), frame.box, silent);
  EXPECT_EQ(result.changed, 16u);
  for (int x = -2; x <= 2; ++x)
    for (int y = -2; y <= 2; ++y) EXPECT_TRUE(same_voxel(result.volume.at({x, y, 0}), flat));
  EXPECT_EQ(result.volume.at({0, 0, 1}).state, VoxelState::unseen);
  EXPECT_EQ(result.volume.at({2, 2, 1}).state, VoxelState::unseen);
}

TEST(VolumeOperators, expand_from_sources_in_the_box_one_voxel_beyond_it) {
  VolumeFrame frame;
  frame.box = {{-8, -8, -8}, {8, 8, 8}};
  VolumeBuilder builder(frame);
  const Voxel first{VoxelState::seen, 1, 2, Eigen::Vector3f(0, 0, 1)};
  const Voxel second{VoxelState::seen, 2, 3, Eigen::Vector3f(0, 0, 1)};
  builder.set({0, 0, 0}, first);
  builder.set({2, 0, 0}, second);
  const RangeVolume volume = builder.finish();
  const RangeVolume both = expand_isosurface(volume, frame.box, silent).volume;
  EXPECT_EQ(both.at({1, 0, 0}).distance, 2) << "the last in the order wins";
  const RangeVolume one = expand_isosurface(volume, {{0, 0, 0}, {0, 0, 0}}, silent).volume;
  EXPECT_EQ(one.at({1, 0, 0}).distance, 1);
  EXPECT_EQ(one.at({-1, -1, 0}).state, VoxelState::seen);
  EXPECT_EQ(one.at({3, 0, 0}).state, VoxelState::unseen);
}

TEST(VolumeOperators, do_the_same_in_one_thread_and_in_many) {
  const RangeVolume volume = sphere_volume(90);
  const auto run = [&] {
    const RangeVolume dilated = dilate(volume, volume.frame().box, silent).volume;
    return DenseVolume(expand_isosurface(dilated, volume.frame().box, silent).volume);
  };
  const DenseVolume many = run();
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  EXPECT_EQ(count_differences(run(), many), 0u);
}

TEST(VolumeOperators, stop_when_cancelled) {
  const RangeVolume volume = sphere_volume(60);
  for (const Pair& pair : {erosion, dilation, expansion})
    test::expect_cancels_at_any_step(
        [&](const Progress& progress) { pair.sparse(volume, volume.frame().box, progress); });
}

TEST(VolumeOperators, say_the_bounds_when_the_box_lies_outside) {
  const RangeVolume volume = random_volume({{-3, 4, 20}, {14, 17, 31}}, 1).volume();
  for (const VoxelBox& box : {VoxelBox{{15, 4, 20}, {20, 17, 31}}, VoxelBox{{5, 5, 25}, {4, 9, 26}}}) {
    for (const Pair& pair : {erosion, dilation, expansion}) {
      try {
        pair.sparse(volume, box, silent);
        FAIL() << "no error";
      } catch (const CompletionError& error) {
        EXPECT_NE(std::string(error.what()).find("from (-3, 4, 20) to (14, 17, 31)"), std::string::npos)
            << error.what();
      }
    }
  }
}

}  // namespace
}  // namespace meshcomplete
