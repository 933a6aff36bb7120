// Remeshing and fairing in steps that never let a patch meet anything.
#pragma once

#include <vector>

#include "common/core/guarded_patch.h"
#include "common/core/progress.h"

namespace meshcomplete {

struct GuardedRemeshOptions {
  int rounds = 5;               ///< of split, collapse, flip, smooth, 0 to 100
  double longest = 4.0 / 3.0;   ///< an edge is split when it is longer than this many target lengths
  double shortest = 4.0 / 5.0;  ///< and collapsed when shorter than this many
};

/// As `remesh`, but each step is made only when the patch stays clean. `target` holds the wanted edge length
/// of each vertex, gaps included, and grows with the patch. Smoothing moves vertices to the mean of their
/// neighbours, so that the stairs of an octree go too. Cost: O(n) guarded steps a round.
void guarded_remesh(GuardedPatch& guarded, std::vector<double>& target, const GuardedRemeshOptions& options,
                    const Progress& progress = Progress());

/// Moves every inner vertex towards its place in `goal` as far as the patch stays clean: whole steps, and
/// halves of them where those are not free, for some sweeps. Returns the greatest distance that is left,
/// relative to the first. Cost: O(n) guarded moves a sweep.
double guarded_approach(GuardedPatch& guarded, const std::vector<Vector3>& goal, int sweeps,
                        const Progress& progress = Progress());

}  // namespace meshcomplete
