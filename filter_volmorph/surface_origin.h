// Where each part of an extracted surface comes from: from scanners, from a filler, or from nothing but the
// boundary between unseen and empty.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/core/mesh.h"
#include "common/core/progress.h"
#include "filter_volmorph/range_volume.h"

namespace meshcomplete {

enum class SurfaceOrigin : std::uint8_t {
  observed,  ///< between seen voxels
  filled,    ///< between voxels with distances, not all of them seen: diffusion
  boundary   ///< between unseen and empty voxels: VRIP's filler
};

struct SurfaceOrigins {
  std::vector<float> weights;        ///< of each vertex: the volume's where it was observed, elsewhere 0
  std::vector<SurfaceOrigin> faces;  ///< of each face, that of its least observed vertex

  std::size_t count(SurfaceOrigin origin) const;
};

/// `surface` is what `extract_surface` makes of the volume: each vertex lies between two neighbouring voxels.
/// Cost: proportional to the surface; threaded.
SurfaceOrigins surface_origins(const RangeVolume& volume, const TriangleMesh& surface,
                               const Progress& progress = Progress());

}  // namespace meshcomplete
