// A hierarchy of bounding boxes over the segments of a closed polygon, in the order of the polygon.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "filter_curveunfold/loop_geometry.h"

namespace meshcomplete {

/// Boxes over runs of consecutive segments: neighbours along a curve are neighbours in space, so that the
/// order of the polygon is a good hierarchy that never has to be rebuilt when the polygon moves. Segments can
/// be replaced and taken out. Cost: O(n) to build and to refit, O(log n) to change a segment.
class LoopTree {
 public:
  struct Box {
    std::array<double, 3> low;
    std::array<double, 3> high;
    bool overlaps(const Box& other) const;
    double squared_distance(const Box& other) const;  ///< 0 when they overlap
  };

  /// Segment i goes from point i to the next.
  explicit LoopTree(const Loop& loop);

  /// The points have moved. Cost: O(n).
  void refit(const Loop& loop);

  void set_segment(std::size_t segment, const Vector3& from, const Vector3& to);
  void remove_segment(std::size_t segment);

  static Box box_of(const Vector3& a, const Vector3& b);
  static Box grown(Box box, double margin);

  /// Calls `visit(segment)` for the segments whose boxes overlap `box` until it returns false. Returns
  /// whether it never did.
  template <typename Visit>
  bool for_each_in_box(const Box& box, Visit&& visit) const;

  /// Calls `visit(i, j)` (i < j) for pairs of segments with overlapping boxes until it returns false. Returns
  /// whether it never did.
  template <typename Visit>
  bool for_each_overlapping_pair(Visit&& visit) const;

  /// The least distance between two segments without a common point, at most `upper` (which cuts the search
  /// short). The loop is the one last given. Returns `upper` when no pair is nearer.
  double least_distance(const Loop& loop, double upper) const;

 private:
  template <typename Visit>
  bool visit_pairs(std::size_t a, std::size_t b, Visit& visit) const;
  void refit_upwards(std::size_t segment);
  bool is_empty(std::size_t node) const { return boxes_[node].low[0] > boxes_[node].high[0]; }

  std::size_t segments_;
  std::size_t leaves_;      // segments_ rounded up to a power of two
  std::vector<Box> boxes_;  // a binary heap: the children of node k are 2 k and 2 k + 1; leaves come last
};

template <typename Visit>
bool LoopTree::for_each_in_box(const Box& box, Visit&& visit) const {
  std::array<std::size_t, 128> stack;
  std::size_t size = 0;
  stack[size++] = 1;
  while (size > 0) {
    const std::size_t node = stack[--size];
    if (!boxes_[node].overlaps(box)) continue;
    if (node >= leaves_) {
      if (!visit(node - leaves_)) return false;
    } else {
      stack[size++] = 2 * node + 1;
      stack[size++] = 2 * node;
    }
  }
  return true;
}

template <typename Visit>
bool LoopTree::visit_pairs(std::size_t a, std::size_t b, Visit& visit) const {
  if (is_empty(a) || is_empty(b)) return true;
  if (a != b && !boxes_[a].overlaps(boxes_[b])) return true;
  if (a >= leaves_) return a == b || visit(a - leaves_, b - leaves_);
  if (a == b) {
    return visit_pairs(2 * a, 2 * a, visit) && visit_pairs(2 * a + 1, 2 * a + 1, visit) &&
           visit_pairs(2 * a, 2 * a + 1, visit);
  }
  return visit_pairs(2 * a, 2 * b, visit) && visit_pairs(2 * a, 2 * b + 1, visit) &&
         visit_pairs(2 * a + 1, 2 * b, visit) && visit_pairs(2 * a + 1, 2 * b + 1, visit);
}

template <typename Visit>
bool LoopTree::for_each_overlapping_pair(Visit&& visit) const {
  return visit_pairs(1, 1, visit);
}

}  // namespace meshcomplete
