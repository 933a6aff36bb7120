// The distances that a filler has stored, where states change.
#pragma once

#include <vector>

#include "common/core/progress.h"
#include "filter_volmorph/block_bits.h"
#include "filter_volmorph/range_volume.h"

namespace meshcomplete {

/// Voxels of a block that changed from unseen to empty, or back.
struct StateChange {
  VoxelIndex lowest;  ///< of the block
  BlockBits bits;
};

/// Forgets the distances stored at the voxels that changed; no block is named twice. The same grid stays
/// where there are none. Cost: proportional to `changes`, and one copy of the distances when some go.
void reset_filler_distances(VolumeGrids& grids, const std::vector<StateChange>& changes,
                            const Progress& progress = Progress());

/// The same for all voxels that changed from `before` to `grids`, for changes of large regions at once. Cost:
/// proportional to the leaves with distances.
void reset_filler_distances(const VolumeGrids& before, VolumeGrids& grids,
                            const Progress& progress = Progress());

}  // namespace meshcomplete
