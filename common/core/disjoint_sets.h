// Which of many things hang together: sets that are united two by two.
#pragma once

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <vector>

#include "common/core/mesh.h"

namespace meshcomplete {

/// Every number below `count` is a set by itself at first. The least member of a set stands for it, whatever
/// the order in which sets were united. Cost: nearly constant for each call.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), Index(0));
  }

  std::size_t size() const { return parent_.size(); }

  /// The member that stands for the set of `i`.
  Index root(Index i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }

  /// Unites the sets of `a` and `b`; whether they were apart.
  bool unite(Index a, Index b) {
    a = root(a);
    b = root(b);
    parent_[std::max(a, b)] = std::min(a, b);
    return a != b;
  }

 private:
  std::vector<Index> parent_;
};

}  // namespace meshcomplete
