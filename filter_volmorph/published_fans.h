// Hole filling by triangle fans exactly as published: hole-spanning faces removed, every rim filled,
// overlapping vertices split. Input is removed and split, and intersections are not avoided.
// Source: Firestone, "An Exploration of Hole Filling Algorithms", 2008, section 2.2.1.
#pragma once

#include <cstddef>
#include <vector>

#include "common/core/hole_selection.h"
#include "common/core/mesh.h"
#include "common/core/patch.h"
#include "common/core/progress.h"
#include "common/core/vertex_splits.h"
#include "filter_volmorph/hole_spanning.h"

namespace meshcomplete {

struct PublishedFansOptions {
  HoleSelectionOptions holes;  ///< the holes of what mark and sweep has left
  SpanningPieces spanning = SpanningPieces::all_but_largest;
};

struct PublishedFans {
  Completion completion;            ///< the holes are those of what mark and sweep has left
  std::vector<Index> removed;       ///< faces of the mesh, ascending, that the patch does not go with
  std::vector<VertexSplit> splits;  ///< faces are numbered without the removed ones, then the patch's follow
  std::size_t intersections = 0;    ///< pairs of faces of the result that meet improperly
};

/// Removes hole-spanning faces by mark and sweep, closes the selected holes of what is left, each by a fan
/// round the mean of its rim's vertices, whatever that meets, and splits vertices with several fans of faces.
/// The result is manifold, and when all holes are selected without boundary. Also rims of single triangles
/// and of flat sheets are filled, and those with edges without length. Deterministic whatever the number of
/// threads. Throws as `sweep_hole_spanning_faces` and `select_holes`, and `Cancelled`. Cost: near-linear in
/// the faces, and the pairs of faces whose boxes meet.
PublishedFans close_as_published(const TriangleMesh& mesh, const MeshSelection& selection,
                                 const PublishedFansOptions& options, const Progress& progress = Progress());

}  // namespace meshcomplete
