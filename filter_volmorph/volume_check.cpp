#include "filter_volmorph/volume_check.h"

#include <openvdb/tree/LeafManager.h>

#include <atomic>
#include <cmath>
#include <cstdint>

#include "common/core/parameter_checks.h"
#include "common/core/threads.h"
#include "filter_volmorph/volume_grids.h"

namespace meshcomplete {
namespace {

constexpr int largest_voxel_number = 1 << 28;
constexpr std::size_t leaves_per_range = 256;

/// Whether every value that is not idle (`idle(active, value)`) lies in the box.
template <class Tree, class Idle>
bool keeps_to(const Tree& tree, const openvdb::CoordBBox& box, Idle&& idle) {
  if (!idle(false, tree.background())) return false;
  for (auto leaf = tree.cbeginLeaf(); leaf; ++leaf) {
    if (box.isInside(leaf->getNodeBoundingBox())) continue;
    for (auto value = leaf->cbeginValueAll(); value; ++value)
      if (!idle(value.isValueOn(), value.getValue()) && !box.isInside(value.getCoord())) return false;
  }
  auto tile = tree.cbeginValueAll();
  tile.setMaxDepth(Tree::ValueAllCIter::LEAF_DEPTH - 1);
  for (; tile; ++tile)
    if (!idle(tile.isValueOn(), tile.getValue()) && !box.isInside(tile.getBoundingBox())) return false;
  return true;
}

/// Whether what is active in `part` is active in `whole`.
template <class Part, class Whole>
bool lies_in(const Part& part, const Whole& whole) {
  openvdb::MaskTree beyond(part, false, true, openvdb::TopologyCopy());
  beyond.topologyDifference(whole);
  return beyond.activeVoxelCount() == 0;
}

/// Whether all active values are good.
template <class Tree, class Good>
bool all_values(const Tree& tree, const Progress& progress, Good&& good) {
  std::atomic<bool> all{true};
  const openvdb::tree::LeafManager<const Tree> leaves(tree);
  for_ranges(leaves.leafCount(), leaves_per_range, progress, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      for (auto value = leaves.leaf(i).cbeginValueOn(); value; ++value)
        if (!good(value.getValue())) all = false;
  });
  auto tile = tree.cbeginValueOn();
  tile.setMaxDepth(Tree::ValueOnCIter::LEAF_DEPTH - 1);
  for (; tile; ++tile)
    if (!good(tile.getValue())) all = false;
  return all;
}

}  // namespace

std::optional<std::string> frame_fault(const VolumeFrame& frame) {
  if (!positive(frame.voxel_size)) return "its voxel size is not a number greater than 0";
  if (!positive(frame.ramp)) return "its ramp is not a number greater than 0";
  if (!frame.origin.allFinite()) return "its origin is not a point";
  if (frame.box.empty()) return "its box has no voxels";
  if (frame.box.low.minCoeff() < -largest_voxel_number || frame.box.high.maxCoeff() > largest_voxel_number)
    return "its box is too large";
  // Whose voxels cannot be counted.
  const VoxelIndex size = frame.box.size();
  std::uint64_t voxels = 0;
  if (__builtin_mul_overflow(static_cast<std::uint64_t>(size.x()), static_cast<std::uint64_t>(size.y()),
                             &voxels) ||
      __builtin_mul_overflow(voxels, static_cast<std::uint64_t>(size.z()), &voxels))
    return "its box is too large";
  return {};
}

std::optional<std::string> volume_fault(const RangeVolume& volume, const Progress& progress) {
  const VolumeGrids& grids = volume.grids();
  const auto& state = grids.state->tree();
  const auto& distance = grids.distance->tree();
  const auto& weight = grids.weight->tree();
  const auto& normal = grids.normal->tree();
  const openvdb::CoordBBox box = to_coord_box(volume.frame().box);
  const auto inactive = [](bool active, auto) { return !active; };
  const auto zero = [](bool active, auto value) { return !active && value == 0; };
  if (!keeps_to(state, box, [](bool active, bool empty) { return !active && empty; }) ||
      !keeps_to(distance, box, inactive) || !keeps_to(weight, box, zero) || !keeps_to(normal, box, zero))
    return "there are voxels outside its box";
  progress.update(0.3);
  if (!lies_in(state, distance)) return "there are seen voxels without a distance";
  progress.update(0.5);
  if (!lies_in(weight, state) || !lies_in(normal, state))
    return "there are weights or normals at voxels that are not seen";
  progress.update(0.7);
  if (!all_values(distance, progress, [](float value) { return std::isfinite(value); }))
    return "there are distances that are not finite";
  if (!all_values(weight, progress, [](float value) { return std::isfinite(value) && value >= 0; }))
    return "there are weights below 0 or not finite";
  progress.update(0.9);
  if (!all_values(normal, progress, [](std::int32_t value) { return value != 0; }))
    return "there are normals of length 0";
  progress.update(1);
  return {};
}

}  // namespace meshcomplete
