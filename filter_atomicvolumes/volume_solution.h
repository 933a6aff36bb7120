// One octree, its graph and its cut: what one position of the root cube gives.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/core/progress.h"
#include "filter_atomicvolumes/atomic_volumes.h"
#include "filter_atomicvolumes/constraints.h"
#include "filter_atomicvolumes/decomposition.h"
#include "filter_atomicvolumes/extraction.h"
#include "filter_atomicvolumes/labelling.h"
#include "filter_atomicvolumes/lattice_mesh.h"
#include "filter_atomicvolumes/volume_complex.h"

namespace meshcomplete {

struct VolumeSolution {
  LatticeMesh mesh;
  Decomposition decomposition;
  VolumeComplex complex;
  Labelling labelling;
  std::vector<NodeTie> ties;  ///< of constraints and hints
  LabelledSurface surface;
  AtomicVolumesFigures figures;
  std::vector<std::string> notes;
};

/// Where the root cube of the i-th division stands, counted from 0.
inline std::uint64_t seed_of_division(const AtomicVolumesOptions& options, int i) {
  return options.seed + static_cast<std::uint64_t>(i) * 0x9e3779b97f4a7c15ull;
}

/// Divides space round the mesh, with the root cube where `seed` puts it, and labels the volumes. Starts
/// again elsewhere when features coincide. `oracle` is for `CutWeight::poisson`. Throws CompletionError
/// beyond the node budget, `Cancelled`. Deterministic.
VolumeSolution solve_volumes(const TriangleMesh& mesh, const MeshTopology& topology,
                             const InputNeighbourhood& neighbourhood, const AtomicVolumesOptions& options,
                             const PreparedConstraints& constraints, std::uint64_t seed,
                             const ImplicitFunction* oracle = nullptr, const Progress& progress = Progress());

/// Smooths the surface of a solution as the options say (paper, section 5); two passes cut anew in between.
/// Points of the constraints stay in their volumes. Throws `Cancelled`. Cost: O(volumes at the patch) per
/// iteration, and that of another cut.
void smooth(VolumeSolution& solution, const AtomicVolumesOptions& options,
            const PreparedConstraints& constraints, const ImplicitFunction* oracle = nullptr,
            const Progress& progress = Progress());

}  // namespace meshcomplete
