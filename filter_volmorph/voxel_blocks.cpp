#include "filter_volmorph/voxel_blocks.h"

#include <openvdb/tools/Prune.h>

#include <algorithm>
#include <mutex>
#include <utility>
#include <vector>

#include "filter_volmorph/volume_grids.h"

namespace meshcomplete {
namespace {

constexpr std::size_t between_checks = 1024;  // leaves or cubes

template <class Grid>
using Leaf = typename Grid::TreeType::LeafNodeType;

template <class Grid>
struct Leaves {
  std::vector<std::unique_ptr<Leaf<Grid>>> leaves;

  void hand_over(Grid& grid, const Progress& progress) {
    for (std::size_t i = 0; i < leaves.size(); ++i) {
      if (i % between_checks == 0) progress.check();
      grid.tree().addLeaf(leaves[i].release());
    }
    leaves.clear();
  }
};

/// The values of the voxels for which `active` holds.
template <class Grid, class Values, class Active>
std::unique_ptr<Leaf<Grid>> make_leaf(const VoxelIndex& low, const Values& values,
                                      typename Grid::ValueType background, Active&& active) {
  auto leaf = std::make_unique<Leaf<Grid>>(to_coord(low), background, false);
  bool any = false;
  for (int i = 0; i < VoxelBlock::count; ++i) {
    if (!active(i)) continue;
    leaf->setValueOn(static_cast<openvdb::Index>(i), values[static_cast<std::size_t>(i)]);
    any = true;
  }
  return any ? std::move(leaf) : nullptr;
}

}  // namespace

struct VoxelBlocks::Parts {
  std::mutex mutex;
  Leaves<openvdb::BoolGrid> state;
  Leaves<openvdb::FloatGrid> distance, weight;
  Leaves<openvdb::Int32Grid> normal;
  std::vector<openvdb::CoordBBox> empty;
};

VoxelBlocks::VoxelBlocks(const VolumeFrame& frame) : frame_(frame), parts_(std::make_unique<Parts>()) {
  prepare_openvdb();
}

VoxelBlocks::~VoxelBlocks() = default;

void VoxelBlocks::add(const VoxelBlock& block) {
  const auto has = [&](VoxelState state) {
    return std::find(block.state.begin(), block.state.end(), state) != block.state.end();
  };
  const bool seen = has(VoxelState::seen), unseen = has(VoxelState::unseen), empty = has(VoxelState::empty);
  if (!seen && !empty) return;
  if (!seen && !unseen) return add_empty(block.low, VoxelBlock::side);

  const auto state_of = [&](int i) { return block.state[static_cast<std::size_t>(i)]; };
  auto state = std::make_unique<Leaf<openvdb::BoolGrid>>(to_coord(block.low), false, false);
  for (int i = 0; i < VoxelBlock::count; ++i) {
    const auto at = static_cast<openvdb::Index>(i);
    if (state_of(i) == VoxelState::seen) state->setValueOn(at, false);
    if (state_of(i) == VoxelState::empty) state->setValueOff(at, true);
  }
  const auto is_seen = [&](int i) { return state_of(i) == VoxelState::seen; };
  const auto has_normal = [&](int i) { return is_seen(i) && block.normal[static_cast<std::size_t>(i)] != 0; };
  const float ramp = static_cast<float>(frame_.ramp);
  auto distance = make_leaf<openvdb::FloatGrid>(block.low, block.distance, ramp, is_seen);
  auto weight = make_leaf<openvdb::FloatGrid>(block.low, block.weight, 0, is_seen);
  auto normal = make_leaf<openvdb::Int32Grid>(block.low, block.normal, 0, has_normal);

  const std::lock_guard<std::mutex> lock(parts_->mutex);
  parts_->state.leaves.push_back(std::move(state));
  if (distance) parts_->distance.leaves.push_back(std::move(distance));
  if (weight) parts_->weight.leaves.push_back(std::move(weight));
  if (normal) parts_->normal.leaves.push_back(std::move(normal));
}

void VoxelBlocks::add_empty(const VoxelIndex& low, int side) {
  const VoxelBox box = frame_.box.common({low, low + VoxelIndex::Constant(side - 1)});
  if (box.empty()) return;
  const std::lock_guard<std::mutex> lock(parts_->mutex);
  parts_->empty.push_back(to_coord_box(box));
}

RangeVolume VoxelBlocks::finish(const Progress& progress) {
  auto state = openvdb::BoolGrid::create(true);
  auto distance = openvdb::FloatGrid::create(static_cast<float>(frame_.ramp));
  auto weight = openvdb::FloatGrid::create(0);
  auto normal = openvdb::Int32Grid::create(0);
  state->tree().sparseFill(to_coord_box(frame_.box), false, false);
  for (std::size_t i = 0; i < parts_->empty.size(); ++i) {
    if (i % between_checks == 0) progress.check();
    state->tree().sparseFill(parts_->empty[i], true, false);
  }
  progress.update(0.2);
  parts_->state.hand_over(*state, progress);
  progress.update(0.4);
  parts_->distance.hand_over(*distance, progress);
  progress.update(0.6);
  parts_->weight.hand_over(*weight, progress);
  progress.update(0.8);
  parts_->normal.hand_over(*normal, progress);
  openvdb::tools::prune(state->tree());
  VolumeGrids grids{state, distance, weight, normal};
  return RangeVolume(frame_, std::make_shared<const VolumeGrids>(std::move(grids)));
}

}  // namespace meshcomplete
