// Opening a simple planar polygon until its edges are as long as those of the loop that it stands for.
#pragma once

#include <cstddef>

#include "common/core/progress.h"
#include "filter_curveunfold/loop_geometry.h"

namespace meshcomplete {

struct PlanarStretch {
  Polygon polygon;        ///< simple, counter-clockwise
  std::size_t steps = 0;  ///< steps of the flow that led to it; 0 when it is the polygon as it was
};

/// Lets a simple counter-clockwise `polygon` repel itself within its plane (`RepulsiveFlow`), its edges drawn
/// to the lengths that they have in `loop`: projections shorten edges, and reinserted points stand in
/// arbitrary places. The polygon stays simple all the way, and becomes more convex with every one of up to
/// `steps` steps; it stops early when it is convex and its edges are within a twentieth of their lengths.
/// Large polygons flow with fewer points, the others are put back. Cost: O(n log n) plus steps on at most 96
/// points.
PlanarStretch stretched(const Polygon& polygon, const Loop& loop, int steps,
                        const Progress& progress = Progress());

}  // namespace meshcomplete
