// Mesh completion driven by a screened Poisson reconstruction: patches with the triangles of the mesh round
// them, on a surface that goes through the mesh and closes what is missing. Source: Centin, Pezzotti and
// Signoroni, "Poisson-driven seamless completion of triangular meshes", 2015.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "common/core/hole_selection.h"
#include "common/core/mesh.h"
#include "common/core/patch.h"
#include "common/core/poisson_oracle.h"
#include "common/core/progress.h"
#include "filter_poissoncompletion/completion_by_refinement.h"

namespace meshcomplete {

struct PoissonCompletionOptions {
  HoleSelectionOptions holes;
  /// Instead of whole holes only strips along the selected parts of their rims are filled, see
  /// `selected_stretches` and `cut_strip`. `holes.selected_only` means nothing then.
  bool partial_fill = false;
  /// What a user adds to the mesh to say how it goes on; not completed itself. Source: the paper,
  /// sections 3.2 and 4.5.
  OrientedSurfaces guides;
  PoissonOracleOptions oracle;
  RefinedCompletionOptions refinement;
};

struct PoissonCompletionFigures {
  PoissonOracleFigures oracle;
  RefinedCompletionFigures refinement;
};

/// The same, with names for reports.
std::vector<std::pair<std::string, double>> named(const PoissonCompletionFigures& figures);

struct PoissonCompletionResult {
  Completion completion;
  PoissonCompletionFigures figures;
};

/// Throws CompletionError on options out of range.
void check_options(const PoissonCompletionOptions& options);

/// Closes the selected holes of `mesh` along the zero set of a screened Poisson reconstruction of it and of
/// the guides. A hole of the report may have several loops. The patch has passed `check_patch`. Deterministic
/// whatever the number of threads. Throws `CompletionError` on options out of range, `Cancelled`. Cost:
/// O(faces) for a few passes over the mesh; the rest near-linear in the rims and the patches.
PoissonCompletionResult complete_by_poisson(const TriangleMesh& mesh, const MeshSelection& selection,
                                            const PoissonCompletionOptions& options,
                                            const Progress& progress = Progress());

}  // namespace meshcomplete
