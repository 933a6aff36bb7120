// The operators as plain loops over all voxels: what the sparse ones are compared with.
#pragma once

#include "filter_volmorph/volume_operators.h"
#include "tests/volmorph/volumes.h"

namespace meshcomplete {

/// Each gives the volume afterwards; the box is one of voxels, and may reach beyond the volume.
DenseVolume dense_erosion(const DenseVolume& volume, const VoxelBox& box);
DenseVolume dense_dilation(const DenseVolume& volume, const VoxelBox& box);
DenseVolume dense_expansion(const DenseVolume& volume, const VoxelBox& box);

/// Voxels that are not the same in every bit.
std::uint64_t count_differences(const DenseVolume& a, const DenseVolume& b);

}  // namespace meshcomplete
