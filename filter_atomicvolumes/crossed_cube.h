// A cube that the mesh crosses, away from its boundary: what is inside there and what outside is known
// already.
#pragma once

#include <optional>
#include <vector>

#include "filter_atomicvolumes/lattice_mesh.h"

namespace meshcomplete {

/// Whether the connected pieces of surface in the cube agree which part of it is inside: along a segment
/// between two of them the mesh is crossed from back to front and from front to back in turns (paper, figures
/// 4 and 5). One piece always agrees with itself, because it divides the cube. Pieces that intersect each
/// other do not count as contradicting. `triangles` are those that meet the cube. Cost: O(triangles), and for
/// every further piece O(triangles) again.
bool sides_agree(const LatticeMesh& mesh, const std::vector<Index>& triangles, const LatticeBox& cube);

/// Whether `point`, in the cube and not on the mesh, is inside: the first triangle met on the way to the mesh
/// decides. Absent when no way can be told from touching an edge. Cost: O(triangles).
std::optional<bool> is_inside(const LatticeMesh& mesh, const std::vector<Index>& triangles,
                              const LatticeBox& cube, const LatticePoint& point);

}  // namespace meshcomplete
