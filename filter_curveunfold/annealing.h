// Unfolding by simulated annealing, as published (paper, section 3.1).
#pragma once

#include <cstddef>
#include <functional>
#include <optional>

#include "common/core/progress.h"
#include "filter_curveunfold/loop_geometry.h"
#include "filter_curveunfold/unfold.h"

namespace meshcomplete {

/// The paper's energy E_PE: the sum over the loop of the angles between consecutive normals
/// n_i = (p_i - p_{i+1}) x (p_{i+2} - p_{i+1}), radians. 0 for convex planar polygons. Three collinear points
/// have no normal and count as in line with their neighbours. Cost: O(n).
double planarity_energy(const Loop& loop);

struct AnnealingResult {
  std::optional<Polygon> polygon;  ///< simple, counter-clockwise; absent when all runs were used up
  int runs = 0;                    ///< runs of the annealing, the paper's d
  std::size_t steps = 0;           ///< random steps tried in all runs, the paper's c summed
};

/// Called with every loop that a step was accepted to and the one before it.
using AnnealingObserver = std::function<void(const Loop& before, const Loop& after)>;

/// Unfolds `loop` (centred, with a bounding-box diagonal of 1) by simulated annealing.
///
/// A run starts from the loop itself. At level j = 0, 1, 2, ... the temperature is T k^j; a level is 60
/// random steps, and a run ends once the temperature is below a thousandth of T (3,960 steps with the default
/// k). After every second accepted step the loop is projected to its best-fitting plane (by principal axes,
/// and by area): the run has succeeded when the projection is simple, which is when the linear motion to the
/// plane is free of crossings. A loop whose projection is simple to begin with counts as one run without
/// steps.
///
/// A step moves every point by the same length along a random direction of its own. It is accepted when it
/// lowers the energy, or else with probability exp(-(E' - E) / (T k^j)). After a step that lowered the energy
/// the next directions lie within 10 degrees of the last. The length is random, up to half of what the
/// closest pair of segments without a common point is apart beyond epsilon (the paper's bound max(epsilon, d)
/// lets two segments cross), and such that no two neighbouring segments can fold onto each other. All loops
/// that a run passes through are isotopic. A step is also rejected when it leaves less than half of the room
/// that the run has had at best: step lengths are proportional to the room, and the walk would freeze on the
/// constraint.
///
/// Uses `restarts`, `seed`, `min_distance`, `cooling` and `start_temperature` of `options`. Deterministic for
/// equal options on all platforms. Cost per step: O(n); per accepted step near-linear for the closest pair.
AnnealingResult anneal(const Loop& loop, const UnfoldOptions& options, const Progress& progress = Progress(),
                       const AnnealingObserver& observer = AnnealingObserver());

}  // namespace meshcomplete
