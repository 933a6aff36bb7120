// Where a mesh is open: its boundary loops, each a simple cycle of vertices.
#pragma once

#include <string>
#include <vector>

#include "common/core/mesh.h"
#include "common/core/mesh_topology.h"
#include "common/core/progress.h"

namespace meshcomplete {

/// Why a boundary loop cannot be closed by any patch that keeps the input as it is.
enum class LoopDefect {
  none,
  non_manifold_edge,     ///< edges with three or more faces end at the loop, and how it goes on there is
                         ///< ambiguous
  inconsistent_normals,  ///< the faces along the loop do not agree which side is the front
  isolated_triangle,     ///< the rim of a single triangle
  open_sheet,           ///< the outer rim of a nearly flat sheet: a patch would cover the sheet a second time
  edge_without_length,  ///< two neighbouring vertices of the loop lie at the same position
  degenerate_rim,       ///< all vertices of the loop lie on one line
};

/// What a user is told about a defect: what it is, and which MeshLab filter mends it.
std::string describe(LoopDefect defect);

/// One boundary loop. `vertices[i] -> vertices[i + 1]` (cyclic) is the direction in which a patch triangle
/// walks the edge: against the face that is there. Every vertex occurs once.
struct BoundaryLoop {
  std::vector<Index> vertices;
  std::vector<Index>
      faces;  ///< `faces[i]` is the one triangle at the edge from `vertices[i]` to `vertices[i + 1]`.
  LoopDefect defect = LoopDefect::none;
};

/// Traces all boundary loops. Loops follow the fans of faces round each vertex, and are cut where they
/// revisit a vertex, so that two holes that touch at a vertex are two loops. Where a fan ends at a
/// non-manifold edge the loop goes on with the other loose end at that vertex, when there is just one. A loop
/// with a defect may be an open chain. Order: by smallest vertex index, each loop starting there. Cost:
/// O(boundary) after the topology, and for a loop whose surface may be an open sheet as many faces as cover
/// about its area.
std::vector<BoundaryLoop> trace_boundary_loops(const TriangleMesh& mesh, const MeshTopology& topology,
                                               const Progress& progress = Progress());

/// The half-edge of the mesh at the loop's edge from `vertices[edge]` to the next; it runs against the loop.
Index half_edge_at(const TriangleMesh& mesh, const BoundaryLoop& loop, std::size_t edge);

/// Sum of the edge lengths of a loop.
double perimeter(const TriangleMesh& mesh, const BoundaryLoop& loop);

}  // namespace meshcomplete
