// Whether a volume's grids are what volume_grids.h says.
#pragma once

#include <optional>
#include <string>

#include "common/core/progress.h"
#include "filter_volmorph/range_volume.h"

namespace meshcomplete {

/// The first fault of the frame, or nothing: 1. voxel size, ramp and origin are finite, the first two above
/// 0;
/// 2. the box has voxels, whose numbers are below 2^28.
std::optional<std::string> frame_fault(const VolumeFrame& frame);

/// The first fault, or nothing: 3. outside the box nothing is stored; 4. every seen voxel has a distance;
/// 5. only seen voxels have weights and normals; 6. distances and weights are finite, weights not below 0,
/// normals not zero. Cost: proportional to the leaves.
std::optional<std::string> volume_fault(const RangeVolume& volume, const Progress& progress);

}  // namespace meshcomplete
