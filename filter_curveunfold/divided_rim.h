// Rims that one flat triangulation does not serve: divided by a chord into two shorter ones, each filled by itself.
#pragma once

#include "common/core/patch_check.h"
#include "common/core/patch_mesh.h"
#include "common/core/progress.h"
#include "common/core/rim.h"
#include "filter_curveunfold/embedding.h"
#include "filter_curveunfold/unfold.h"

#include <cstddef>
#include <utility>
#include <vector>

namespace meshcomplete {

/// A chord joins two vertices of a rim: their positions in it, the smaller first.
using Chord = std::pair<Index, Index>;

/// Chords that shorten the way between their ends most and meet no face of the input in between, at most `count`, the best
/// first and no two of them close to each other. Both parts of the rim keep a fifth of its length at least. A rim that winds
/// twice is cut by the first of them into two that wind once.
/// Cost: O(n^2) for rims of up to a few hundred vertices; of longer ones only so many are looked at.
std::vector<Chord> chords(const Rim& rim, const InputNeighbourhood& input, std::size_t count);

/// Fills both sides of the chord as `embed` does, each unfolded and triangulated by itself, and joins them along it; a side
/// whose projection is not simple is divided again, `depth` times at most. The chord is straight, and an inner line of the
/// patch like any other. Throws CompletionError when a side does not unfold or the two do not fit together, and `Cancelled`.
PatchMesh embed_divided(const Rim& rim, const Chord& chord, const InputNeighbourhood& input, const UnfoldOptions& unfolding,
                        const EmbeddingOptions& options, int depth, const Progress& progress = Progress());

}  // namespace meshcomplete
