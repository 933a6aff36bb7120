// One short loop for each handle, from a basis of loops.
#pragma once

#include <vector>

#include "common/core/mesh.h"
#include "common/core/progress.h"
#include "filter_volmorph/capped_surface.h"
#include "filter_volmorph/loop_basis.h"

namespace meshcomplete {

/// As many loops as there are handles, by ascending length, from a basis by ascending length. Each time the
/// shortest loop that is left and the shortest that crosses it are a handle's; the shorter of the two, after
/// shortening, is taken, and all loops that are left are led round this handle. `lengths`: `edge_lengths`.
/// Cost: a search round each handle, and O(g^2) for g handles where each crosses few others.
std::vector<SurfaceLoop> loops_of_handles(const CappedSurface& surface, const std::vector<double>& lengths,
                                          const std::vector<SurfaceLoop>& basis,
                                          const Progress& progress = Progress());

}  // namespace meshcomplete
