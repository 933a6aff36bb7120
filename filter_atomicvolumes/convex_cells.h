// A hole cube that is not trivial, cut into convex cells that the mesh does not cross.
#pragma once

#include <utility>
#include <vector>

#include "common/core/octree.h"
#include "filter_atomicvolumes/cell_complex.h"
#include "filter_atomicvolumes/hole_cube.h"
#include "filter_atomicvolumes/lattice_mesh.h"

namespace meshcomplete {

/// What a facet is to the mesh (`CellComplex::Facet::wall`).
enum FacetWall : std::int8_t {
  no_wall = 0,
  wall_facing_up = 1,    ///< the mesh lies in it, its front on the positive side of the facet's plane
  wall_facing_down = 2,  ///< its front on the negative side
};

struct ConvexCells {
  LatticePoint centre;  ///< the origin of the complex's coordinates
  CellComplex complex;
  std::vector<Side> sides;  ///< of each cell
  /// The boundary half-edges of the mesh on which a vertex lies; per vertex.
  std::vector<std::vector<Index>> rims;
  std::vector<std::pair<Index, Index>> rim_vertices;  ///< vertices that are boundary vertices, and which
  std::size_t contradicting =
      0;  ///< cells that the mesh wants inside and outside, because it intersects itself

  explicit ConvexCells(const LatticePoint& middle, std::int64_t half) : centre(middle), complex(half) {}
};

/// `triangles` are those that meet the cube. Source: the paper's section 3.1. Cells are cut by the planes of
/// the triangles that meet their interior, then by planes through the boundary edges, nearly at right angles
/// to the edge's triangle. Those that touch the mesh elsewhere than on its boundary are fixed: outside before
/// it, inside behind it; a cell between two walls that contradict each other is cut once more. Throws
/// `Coincidence`. Thread-safe. Cost: O(n^2) for n triangles at worst, in practice less.
ConvexCells cut_into_cells(const LatticeMesh& mesh, const LatticeBox& cube,
                           const std::vector<Index>& triangles);

/// The volume of each cell, in cubic steps; rounded.
std::vector<double> cell_volumes(const ConvexCells& cells);

}  // namespace meshcomplete
