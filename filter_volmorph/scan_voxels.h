// The voxels of a volume as prepared scans see them: the merge itself.
#pragma once

#include <vector>

#include "common/core/mesh.h"
#include "common/core/progress.h"
#include "filter_volmorph/range_volume.h"
#include "filter_volmorph/scan_view.h"
#include "filter_volmorph/scan_weights.h"
#include "filter_volmorph/volume_size.h"

namespace meshcomplete {

/// A scan ready for merging. The views' unit of length is a voxel, and their origin voxel (0, 0, 0).
struct PreparedScan {
  std::vector<ScanView> views;
  ScanWeights weights;
};

struct ScanVoxelOptions {
  bool carving = true;       ///< as in ScanMergeOptions
  double full_behind = 0.5;  ///< as in ScanMergeOptions
};

/// Finds from large blocks down to small ones which are uniform, and asks for the lines of sight of the
/// voxels in the others. Throws CompletionError when the blocks near surfaces take more memory than `size`
/// allows, and Cancelled.
RangeVolume merge_voxels(const std::vector<PreparedScan>& scans, const VolumeFrame& frame,
                         const VolumeSizeOptions& size, const ScanVoxelOptions& options,
                         const Progress& progress);

}  // namespace meshcomplete
