// What a list of triangles is, by the definitions: no adjacency of the library's is used.
#pragma once

#include <cstddef>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "common/core/mesh.h"

namespace meshcomplete {
namespace test {

using Edge = std::pair<Index, Index>;

/// The sum of the triangles' boundaries: how often each edge (smaller end first) is walked upwards more than
/// downwards. Edges where that is 0 are left out; of a closed oriented surface nothing is left.
inline std::map<Edge, int> boundary_of(const std::vector<Triangle>& triangles) {
  std::map<Edge, int> sum;
  for (const Triangle& t : triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const Index a = t[k], b = t[(k + 1) % 3];
      int& count = a < b ? sum[{a, b}] : sum[{b, a}];
      count += a < b ? 1 : -1;
    }
  for (auto at = sum.begin(); at != sum.end();) at = at->second == 0 ? sum.erase(at) : std::next(at);
  return sum;
}

struct Shape {
  bool manifold =
      true;        ///< no side walked twice in a direction, every vertex with one fan, no two faces alike
  long euler = 0;  ///< vertices - edges + faces
  std::size_t boundary = 0;    ///< edges with one face
  std::size_t components = 0;  ///< joined by vertices
};

inline Shape shape_of(const std::vector<Triangle>& triangles) {
  Shape shape;
  std::set<Edge> sides;
  std::set<std::set<Index>> faces;
  std::map<Index, std::map<Index, Index>> links;  // round each vertex from one neighbour to the next
  for (const Triangle& t : triangles) {
    const std::set<Index> corners(t.begin(), t.end());
    shape.manifold &= corners.size() == 3 && faces.insert(corners).second;
    for (std::size_t k = 0; k < 3; ++k) {
      shape.manifold &= sides.emplace(t[k], t[(k + 1) % 3]).second;
      shape.manifold &= links[t[k]].emplace(t[(k + 1) % 3], t[(k + 2) % 3]).second;
    }
  }
  std::size_t edges = 0;
  for (const auto& [a, b] : sides) {
    const bool paired = sides.count({b, a}) != 0;
    shape.boundary += !paired;
    edges += !paired || a < b;
  }
  std::map<Index, Index> parent;
  const auto root = [&](Index v) {
    while (parent.at(v) != v) v = parent[v] = parent.at(parent.at(v));
    return v;
  };
  for (const auto& entry : links) parent[entry.first] = entry.first;
  for (const auto& [a, b] : sides) parent[root(a)] = root(b);
  for (const auto& entry : links) {
    shape.components += root(entry.first) == entry.first;
    const std::map<Index, Index>& link = entry.second;
    // A path begins where nothing leads to, a cycle anywhere.
    std::set<Index> ends;
    for (const auto& [from, to] : link) ends.insert(to);
    Index start = link.begin()->first;
    for (const auto& [from, to] : link)
      if (!ends.count(from)) start = from;
    std::size_t length = 0;
    for (auto step = link.find(start); step != link.end() && length <= link.size();) {
      ++length;
      if (step->second == start) break;
      step = link.find(step->second);
    }
    shape.manifold &= length == link.size();
  }
  shape.euler =
      static_cast<long>(links.size()) - static_cast<long>(edges) + static_cast<long>(triangles.size());
  return shape;
}

}  // namespace test
}  // namespace meshcomplete
