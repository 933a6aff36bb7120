#include "filter_atomicvolumes/atomic_volumes.h"

namespace meshcomplete {

std::vector<std::pair<std::string, double>> named(const AtomicVolumesFigures& figures) {
  const auto count = [](auto number) { return static_cast<double>(number); };
  return {{"leaves", count(figures.leaves)},
          {"blank leaves", count(figures.blank_leaves)},
          {"hole leaves", count(figures.hole_leaves)},
          {"crossed leaves", count(figures.crossed_leaves)},
          {"nodes", count(figures.nodes)},
          {"tetrahedra", count(figures.tetrahedra)},
          {"depth", count(figures.depth)},
          {"smallest leaf", figures.smallest_leaf},
          {"smallest distance", figures.smallest_distance},
          {"cut weight", figures.cut_weight},
          {"restarts", count(figures.restarts)}};
}

}  // namespace meshcomplete
