// Volumes as .vdb files, which OpenVDB's own programs and others can open.
#pragma once

#include <string>

#include "common/core/progress.h"
#include "filter_volmorph/range_volume.h"

namespace meshcomplete {

/// Saves the four grids "distance", "weight", "normal" (three numbers of ten bits, `pack_normal`) and "state"
/// (volume_grids.h), with a transform that places them in the mesh's space, and what `VolumeFrame` has as the
/// file's metadata. The distances of voxels that are not stored are written as -ramp and +ramp, so that
/// "distance" is a signed distance field for other programs, too. Behind OpenVDB's content a seal follows
/// (file_seal.h). The file is written beside its place, under its name with ".part", and then moved there:
/// until all is written an older file stays. CompletionError when that cannot be done. Cost: one copy of the
/// distances in memory.
void save_volume(const RangeVolume& volume, const std::string& path, const Progress& progress);

/// The volume that was saved, every voxel the same in every bit. CompletionError when the file is not there,
/// is damaged, was not saved by `save_volume` (the message says which grids it has and lacks), is of another
/// version of the format, or contradicts itself.
RangeVolume open_volume(const std::string& path, const Progress& progress);

}  // namespace meshcomplete
