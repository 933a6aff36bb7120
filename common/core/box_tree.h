// Bounding boxes and a tree over them: which of many boxes meet a given one.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include "common/core/mesh.h"

namespace meshcomplete {

/// Closed axis-aligned box. Empty when made, and an empty box meets nothing.
struct Box {
  std::array<double, 3> low = {std::numeric_limits<double>::infinity(),
                               std::numeric_limits<double>::infinity(),
                               std::numeric_limits<double>::infinity()};
  std::array<double, 3> high = {-std::numeric_limits<double>::infinity(),
                                -std::numeric_limits<double>::infinity(),
                                -std::numeric_limits<double>::infinity()};

  void include(const Box& other) {
    for (int k = 0; k < 3; ++k) {
      low[k] = std::min(low[k], other.low[k]);
      high[k] = std::max(high[k], other.high[k]);
    }
  }
  bool meets(const Box& other) const {
    return low[0] <= other.high[0] && other.low[0] <= high[0] && low[1] <= other.high[1] &&
           other.low[1] <= high[1] && low[2] <= other.high[2] && other.low[2] <= high[2];
  }
};

/// The box of three points; empty when a coordinate is infinite or not a number, so that such a triangle
/// meets nothing.
inline Box bounding_box(const Vector3& a, const Vector3& b, const Vector3& c) {
  Box box;
  for (int k = 0; k < 3; ++k) {
    if (!std::isfinite(a[k]) || !std::isfinite(b[k]) || !std::isfinite(c[k])) return Box();
    box.low[k] = std::min({a[k], b[k], c[k]});
    box.high[k] = std::max({a[k], b[k], c[k]});
  }
  return box;
}

/// The numbers of the boxes in an order in which neighbours in the list are neighbours in space (along a
/// Morton curve through the centres). Ties by number. Threaded. Cost: O(n log n).
std::vector<Index> spatial_order(const std::vector<Box>& boxes);

/// A balanced tree over boxes that the caller has put in a good order. Immutable, safe to ask from many
/// threads.
class BoxTree {
 public:
  BoxTree() = default;
  /// Threaded when there are many. Cost: O(n).
  explicit BoxTree(std::vector<Box> leaves);

  std::size_t size() const { return levels_.empty() ? 0 : levels_.front().size(); }
  const Box& leaf(std::size_t i) const { return levels_.front()[i]; }

  /// Calls `visit(leaf)`, ascending, for every leaf from `first` on whose box meets `box`, until it returns
  /// false. Returns whether it never did. Cost: O(log n + leaves visited) for leaves in a good order.
  template <class Visit>
  bool visit(const Box& box, Visit&& visit, std::size_t first = 0) const {
    return descend([&](const Box& node) { return node.meets(box); }, visit, first);
  }

  /// As `visit`, for the leaves for which `enter(box)` holds; it must hold for every box that contains such a
  /// leaf.
  template <class Enter, class Visit>
  bool descend(Enter&& enter, Visit&& visit, std::size_t first = 0) const {
    return levels_.empty() || walk(levels_.size() - 1, 0, levels_.back().size(), first, enter, visit);
  }

 private:
  static constexpr int fan_out_bits = 3;

  template <class Enter, class Visit>
  bool walk(std::size_t level, std::size_t begin, std::size_t end, std::size_t first, Enter& enter,
            Visit& visit) const {
    begin = std::max(begin, first >> (fan_out_bits * level));
    for (std::size_t i = begin; i < end; ++i) {
      if (!enter(levels_[level][i])) continue;
      if (level == 0) {
        if (!visit(i)) return false;
        continue;
      }
      const std::size_t child = i << fan_out_bits;
      const std::size_t past = std::min(child + (std::size_t{1} << fan_out_bits), levels_[level - 1].size());
      if (!walk(level - 1, child, past, first, enter, visit)) return false;
    }
    return true;
  }

  std::vector<std::vector<Box>>
      levels_;  ///< leaves first; box i of a level holds the boxes 8 i to 8 i + 7 below
};

}  // namespace meshcomplete
