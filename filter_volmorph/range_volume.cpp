#include "filter_volmorph/range_volume.h"

#include <openvdb/tools/Prune.h>

#include <algorithm>
#include <cmath>
#include <mutex>
#include <stdexcept>
#include <utility>

#include "filter_volmorph/volume_grids.h"

namespace meshcomplete {
namespace {

constexpr int normal_bits = 10;
constexpr int largest_part = (1 << (normal_bits - 1)) - 1;
constexpr int part_mask = (1 << normal_bits) - 1;

std::uint64_t unseen_voxels(const openvdb::BoolTree& states) {
  std::uint64_t count = 0;
  for (auto leaf = states.cbeginLeaf(); leaf; ++leaf)
    count += static_cast<std::uint64_t>(count_bits(unseen_bits(*leaf)));
  auto tile = states.cbeginValueOff();
  tile.setMaxDepth(openvdb::BoolTree::ValueOffCIter::LEAF_DEPTH - 1);
  for (; tile; ++tile)
    if (!tile.getValue()) count += tile.getVoxelCount();
  return count;
}

}  // namespace

RangeVolume::RangeVolume(const VolumeFrame& frame, std::shared_ptr<const VolumeGrids> grids)
    : frame_(frame), grids_(std::move(grids)) {}

Voxel RangeVolume::at(const VoxelIndex& voxel) const {
  if (!frame_.box.contains(voxel)) throw std::out_of_range("a voxel outside the volume");
  return VoxelReader(*this).voxel(to_coord(voxel));
}

VolumeCounts RangeVolume::counts() const {
  const VoxelIndex size = frame_.box.size();
  VolumeCounts counts;
  counts.seen = grids_->state->activeVoxelCount();
  counts.unseen = unseen_voxels(grids_->state->tree());
  const std::uint64_t all = std::uint64_t(size.x()) * std::uint64_t(size.y()) * std::uint64_t(size.z());
  counts.empty = all - counts.seen - counts.unseen;
  counts.filled = grids_->distance->activeVoxelCount() - counts.seen;
  return counts;
}

std::size_t RangeVolume::memory() const {
  return grids_->state->memUsage() + grids_->distance->memUsage() + grids_->weight->memUsage() +
         grids_->normal->memUsage();
}

std::int32_t pack_normal(const Eigen::Vector3f& normal) {
  const float longest = normal.cwiseAbs().maxCoeff();
  std::int32_t packed = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const int part = static_cast<int>(std::lround(normal[axis] / longest * largest_part));
    packed |= (part & part_mask) << (axis * normal_bits);
  }
  return packed;
}

Eigen::Vector3f unpack_normal(std::int32_t packed) {
  Eigen::Vector3f normal;
  for (int axis = 0; axis < 3; ++axis) {
    const int part = (packed >> (axis * normal_bits)) & part_mask;
    normal[axis] = static_cast<float>(part > largest_part ? part - part_mask - 1 : part);
  }
  return normal.normalized();
}

void prepare_openvdb() {
  static std::once_flag once;
  std::call_once(once, [] { openvdb::initialize(); });
}

VoxelReader::VoxelReader(const RangeVolume& volume)
    : state_(volume.grids().state->getConstAccessor()),
      distance_(volume.grids().distance->getConstAccessor()),
      weight_(volume.grids().weight->getConstAccessor()),
      normal_(volume.grids().normal->getConstAccessor()),
      ramp_(static_cast<float>(volume.frame().ramp)) {}

VolumeBuilder::VolumeBuilder(const VolumeFrame& frame) : frame_(frame) {
  prepare_openvdb();
  state_ = openvdb::BoolGrid::create(true);
  distance_ = openvdb::FloatGrid::create(static_cast<float>(frame.ramp));
  weight_ = openvdb::FloatGrid::create(0);
  normal_ = openvdb::Int32Grid::create(0);
  fill(frame.box, VoxelState::unseen);
}

void VolumeBuilder::set(const VoxelIndex& at, const Voxel& voxel) {
  const openvdb::Coord coord = to_coord(at);
  if (voxel.state != VoxelState::seen) {
    state_->tree().setValueOff(coord, voxel.state == VoxelState::empty);
    distance_->tree().setValueOff(coord);
    weight_->tree().setValueOff(coord, 0);
    normal_->tree().setValueOff(coord, 0);
    return;
  }
  state_->tree().setValueOn(coord, false);
  distance_->tree().setValueOn(coord, voxel.distance);
  weight_->tree().setValueOn(coord, voxel.weight);
  if (voxel.normal)
    normal_->tree().setValueOn(coord, pack_normal(*voxel.normal));
  else
    normal_->tree().setValueOff(coord, 0);
}

void VolumeBuilder::fill(const VoxelBox& box, VoxelState state) {
  const VoxelBox inside = box.common(frame_.box);
  if (inside.empty()) return;
  const openvdb::CoordBBox coords = to_coord_box(inside);
  state_->tree().sparseFill(coords, state == VoxelState::empty, state == VoxelState::seen);
  distance_->tree().sparseFill(coords, 0, false);
  weight_->tree().sparseFill(coords, 0, false);
  normal_->tree().sparseFill(coords, 0, false);
}

RangeVolume VolumeBuilder::finish() {
  openvdb::tools::prune(state_->tree());
  openvdb::tools::pruneInactive(distance_->tree());
  openvdb::tools::pruneInactive(weight_->tree());
  openvdb::tools::pruneInactive(normal_->tree());
  VolumeGrids grids{state_, distance_, weight_, normal_};
  return RangeVolume(frame_, std::make_shared<const VolumeGrids>(std::move(grids)));
}

}  // namespace meshcomplete
