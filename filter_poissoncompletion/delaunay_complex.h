// The tetrahedra of a refined Delaunay triangulation, and which of them lie inside the surface: what the
// surface is cut out of.
#pragma once

#include <array>
#include <vector>

#include "common/core/mesh.h"

namespace meshcomplete {

/// A Delaunay triangulation with a label for every cell. Two facets of its cells meet in nothing but common
/// vertices and edges, so that no surface made of them intersects itself.
struct DelaunayComplex {
  static constexpr Index none = 0xffffffffu;

  /// First the initial points, with their numbers, then `far_corners` ones round all the rest, then those
  /// that were inserted. Where initial points lie at one position, cells name the first of them.
  std::vector<Vector3> vertices;
  Index initial_points = 0;
  static constexpr Index far_corners = 8;
  /// For each vertex: the protected edge (by its number) that it divides, or `none`.
  std::vector<Index> on_edge;
  /// For each vertex: the vertex of the protected mesh that it is, or `none`.
  std::vector<Index> mesh_vertex;

  using Cell = std::array<Index, 4>;
  /// Corners of each cell; the last one lies on the side from which the first three look counter-clockwise.
  std::vector<Cell> cells;
  /// The cell beyond the facet that lies across from each corner; `none` at the hull.
  std::vector<Cell> neighbours;
  /// Whether the surface has the cell inside. What lies beyond the hull is outside.
  std::vector<char> inside;
  /// The function's value that decided it.
  std::vector<float> values;

  /// Protected edges that are not edges of the triangulation, nor divided into such; ascending.
  std::vector<Index> lost_edges;

  bool is_far(Index vertex) const { return vertex - initial_points < far_corners; }
  Index first_inserted() const { return initial_points + far_corners; }
  /// Whether the vertex was inserted on the surface, and is none of the protected mesh's.
  bool is_new(Index vertex) const {
    return vertex >= first_inserted() && on_edge[vertex] == none && mesh_vertex[vertex] == none;
  }
};

/// Which corners make the facet across from corner k: they look counter-clockwise from that corner.
inline Triangle facet_towards_corner(const DelaunayComplex::Cell& cell, int k) {
  static constexpr int corners[4][3] = {{1, 3, 2}, {0, 2, 3}, {0, 3, 1}, {0, 1, 2}};
  return {cell[corners[k][0]], cell[corners[k][1]], cell[corners[k][2]]};
}

/// The facets between inside and outside, the outside before them. Cost: O(cells).
std::vector<Triangle> separating_facets(const DelaunayComplex& complex);

}  // namespace meshcomplete
