// A closed, well-shaped mesh of what a screened Poisson reconstruction makes of a surface: the completion's
// oracle and refinement without anything to keep. Source: Centin, Pezzotti and Signoroni,
// "Poisson-driven seamless completion of triangular meshes", 2015, section 4.4.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/core/mesh.h"
#include "common/core/poisson_oracle.h"
#include "common/core/progress.h"

namespace meshcomplete {

struct PoissonRemeshingOptions {
  PoissonOracleOptions oracle;  ///< without a maximum depth the octree has 8 levels
  /// Of the edges, at most (mesh units, positive). Absent: 8 of the octree's finest cubes when they adapt to
  /// the curvature, else 1.6.
  std::optional<double> edge_length;
  bool adaptive = true;  ///< shorter edges where the surface is more curved
  /// How far facets may be from the surface when edges adapt (mesh units, positive). Absent: as little as
  /// `share` allows.
  std::optional<double> distance;
  /// About so many faces there may be when they adapt and no distance is given, in parts of those that
  /// marching cubes would make of the octree (positive).
  double share = 0.3;
  double smallest_angle = 25;  ///< that facets are refined for (degrees, 0 to 30)
  /// The vertices move off the surface so that the faces are as near to it as can be.
  bool fitted = true;
};

struct PoissonRemeshingResult {
  TriangleMesh mesh;  ///< closed and manifold, outside before its triangles, positions as they are stored
  PoissonOracleFigures oracle;
  std::vector<std::pair<std::string, double>> stage_seconds;
};

/// Throws CompletionError on options out of range.
void check_options(const PoissonRemeshingOptions& options);

/// Meshes the reconstruction of triangles, or points with normals, or both. Components of the reconstruction
/// that are nowhere near a sample are left out. Deterministic whatever the number of threads. Throws
/// CompletionError on options out of range and when there is nothing to reconstruct from, and Cancelled.
/// Cost: near-linear in the octree's cubes and in the result.
PoissonRemeshingResult remesh_by_poisson(const OrientedSurfaces& surface,
                                         const PoissonRemeshingOptions& options,
                                         const Progress& progress = Progress());

}  // namespace meshcomplete
