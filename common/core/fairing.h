// Minimum-energy surfaces: where the inner vertices of a patch go.
#pragma once

#include <vector>

#include "common/core/mesh.h"
#include "common/core/progress.h"

namespace meshcomplete {

enum class SurfaceEnergy {
  membrane,    ///< least-squares mesh: sum of |U|^2, U the umbrella vector (paper's E_AREA); small area,
               ///< creases at the rim
  thin_plate,  ///< discrete fairing: sum of |U^2|^2 (paper's E_DF); continues the surrounding surface
               ///< smoothly
  normal_variation,  ///< smallest change of the normals across edges; starts from the thin plate
};

enum class LaplacianWeights {
  uniform,    ///< every neighbour counts the same, as published
  cotangent,  ///< geometry-aware, made safe: clamped to be positive and bounded
};

const char* name(SurfaceEnergy energy);  ///< "membrane", "thin plate", "normal variation"

/// Moves the vertices of `surface` that are not `fixed` to the minimum of the energy. `surface` holds the
/// patch and at least one ring of the mesh around it (two for the best continuation), so that the energy sees
/// how the surface continues; fixed vertices keep their positions exactly. Sparse Cholesky, one factorisation
/// for three coordinates. Throws CompletionError when the system cannot be solved (a free vertex not
/// connected to any fixed one). Cost: near-linear in the vertices (nested dissection order).
void minimize_energy(TriangleMesh& surface, const std::vector<char>& fixed, SurfaceEnergy energy,
                     LaplacianWeights weights, const Progress& progress = Progress());

}  // namespace meshcomplete
