// Screened Poisson reconstruction: from oriented samples of a surface to a function whose zero set goes
// through them and closes what is missing.
#pragma once

#include <vector>

#include "common/core/lattice.h"
#include "common/core/mesh.h"
#include "common/core/octree_field.h"
#include "common/core/progress.h"

namespace meshcomplete {

/// A point of the surface for a piece of it.
struct OrientedSample {
  Vector3 position = Vector3::Zero();
  Vector3 area_normal = Vector3::Zero();  ///< outward, as long as the area that it stands for
  int depth = 0;                          ///< of the octree there
  int coarsening = 0;  ///< so many levels above `depth` its normal is spread: where samples are sparse
};

/// What the function is at the outside of the root cube.
enum class PoissonBoundary {
  dirichlet,  ///< outside the solid: separate parts stay separate
  neumann,    ///< free: a surface may end there
};

struct ScreenedPoissonOptions {
  int min_depth = 5;  ///< 1 to 10; of all cubes
  PoissonBoundary boundary = PoissonBoundary::dirichlet;
  /// Weight of the distance from the samples, as in Kazhdan and Hoppe: over the side of the finest cubes.
  double screening = 16;
  double coarse_screening = 64;  ///< factor by which it is stronger in all levels but the finest
  int iterations = 30;           ///< of conjugate gradients in each level, at most
  double tolerance = 1e-4;       ///< of the residual in each level, relative to its right-hand side
};

struct PoissonLevelFigures {
  std::size_t unknowns = 0;
  int iterations = 0;
  double residual = 0;  ///< relative
};

struct PoissonSolution {
  OctreeField field;
  std::vector<PoissonLevelFigures> levels;  ///< from the coarsest
};

/// Minimises, level by level from the coarsest, the integral of |grad u - V|^2 plus the weighted sum of
/// u(p)^2 over the samples p, with trilinear elements; V is the samples' area normals spread over the cubes
/// round them. In each level only corners whose cubes are all of its depth are free: the others keep what the
/// coarser level gave them, so that wide gaps are closed by the smooth coarse solution. The field is shifted
/// so that its mean over the samples is 0. All samples must lie in the lattice's cube. Deterministic whatever
/// the number of threads. Throws `Cancelled`, and CompletionError when there is no sample. Source: Kazhdan
/// and Hoppe, "Screened Poisson surface reconstruction" (2013). Cost: O(cubes) per iteration, threaded.
PoissonSolution solve_screened_poisson(const Lattice& lattice, const std::vector<OrientedSample>& samples,
                                       const ScreenedPoissonOptions& options,
                                       const Progress& progress = Progress());

}  // namespace meshcomplete
