// How far a closed polygon may move without passing through itself: continuous collision detection.
#pragma once

#include "filter_curveunfold/loop_geometry.h"

namespace meshcomplete {

/// The greatest fraction t (0 to 1) that is certified: while all points move along straight lines from `from`
/// to `from + t (to - from)`, no two segments without a common point come nearer than a tenth of the distance
/// that they had, and no two neighbouring segments fold onto each other. Such a motion is an isotopy.
/// Conservative advancement: the distance falls no faster than the relative displacement. Cost: near-linear
/// while displacements are small.
double safe_fraction(const Loop& from, const Loop& to);

/// How far a segment's end may move in any direction, for each point: a motion of every point by less than
/// this cannot make neighbouring segments fold onto each other.
double folding_bound(const Vector3& before, const Vector3& point, const Vector3& after);

}  // namespace meshcomplete
