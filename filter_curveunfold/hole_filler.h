// One hole: unfold, triangulate, embed, check, and try again another way when the check fails.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "common/core/boundary_loops.h"
#include "common/core/mesh.h"
#include "common/core/mesh_topology.h"
#include "common/core/patch.h"
#include "common/core/patch_check.h"
#include "common/core/progress.h"
#include "filter_curveunfold/curve_unfolding.h"

namespace meshcomplete {

/// The patch of one hole; empty when every try failed, and then `reason` says why.
struct FilledHole {
  Patch patch;
  std::string route;  ///< unfolding, energy, and which try it was
  std::string reason;
  HoleTimes times;
  std::vector<Eigen::Vector2d> polygon;  ///< the unfolded rim, scaled to the rim's own length
  std::vector<Triangle> flat;            ///< its triangulation; corners are loop positions
};

/// What all holes of a run share. The references outlive the filler.
struct HoleFillerContext {
  const TriangleMesh& mesh;
  const MeshTopology& topology;
  const InputNeighbourhood& neighbourhood;
  const CurveUnfoldingOptions& options;
  bool thorough = true;  ///< false: only the unfolding that is asked for is tried
};

/// Fills one hole. `obstacles` are triangles beyond the input that the patch must not meet either (patches of
/// other holes). Thread-safe. Throws `Cancelled`; every CompletionError ends up in `reason`.
FilledHole fill_hole(const HoleFillerContext& context, const BoundaryLoop& loop,
                     const std::vector<std::array<Vector3, 3>>& obstacles,
                     const Progress& progress = Progress());

}  // namespace meshcomplete
