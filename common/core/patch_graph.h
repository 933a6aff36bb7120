// A patch as a graph: which triangles meet at its edges, and shortest paths along these.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

#include "common/core/mesh.h"
#include "common/core/patch.h"
#include "common/core/progress.h"

namespace meshcomplete {

/// Shortest paths from some vertices.
struct PatchPaths {
  static constexpr double unreached = std::numeric_limits<double>::infinity();

  std::unordered_map<Index, double> distance;
  std::unordered_map<Index, Index> before;  ///< the vertex before each one on its path, but for its first

  double to(Index vertex) const {
    const auto found = distance.find(vertex);
    return found == distance.end() ? unreached : found->second;
  }
  /// The vertices of a path from its last one to its first. It must have been reached.
  std::vector<Index> back_from(Index vertex) const;
};

/// Vertices are named as the patch's triangles do. Refers to mesh and patch, which must outlive it.
class PatchGraph {
 public:
  /// The patch must be manifold and consistently oriented. Cost: O(patch).
  PatchGraph(const TriangleMesh& mesh, const Patch& patch);

  /// The triangle that walks the edge in this direction; there must be one.
  Index face(Index from, Index to) const { return face_.at(key(from, to)); }
  /// The triangle beyond a side of another one; as many as there are triangles at the patch's boundary.
  Index beyond(Index triangle, int side) const;
  const Vector3& position(Index vertex) const { return meshcomplete::position(mesh_, patch_, vertex); }

  /// What it costs to go along an edge, at least 0.
  using Price = std::function<double(Index from, Index to)>;
  double length(Index from, Index to) const { return (position(to) - position(from)).norm(); }

  /// The cheapest paths from any of the vertices `starts`, each with what it costs to start there. Along
  /// edges with two triangles, and through no vertex of the input and none of `closed`; these are reached,
  /// but not passed. Dijkstra's algorithm. Throws Cancelled. Cost: O(n log n).
  PatchPaths paths_from(const std::vector<std::pair<Index, double>>& starts, const Price& price,
                        const std::unordered_set<Index>& closed, const Progress& progress = Progress()) const;

 private:
  static std::uint64_t key(Index from, Index to) { return std::uint64_t{from} << 32 | to; }

  const TriangleMesh& mesh_;
  const Patch& patch_;
  std::unordered_map<std::uint64_t, Index> face_;
  std::unordered_map<Index, std::vector<Index>> neighbours_;  // along edges with two triangles
};

}  // namespace meshcomplete
