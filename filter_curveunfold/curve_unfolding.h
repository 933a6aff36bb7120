// Hole filling by curve unfolding: every single-boundary hole closed with a minimum-energy surface.
// Source: Brunton, Wuhrer, Shu, Bose, Demaine, "Filling Holes in Triangular Meshes by Curve Unfolding", 2009.
#pragma once

#include <optional>

#include "common/core/fairing.h"
#include "common/core/hole_selection.h"
#include "common/core/mesh.h"
#include "common/core/patch.h"
#include "common/core/progress.h"
#include "filter_curveunfold/unfold.h"

namespace meshcomplete {

struct CurveUnfoldingOptions {
  HoleSelectionOptions holes;
  UnfoldOptions unfolding;
  SurfaceEnergy energy = SurfaceEnergy::thin_plate;
  LaplacianWeights weights = LaplacianWeights::cotangent;
  std::optional<double>
      edge_length;  ///< target edge length of the patch, mesh units, positive; absent: as the mesh around
  bool unfolded_layer = false;  ///< also return the flat triangulations (paper, figures 4b to 7b)
};

/// What one hole cost, all tries together. Wall seconds of the thread that worked on it.
struct HoleTimes {
  double unfolding = 0;
  double embedding = 0;  ///< triangulating, refining, solving
  double checking = 0;
  int restarts = 0;       ///< annealing runs (paper's d)
  std::size_t steps = 0;  ///< unfolding steps
};

struct CurveUnfoldingResult {
  Completion completion;
  std::vector<HoleTimes> times;  ///< one per hole of the report
  TriangleMesh
      unfolded;  ///< the planar triangulations side by side in the plane z = 0; empty unless asked for
};

/// Closes the selected holes of `mesh`, each on its own. The patch has passed `check_patch` against the input
/// and all other patches. Deterministic whatever the number of threads. Throws `CompletionError` on options
/// out of range, `Cancelled`. Cost: O(faces) for tracing; per hole near-linear in its edges and in the
/// patch's vertices.
CurveUnfoldingResult fill_by_curve_unfolding(const TriangleMesh& mesh, const MeshSelection& selection,
                                             const CurveUnfoldingOptions& options,
                                             const Progress& progress = Progress());

}  // namespace meshcomplete
