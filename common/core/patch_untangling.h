// Guarded moves: taking the vertices of a patch, one by one, to places where their triangles meet nothing.
#pragma once

#include <array>
#include <vector>

#include "common/core/mesh.h"
#include "common/core/patch_check.h"
#include "common/core/patch_mesh.h"
#include "common/core/patch_remeshing.h"
#include "common/core/progress.h"

namespace meshcomplete {

/// Where triangles of a patch meet each other, the input or `obstacles`, moves the inner vertices near them
/// to nearby places where fewer do, and flips edges where that helps, by exact tests, until none is left or
/// nothing improves. `tangled` are the numbers of the triangles that meet something, and vertices within
/// `rings` edges of theirs move. Triangles without an inner vertex get one by splitting an inner edge, and
/// with rings every tangled triangle gets one. All inner vertices are rounded to what will be stored first,
/// so that the tests speak about the final positions. The vertices far from the tangle stay where they are.
/// No flip makes a `forbidden` edge. Returns the number of moves and flips. Cost: O(patch), and for every
/// vertex at the tangle O(triangles nearby) a few hundred times in each of the `rounds`.
std::size_t untangle(PatchMesh& patch, const std::vector<Index>& tangled, const InputNeighbourhood& input,
                     const std::vector<std::array<Vector3, 3>>& obstacles, const ForbiddenEdges& forbidden,
                     int rings, int rounds, const Progress& progress = Progress());

}  // namespace meshcomplete
