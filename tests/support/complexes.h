// What a list of triangles is, by the definitions: no adjacency of the library's is used.
#pragma once

#include <algorithm>
#include <cstddef>
#include <map>
#include <utility>
#include <vector>

#include "common/core/disjoint_sets.h"
#include "common/core/mesh.h"

namespace meshcomplete {
namespace test {

using Edge = std::pair<Index, Index>;

/// The sum of the triangles' boundaries: how often each edge (smaller end first) is walked upwards more than
/// downwards. Edges where that is 0 are left out; of a closed oriented surface nothing is left.
inline std::map<Edge, int> boundary_of(const std::vector<Triangle>& triangles) {
  std::vector<std::pair<Edge, int>> sides;
  for (const Triangle& t : triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const Index a = t[k], b = t[(k + 1) % 3];
      sides.emplace_back(Edge(std::min(a, b), std::max(a, b)), a < b ? 1 : -1);
    }
  std::sort(sides.begin(), sides.end());
  std::map<Edge, int> sum;
  for (std::size_t i = 0, past = 0; i < sides.size(); i = past) {
    int count = 0;
    for (; past < sides.size() && sides[past].first == sides[i].first; ++past) count += sides[past].second;
    if (count != 0) sum.emplace_hint(sum.end(), sides[i].first, count);
  }
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
  std::vector<std::pair<Edge, Index>> sides;  // by origin and target, with the corner at the origin
  std::vector<Triangle> faces;
  Index past_vertices = 0;
  for (Index t = 0; t < triangles.size(); ++t) {
    Triangle corners = triangles[t];
    for (Index k = 0; k < 3; ++k) sides.emplace_back(Edge(corners[k], corners[(k + 1) % 3]), 3 * t + k);
    std::sort(corners.begin(), corners.end());
    shape.manifold &= corners[0] != corners[1] && corners[1] != corners[2];
    past_vertices = std::max(past_vertices, corners[2] + 1);
    faces.push_back(corners);
  }
  std::sort(faces.begin(), faces.end());
  shape.manifold &= std::adjacent_find(faces.begin(), faces.end()) == faces.end();
  std::sort(sides.begin(), sides.end());
  std::size_t edges = 0;
  DisjointSets fans(3 * triangles.size()), pieces(past_vertices);
  const auto next = [](Index corner) { return corner % 3 == 2 ? corner - 2 : corner + 1; };
  for (std::size_t i = 0; i < sides.size(); ++i) {
    const auto& [side, corner] = sides[i];
    shape.manifold &= i == 0 || sides[i - 1].first != side;
    pieces.unite(side.first, side.second);
    const auto twin =
        std::lower_bound(sides.begin(), sides.end(), std::pair(Edge(side.second, side.first), Index(0)));
    const bool paired = twin != sides.end() && twin->first == Edge(side.second, side.first);
    shape.boundary += !paired;
    edges += !paired || side.first < side.second;
    if (!paired) continue;
    fans.unite(corner, next(twin->second));
    fans.unite(next(corner), twin->second);
  }
  std::vector<Index> fan_of(past_vertices, 0xffffffffu);
  long vertices = 0;
  for (Index corner = 0; corner < 3 * triangles.size(); ++corner) {
    const Index v = triangles[corner / 3][corner % 3], fan = fans.root(corner);
    if (fan_of[v] == 0xffffffffu) {
      ++vertices;
      shape.components += pieces.root(v) == v;
      fan_of[v] = fan;
    }
    shape.manifold &= fan_of[v] == fan;
  }
  shape.euler = vertices - static_cast<long>(edges) + static_cast<long>(triangles.size());
  return shape;
}

}  // namespace test
}  // namespace meshcomplete
