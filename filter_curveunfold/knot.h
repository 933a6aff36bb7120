// Is a closed polygon knotted? An invariant that says yes for certain.
#pragma once

#include <optional>

#include "common/core/progress.h"
#include "filter_curveunfold/loop_geometry.h"

namespace meshcomplete {

/// The determinant of the knot: |Alexander polynomial at -1|, an odd number, 1 for the unknot, 3 for the
/// trefoil, 5 for the figure eight. Any value but 1 proves a knot; 1 proves nothing (some knots have
/// determinant 1). Values beyond the range of int are given as the greatest int.
///
/// Computed from the colouring matrix of a generic projection (one row per crossing: twice the arc above
/// minus the two arcs below), crossings and their signs decided with exact predicates, the determinant taken
/// modulo primes. A determinant that is not 1 modulo a prime is not 1, so that a knot is never claimed
/// wrongly.
///
/// Absent when no direction gives a projection that is generic and has at most a thousand crossings, or when
/// strands are so near each other that the rounding of the rotated coordinates could have passed one through
/// the other. Cost: cubic in the crossings. Take points out with `reduce` first, so that there are few.
std::optional<int> knot_determinant(const Loop& loop, const Progress& progress = Progress());

}  // namespace meshcomplete
