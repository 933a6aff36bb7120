// The cubes of an octree that are cut into convex cells, and the squares on which their cells end.
#pragma once

#include <array>
#include <map>
#include <memory>
#include <unordered_map>
#include <vector>

#include "filter_atomicvolumes/convex_cells.h"
#include "filter_atomicvolumes/decomposition.h"
#include "filter_atomicvolumes/square_triangulation.h"

namespace meshcomplete {

/// A square's triangulation that holds the cuts of the cells on both sides.
struct CellSquare {
  SquareTriangulation triangulation;
  /// Below and above: the cell beside each triangle, numbered in its cube. Empty where there are no cells.
  std::array<std::vector<Index>, 2> cells;
  /// Below and above: the points of the triangulation at the cells' vertices and along their edges.
  std::array<std::unordered_map<Index, Index>, 2> points;
  std::array<std::unordered_map<Index, std::vector<Index>>, 2> chains;
};

/// Refers to its arguments, which must outlive it.
class CellCubes {
 public:
  CellCubes(const LatticeMesh& mesh, const Decomposition& decomposition,
            const std::vector<LeafSquare>& squares)
      : mesh_(mesh), decomposition_(decomposition), squares_(squares) {}

  /// The three steps of the work, one after the other: `list` finds the unresolved leaves, `cut` cuts one of
  /// them, for each a call from any thread (`squares` are those round it; throws `Coincidence`; cost: that of
  /// `cut_into_cells`), and `meet` finds out where their cuts meet the lines of the octree.
  void list();
  void cut(std::size_t i, const std::vector<Index>& squares);
  void meet();

  const std::vector<Index>& cubes() const { return cubes_; }  ///< ascending
  const ConvexCells& cells(std::size_t i) const { return *cells_[i]; }
  /// Whether cells end on the square, or their cuts on its sides.
  bool touch(Index square) const;
  /// For a square that they touch. `candidates` are the mesh triangles that may cross it. Thread-safe.
  CellSquare triangulate(Index square, const std::vector<Index>& candidates) const;

 private:
  struct LinePoint {
    const ExactPoint* point;
    LatticePoint origin;
  };
  using Line = std::array<std::int64_t, 3>;  // axis, and the coordinates in the other two
  using Range = std::pair<std::size_t, std::size_t>;

  void divide_faces(std::size_t i, const std::vector<Index>& squares);
  void divide(std::size_t i, const std::map<LatticePoint, Index>& at, const LatticePoint& low,
              std::int64_t length, int axis, std::vector<Index> facets);
  static Line line(int axis, const LatticePoint& p) { return {axis, p[(axis + 1) % 3], p[(axis + 2) % 3]}; }
  Range between(const std::vector<LinePoint>& points, int axis, const LatticePoint& low,
                std::int64_t length) const;
  template <class Visit>
  void visit_sides(const LeafSquare& square, Visit&& visit) const;
  void assign(CellSquare& result, int place, std::size_t i, const std::vector<Index>& facets) const;

  const LatticeMesh& mesh_;
  const Decomposition& decomposition_;
  const std::vector<LeafSquare>& squares_;
  std::vector<Index> cubes_;
  std::vector<std::unique_ptr<ConvexCells>> cells_;
  std::vector<std::unordered_map<Index, std::vector<Index>>>
      facets_in_;                                   // of each cube: square to facets on it
  std::map<Line, std::vector<LinePoint>> on_line_;  // ascending, no two equal
};

}  // namespace meshcomplete
