// Unfolding by repulsion: our own way, the default for loops that no projection unfolds.
#pragma once

#include <cstddef>
#include <optional>

#include "common/core/progress.h"
#include "filter_curveunfold/loop_geometry.h"

namespace meshcomplete {

struct DescentResult {
  std::optional<Polygon>
      polygon;            ///< simple, counter-clockwise, one point per loop point; absent when it gave up
  std::size_t steps = 0;  ///< steps of the flow
};

/// Unfolds `loop` (centred, about 1 across) by an isotopy that ends in the plane:
///   1. points are taken out by triangle moves while the shape stays what it is, which bounds the cost of a
///   step
///      whatever the number of points;
///   2. the loop repels itself at constant edge lengths until a projection of it is simple (the paper's
///   acceptance);
///   3. a loop that is stuck is reduced further and flows on without fixed lengths, by turns;
///   4. in the plane the points taken out come back in reverse order, and the polygon is opened towards its
///   edge
///      lengths where the shape was lost on the way.
/// Deterministic.
/// Cost: O(n log n) for 1 and 4; steps on at most some 160 points otherwise.
DescentResult descend(const Loop& loop, const Progress& progress = Progress());

}  // namespace meshcomplete
