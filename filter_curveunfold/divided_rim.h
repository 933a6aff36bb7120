// Rims that one flat triangulation does not serve: divided by chords into shorter ones, each filled by
// itself.
#pragma once

#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "common/core/patch_check.h"
#include "common/core/patch_mesh.h"
#include "common/core/progress.h"
#include "common/core/rim.h"
#include "filter_curveunfold/embedding.h"
#include "filter_curveunfold/unfold.h"

namespace meshcomplete {

/// A chord joins two vertices of a rim: their positions in it, the smaller first.
using Chord = std::pair<Index, Index>;

/// Chords that shorten the way between their ends most and that no face of the input obstructs, at most
/// `count`, the best first and no two of them close to each other. Both parts of the rim keep a fifth of its
/// length at least. A rim that winds twice is cut by the first of them into two that wind once. Throws
/// `Cancelled`. Cost: O(n^2 log n) for rims of up to a few hundred vertices, of longer ones only so many are
/// looked at; and a few hundred searches for faces in the way.
std::vector<Chord> chords(const Rim& rim, const InputNeighbourhood& input, std::size_t count,
                          const Progress& progress = Progress());

/// Part of a divided rim, closed by chords, unfolded and triangulated.
struct FlatSide {
  Rim rim;
  std::vector<Index>
      vertex;  ///< per vertex of `rim`: in the undivided rim, or from its size on a point of the chords
  std::vector<Eigen::Vector2d> polygon;
  std::vector<Triangle> flat;  ///< corners are positions in `polygon`
};

struct DividedRim {
  std::vector<Vector3> points;  ///< of the chords, between their ends, as they will be stored
  std::vector<FlatSide> sides;
  std::size_t steps = 0;  ///< of the unfolding, all sides together
};

/// Divides the rim by the chord, unfolds both sides, and triangulates them. A side without a simple
/// projection is divided again, `depth` times at most. Chords are straight and get points `edge_length` apart
/// (absent: the rim's own). Throws CompletionError when a side does not unfold or a chord needs more than
/// 1000 points, and `Cancelled`.
DividedRim divide(const Rim& rim, const Chord& chord, const InputNeighbourhood& input,
                  std::optional<double> edge_length, int depth, const Progress& progress = Progress());

/// About how many triangles the patch will have.
double expected_triangles(const DividedRim& divided, const EmbeddingOptions& options);

/// Embeds all sides, each by itself, and joins them: a patch of the undivided rim, creased along the chords
/// where they are fixed. Throws CompletionError when the sides do not fit together, and `Cancelled`.
PatchMesh embed(const Rim& rim, const DividedRim& divided, const EmbeddingOptions& options,
                const Progress& progress = Progress());

}  // namespace meshcomplete
