// The vertices of a patch brought to numbers that can be stored, without making it meet itself.
#pragma once

#include <cstddef>
#include <vector>

#include "common/core/guarded_patch.h"
#include "common/core/progress.h"

namespace meshcomplete {

/// Rounds inner vertices of a patch whose features may be finer than single precision. Each step is guarded:
/// a vertex that cannot be rounded where it is is merged with a neighbour, or gets another place near it.
/// What is left then is rounded all the same; returns how many that were. `patch` is the one that `guarded`
/// guards. Cost: that of a guarded step per vertex.
std::size_t round_vertices(PatchMesh& patch, GuardedPatch& guarded, const std::vector<Index>& vertices,
                           const Progress& progress = Progress());

}  // namespace meshcomplete
