// Small gaps between a patch in the making and its rims, closed by triangles between their corners.
#pragma once

#include <cstddef>
#include <vector>

#include "common/core/mesh.h"
#include "common/core/sheets.h"

namespace meshcomplete {

struct SurfaceGapFigures {
  std::size_t closed = 0;   ///< gaps
  std::size_t left = 0;     ///< gaps that were too large, or have no triangulation without a second edge
  std::size_t largest = 0;  ///< edges of the largest gap
};

/// Where the triangulation has other edges than the mesh, a surface may miss rims by a few facets. Follows
/// the edges that have more facets on one side than on the other, the mesh's own face at each of the
/// `rim_half_edges` counted in, and closes each loop of them by the triangles with the least sum of squared
/// sides, never with an edge that the surface or the mesh has already. Source: the paper, section 3.4, and
/// Liepa, "Filling holes in meshes" (2003). Cost: O(n) for n facets, and O(k^3) for a gap of k edges; where
/// there is a gap one pass over the mesh's faces.
SurfaceGapFigures close_gaps(SeparatingSurface& surface, const TriangleMesh& mesh,
                             const std::vector<Index>& rim_half_edges);

}  // namespace meshcomplete
