// Untangling a patch where it meets itself or the input: a small disturbance, kept where it is needed.
#pragma once

#include <vector>

#include "common/core/patch_mesh.h"

namespace meshcomplete {

/// Moves the inner vertices within `rings` edges of the given triangles towards the membrane over the rest of
/// the patch: `sweeps` rounds of putting each at the mean of its neighbours. The membrane hugs its boundary,
/// so that folds and overshoots of a stiffer surface disappear, and the rest of the patch stays as it is.
/// `tangled` are triangle numbers. Cost: O(sweeps * vertices moved).
void relax_around(PatchMesh& patch, const std::vector<Index>& tangled, int rings, int sweeps);

}  // namespace meshcomplete
