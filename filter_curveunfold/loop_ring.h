// A closed polygon from which points are taken and into which they are put, with a search structure that
// keeps up.
#pragma once

#include <cstddef>
#include <vector>

#include "filter_curveunfold/loop_geometry.h"
#include "filter_curveunfold/loop_tree.h"

namespace meshcomplete {

/// Distances below this share of the loop's size (about 1) are indistinguishable from contact after the
/// rounding of the distance computations; a triangle that comes as near to another strand counts as met.
constexpr double contact = 1e-12;

/// Likewise for directions, radians.
constexpr double contact_angle = 1e-9;

/// Some of the points of a loop, each linked with those before and after it. Edge `i` goes from point i to
/// `after[i]`; points keep their original numbers.
struct LoopRing {
  Loop position;
  std::vector<std::size_t> before, after;
  std::vector<char> present;
  LoopTree tree;

  /// `members` are the points that are there to begin with, in the order of the loop.
  LoopRing(const Loop& loop, const std::vector<std::size_t>& members);

  void remove(std::size_t point);

  /// Puts a point, at its `position`, on the edge between two neighbours.
  void insert(std::size_t point, std::size_t from, std::size_t to);

  /// Whether no part of the loop but the edges at `from` and `to` themselves comes nearer than `margin` to
  /// the triangle from - apex - to, and those edges leave it by an angle with a sine above `least_sine`.
  /// `skip` is the point at the apex when it is in the ring.
  bool is_clean(std::size_t from, const Vector3& apex, std::size_t to, std::size_t skip, double margin,
                double least_sine) const;
};

/// Where a point stands against a chord from a to b.
struct ChordHeight {
  double along;   ///< position of its foot on the chord, 0 at a, 1 at b
  double height;  ///< its distance from the chord
  double chord;   ///< the chord's length
};
ChordHeight height_over_chord(const Vector3& a, const Vector3& p, const Vector3& b);

}  // namespace meshcomplete
