// Faces that span holes, found by mark and sweep, and what else keeps a mesh from being a surface.
// Source: Firestone, "An Exploration of Hole Filling Algorithms", 2008, sections 1.3 and 2.2.1.
#pragma once

#include <cstddef>

#include "common/core/hole_selection.h"
#include "common/core/mesh.h"
#include "common/core/progress.h"
#include "common/core/reduced_mesh.h"

namespace meshcomplete {

/// Which pieces of a mesh are taken for hole-spanning faces. A piece is what hangs together by edges that two
/// faces share and walk in opposite directions; the largest one has the most faces (of two, that with the
/// lowest face).
enum class SpanningPieces {
  all_but_largest,  ///< every one but the largest, as published
  touching_larger,  ///< those that share a vertex with a larger one that stays
};

/// A mesh whose every edge has one face, or two that walk it in opposite directions; and what had to go.
struct SweptMesh {
  ReducedMesh rest;
  std::size_t repeating_faces = 0;  ///< removed because they name a vertex twice
  std::size_t spanning_faces = 0;   ///< removed as hole-spanning
  std::size_t spanning_pieces = 0;  ///< how many pieces these were
  std::size_t unclear_faces = 0;    ///< removed because one of their edges still had more than two faces, or
                                    ///< two that walk it in one direction
};

/// Marks what can be reached from the largest piece (or several, see `SpanningPieces`) across edges, and
/// sweeps the rest away. Marking does not cross an edge with three or more faces, nor one with two that walk
/// it in one direction: a fin on a surface is swept away, the surface is not. Where the marked faces
/// themselves have such an edge all faces there go, and what then no longer hangs together is swept again.
/// `select_corners`: as in `remove_faces`. Throws CompletionError when nothing is left, and `Cancelled`.
/// Cost: O(faces).
SweptMesh sweep_hole_spanning_faces(const TriangleMesh& mesh, const MeshSelection& selection,
                                    SpanningPieces pieces, bool select_corners,
                                    const Progress& progress = Progress());

}  // namespace meshcomplete
