// The neighbours of a surface's vertices, and where they pull.
#pragma once

#include <vector>

#include "filter_atomicvolumes/extraction.h"

namespace meshcomplete {

/// Equal springs along the edges. Immutable.
class Springs {
 public:
  /// Cost: O(n log n) for n triangles.
  explicit Springs(const LabelledSurface& surface);

  /// Where the springs at a vertex of a triangle come to rest: the mean of its neighbours' positions.
  template <class Position>
  Vector3 rest(Index vertex, Position&& position) const {
    Vector3 sum = Vector3::Zero();
    for (std::size_t i = first_[vertex]; i < first_[vertex + 1]; ++i) sum += position(neighbours_[i]);
    return sum / static_cast<double>(first_[vertex + 1] - first_[vertex]);
  }

 private:
  std::vector<std::size_t> first_;  // of each vertex, in `neighbours_`
  std::vector<Index> neighbours_;
};

}  // namespace meshcomplete
