// From an implicit surface to patches: initial points, refinement, tailoring and finishing in one call.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/core/boundary_loops.h"
#include "common/core/finishing.h"
#include "common/core/implicit_function.h"
#include "common/core/mesh.h"
#include "common/core/mesh_topology.h"
#include "common/core/partial_fill.h"
#include "common/core/patch.h"
#include "common/core/patch_check.h"
#include "common/core/progress.h"
#include "filter_poissoncompletion/surface_gaps.h"
#include "filter_poissoncompletion/tailoring.h"

namespace meshcomplete {

/// How far fairing may take a patch off the function's surface, as a share of the diagonal of the patch and
/// the ring round it. Chosen by trial: with 0.03 flaws of the reconstruction remain, and without a limit the
/// flat bottom of a bust bulges.
constexpr double near_function = 0.06;

struct RefinedCompletionOptions {
  /// How many rings of vertices round the rims are in the triangulation from the beginning (at least 1).
  int rings = 3;
  /// Which part of the other vertices is (0 to 1).
  double sample_share = 0.02;
  /// Target edge length (mesh units, positive). Absent: that of the mesh round the rims.
  std::optional<double> edge_length;
  /// Radius of the cushion in target edge lengths (positive), at the rims.
  double cushion = 1.05;
  /// The radius of the cushion (mesh units, positive) everywhere instead.
  std::optional<double> cushion_radius;
  /// By how much the cushion grows with the distance from the rims, up to two radii away from them, for
  /// surfaces that face as the mesh does: the function may be less exact than at the rims.
  double cushion_growth = 1;
  /// Facets with a smaller angle are refined (degrees, 0 to 30).
  double smallest_angle = 27;
  /// What is done to the patches after they were cut out. Without fairing they keep the function's shape.
  FinishingOptions finishing = {
      true, SurfaceEnergy::normal_variation, std::nullopt, std::nullopt, near_function, "as cut out"};
  /// Absent: holes are closed whole. Else only along these.
  std::optional<std::vector<RimStretch>> stretches;
};

struct RefinedCompletionFigures {
  std::size_t initial_points = 0, points = 0, cells = 0, lost_edges = 0;
  TailoringFigures tailoring;
  SurfaceGapFigures gaps;
};

struct RefinedCompletion {
  Completion completion;
  RefinedCompletionFigures figures;
};

/// Closes the targeted holes of `report` (one hole for each loop, as `select_holes` and `target_islands` left
/// them) along the surface of `function`, which should be near the mesh where that is. The result's report is
/// `report` with what became of them. Source: the paper, sections 3.3 and 3.4. Throws CompletionError and
/// Cancelled. Cost: O(faces) for a few passes over the mesh; else near-linear in the rims and the patches.
RefinedCompletion complete_by_refinement(const TriangleMesh& mesh, const MeshTopology& topology,
                                         const std::vector<BoundaryLoop>& loops,
                                         const InputNeighbourhood& input, const ImplicitFunction& function,
                                         const RefinedCompletionOptions& options, CompletionReport report,
                                         const Progress& progress = Progress());

}  // namespace meshcomplete
