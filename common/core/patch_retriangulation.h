// Where a patch is tangled: its triangles there taken out, and the gap closed by the best triangulation that meets nothing.
#pragma once

#include "common/core/mesh.h"
#include "common/core/patch_check.h"
#include "common/core/patch_mesh.h"
#include "common/core/progress.h"
#include "common/core/rim.h"

#include <array>
#include <cstddef>
#include <vector>

namespace meshcomplete {

/// Takes out the triangles within `rings` edges of the `tangled` ones (numbers of triangles) and closes every gap with
/// triangles between its corners that meet neither each other nor the rest of the patch, the input or `obstacles`: of all
/// such triangulations the one with the least worst crease, as Liepa 2003 has it ("Filling holes in meshes"). The new
/// edges are then split to the resolution of the patch round the gap, flipped towards good triangles, and the new vertices
/// smoothed, as far as nothing is met.
/// A gap that is not a simple polygon, is too long, or has no such triangulation is left as it was. All inner vertices are
/// rounded to what will be stored. `rim` is the patch's own. Compacts the patch. Returns the number of gaps closed.
/// Cost: O(n^3) tests for a gap of n corners, plus O(patch) per gap.
std::size_t retriangulate(PatchMesh& patch, const std::vector<Index>& tangled, const Rim& rim,
                          const InputNeighbourhood& input, const std::vector<std::array<Vector3, 3>>& obstacles,
                          int rings, const Progress& progress = Progress());

}  // namespace meshcomplete
