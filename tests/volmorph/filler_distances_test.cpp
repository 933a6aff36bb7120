#include "filter_volmorph/filler_distances.h"

#include <gtest/gtest.h>

#include "filter_volmorph/volume_operators.h"
#include "tests/volmorph/volumes.h"

namespace meshcomplete {
namespace {

const Progress silent;

/// The operators know what they changed; here the states are compared. Returns how many distances went.
std::uint64_t expect_forgotten_as_compared(const RangeVolume& before, const RangeVolume& after) {
  VolumeGrids compared = before.grids();
  compared.state = after.grids().state;
  reset_filler_distances(before.grids(), compared);
  const openvdb::FloatTree &is = after.grids().distance->tree(), &should = compared.distance->tree();
  EXPECT_TRUE(is.hasSameTopology(should));
  for (auto value = is.cbeginValueOn(); value; ++value)
    EXPECT_EQ(*value, should.getValue(value.getCoord())) << value.getCoord();
  return before.grids().distance->activeVoxelCount() - is.activeVoxelCount();
}

TEST(FillerDistances, go_where_operators_change_states_and_nowhere_else) {
  const VoxelBox box{{-11, -3, 5}, {19, 17, 22}};
  for (std::uint32_t seed = 0; seed < 6; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const RangeVolume volume = with_filler_distances(random_volume(box, seed).volume());
    const VoxelBox part = random_box(box, seed + 100);
    for (const VoxelBox& where : {box, part}) {
      const RangeVolume eroded = erode(volume, where, silent).volume;
      expect_forgotten_as_compared(volume, eroded);
      expect_forgotten_as_compared(eroded, dilate(eroded, where, silent).volume);
    }
    EXPECT_GT(expect_forgotten_as_compared(volume, erode(volume, box, silent).volume), 10u);
  }
}

TEST(FillerDistances, go_from_single_values_of_whole_blocks) {
  VolumeFrame frame;
  frame.box = {{0, 0, 0}, {31, 31, 31}};
  VolumeBuilder builder(frame);
  builder.fill({{0, 0, 0}, {31, 31, 15}}, VoxelState::empty);
  const RangeVolume plain = builder.finish();
  VolumeGrids grids = plain.grids();
  const openvdb::FloatGrid::Ptr distances = grids.distance->deepCopy();
  distances->tree().sparseFill(openvdb::CoordBBox({0, 0, 0}, {31, 31, 31}), -0.5f, true);
  grids.distance = distances;
  ASSERT_TRUE(distances->tree().hasActiveTiles());
  const RangeVolume volume(frame, std::make_shared<const VolumeGrids>(grids));
  EXPECT_EQ(expect_forgotten_as_compared(volume, erode(volume, frame.box, silent).volume), 32u * 32);
  EXPECT_EQ(expect_forgotten_as_compared(volume, dilate(volume, frame.box, silent).volume), 32u * 32);
}

TEST(FillerDistances, stay_the_same_grid_where_none_goes) {
  const RangeVolume volume = with_filler_distances(random_volume({{0, 0, 0}, {9, 9, 9}}, 3).volume());
  VolumeGrids grids = volume.grids();
  reset_filler_distances(grids, {{{64, 64, 64}, BlockBits{1, 2, 3}}});
  EXPECT_EQ(grids.distance, volume.grids().distance);
}

}  // namespace
}  // namespace meshcomplete
