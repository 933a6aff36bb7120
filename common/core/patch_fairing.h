// Fairing a patch together with the mesh round it.
#pragma once

#include "common/core/fairing.h"
#include "common/core/patch_mesh.h"
#include "common/core/progress.h"
#include "common/core/rim.h"

namespace meshcomplete {

/// Moves the inner vertices of the patch to the minimum of the energy, which sees the rim's one-ring and so
/// how the surface goes on there. The first vertices of the patch are those of `rim`, in its order. Throws as
/// `minimize_energy` does. Cost: near-linear in the vertices.
void fair(PatchMesh& patch, const Rim& rim, SurfaceEnergy energy, LaplacianWeights weights,
          const Progress& progress = Progress());

/// The same, but lowers the normal variation from the shape that the patch has, as `lower_normal_variation`.
void fair_near(PatchMesh& patch, const Rim& rim, double largest_move, const Progress& progress = Progress());

}  // namespace meshcomplete
