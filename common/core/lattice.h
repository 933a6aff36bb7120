// A cube of space with integer coordinates, in which questions about triangles and boxes have exact answers.
#pragma once

#include <array>
#include <cstdint>

#include "common/core/box_tree.h"
#include "common/core/mesh.h"

namespace meshcomplete {

/// Coordinates in steps of a lattice; those inside the cube lie between 0 and `Lattice::steps`.
using LatticePoint = std::array<std::int64_t, 3>;
using LatticeTriangle = std::array<LatticePoint, 3>;

/// A closed axis-aligned box, flat where `low` equals `high`.
struct LatticeBox {
  LatticePoint low, high;

  bool contains(const LatticePoint& p) const {
    return low[0] <= p[0] && p[0] <= high[0] && low[1] <= p[1] && p[1] <= high[1] && low[2] <= p[2] &&
           p[2] <= high[2];
  }
};

/// A cube divided into 2^30 cells along each side, and every cell into 2^8 steps. What is snapped to the
/// lattice gets odd coordinates, so that it lies on no plane between cells, nor on one through the middles of
/// cells. 38 bits a coordinate are few enough for the predicates below to be exact in 128 bits.
class Lattice {
 public:
  static constexpr int depth = 30;                      ///< halvings of the cube down to a cell
  static constexpr std::int64_t cell = 256;             ///< steps of the smallest cell
  static constexpr std::int64_t steps = cell << depth;  ///< of the whole cube

  /// `origin` is the cube's lowest corner, `side` its length in mesh units (positive).
  Lattice(const Vector3& origin, double side)
      : origin_(origin), side_(side), scale_(static_cast<double>(steps) / side) {}

  /// The nearest point with odd coordinates. `position` must lie inside the cube.
  LatticePoint snap(const Vector3& position) const;
  Vector3 position(const LatticePoint& p) const;
  double side() const { return side_; }
  double step() const { return side_ / static_cast<double>(steps); }  ///< mesh units
  /// In mesh units, wider than the exact box by more than what snapping and rounding move a point by.
  Box around(const LatticeBox& box) const;

 private:
  Vector3 origin_;
  double side_, scale_;
};

/// The sign of the volume of the tetrahedron: positive when `a`, `b`, `c` appear counter-clockwise seen from
/// `d`, which then lies on the side that the triangle's normal points to. Exact.
int orientation(const LatticePoint& a, const LatticePoint& b, const LatticePoint& c, const LatticePoint& d);

/// The sign of component `axis` of the triangle's normal. Exact.
int normal_sign(const LatticeTriangle& triangle, int axis);

/// Whether the closed triangle and the closed box have a point in common. Exact. Sides of the box must be
/// even numbers.
bool meets(const LatticeTriangle& triangle, const LatticeBox& box);

/// Whether the closed segment and the closed box have a point in common. Exact. Sides of the box must be even
/// numbers.
bool meets(const LatticePoint& a, const LatticePoint& b, const LatticeBox& box);

/// How the segment from `from` to `to` passes through a triangle: `none` when they do not meet; `to_front`
/// and `to_back` when inner points of both meet; `touches` when it meets a corner or side, or the triangle
/// with an end. A segment in the triangle's plane always counts as touching. Exact.
enum class Passage { none, to_front, to_back, touches };
Passage passage(const LatticePoint& from, const LatticePoint& to, const LatticeTriangle& triangle);

/// Where the segment meets the triangle's plane, as a share of the segment; for a segment with a `passage`.
double passage_parameter(const LatticePoint& from, const LatticePoint& to, const LatticeTriangle& triangle);

}  // namespace meshcomplete
