// An adaptive octree over a lattice: cubes split where the caller asks, and the squares in which leaves
// touch.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "common/core/lattice.h"

namespace meshcomplete {

/// Cubes are numbered in the order in which they were made; cube 0 is the whole lattice. The eight children
/// of a cube have consecutive numbers; bit k of a child's place says whether it lies in the upper half along
/// axis k.
class Octree {
 public:
  static constexpr Index none = 0xffffffffu;

  struct Cube {
    LatticePoint low = {0, 0, 0};
    int depth = 0;
    Index children = none;  ///< the first of eight, or `none` for a leaf
  };

  Octree() : cubes_(1) {}

  std::size_t size() const { return cubes_.size(); }
  const Cube& operator[](Index cube) const { return cubes_[cube]; }
  bool is_leaf(Index cube) const { return cubes_[cube].children == none; }
  static std::int64_t side(int depth) { return Lattice::steps >> depth; }
  LatticeBox box(Index cube) const;
  LatticePoint centre(Index cube) const;

  /// Splits a leaf whose depth is less than `Lattice::depth`; returns its first child.
  Index split(Index leaf);

  /// The cube of at most this depth that holds the point; a point on a plane between cubes counts for the
  /// upper one. The point must lie in the root. Cost: O(depth).
  Index find(const LatticePoint& point, int depth = Lattice::depth) const;

  /// Whether the middle of a leaf's edge (or of part of one) is a corner of another leaf: one of the four
  /// cubes of side `length` round the edge is split. `start` is the edge's lower end, `axis` its direction.
  /// Cost: O(depth).
  bool has_midpoint(const LatticePoint& start, int axis, std::int64_t length) const;

  /// The corners of leaves on an edge from `start`, both ends included, in order. Cost: O(depth) per corner.
  std::vector<LatticePoint> corners_on(const LatticePoint& start, int axis, std::int64_t length) const;

 private:
  std::vector<Cube> cubes_;
};

/// Where two leaves touch: a face of the finer one.
struct LeafSquare {
  LatticePoint low;     ///< its lowest corner
  std::int64_t length;  ///< of its sides, in steps
  int axis;             ///< across which it lies
  Index below, above;   ///< the leaves on its two sides along the axis; `Octree::none` outside the root

  LatticeBox box() const;
  LatticePoint centre() const;
  /// Counter-clockwise seen from above: axes (axis + 1) % 3 and (axis + 2) % 3.
  std::array<LatticePoint, 4> corners() const;
};

/// All squares between leaves, and those on the outside of the root. Cost: O(leaves * depth).
std::vector<LeafSquare> leaf_squares(const Octree& octree);

}  // namespace meshcomplete
