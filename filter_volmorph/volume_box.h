// Boxes of voxels that a user gives, in voxels or in world units.
#pragma once

#include "filter_volmorph/range_volume.h"

namespace meshcomplete {

/// The part of the box that lies in the volume. CompletionError, with the volume's bounds, when there is
/// none.
VoxelBox box_in_volume(const VolumeFrame& frame, const VoxelBox& box);

/// The voxels whose middles lie in the box between two corners (mesh units, both of it), whether or not they
/// lie in the volume; perhaps none. CompletionError when a number is not finite.
VoxelBox voxels_between(const VolumeFrame& frame, const Vector3& low, const Vector3& high);

}  // namespace meshcomplete
