// A volume from a single mesh, closed or with holes.
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "common/core/mesh.h"
#include "common/core/progress.h"
#include "filter_volmorph/range_volume.h"
#include "filter_volmorph/volume_size.h"

namespace meshcomplete {

struct VoxelizedMesh {
  RangeVolume volume;
  VolumeCounts counts;
  std::size_t rim_edges = 0;  ///< edges with one face: where the surface is missing behind them
  std::vector<std::pair<std::string, double>> stage_seconds;
};

/// A volume of a mesh, as if it had been seen from all sides:
/// - seen: voxels within the ramp of the surface, with the distance to the nearest point of it, the normal
///   there (of the face, or at edges and vertices the mean of those round it, weighted with their angles),
///   and weight 1; negative on the side that the faces look away from;
/// - but not those whose nearest point lies on a rim: there the surface is missing, and a filler has to go
/// on;
/// - all others are unseen inside and empty outside. Inside is where the generalized winding number is above
///   a half, which is exact for a closed mesh, and lays a smooth membrane through the holes of an open one.
///   (OpenVDB's `meshToVolume` would need a closed mesh.) Faces must be oriented alike. An open sheet that
///   encloses less than half of the space before it has no inside.
///
/// Where faces intersect, the walls inside are kept. Sign at edges and vertices: Baerentzen and Aanaes,
/// "Signed Distance Computation Using the Angle Weighted Pseudonormal" (2005); at edges with three faces or
/// more, and where faces are not oriented alike, the winding number decides.
///
/// The same in every bit whatever the number of threads. Throws CompletionError when the mesh has no faces
/// with an area, on options out of range, and when the volume needs too much memory; and Cancelled.
/// Cost: O(faces + voxels within the ramp); memory likewise.
VoxelizedMesh voxelize_mesh(const TriangleMesh& mesh, const VolumeSizeOptions& options,
                            const Progress& progress = Progress());

}  // namespace meshcomplete
