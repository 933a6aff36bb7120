// A mesh without some of its faces: for modes that take away what is in the way of a patch.
#pragma once

#include <vector>

#include "common/core/hole_selection.h"
#include "common/core/mesh.h"
#include "common/core/progress.h"

namespace meshcomplete {

/// What is left of a mesh: all vertices, and faces in their order.
struct ReducedMesh {
  TriangleMesh mesh;
  MeshSelection selection;     ///< on what is left
  std::vector<Index> removed;  ///< faces of the whole mesh, ascending
  std::vector<Index> number;   ///< of each face that is left, in the whole mesh
};

/// The whole mesh to begin with.
ReducedMesh unreduced(const TriangleMesh& mesh, const MeshSelection& selection);

/// Takes away these faces of what is left (ascending). `select_corners`: their corners become selected, so
/// that a hole that was asked for by the selection stays so. Cost: O(faces).
void remove_faces(ReducedMesh& rest, const std::vector<Index>& faces, bool select_corners);

/// Takes away `rings` rings of faces round every hole that is to be closed: those with a corner on its rim,
/// then those with a corner on what has become the rim there. Source: Centin, Pezzotti and Signoroni (2015),
/// section 3.1, "deleting an n-ring of the boundary". Throws CompletionError when that leaves
/// nothing, and as `select_holes`. Cost: O(faces) a ring.
ReducedMesh without_rings(const TriangleMesh& mesh, const MeshSelection& selection,
                          const HoleSelectionOptions& options, int rings,
                          const Progress& progress = Progress());

}  // namespace meshcomplete
