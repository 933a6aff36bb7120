#include "filter_volmorph/scan_voxels.h"

#include <algorithm>
#include <cstdint>
#include <utility>

#include "common/core/threads.h"
#include "filter_volmorph/block_descent.h"
#include "filter_volmorph/voxel_blocks.h"

namespace meshcomplete {
namespace {

/// Voxels of a block are looked at in parts of this side, since half of a block is often uniform.
constexpr int part_side = 4;

/// Weighted normals whose sum is shorter than this part of the weights do not say where the surface looks to:
/// those of the two sides of a thin wall.
constexpr double least_normal = 0.1;

constexpr std::size_t blocks_at_once = 32;

/// One image of one scan.
struct View {
  const ScanView* view;
  const ScanWeights* weights;
};

/// A cube of voxels of which not everything is known yet.
struct Block {
  VoxelIndex low;
  bool empty = false;                ///< a scan looked through all of it
  bool near = false;                 ///< a surface may be near
  std::vector<std::uint32_t> views;  ///< numbers of those that may know more, ascending
};

/// What is summed up of a block's voxels.
struct Sums {
  std::array<double, VoxelBlock::count> weight{}, distance{};
  std::array<Vector3, VoxelBlock::count> normal;
  std::array<bool, VoxelBlock::count> empty{};
};

class Merger {
 public:
  Merger(const std::vector<PreparedScan>& scans, const VolumeFrame& frame, const ScanVoxelOptions& options)
      : frame_(frame), options_(options), ramp_(frame.ramp / frame.voxel_size), blocks_(frame) {
    for (const PreparedScan& scan : scans)
      for (const ScanView& view : scan.views) views_.push_back({&view, &scan.weights});
  }

  RangeVolume run(const VolumeSizeOptions& size, const Progress& progress) {
    std::vector<Block> blocks = descend_to_blocks(
        frame_.box, everything(),
        [&](std::vector<Block>& all, std::size_t begin, std::size_t end, int side,
            std::vector<char>& undecided) {
          for (std::size_t i = begin; i < end; ++i) {
            look(all[i], side);
            undecided[i] = !all[i].views.empty();
            if (!undecided[i] && all[i].empty) blocks_.add_empty(all[i].low, side);
          }
        },
        progress.part(0, 0.1, "finding the blocks near the surfaces"));
    check_memory(static_cast<std::size_t>(
                     std::count_if(blocks.begin(), blocks.end(), [](const Block& b) { return b.near; })),
                 size);
    const Progress filling = progress.part(0.1, 0.95, "merging the scans");
    for_ranges(blocks.size(), blocks_at_once, filling, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        fill(blocks[i]);
        filling.advance(1.0 / static_cast<double>(blocks.size()));
      }
    });
    blocks = {};
    progress.part(0.95, 1, "putting the volume together").update(0);
    RangeVolume volume = blocks_.finish();
    progress.update(1);
    return volume;
  }

 private:
  /// A cube that every view may know of.
  Block everything() const {
    Block block;
    for (std::uint32_t v = 0; v < views_.size(); ++v) block.views.push_back(v);
    return block;
  }

  /// Narrows the views of a block down to those that may know more of it than that it is empty.
  void look(Block& block, int side) const {
    const double half = (side - 1) / 2.0;
    const Vector3 middle = block.low.cast<double>().array() + half;
    std::vector<std::pair<std::uint32_t, BlockView>> seen;
    for (const std::uint32_t v : block.views) {
      const BlockView view = views_[v].view->look(middle, half, ramp_);
      if (view == BlockView::empty) block.empty = block.empty || options_.carving;
      if (view == BlockView::near || view == BlockView::partly_empty) seen.emplace_back(v, view);
    }
    block.views.clear();
    block.near = false;
    for (const auto& [v, view] : seen) {
      if (view == BlockView::partly_empty && (block.empty || !options_.carving)) continue;
      block.views.push_back(v);
      block.near = block.near || view == BlockView::near;
    }
    block.views.shrink_to_fit();
  }

