// Cutting a strip out of a patch: what lies along stretches of its rims.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "common/core/boundary_loops.h"
#include "common/core/mesh.h"
#include "common/core/patch.h"
#include "common/core/progress.h"

namespace meshcomplete {

/// Edges of a boundary loop one after the other: from `vertices[first]` to `vertices[first + edges]`
/// (cyclic). With as many edges as the loop has it is the whole loop. Between
/// two stretches of a loop there is at least one edge of neither.
struct RimStretch {
  std::size_t loop = 0, first = 0, edges = 0;
};

/// What is left of a patch along stretches of its rims.
struct Strip {
  Patch patch;
  std::size_t edges = 0, of = 0;  ///< how many edges of the rims it closes, and how many there are
  std::string reason;             ///< why there is none; empty when there is
};

/// Most stretches at one patch: which ends belong together is tried out.
constexpr std::size_t most_stretches = 7;

/// Cuts out of `patch`, which closes `rims`, what lies along those of the stretches that are on these rims.
/// The end of each is joined to the start of another one (of itself when it is the only one, or the others
/// are eight times as far) by a path along edges of the patch that touches no rim, ends and starts paired so
/// that the paths are short together. A path goes beside the geodesic between its ends. Where the patch is so
/// narrow that it would go far round, its ends are moved along the rims by up to sixteen edges. What is on
/// one side of these paths with the stretches is the strip; rims that lie in it whole are closed too. There
/// is none when the paths do not separate it from an unselected edge of a rim with a stretch. Source: Centin,
/// Pezzotti and Signoroni, section 3.4. Cost: O(n log n) in the patch for each stretch. Throws Cancelled.
Strip cut_strip(const TriangleMesh& mesh, const std::vector<BoundaryLoop>& loops,
                const std::vector<std::size_t>& rims, const std::vector<RimStretch>& stretches,
                const Patch& patch, const Progress& progress = Progress());

}  // namespace meshcomplete
