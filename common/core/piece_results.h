// Which pieces of a patch are asked for, and what became of the holes that they close.
#pragma once

#include <string>
#include <vector>

#include "common/core/boundary_loops.h"
#include "common/core/mesh.h"
#include "common/core/patch.h"
#include "common/core/patch_pieces.h"

namespace meshcomplete {

/// Whether some hole is to stay open: it may be another rim of one that cannot be closed without it.
bool any_left_open(const std::vector<HoleReport>& holes);

/// What a user is told of a flaw. Why a sheet is open only the filter knows: that is `open`.
std::string describe(Sheet::Flaw flaw, const std::string& open);

/// Marks the pieces that close targeted loops as wanted, as far as nothing keeps their groups from closing
/// all their loops, and tells the targeted holes whose patches are not wanted why; `open` as for `describe`.
/// Returns for each loop whether its patch closes another loop too that is to stay
/// open or cannot be closed. Cost: O(n log n).
std::vector<char> choose_pieces(std::vector<PatchPiece>& pieces, const std::vector<BoundaryLoop>& loops,
                                std::vector<HoleReport>& holes, const std::string& open);

/// The patches of the wanted pieces, and the report with one hole for each group of loops that are closed
/// together. A targeted hole without a piece or reason gets "no patch reaches this rim" as its reason. Cost:
/// O(patch).
Completion gather_pieces(const TriangleMesh& mesh, const std::vector<PatchPiece>& pieces,
                         CompletionReport report);

}  // namespace meshcomplete
