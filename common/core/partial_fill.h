// Filling holes in part: along selected stretches of their rims.
#pragma once

#include <vector>

#include "common/core/boundary_loops.h"
#include "common/core/hole_selection.h"
#include "common/core/hole_targets.h"
#include "common/core/mesh.h"
#include "common/core/patch_pieces.h"
#include "common/core/progress.h"
#include "common/core/rim_strip.h"

namespace meshcomplete {

/// The stretches of the loops of which every vertex is selected or a corner of a selected face, but for
/// short interruptions (six edges, and no more than a run beside them); those of one or two edges only where
/// their loop has no others. Ordered by loop. Throws CompletionError when there are none. Cost: O(faces).
std::vector<RimStretch> selected_stretches(const TriangleMesh& mesh, const std::vector<BoundaryLoop>& loops,
                                           const MeshSelection& selection);

/// Leaves of the holes that are to be closed those with a stretch and those whose bounding boxes meet one of
/// them: they may be islands in what is filled. The others are skipped now. Cost: O(boundary + loops * loops
/// with stretches).
void target_stretches(const TriangleMesh& mesh, const std::vector<RimStretch>& stretches, OpenMesh& open);

/// Of the wanted pieces only those at a stretch stay wanted; the other holes are skipped.
void keep_pieces_at(const std::vector<RimStretch>& stretches, std::vector<PatchPiece>& pieces,
                    std::vector<HoleReport>& holes);

/// Leaves of the patch of every wanted piece without a defect what `cut_strip` cuts out of it, and says so.
void cut_strips(const TriangleMesh& mesh, const std::vector<BoundaryLoop>& loops,
                const std::vector<RimStretch>& stretches, std::vector<PatchPiece>& pieces,
                const Progress& progress = Progress());

}  // namespace meshcomplete
