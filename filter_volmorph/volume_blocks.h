// A volume in blocks of 8 x 8 x 8 voxels, as its grids store it: for what goes over all of it.
#pragma once

#include <array>
#include <bitset>
#include <memory>
#include <vector>

#include "common/core/progress.h"
#include "filter_volmorph/block_bits.h"
#include "filter_volmorph/range_volume.h"

namespace meshcomplete {

/// The block that a voxel lies in. Block b begins at voxel `block_size * b`.
inline VoxelIndex block_of(const VoxelIndex& voxel) {
  return voxel.unaryExpr(
      [](int x) { return x >= 0 ? x / block_size : -((block_size - 1 - x) / block_size); });
}

/// The order in which blocks are kept: x, then y, then z.
inline bool block_before(const VoxelIndex& a, const VoxelIndex& b) {
  if (a.x() != b.x()) return a.x() < b.x();
  return a.y() != b.y() ? a.y() < b.y() : a.z() < b.z();
}

/// A block and the voxels round it.
struct BlockValues {
  static constexpr int side = block_size + 2;
  static constexpr int count = side * side * side;
  /// x, y and z from -1 to 8, counted from the block's first voxel.
  static constexpr int number(int x, int y, int z) { return ((x + 1) * side + y + 1) * side + z + 1; }

  std::array<float, count> distance;  ///< as Voxel's
  std::bitset<count> seen;
};

/// Reads blocks. For one thread.
class BlockReader {
 public:
  explicit BlockReader(const RangeVolume& volume);
  ~BlockReader();

  /// Outside the volume's box all is empty.
  void read(const VoxelIndex& block, BlockValues& values);

 private:
  struct Grids;
  std::unique_ptr<Grids> grids_;
};

/// All blocks (in order) such that it or one of the seven above it holds a distance below 0 and another one
/// not: every pair of such voxels next to each other is in the 9 x 9 x 9 voxels from a block's first one on.
/// Some of the blocks may have no such pair. Cost: proportional to the leaves and to the surface of constant
/// tiles; threaded.
std::vector<VoxelIndex> blocks_with_sign_changes(const RangeVolume& volume,
                                                 const Progress& progress = Progress());

}  // namespace meshcomplete
