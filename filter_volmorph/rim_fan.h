// The triangle fan over one rim.
#pragma once

#include "common/core/boundary_loops.h"
#include "common/core/mesh.h"
#include "common/core/patch.h"

namespace meshcomplete {

/// One new vertex at the mean of the loop's vertices, rounded as it is stored, and one triangle for each of
/// the loop's edges, in their order. Says nothing about what the triangles meet. Source: Firestone (2008),
/// section 2.2.1. Cost: O(edges).
Patch rim_fan(const TriangleMesh& mesh, const BoundaryLoop& loop);

}  // namespace meshcomplete
