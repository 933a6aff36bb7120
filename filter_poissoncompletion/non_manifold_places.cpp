#include "filter_poissoncompletion/non_manifold_places.h"

#include <algorithm>
#include <tuple>

#include "common/core/disjoint_sets.h"

namespace meshcomplete {
namespace {

struct Side {
  Index low, high, half_edge;
  bool operator<(const Side& o) const {
    return std::tie(low, high, half_edge) < std::tie(o.low, o.high, o.half_edge);
  }
};

}  // namespace

std::vector<std::vector<Index>> non_manifold_places(const std::vector<Triangle>& triangles) {
  std::vector<Side> sides;
  Index past_vertices = 0;
  for (Index t = 0; t < triangles.size(); ++t)
    for (Index k = 0; k < 3; ++k) {
      const Index a = triangles[t][k], b = triangles[t][(k + 1) % 3];
      sides.push_back({std::min(a, b), std::max(a, b), 3 * t + k});
      past_vertices = std::max(past_vertices, a + 1);
    }
  std::sort(sides.begin(), sides.end());
  // Corners of one fan hang together through the edges with two triangles.
  DisjointSets fans(3 * triangles.size());
  const auto corner_at = [&](Index half_edge, Index vertex) {
    const Index next = half_edge % 3 == 2 ? half_edge - 2 : half_edge + 1;
    return triangles[half_edge / 3][half_edge % 3] == vertex ? half_edge : next;
  };
  std::vector<std::vector<Index>> places;
  std::vector<char> listed(past_vertices, 0);
  for (std::size_t i = 0, past = 0; i < sides.size(); i = past) {
    while (past < sides.size() && sides[past].low == sides[i].low && sides[past].high == sides[i].high)
      ++past;
    if (past - i == 2) {
      for (Index v : {sides[i].low, sides[i].high})
        fans.unite(corner_at(sides[i].half_edge, v), corner_at(sides[i + 1].half_edge, v));
      continue;
    }
    places.emplace_back();
    for (std::size_t k = i; k < past; ++k) places.back().push_back(sides[k].half_edge / 3);
    listed[sides[i].low] = listed[sides[i].high] = 1;
  }
  std::vector<std::vector<Index>> at(past_vertices);
  for (Index corner = 0; corner < fans.size(); ++corner)
    at[triangles[corner / 3][corner % 3]].push_back(corner);
  for (Index v = 0; v < past_vertices; ++v) {
    if (listed[v] || std::all_of(at[v].begin(), at[v].end(),
                                 [&](Index corner) { return fans.root(corner) == fans.root(at[v].front()); }))
      continue;
    places.emplace_back();
    for (Index corner : at[v]) places.back().push_back(corner / 3);
  }
  std::sort(places.begin(), places.end());
  return places;
}

}  // namespace meshcomplete
