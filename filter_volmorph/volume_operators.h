// Operators on the states of a volume's voxels, after Firestone 2008, section 3.3: erosion, dilation and the
// expansion of the isosurface.
#pragma once

#include <cstdint>

#include "common/core/progress.h"
#include "filter_volmorph/range_volume.h"

namespace meshcomplete {

struct OperatorResult {
  RangeVolume volume;
  std::uint64_t changed = 0;  ///< voxels
};

// All of them read the volume as it was and write a new one (double buffering). The box is cut to the volume;
// CompletionError when nothing of it lies there. Neighbours outside the volume do not count, those outside
// the box do. Grids that stay as they are are shared with the volume that was given; where nothing changes,
// all are.

/// Erosion `e`: an unseen voxel of the box that has an empty 6-neighbour becomes empty, at distance +ramp.
/// Seen voxels stay as they are. Cost: proportional to the leaves of the states' grid and to the surface of
/// its unseen tiles, not to the volume.
OperatorResult erode(const RangeVolume& volume, const VoxelBox& box, const Progress& progress);

/// Dilation `d`: an empty voxel of the box that has an unseen 6-neighbour becomes unseen, at distance -ramp.
/// Otherwise like `erode`.
OperatorResult dilate(const RangeVolume& volume, const VoxelBox& box, const Progress& progress);

/// Isosurface expansion `x`: a seen voxel of the box that has a normal gives its distance, weight and normal
/// to those of its 26 neighbours that are unseen or empty and lie beside it along the surface: the direction
/// to them and the normal enclose between 67.5 and 112.5 degrees. They become seen; they may lie one voxel
/// outside the box, but not outside the volume. Where several voxels give to one, the last of them in the
/// order z, y, x (x fastest) wins. Cost: proportional to the leaves with normals, and one copy of the grids.
OperatorResult expand_isosurface(const RangeVolume& volume, const VoxelBox& box, const Progress& progress);

}  // namespace meshcomplete
