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

/// Lowers the normal variation from the shape that `surface` has, by a few steps of gradient descent: part of
/// the way to the nearest minimum, which need not be the one that `minimize_energy` finds from the rim alone.
/// No vertex ends farther from where it was than `largest_move` times the surface's diagonal (positive).
/// Otherwise as `minimize_energy`.
void lower_normal_variation(TriangleMesh& surface, const std::vector<char>& fixed, double largest_move,
                            const Progress& progress = Progress());

}  // namespace meshcomplete
