// Where a patch is tangled: its triangles there are taken out, and the gap is closed by others that meet
// nothing.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "common/core/mesh.h"
#include "common/core/patch_check.h"
#include "common/core/patch_mesh.h"
#include "common/core/progress.h"
#include "common/core/rim.h"

namespace meshcomplete {

/// Takes out the triangles within `rings` edges of the `tangled` ones (numbers of triangles) and closes every
/// gap with triangles between its corners that meet neither each other nor the rest of the patch, the input
/// or `obstacles`. Among them dynamic programming looks for a small worst crease and then for short edges, as
/// in Liepa 2003 ("Filling holes in meshes"). The new edges are then split to the resolution of the patch
/// round the gap, flipped towards good triangles, and the new vertices smoothed, each step only if nothing is
/// met.
///
/// `rim` is the patch's own, and `wanted` holds the edge length to aim at for each of its vertices. A gap
/// that is no simple polygon, has more than 60 corners, or for which no such triangles are found is left as
/// it was. All inner vertices are rounded to what will be stored. Compacts the patch. Returns the number of
/// gaps closed. Throws `Cancelled`. Cost: O(n^3) tests for a gap of n corners, plus O(patch) per gap.
std::size_t retriangulate(PatchMesh& patch, const std::vector<Index>& tangled, const Rim& rim,
                          const std::vector<double>& wanted, const InputNeighbourhood& input,
                          const std::vector<std::array<Vector3, 3>>& obstacles, int rings,
                          const Progress& progress = Progress());

}  // namespace meshcomplete
