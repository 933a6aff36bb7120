// The half-edges of a patch by vertex: which faces are at an edge, and whether they form fans round their
// vertices.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "common/core/patch.h"

namespace meshcomplete {

/// Knows nothing about what makes a patch right: any triangles with three different corners in range will do.
/// Vertices are named as the patch names them. Cost: O(patch log patch) to build, O(log valence) per edge
/// asked for.
class PatchHalfEdges {
 public:
  struct HalfEdge {
    Index to;      ///< local number of the vertex at its end
    Index across;  ///< local number of the triangle's third corner
    Index triangle;
  };
  class Range {
   public:
    Range(const HalfEdge* first, const HalfEdge* past) : first_(first), past_(past) {}
    const HalfEdge* begin() const { return first_; }
    const HalfEdge* end() const { return past_; }
    std::size_t size() const { return static_cast<std::size_t>(past_ - first_); }
    bool empty() const { return first_ == past_; }

   private:
    const HalfEdge *first_, *past_;
  };

  PatchHalfEdges() = default;
  explicit PatchHalfEdges(const Patch& patch);

  Range leaving(Index vertex) const { return row(local(vertex)); }
  Range between(Index from, Index to) const { return between_local(local(from), local(to)); }

  /// Declares the closed chain of vertices a rim: its edges are walked by the patch in this direction.
  void add_rim(const std::vector<Index>& vertices);

  /// Calls `visit(vertex)` for every vertex of the patch, ascending.
  template <class Visit>
  void for_each_vertex(Visit&& visit) const {
    for (Index v = 0; v + 1 < first_.size(); ++v) visit(global(v));
  }

  /// Calls `visit(a, b)` once for every undirected edge that is not on a rim.
  template <class Visit>
  void for_each_edge_inside(Visit&& visit) const {
    for (Index v = 0; v + 1 < first_.size(); ++v) {
      Index last = none;
      for (const HalfEdge& h : row(v)) {
        if (h.to == last || is_rim(v, h.to) || (h.to < v && !between_local(h.to, v).empty())) continue;
        last = h.to;
        visit(global(v), global(h.to));
      }
    }
  }

  /// Whether the faces at `vertex` form one fan for every visit of a rim, from the edge by which it leaves to
  /// the edge by which it came, and nothing else; for a `closed` vertex whether they form one closed fan. The
  /// edges must be manifold.
  bool fans_match_rim(Index vertex, bool closed) const;

 private:
  static constexpr Index none = 0xffffffffu;
  struct Visit {
    Index vertex, came_from, goes_to;  ///< local numbers
    bool operator<(const Visit& other) const { return vertex < other.vertex; }
  };

  Index local(Index vertex) const;
  Index global(Index v) const;
  Range row(Index v) const;
  Range between_local(Index from, Index to) const;
  bool is_rim(Index from, Index to) const;
  std::pair<const Visit*, const Visit*> visits_of(Index v) const;
  std::size_t fan_size(Index v, Index start, Index goal) const;

  Index input_vertices_ = 0;
  std::vector<Index>
      input_used_;  ///< input vertices of the patch, ascending; new ones are numbered after them
  std::vector<std::size_t> first_;  ///< row of vertex v: half_edges_[first_[v]] to half_edges_[first_[v + 1]]
  std::vector<HalfEdge> half_edges_;  ///< each row by `to`
  std::vector<Visit> visits_;         ///< by vertex
};

}  // namespace meshcomplete
