// How much each neighbour counts when distances diffuse.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "common/core/progress.h"
#include "filter_volmorph/diffusion_blocks.h"
#include "filter_volmorph/diffusion_kernels.h"

namespace meshcomplete {

/// Fills `halo` with the values of all blocks around, and `nothing` where there are none. `values(block)` is
/// a pointer to those of a block, by block_number, or null.
template <class Value, class Values>
void gather(const DiffusionBlock& centre, Value nothing, Halo<Value>& halo, Values&& values) {
  std::array<const Value*, 27> sources;
  for (std::size_t place = 0; place < sources.size(); ++place) {
    const std::int32_t number = centre.neighbours[place];
    sources[place] = number < 0 ? nullptr : values(static_cast<std::size_t>(number));
  }
  const auto copy = [&](int place, int from, int count, int to) {
    const Value* source = sources[static_cast<std::size_t>(place)];
    if (source == nullptr)
      std::fill_n(halo.begin() + to, count, nothing);
    else
      std::copy_n(source + from, count, halo.begin() + to);
  };
  for (int x = -1; x <= block_size; ++x)
    for (int y = -1; y <= block_size; ++y) {
      const int bx = x < 0 ? 0 : x < block_size ? 1 : 2, by = y < 0 ? 0 : y < block_size ? 1 : 2;
      const int row = block_number(x - block_size * (bx - 1), y - block_size * (by - 1), 0);
      const int place = bx * 9 + by * 3;
      copy(place, row + block_size - 1, 1, BlockValues::number(x, y, -1));
      copy(place + 1, row, block_size, BlockValues::number(x, y, 0));
      copy(place + 2, row, 1, BlockValues::number(x, y, block_size));
    }
}

/// Of the 26 neighbours, in the order of `DiffusionBlock::neighbours` without the voxel itself, for each
/// voxel of a block, above 0: nearer ones count more.
std::vector<std::uint8_t> weights_by_distance();

/// Spreads the normals from the seen voxels to all that are within reach of one and relaxes them, so that
/// they turn evenly from rim to rim, then gives every block that has voxels within its weights: by distance,
/// and more where the neighbour lies perpendicular to the normals at both voxels. The normals are gone
/// afterwards. Cost: two passes over the voxels within for each step of `reach`; threaded.
void make_weights_by_normals(std::vector<DiffusionBlock>& blocks, int reach,
                             const Progress& progress = Progress());

}  // namespace meshcomplete
