// A cube cut by planes into convex cells that share their facets, edges and vertices.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "common/core/mesh.h"
#include "filter_atomicvolumes/exact_planes.h"

namespace meshcomplete {

/// Coordinates are relative to the cube's centre. Every cut keeps the complex conforming: a vertex put on an
/// edge is a corner of all facets there, and two cells meet in whole facets. A cell may have several facets
/// in one plane. Exact.
class CellComplex {
 public:
  static constexpr Index none = 0xffffffffu;

  struct Edge {
    std::array<Index, 2> ends, planes;  ///< it lies where two different planes meet
    std::vector<Index> facets;
  };
  struct Facet {
    Index plane;
    std::vector<Index> corners;  ///< counter-clockwise seen from the plane's positive side
    std::vector<Index> sides;    ///< the edge from each corner to the next
    std::array<Index, 2> cells;  ///< on the positive side of the plane and on the negative; `none` outside
    std::int8_t wall = 0;        ///< what the caller wants to remember, inherited by its parts
  };
  struct Cell {
    std::vector<Index> facets;
  };

  /// A cube with sides of 2 * `half`. Plane 2 * k + 1 is its upper face across axis k, 2 * k the lower one.
  explicit CellComplex(std::int64_t half);

  /// The number of the plane; the same for equal planes whatever their orientation, which may be turned over.
  std::pair<Index, bool> add_plane(ExactPlane plane);

  const std::vector<ExactPlane>& planes() const { return planes_; }
  const std::vector<ExactPoint>& points() const { return points_; }
  const std::vector<Edge>& edges() const { return edges_; }
  const std::vector<Facet>& facets() const { return facets_; }
  const std::vector<Cell>& cells() const { return cells_; }

  static bool on_surface(const Facet& facet) { return facet.plane < 6; }
  /// A plane through the facet's side that is not the facet's.
  Index plane_through_side(Index facet, std::size_t place) const;
  /// The side of the plane on which a vertex lies. Remembered for the plane that was asked for last.
  int side(Index plane, Index vertex);
  /// Whether the plane meets the cell's interior.
  bool crosses(Index plane, Index cell);
  void mark(Index facet, std::int8_t wall) { facets_[facet].wall = wall; }

  /// Cuts a cell that the plane crosses: it becomes the part on the positive side; returns the other one.
  Index split(Index cell, Index plane);
  /// Cuts a facet, and not the cells beside it, where the plane crosses it; returns the part on the negative
  /// side, `none` when the plane does not cross it.
  Index split_facet(Index facet, Index plane);

 private:
  void split_edge(Index edge, Index plane);
  void split_sides(Index facet, Index plane);
  Index cut_facet(Index facet, Index plane);
  void close(Index positive, Index negative, Index plane);
  bool crosses_facet(Index facet, Index plane);

  std::vector<ExactPlane> planes_;
  std::map<ExactPlane, Index> plane_number_;
  std::vector<ExactPoint> points_;
  std::vector<std::pair<Index, int>> last_side_;  // per vertex, a plane and the side
  std::vector<Edge> edges_;
  std::vector<Facet> facets_;
  std::vector<Cell> cells_;
};

}  // namespace meshcomplete
