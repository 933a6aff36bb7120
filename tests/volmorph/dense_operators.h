// The operators as plain loops over all voxels: what the sparse ones are compared with.
#pragma once

#include "filter_volmorph/volume_diffusion.h"
#include "filter_volmorph/volume_operators.h"
#include "tests/volmorph/volumes.h"

namespace meshcomplete {

/// Each gives the volume afterwards; the box is one of voxels, and may reach beyond the volume.
DenseVolume dense_erosion(const DenseVolume& volume, const VoxelBox& box);
DenseVolume dense_dilation(const DenseVolume& volume, const VoxelBox& box);
DenseVolume dense_expansion(const DenseVolume& volume, const VoxelBox& box);

/// `diffuse` with `normals` off, in double precision. The distance of a voxel that is not seen is known, as
/// one that a filler has stored, when it is not the ramp's.
DenseVolume dense_diffusion(const DenseVolume& volume, const VoxelBox& box, const DiffusionOptions& options);

/// Voxels that are not the same in every bit.
std::uint64_t count_differences(const DenseVolume& a, const DenseVolume& b);

}  // namespace meshcomplete
