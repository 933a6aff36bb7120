// Sets of voxels of one block of 8 x 8 x 8 as bits: what the operators compute with.
#pragma once

#include <array>
#include <cstdint>

#include "filter_volmorph/range_volume.h"

namespace meshcomplete {

/// Voxels along a block's edge. Blocks are aligned: the lowest voxel's numbers are multiples of this. They
/// are the leaves of the volume's grids.
constexpr int block_size = 8;

/// One word for each x of the block; bit 8 y + z of it is the voxel (x, y, z). The order of OpenVDB's leaves.
using BlockBits = std::array<std::uint64_t, block_size>;

/// The voxels of the block with the given lowest voxel that lie in the box.
BlockBits bits_in_box(const VoxelIndex& lowest, const VoxelBox& box);

bool any_bit(const BlockBits& bits);
int count_bits(const BlockBits& bits);
BlockBits operator&(const BlockBits& a, const BlockBits& b);

/// A block's bits, and those of the blocks before (0) and behind it (1) along every axis.
struct BlockWithFaces {
  BlockBits own{};
  std::array<std::array<BlockBits, 2>, 3> beside{};
};

/// The voxels of the block that have a 6-neighbour whose bit is set.
BlockBits bits_beside(const BlockWithFaces& block);

/// The bits of a block and of the voxels round it, for questions about 26 neighbours.
class WideBlock {
 public:
  /// Bits of the block that is `step` (-1, 0 or 1 along every axis) blocks away.
  void set(const VoxelIndex& step, const BlockBits& bits);

  /// Whether the bit of a voxel is set; numbers from -1 to 8, the block's own from 0 to 7.
  bool has(int x, int y, int z) const { return (rows_[x + 1][y + 1] >> (z + 1) & 1) != 0; }

  /// The voxels of the block whose bit, or that of one of their 26 neighbours, is set.
  BlockBits near() const;

 private:
  std::array<std::array<std::uint16_t, block_size + 2>, block_size + 2>
      rows_{};  ///< bit z + 1 of [x + 1][y + 1]
};

/// Calls `visit(x, y, z)` for every bit, in the order of the words.
template <class Visit>
void for_each_bit(const BlockBits& bits, Visit&& visit) {
  for (int x = 0; x < block_size; ++x) {
    for (std::uint64_t left = bits[x]; left != 0; left &= left - 1) {
      const int bit = __builtin_ctzll(left);
      visit(x, bit / block_size, bit % block_size);
    }
  }
}

}  // namespace meshcomplete
