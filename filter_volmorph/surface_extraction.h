// The surface of a volume as a mesh: where its distances are zero.
#pragma once

#include <cstddef>

#include "common/core/mesh.h"
#include "common/core/progress.h"
#include "filter_volmorph/range_volume.h"

namespace meshcomplete {

struct ExtractionOptions {
  /// Only between voxels that are seen: what no scanner observed stays a hole. Otherwise the surface goes
  /// between unseen and empty voxels there (VRIP's filler; Curless and Levoy 1996, section 4), and is closed.
  bool observed_only = false;

  /// Components with fewer faces are left out. 0 keeps all.
  std::size_t smallest_component = 0;
};

/// Marching cubes over the voxels' distances; a voxel is inside where its distance is below 0, and all voxels
/// outside the box are empty, so that the surface is also closed where the inside reaches the box. Every
/// coordinate is exactly a float; normals point outwards, from inside. The mesh is manifold, consistently
/// oriented, has no degenerate face and no two vertices at one position, and does not meet itself; it is
/// closed unless `observed_only`. A vertex lies on the edge between two voxels, at least 1/64 of a voxel from
/// either: the surface is moved by less than that. Throws CompletionError when floats are too coarse for the
/// voxels at their place in space, or the surface has 2^30 faces or more. Deterministic. Cost, memory too:
/// proportional to the surface (see `blocks_with_sign_changes`); threaded.
TriangleMesh extract_surface(const RangeVolume& volume, const ExtractionOptions& options,
                             const Progress& progress = Progress());

}  // namespace meshcomplete