  /// What a view knows of one voxel.
  void add(const View& view, const Vector3& voxel, int at, Sums& sums) const {
    const Sighting sighting = view.view->sight(voxel, ramp_);
    const auto i = static_cast<std::size_t>(at);
    if (sighting.view == BlockView::empty) sums.empty[i] = sums.empty[i] || options_.carving;
    if (sighting.view != BlockView::near) return;
    const SightHit& hit = sighting.hit;
    double weight = 0;
    Vector3 normal = Vector3::Zero();
    for (std::size_t k = 0; k < 3; ++k) {
      weight += hit.parts[k] * view.weights->weights[hit.corners[k]];
      normal += hit.parts[k] * view.weights->normals[hit.corners[k]].cast<double>();
    }
    const double behind = -hit.distance / ramp_;
    if (behind > options_.full_behind) weight *= (1 - behind) / (1 - options_.full_behind);
    sums.weight[i] += weight;
    sums.distance[i] += weight * hit.distance;
    sums.normal[i] += weight * normal;
  }

  void add(const View& view, const VoxelIndex& low, const VoxelIndex& part, Sums& sums) const {
    const double half = (part_side - 1) / 2.0;
    const Vector3 middle = (low + part).cast<double>().array() + half;
    const BlockView known = view.view->look(middle, half, ramp_);
    if (known == BlockView::nothing || (known != BlockView::near && !options_.carving)) return;
    for (int x = part.x(); x < part.x() + part_side; ++x) {
      for (int y = part.y(); y < part.y() + part_side; ++y) {
        for (int z = part.z(); z < part.z() + part_side; ++z) {
          const int at = VoxelBlock::number(x, y, z);
          bool& empty = sums.empty[static_cast<std::size_t>(at)];
          if (known == BlockView::empty) {
            empty = true;
          } else if (known == BlockView::near || !empty) {
            add(view, (low + VoxelIndex(x, y, z)).cast<double>(), at, sums);
          }
        }
      }
    }
  }

  void fill(const Block& block) {
    Sums sums;
    sums.empty.fill(block.empty);
    sums.normal.fill(Vector3::Zero());
    for (const std::uint32_t v : block.views)
      for (int x = 0; x < VoxelBlock::side; x += part_side)
        for (int y = 0; y < VoxelBlock::side; y += part_side)
          for (int z = 0; z < VoxelBlock::side; z += part_side) add(views_[v], block.low, {x, y, z}, sums);
    blocks_.add(mean(block.low, sums));
  }

  VoxelBlock mean(const VoxelIndex& low, const Sums& sums) const {
    VoxelBlock block;
    block.low = low;
    const float ramp = static_cast<float>(frame_.ramp);
    for (std::size_t i = 0; i < VoxelBlock::count; ++i) {
      block.state[i] = sums.empty[i] ? VoxelState::empty : VoxelState::unseen;
      const float weight = static_cast<float>(sums.weight[i]);
      if (!(weight > 0)) continue;
      block.state[i] = VoxelState::seen;
      block.weight[i] = weight;
      const double distance = sums.distance[i] / sums.weight[i] * frame_.voxel_size;
      block.distance[i] = std::clamp(static_cast<float>(distance), -ramp, ramp);
      const double length = sums.normal[i].norm();
      if (length > least_normal * sums.weight[i]) {
        block.normal[i] = pack_normal((sums.normal[i] / length).cast<float>());
      }
    }
    return block;
  }

  const VolumeFrame& frame_;
  const ScanVoxelOptions& options_;
  double ramp_;  ///< voxels
  std::vector<View> views_;
  VoxelBlocks blocks_;
};

}  // namespace

RangeVolume merge_voxels(const std::vector<PreparedScan>& scans, const VolumeFrame& frame,
                         const VolumeSizeOptions& size, const ScanVoxelOptions& options,
                         const Progress& progress) {
  return Merger(scans, frame, options).run(size, progress);
}

}  // namespace meshcomplete
