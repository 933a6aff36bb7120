#include "filter_atomicvolumes/springs.h"

#include <algorithm>
#include <utility>

namespace meshcomplete {

Springs::Springs(const LabelledSurface& surface) : first_(surface.vertices.size() + 1, 0) {
  std::vector<std::pair<Index, Index>> edges;
  for (const Triangle& t : surface.triangles)
    for (int k = 0; k < 3; ++k) {
      edges.emplace_back(t[k], t[(k + 1) % 3]);
      edges.emplace_back(t[(k + 1) % 3], t[k]);
    }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  for (const auto& [from, to] : edges) {
    ++first_[from + 1];
    neighbours_.push_back(to);
  }
  for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
}

}  // namespace meshcomplete
