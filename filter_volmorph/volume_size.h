// How large a volume has to be for some surfaces, and whether it fits into memory.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "common/core/mesh.h"
#include "common/core/progress.h"
#include "filter_volmorph/range_volume.h"

namespace meshcomplete {

struct VolumeSizeOptions {
  double voxel_size = 0;         ///< side of a voxel, mesh units, above 0; must be given
  std::optional<double> ramp;    ///< mesh units, at least a voxel; absent: four voxels
  std::optional<double> margin;  ///< between the ramp and the box, mesh units, at least 0; absent: two voxels
  double max_memory = 4e9;       ///< bytes that the volume may take, above 0
};

/// Throws CompletionError on options out of range.
void check_options(const VolumeSizeOptions& options);

/// The ramp that the options mean, mesh units.
double ramp_of(const VolumeSizeOptions& options);

/// The frame of a volume for some surfaces: their triangles, the ramp and the margin lie in its box. Voxel
/// middles are at multiples of the voxel size, voxel (0, 0, 0) is the box's low corner, and the box is grown
/// upwards to whole leaves of eight voxels, so that uniform parts need no leaves. Throws CompletionError when
/// the volume would need more memory than allowed, or be longer than 2^20 voxels: the message says how much
/// that is and which voxel size would fit; and Cancelled. Cost: O(triangles); the surface is only looked at
/// coarsely.
VolumeFrame choose_frame(const std::vector<const TriangleMesh*>& surfaces, const VolumeSizeOptions& options,
                         const Progress& progress = Progress());

/// Of the blocks that may be near a scan's surface as many turn out to have seen voxels (0.55 to 0.6 on real
/// scans).
constexpr double seen_share_of_scans = 0.6;

/// Throws the error of `choose_frame` when so many blocks of eight voxels a side, of which the given share
/// has seen voxels, make a volume that is too large: for callers that know it by now, before they fill them.
void check_memory(std::size_t near_blocks, const VolumeSizeOptions& options,
                  double seen_share = seen_share_of_scans);

}  // namespace meshcomplete
