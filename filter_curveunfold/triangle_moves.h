// Taking points out of a closed polygon without changing its knot type, and putting them back in the plane.
#pragma once

#include <cstddef>
#include <vector>

#include "common/core/progress.h"
#include "filter_curveunfold/loop_geometry.h"

namespace meshcomplete {

/// One point that was taken out: where it stood against the chord that took its place.
struct Removal {
  std::size_t point;   ///< its number in the original loop
  std::size_t before;  ///< the neighbours it had, by their numbers
  std::size_t after;
  double along;   ///< position of its foot on the chord from `before` (0) to `after` (1)
  double height;  ///< its distance from the chord, in chord lengths
};

/// When a point may be taken out.
struct ReductionLimits {
  std::size_t least_points = 3;   ///< stop at so many
  double largest_height = 1e300;  ///< greatest distance of a point from the chord that replaces it
  double longest_chord =
      1e300;  ///< greatest length of such a chord, except where it is no longer than an old edge
  double clearance_share = 0;  ///< other strands stay away from the triangle by this share of its height
  double least_clearance = 0;  ///< and by this distance
  double least_angle = 0;  ///< radians between the new chord and its neighbours, and any direction in between
  double shortest_edge = 0;  ///< points at a shorter edge are taken out whenever that is an isotopy, even
                             ///< below `least_points` (but not below six)
};

/// A loop from which points were taken, in order, by triangle moves.
struct ReducedLoop {
  std::vector<std::size_t> kept;  ///< original numbers, ascending
  std::vector<Removal> removals;  ///< in the order of removal
};

/// Takes points out, those nearest to their chord first, as long as the triangle of the point and its
/// neighbours is not met by any other part of the loop: moving the point to the chord is then an isotopy (an
/// elementary move of polygonal knot theory), so that the reduced loop has the same knot type. A loop that is
/// reduced to five points or fewer is unknotted, since a knot needs six edges. `kept` lists the points that
/// are there to begin with; `loop` holds a position for every original number. Cost: O((n + removals) log n)
/// for curves that do not crowd.
void reduce(const Loop& loop, const ReductionLimits& limits, ReducedLoop& reduced,
            const Progress& progress = Progress());

/// All points kept.
ReducedLoop unreduced(std::size_t points);

/// The positions of the points that are kept, as a loop of its own.
Loop kept_points(const Loop& loop, const ReducedLoop& reduced);

/// Undoes the removals in the plane. `polygon` is a simple counter-clockwise polygon with a point for each
/// point kept; the points taken out come back in reverse order as bumps of their height over their chord, to
/// the outside where the polygon is convex, made as flat as needed to meet nothing. The result is simple (up
/// to rounding, which the caller checks) and has one point per original number. Where `wanted` gives a
/// position for every original number, a point comes back there, or between there and its chord, when there
/// is room. Cost: like `reduce`.
Polygon reinserted(const Polygon& polygon, const ReducedLoop& reduced, const Polygon* wanted = nullptr);

}  // namespace meshcomplete
