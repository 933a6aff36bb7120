// The mesh round a hole: what a patch continues, and what it must not double.
#pragma once

#include <vector>

#include "common/core/boundary_loops.h"
#include "common/core/mesh.h"
#include "common/core/mesh_topology.h"
#include "common/core/patch_check.h"
#include "common/core/patch_remeshing.h"

namespace meshcomplete {

struct Rim {
  std::vector<Vector3>
      positions;            ///< of the loop's vertices, in its order; of several loops one after the other
  std::vector<Index> next;  ///< the position in `positions` that follows along the loop
  /// The faces in the fans between the loop's edges (the one-ring), as a mesh of its own whose first vertices
  /// are the loop's in its order.
  TriangleMesh ring;
  std::vector<double>
      edge_length;  ///< per loop vertex: mean length of the ring's edges near it, the resolution to match
  ForbiddenEdges forbidden;  ///< places in `positions` of vertices that an input edge joins, and from those
                             ///< that the loops visit more than once to all near by; neighbours left out
};

/// Cost: O(faces of the ring).
Rim collect_rim(const TriangleMesh& mesh, const MeshTopology& topology, const BoundaryLoop& loop);

/// The rim of a hole with several loops. A vertex that they visit twice is in `positions` twice; the ring's
/// faces at it use its first place.
Rim collect_rim(const TriangleMesh& mesh, const MeshTopology& topology,
                const std::vector<BoundaryLoop>& loops);

/// Whether the input comes between two of its vertices: a triangle without a corner at either end meets the
/// segment. Exact. Cost: O(log faces + triangles whose box meets that of the segment), until the first one is
/// found.
bool is_obstructed(const InputNeighbourhood& input, const Vector3& a, const Vector3& b);

/// The edges of the rim (positions of their first vertices in the loop) through which the input itself
/// passes: triangles without a corner at the edge meet it. No patch can close such an edge without meeting
/// those triangles. Exact. Cost: O(edges times (log faces + triangles nearby)).
std::vector<Index> obstructed_edges(const InputNeighbourhood& input, const BoundaryLoop& loop);

}  // namespace meshcomplete
