// A mesh as a closed surface of half-edges: holes covered, vertices with one fan.
#pragma once

#include <vector>

#include "common/core/mesh.h"
#include "common/core/mesh_topology.h"
#include "common/core/progress.h"

namespace meshcomplete {

/// Half-edge `3 * f + k` goes from corner k to corner k + 1 of face f; the mesh's faces come first.
struct CappedSurface {
  std::vector<Index> opposite;  ///< of each half-edge; it runs the other way
  std::vector<Index> origin;    ///< the vertex that each half-edge comes from
  std::vector<Index> outgoing;  ///< a half-edge from each vertex
  std::vector<Index> original;  ///< each vertex's number in the mesh; `no_vertex` for the middle of a cap
  Index first_cap = 0;          ///< faces from here on are caps

  static constexpr Index no_vertex = 0xffffffffu;

  static Index next(Index h) { return h % 3 == 2 ? h - 2 : h + 1; }
  static Index previous(Index h) { return h % 3 == 0 ? h + 2 : h - 1; }
  Index target(Index h) const { return origin[next(h)]; }
  /// The next half-edge from the same vertex, clockwise seen from outside.
  Index turned(Index h) const { return next(opposite[h]); }
  bool in_cap(Index h) const { return h / 3 >= first_cap; }
};

/// The mesh's edges have at most two faces, which run opposite ways there, and no face repeats a corner. Each
/// fan of faces gets a vertex of its own; each boundary loop (following fans) a cap: faces from its edges to
/// a vertex in the middle. Cost: O(faces).
CappedSurface cap_surface(const TriangleMesh& mesh, const MeshTopology& topology,
                          const Progress& progress = Progress());

}  // namespace meshcomplete
