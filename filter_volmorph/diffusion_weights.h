// How much each neighbour counts when distances diffuse.
#pragma once

#include <cstdint>
#include <vector>

#include "common/core/progress.h"
#include "filter_volmorph/diffusion_blocks.h"

namespace meshcomplete {

/// A value of each voxel of a block and of those around it; BlockValues::number says where.
template <class Value>
using Halo = std::array<Value, BlockValues::count>;

/// Fills `halo` with `value(block, number)` of all blocks around, and `nothing` where there is no block.
template <class Value, class Read>
void gather(const std::vector<DiffusionBlock>& blocks, const DiffusionBlock& centre, Value nothing,
            Halo<Value>& halo, Read&& value) {
  const auto first = [](int step) { return step < 0 ? block_side - 1 : 0; };
  const auto last = [](int step) { return step > 0 ? 0 : block_side - 1; };
  for (int place = 0; place < 27; ++place) {
    const int dx = place / 9 - 1, dy = place / 3 % 3 - 1, dz = place % 3 - 1;
    const std::int32_t number = centre.neighbours[place];
    for (int x = first(dx); x <= last(dx); ++x)
      for (int y = first(dy); y <= last(dy); ++y)
        for (int z = first(dz); z <= last(dz); ++z)
          halo[BlockValues::number(x + block_side * dx, y + block_side * dy, z + block_side * dz)] =
              number < 0 ? nothing : value(blocks[number], block_number(x, y, z));
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
