// Which faces meet at which edge: the adjacency that boundary tracing and statistics need, built in one
// linear pass.
#pragma once

#include <cstddef>
#include <vector>

#include "common/core/mesh.h"
#include "common/core/progress.h"

namespace meshcomplete {

/// Half-edge `3 * f + k` goes from corner k to corner k + 1 of triangle f.
struct MeshTopology {
  static constexpr Index boundary = 0xffffffffu;      ///< the edge has one face
  static constexpr Index non_manifold = 0xfffffffeu;  ///< the edge has three or more faces

  /// For each half-edge the other half-edge at the same undirected edge, or `boundary`, or `non_manifold`.
  /// The other one runs the opposite way when the two faces are oriented alike, and the same way when they
  /// are not. (For a degenerate face: a value above that of every half-edge.)
  std::vector<Index> opposite;
  std::vector<Index> boundary_half_edges;      ///< ascending
  std::vector<Index> non_manifold_half_edges;  ///< ascending
  std::vector<Index>
      degenerate_faces;  ///< triangles with a repeated corner; their half-edges are left out everywhere
};

/// Throws CompletionError when a triangle names a vertex that does not exist, or the mesh has 2^30 triangles
/// or more. Cost: O(faces), threaded; 4 bytes of scratch per half-edge and 4 per vertex.
MeshTopology build_topology(const TriangleMesh& mesh, const Progress& progress = Progress());

/// The number of faces of a piece of the mesh (connected by edges) that holds one of the faces `starts` and
/// none of `others`, and has at most `limit` faces; 0 when there is no such piece. What ends at a
/// non-manifold edge is no piece of its own. Cost: O(`limit`) for every start.
std::size_t separate_piece(const MeshTopology& topology, const std::vector<Index>& starts,
                           const std::vector<Index>& others, std::size_t limit);

}  // namespace meshcomplete
