// Vertices that several fans of faces share, and the copies that take them apart.
#pragma once

#include <vector>

#include "common/core/mesh.h"
#include "common/core/mesh_topology.h"

namespace meshcomplete {

/// One fan of faces that gets a copy of the vertex, at the same place.
struct VertexSplit {
  Index vertex = 0;
  std::vector<Index> faces;  ///< all faces of the fan, ascending
};

/// What makes every vertex the middle of one fan: of the fans at a vertex the one with the lowest face keeps
/// it, and each other one is in the list. A fan is what hangs together by edges that two faces share; faces
/// that name a vertex twice are in none. Order: by vertex, then by lowest face. Source: Firestone (2008),
/// section 2.2.1, "overlapping vertices". Cost: near-linear in the faces.
std::vector<VertexSplit> split_overlapping_vertices(const TriangleMesh& mesh, const MeshTopology& topology);

/// Adds the copies, in the order of the list, and gives them to their faces. Cost: O(faces of the fans).
void apply_splits(TriangleMesh& mesh, const std::vector<VertexSplit>& splits);

}  // namespace meshcomplete
