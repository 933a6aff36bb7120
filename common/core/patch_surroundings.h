// What the triangles of a patch must not meet, near a place: the rest of the patch, the input, and other obstacles.
#pragma once

#include "common/core/mesh.h"
#include "common/core/patch_check.h"
#include "common/core/patch_mesh.h"

#include <array>
#include <cstddef>
#include <functional>
#include <vector>

namespace meshcomplete {

/// An axis-parallel box round triangles.
struct TriangleBox {
  Vector3 low, high;
  explicit TriangleBox(const std::array<Vector3, 3>& c)
      : low(c[0].cwiseMin(c[1]).cwiseMin(c[2])), high(c[0].cwiseMax(c[1]).cwiseMax(c[2])) {}
  void extend(const TriangleBox& other) {
    low = low.cwiseMin(other.low);
    high = high.cwiseMax(other.high);
  }
  void widen(double margin) {
    low -= Vector3::Constant(margin);
    high += Vector3::Constant(margin);
  }
  bool meets(const TriangleBox& other) const {
    return (low.array() <= other.high.array()).all() && (other.low.array() <= high.array()).all();
  }
};

/// Counts, exactly, how many triangles a triangle of the patch meets in more than shared corners and sides. Refers to its
/// arguments, which must outlive it. Not for more than one thread.
class PatchSurroundings {
 public:
  PatchSurroundings(const PatchMesh& patch, const InputNeighbourhood& input,
                    const std::vector<std::array<Vector3, 3>>& obstacles);

  std::array<Vector3, 3> corners(Index triangle) const;
  /// From now on only these triangles of the patch, and those made later, are looked at: for work in one place. They are the
  /// ones that meet a box a good deal wider than that of `triangles`. Cost: O(patch).
  void focus(const std::vector<Index>& triangles);
  /// Remembers what meets `box`: the patch's triangles, where `left_out` is false, the input's, and the obstacles.
  /// Cost: O(triangles in focus + log faces + triangles found).
  void collect(const TriangleBox& box, const std::function<bool(Index)>& left_out);
  /// The same round a star, a few triangles of the patch, whose vertices will move by at most `reach`.
  void collect_round(const std::vector<Index>& star, double reach);
  /// How many of the triangles remembered this one, inside the box, meets; it may stop counting at `enough`.
  /// A degenerate triangle meets nothing.
  std::size_t met_by(const std::array<Vector3, 3>& triangle, std::size_t enough = static_cast<std::size_t>(-1)) const;
  /// How many triangles those of the star, remembered before, meet where they are now, each other included; a degenerate one
  /// counts as `degenerate_cost`. At most `enough`.
  std::size_t met_by_star(const std::vector<Index>& star, std::size_t enough = static_cast<std::size_t>(-1)) const;
  /// More than any likely number of meetings.
  static constexpr std::size_t degenerate_cost = 1000;

 private:
  const PatchMesh& patch_;
  const InputNeighbourhood& input_;
  std::vector<std::array<Vector3, 3>> obstacles_;  // those that the patch could reach
  std::vector<Index> in_focus_;  // of the patch
  std::size_t first_after_ = 0;  // triangles from here on are in focus too
  struct Nearby {
    TriangleBox box;
    std::array<Vector3, 3> corners;
  };
  std::vector<Nearby> nearby_;
};

}  // namespace meshcomplete
