// Fans of a patch that touch the rim or each other at a vertex, moved apart.
#pragma once

#include <vector>

#include "common/core/mesh.h"
#include "common/core/sheets.h"

namespace meshcomplete {

/// The fan round a vertex that lies where something else is.
struct TouchingFan {
  Index vertex;  ///< its own
  Index input;   ///< the boundary vertex of the mesh at this position, `SheetVertex::none` when there is none
  Index rim_edge;  ///< the boundary half-edge on which it lies, else `none`
};

/// Moves the vertices of these fans by a small part of their edges, into the inside behind the fan, which is
/// where the mesh and the other fans at the position are not: to the first of several places at which the
/// fan's triangles meet neither the mesh's triangles at the position nor the patch's triangles round it
/// (exact). Cost: O(vertices + triangles), and a pass over the mesh's triangles when a fan lies at a boundary
/// vertex.
void retreat(const TriangleMesh& mesh, const std::vector<TouchingFan>& fans,
             const std::vector<Triangle>& triangles, std::vector<SheetVertex>& vertices);

}  // namespace meshcomplete
