#include "filter_volmorph/block_bits.h"

#include <algorithm>

namespace meshcomplete {
namespace {

constexpr std::uint64_t every_byte = 0x0101010101010101;
constexpr std::uint64_t low_z = every_byte;        ///< the bits with z = 0
constexpr std::uint64_t high_z = every_byte << 7;  ///< the bits with z = 7
constexpr int last = block_size - 1;

/// Bits `low` to `high`, both of 0 to 7.
std::uint64_t bit_range(int low, int high) { return (0xffu >> (last - high)) & (0xffu << low) & 0xffu; }

}  // namespace

BlockBits bits_in_box(const VoxelIndex& lowest, const VoxelBox& box) {
  BlockBits bits{};
  const VoxelIndex low = (box.low - lowest).cwiseMax(0);
  const VoxelIndex high = (box.high - lowest).cwiseMin(last);
  if ((high.array() < low.array()).any()) return bits;
  std::uint64_t plane = 0;
  for (int y = low.y(); y <= high.y(); ++y) plane |= bit_range(low.z(), high.z()) << (block_size * y);
  for (int x = low.x(); x <= high.x(); ++x) bits[x] = plane;
  return bits;
}

bool any_bit(const BlockBits& bits) {
  return std::any_of(bits.begin(), bits.end(), [](std::uint64_t word) { return word != 0; });
}

int count_bits(const BlockBits& bits) {
  int count = 0;
  for (const std::uint64_t word : bits) count += __builtin_popcountll(word);
  return count;
}

BlockBits operator&(const BlockBits& a, const BlockBits& b) {
  BlockBits both;
  for (int x = 0; x < block_size; ++x) both[x] = a[x] & b[x];
  return both;
}

BlockBits bits_beside(const BlockWithFaces& block) {
  BlockBits bits;
  for (int x = 0; x < block_size; ++x) {
    const std::uint64_t own = block.own[x];
    const auto& [before_y, behind_y] = block.beside[1];
    const auto& [before_z, behind_z] = block.beside[2];
    bits[x] = (x > 0 ? block.own[x - 1] : block.beside[0][0][last]) |
              (x < last ? block.own[x + 1] : block.beside[0][1][0]);
    bits[x] |= own << 8 | before_y[x] >> 56 | own >> 8 | behind_y[x] << 56;
    bits[x] |= (own << 1 & ~low_z) | (before_z[x] >> last & low_z);
    bits[x] |= (own >> 1 & ~high_z) | (behind_z[x] << last & high_z);
  }
  return bits;
}

void WideBlock::set(const VoxelIndex& step, const BlockBits& bits) {
  // Of a block beside this one only the layer counts that touches it.
  const VoxelIndex low = (step.array() < 0).select(VoxelIndex::Constant(last), VoxelIndex::Zero());
  const VoxelIndex high = (step.array() > 0).select(VoxelIndex::Zero(), VoxelIndex::Constant(last));
  for (int x = low.x(); x <= high.x(); ++x) {
    for (int y = low.y(); y <= high.y(); ++y) {
      const std::uint64_t row = bits[x] >> (block_size * y) & bit_range(low.z(), high.z());
      const std::uint64_t moved = step.z() < 0 ? row >> last : row << (1 + block_size * step.z());
      rows_[block_size * step.x() + x + 1][block_size * step.y() + y + 1] |=
          static_cast<std::uint16_t>(moved);
    }
  }
}

BlockBits WideBlock::near() const {
  BlockBits bits{};
  for (int x = 0; x < block_size; ++x) {
    for (int y = 0; y < block_size; ++y) {
      std::uint64_t rows = 0;
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) rows |= rows_[x + i][y + j];
      bits[x] |= ((rows | rows >> 1 | rows >> 2) & 0xff) << (block_size * y);
    }
  }
  return bits;
}

}  // namespace meshcomplete
