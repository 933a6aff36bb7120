// Faces at the boundary that make cubes of the greatest depth complicated: the alternative to cutting them.
#pragma once

#include <cstdint>
#include <vector>

#include "common/core/hole_selection.h"
#include "filter_atomicvolumes/atomic_volumes.h"
#include "filter_atomicvolumes/decomposition.h"

namespace meshcomplete {

/// The faces at the mesh's boundary in unresolved cubes: those with a boundary edge that meets such a cube or
/// a boundary vertex in it, ascending. Source: the paper's section 3.1 ("offending faces around the holes
/// could also be removed"). Without them the boundary runs elsewhere, which may be in such a cube again:
/// divide the rest and ask again. Where `rims` is given, a mark for each half-edge, only cubes that a marked
/// boundary edge meets count. Cost: O(triangles of those cubes).
std::vector<Index> offending_faces(const LatticeMesh& mesh, const Decomposition& decomposition,
                                   const std::vector<char>& rims = {});

/// A mesh without faces that were in the way.
struct FaceRemoval {
  std::vector<Index> faces;  ///< removed, by their numbers in the whole mesh, ascending
  std::uint64_t seed = 1;    ///< of the division that has no unresolved cube at these rims any more
  int rounds = 0;            ///< of removing, 0 when nothing had to be
  TriangleMesh mesh;         ///< the rest: all vertices, and the other faces in their order
  MeshSelection
      selection;  ///< the given one on the rest; vertices of removed faces at selected holes are in it
};

/// Removes offending faces at the rims that are to be closed, divides what is left and asks again, until no
/// cube at these rims is unresolved. Of the divisions that `options` ask for the one that loses the fewest
/// faces is taken. `options.max_depth` must be there. Throws CompletionError when no division comes to an end
/// within 24 rounds and a quarter of the faces, and what `fill_by_atomic_volumes` throws for the
/// options; `Cancelled`. Deterministic. Cost: for each division and round that of dividing space and cutting.
FaceRemoval remove_offending_faces(const TriangleMesh& mesh, const MeshSelection& selection,
                                   const AtomicVolumesOptions& options,
                                   const Progress& progress = Progress());

/// A completion of the mesh without the faces `removed`.
struct ReducedCompletion {
  AtomicVolumesResult result;  ///< its patch fits the rest of the mesh; vertices keep their numbers
  std::vector<Index> removed;  ///< by their numbers in the whole mesh, ascending
};

/// Removes offending faces and completes what is left, with the division for which they were removed.
ReducedCompletion fill_without_offending_faces(const TriangleMesh& mesh, const MeshSelection& selection,
                                               const AtomicVolumesOptions& options,
                                               const Progress& progress = Progress());

}  // namespace meshcomplete
