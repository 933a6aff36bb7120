// The distances that a filler has stored, where states change.
#pragma once

#include "common/core/progress.h"
#include "filter_volmorph/range_volume.h"

namespace meshcomplete {

/// Forgets the distances stored at voxels that changed from unseen to empty, or back, from `before` to
/// `grids`. The same grid stays where there are none. Cost: proportional to the leaves with distances.
void reset_filler_distances(const VolumeGrids& before, VolumeGrids& grids,
                            const Progress& progress = Progress());

}  // namespace meshcomplete
