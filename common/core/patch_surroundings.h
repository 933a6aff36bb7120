// What the triangles of a patch must not meet, near a place: the rest of the patch, the input, and other
// obstacles.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <limits>
#include <vector>

#include "common/core/box_tree.h"
#include "common/core/mesh.h"
#include "common/core/patch_check.h"
#include "common/core/patch_mesh.h"

namespace meshcomplete {

/// Counts, exactly, how many triangles a triangle of the patch meets in more than shared corners and sides.
/// Refers to its arguments, which must outlive it. Not for more than one thread.
class PatchSurroundings {
 public:
  PatchSurroundings(const PatchMesh& patch, const InputNeighbourhood& input,
                    const std::vector<std::array<Vector3, 3>>& obstacles);

  std::array<Vector3, 3> corners(Index triangle) const;
  /// The box of some triangles of the patch.
  Box box_of(const std::vector<Index>& triangles) const;

  /// Makes work near `triangles` cheap: `collect` then looks only through what is near them, and through
  /// triangles made later. Without it, and for boxes that reach further, all are looked through. To be called
  /// again when the patch was compacted. Cost: O(patch + obstacles).
  void focus(const std::vector<Index>& triangles);

  /// Remembers what meets `box`: triangles of the patch for which `left_out` is false, the input's, and
  /// obstacles. Cost: O(triangles and obstacles in focus + log faces + triangles found).
  void collect(const Box& box, const std::function<bool(Index)>& left_out);
  /// The same round a star, a few triangles of the patch, whose vertices will move by at most `reach`.
  void collect_round(const std::vector<Index>& star, double reach);
  /// One triangle more, until the next `collect`.
  void add(const std::array<Vector3, 3>& triangle);

  /// How many of the triangles remembered this one, inside the box, meets; it may stop counting at `enough`.
  /// A degenerate triangle meets nothing. Cost: O(triangles remembered).
  std::size_t met_by(const std::array<Vector3, 3>& triangle,
                     std::size_t enough = std::numeric_limits<std::size_t>::max()) const;
  /// How many triangles those of the star, remembered before, meet where they are now, each other included; a
  /// degenerate one counts as `degenerate_cost`. At most `enough`.
  std::size_t met_by_star(const std::vector<Index>& star,
                          std::size_t enough = std::numeric_limits<std::size_t>::max()) const;
  /// More than any likely number of meetings.
  static constexpr std::size_t degenerate_cost = 1000;

 private:
  struct Nearby {
    Box box;
    std::array<Vector3, 3> corners;
  };

  const PatchMesh& patch_;
  const InputNeighbourhood& input_;
  std::vector<Nearby> obstacles_;
  bool focused_ = false;
  Box focus_;
  std::vector<Index> in_focus_;              // triangles of the patch
  std::vector<std::size_t> obstacles_near_;  // in focus
  std::size_t first_later_ = 0;              // triangles from here on were made after `focus`
  std::vector<Nearby> nearby_;
  bool ask_input_ = false;  // too many triangles of the input to remember
};

}  // namespace meshcomplete
