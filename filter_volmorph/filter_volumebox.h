// Which part of a volume a filter changes: parameters, and the box that they mean.
#pragma once

#include <vector>

#include "common/host/filter_declaration.h"
#include "filter_volmorph/range_volume.h"

namespace meshcomplete {
namespace host {

/// "Box", "BoxFrom", "BoxTo" and "SliceLayer".
std::vector<ParameterDeclaration> box_parameters();

/// The voxels that these parameters choose of the volume in `layer`, cut to the volume. Throws
/// CompletionError when there are none, when voxels are not given as whole numbers, or when no slice of the
/// volume has selected faces though the selection is to choose.
VoxelBox wanted_box(const FilterRun& run, const MeshModel& layer);

/// The voxels under the selected faces of the slice layer that is given, or, without one, of the only slice
/// of `volume` with a selection: their bounding rectangle, through the whole depth. Throws CompletionError
/// when there is no such layer or no selected face.
VoxelBox selected_box(const FilterRun& run, const MeshModel& volume, const MeshModel* slice);

}  // namespace host
}  // namespace meshcomplete
