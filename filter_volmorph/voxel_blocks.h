// A volume put together from blocks of eight voxels a side, in any order and from many threads.
#pragma once

#include <array>
#include <cstdint>
#include <memory>

#include "common/core/progress.h"
#include "filter_volmorph/block_bits.h"
#include "filter_volmorph/range_volume.h"

namespace meshcomplete {

/// All that is known of 8 x 8 x 8 voxels. Voxel (x, y, z) from the low corner is number 64 x + 8 y + z.
struct VoxelBlock {
  static constexpr int side = block_size;
  static constexpr int count = side * side * side;
  static constexpr int number(int x, int y, int z) { return (x * side + y) * side + z; }

  VoxelIndex low = VoxelIndex::Zero();  ///< of multiples of 8
  std::array<VoxelState, count> state{};
  // Of seen voxels only:
  std::array<float, count> distance{};
  std::array<float, count> weight{};
  std::array<std::int32_t, count> normal{};  ///< as `pack_normal`; 0: none
};

/// Blocks and uniform cubes that do not overlap; whatever is not set is unseen. The frame's box starts at a
/// multiple of 8 along every axis and has whole blocks only.
class VoxelBlocks {
 public:
  explicit VoxelBlocks(const VolumeFrame& frame);
  ~VoxelBlocks();

  /// Safe from many threads; the volume does not depend on the order.
  void add(const VoxelBlock& block);
  /// A cube that is empty; what is outside the volume's box is left out. Safe from many threads.
  void add_empty(const VoxelIndex& low, int side);

  /// The volume. This object is of no use afterwards. Throws `Cancelled`.
  RangeVolume finish(const Progress& progress = Progress());

 private:
  struct Parts;
  VolumeFrame frame_;
  std::unique_ptr<Parts> parts_;
};

}  // namespace meshcomplete
