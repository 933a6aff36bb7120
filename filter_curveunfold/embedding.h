// From the flat triangulation to a minimum-energy surface in space (paper, section 3.3).
#pragma once

#include <optional>
#include <vector>

#include "common/core/fairing.h"
#include "common/core/mesh.h"
#include "common/core/patch_mesh.h"
#include "common/core/progress.h"
#include "common/core/rim.h"

namespace meshcomplete {

struct EmbeddingOptions {
  SurfaceEnergy energy = SurfaceEnergy::thin_plate;
  LaplacianWeights weights = LaplacianWeights::cotangent;
  std::optional<double>
      edge_length;          ///< target edge length, mesh units, positive; absent: that of the rim's ring
  double resolution = 1.0;  ///< the target edge length is divided by this
};

/// The edge length to aim at for each vertex of the rim: that asked for, or the rim's, divided by the
/// resolution.
std::vector<double> target_lengths(const Rim& rim, const EmbeddingOptions& options);

/// About how many triangles the patch will have. Cost: O(rim).
double expected_triangles(const Rim& rim, const std::vector<Triangle>& flat, const EmbeddingOptions& options);

/// Puts the flat triangulation `flat` of the unfolded rim onto the rim's positions in space, refines it to
/// the resolution of the surrounding mesh, and moves the new vertices to the minimum of the energy; triangles
/// are kept well-shaped by remeshing between the solves. The result is compact; its rim vertices are the
/// loop's, in their order. Rim edges are never split. Throws `Cancelled`, CompletionError. Cost: near-linear
/// in the vertices of the patch.
PatchMesh embed(const Rim& rim, const std::vector<Triangle>& flat, const EmbeddingOptions& options,
                const Progress& progress = Progress());

}  // namespace meshcomplete
