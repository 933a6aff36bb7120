// The Poisson reconstruction that a completion follows: as fine at the rims as their edges.
#pragma once

#include "common/core/hole_targets.h"
#include "common/core/patch_check.h"
#include "common/core/poisson_oracle.h"

namespace meshcomplete {

/// The reconstruction of a mesh (and of `guides`) for closing the holes of `open` that are targeted or may be
/// part of one that is: the octree's cubes are as large as the edges of these rims, or as walls thinner than
/// an edge are thick but no smaller than half an edge, and they grow away from the rims. `input` is the
/// mesh's own. Throws as `make_oracle` does, and CompletionError when no hole is targeted. Cost: O(faces) and
/// near-linear in the cubes.
PoissonOracle make_completion_oracle(const TriangleMesh& mesh, const OpenMesh& open,
                                     const InputNeighbourhood& input, const OrientedSurfaces& guides,
                                     const PoissonOracleOptions& options,
                                     const Progress& progress = Progress());

}  // namespace meshcomplete
