// The voxels at the observed surface: what a volume's layer shows.
#pragma once

#include <vector>

#include "filter_volmorph/range_volume.h"

namespace meshcomplete {

struct SurfaceVoxel {
  Vector3 position;  ///< its middle, mesh units
  Vector3 normal;    ///< zero where the voxel has none
  float weight;
};

/// The seen voxels whose middles are at most half a voxel from the surface, by z, y, x within the leaves of
/// the grid. Cost: proportional to the leaves.
std::vector<SurfaceVoxel> surface_voxels(const RangeVolume& volume);

}  // namespace meshcomplete
