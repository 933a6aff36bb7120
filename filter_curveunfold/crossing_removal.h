// Unfolding loops that a projection shows simple but for a few crossings, as jagged rims are.
#pragma once

#include <cstddef>
#include <optional>

#include "common/core/progress.h"
#include "filter_curveunfold/loop_geometry.h"

namespace meshcomplete {

struct CrossingRemoval {
  std::optional<Polygon>
      polygon;            ///< simple, counter-clockwise, one point per loop point; absent if it gave up
  std::size_t moves = 0;  ///< points moved out of the way, in all projections that were tried
};

/// Looks for projections of `loop` (centred, about 1 across) with few crossings and takes points at them out
/// by triangle moves, until the loop that is left projects simply. In the plane the points come back where
/// the projection has them, or as near to that as there is room. A loop that is unfolded this way is
/// unknotted: the moves are isotopies.
///
/// Gives up early: the loop has to be nearly planar, only small teeth are taken out, and not many, so that
/// the polygon keeps the shape of the projection. Loops that are bent, wound or tangled on the whole are left
/// to `descend`. Deterministic. Cost: O(n log n), times a dozen directions of projection.
CrossingRemoval remove_crossings(const Loop& loop, const Progress& progress = Progress());

}  // namespace meshcomplete
