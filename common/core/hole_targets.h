// Which boundary loops a completion of all holes at once works on.
#pragma once

#include <vector>

#include "common/core/boundary_loops.h"
#include "common/core/patch.h"

namespace meshcomplete {

/// Whether a hole, as `select_holes` reports it, is to be worked on.
bool is_targeted(const HoleReport& hole);

/// Open sheets beside a surface whose holes are closed are islands: if any hole is targeted, the rims of
/// sheets that were only left out for being sheets become targets, to be closed together with the hole round
/// them if that takes less area. One report for each loop. Cost: O(loops).
void target_islands(const std::vector<BoundaryLoop>& loops, std::vector<HoleReport>& holes);

}  // namespace meshcomplete
