// The vertices of the input with which the refinement begins.
#pragma once

#include <functional>
#include <vector>

#include "common/core/boundary_loops.h"
#include "common/core/mesh.h"
#include "common/core/mesh_topology.h"
#include "common/core/triangle_blocks.h"

namespace meshcomplete {

/// Vertices of a mesh, as the refinement takes them.
struct InitialPoints {
  std::vector<Index> vertices;    ///< of the mesh: first those on the rims, then the rings', then the samples
  std::size_t on_rims = 0;        ///< how many are on the rims
  std::vector<Index> half_edges;  ///< boundary half-edges of the loops, then inner ones of faces there
  std::size_t rim_edges = 0;      ///< how many are boundary half-edges
};

/// The vertices of the loops, those of `rings` rings of faces round them, those nearer to them than
/// `neighbourhood` (mesh units, at a vertex of a loop), and about `sample_share` of the others, spread
/// evenly, with some of every connected component. Source: the paper's E_0, section 3.3. Cost: O(faces *
/// rings).
InitialPoints choose_initial_points(const TriangleMesh& mesh, const MeshTopology& topology,
                                    const std::vector<const BoundaryLoop*>& loops, int rings,
                                    const std::function<double(const Vector3&)>& neighbourhood,
                                    const TriangleBlocks& blocks, double sample_share);

}  // namespace meshcomplete
