// Facets that lie over the input's own faces, taken off a patch.
#pragma once

#include <cstddef>

#include "common/core/mesh.h"
#include "common/core/mesh_topology.h"
#include "common/core/sheets.h"

namespace meshcomplete {

/// Where the triangulation has other diagonals than the mesh, facets between rim vertices alone may stand for
/// faces of the mesh: then rim edges have two facets, and others one. Takes off those facets for which that
/// leaves fewer such edges, the worst first, of equal ones those nearest to the mesh's own faces. Returns how
/// many. Cost: O(n log n).
std::size_t drop_surplus_facets(SeparatingSurface& surface, const TriangleMesh& mesh,
                                const MeshTopology& topology);

}  // namespace meshcomplete
