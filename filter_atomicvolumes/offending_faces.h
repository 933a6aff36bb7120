// Faces at the boundary that make cubes of the greatest depth complicated: the alternative to cutting them.
#pragma once

#include <vector>

#include "filter_atomicvolumes/decomposition.h"

namespace meshcomplete {

/// The faces at the mesh's boundary in unresolved cubes: those with a boundary edge that meets such a cube or
/// a boundary vertex in it, ascending. Source: the paper's section 3.1 ("offending faces around the holes
/// could also be removed"). Without them the boundary runs elsewhere, which may be in such a cube again:
/// divide the rest and ask again. Cost: O(triangles of those cubes).
std::vector<Index> offending_faces(const LatticeMesh& mesh, const Decomposition& decomposition);

}  // namespace meshcomplete
