// Where a labelled surface meets what it must not.
#pragma once

#include <vector>

#include "common/core/progress.h"
#include "filter_atomicvolumes/extraction.h"

namespace meshcomplete {

/// The triangles, ascending, that are degenerate, meet an input triangle or each other in more than shared
/// corners and sides, or enter a cube that the mesh divides; of pairs that meet only those with a triangle in
/// `changed` (ascending), and only triangles in `changed` against input and cubes. A triangle at a Steiner
/// point does not count as meeting the face at that point's edge. Exact. Cost: O(triangles log triangles) and
/// the input triangles near those in `changed`; threaded. Throws `Cancelled`.
std::vector<Index> triangles_in_contact(const LatticeMesh& mesh, const Decomposition& decomposition,
                                        const LabelledSurface& surface, const std::vector<Index>& changed,
                                        const Progress& progress = Progress());

}  // namespace meshcomplete
