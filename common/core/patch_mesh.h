// A triangulated patch that can be edited: edges split, flipped and collapsed, its rim never.
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <functional>
#include <vector>

#include "common/core/mesh.h"

namespace meshcomplete {

/// A manifold triangulation with boundary. Vertices 0 to `rim_size() - 1` are the rim: they never move, are
/// never removed, and the boundary edges between them are never split. Only a patch in the making has other
/// vertices at its boundary, until `collapse_at_boundary` or `fill_at_boundary` has taken them off it.
/// Half-edge `3 * t + k` goes from corner k to corner k + 1 of triangle t. Removed vertices and triangles
/// leave gaps until `compact` is called.
class PatchMesh {
 public:
  static constexpr Index none = 0xffffffffu;

  /// `triangles` over `positions`, of which the first `rim_size` are the rim; the triangulation must be
  /// manifold and consistently oriented, else throws CompletionError.
  PatchMesh(std::vector<Vector3> positions, std::size_t rim_size, std::vector<Triangle> triangles);

  std::size_t rim_size() const { return rim_size_; }
  bool on_rim(Index vertex) const { return vertex < rim_size_; }
  /// The half-edges of the boundary that leave a vertex there and arrive at it.
  Index leaving_along_boundary(Index vertex) const { return half_edge_of_[vertex]; }
  Index arriving_along_boundary(Index vertex) const;
  /// On the rim, or one of the other vertices between rim vertices that a patch in the making may have.
  bool at_boundary(Index vertex) const { return opposite_[half_edge_of_[vertex]] == none; }
  std::size_t vertex_count() const { return positions_.size(); }    ///< with gaps
  std::size_t triangle_count() const { return triangles_.size(); }  ///< with gaps
  bool alive(Index triangle) const { return triangles_[triangle][0] != none; }
  bool vertex_alive(Index vertex) const { return half_edge_of_[vertex] != none; }

  const std::vector<Vector3>& positions() const { return positions_; }
  const std::vector<Triangle>& triangles() const { return triangles_; }
  const Vector3& position(Index vertex) const { return positions_[vertex]; }
  void move(Index vertex, const Vector3& to) { positions_[vertex] = to; }

  Index origin(Index half_edge) const { return triangles_[half_edge / 3][half_edge % 3]; }
  Index target(Index half_edge) const { return triangles_[half_edge / 3][(half_edge % 3 + 1) % 3]; }
  Index apex(Index half_edge) const { return triangles_[half_edge / 3][(half_edge % 3 + 2) % 3]; }
  static Index next(Index half_edge) { return half_edge % 3 == 2 ? half_edge - 2 : half_edge + 1; }
  static Index previous(Index half_edge) { return half_edge % 3 == 0 ? half_edge + 2 : half_edge - 1; }
  Index opposite(Index half_edge) const { return opposite_[half_edge]; }  ///< `none` on the boundary
  bool is_boundary(Index half_edge) const { return opposite_[half_edge] == none; }
  double length(Index half_edge) const {
    return (positions_[origin(half_edge)] - positions_[target(half_edge)]).norm();
  }
  /// Cross product of two sides: normal times twice the area.
  Vector3 area_normal(Index triangle) const;

  /// Calls `visit` with every half-edge that leaves `vertex`. On the rim the last neighbour, reached only by
  /// a half-edge that arrives at `vertex`, is not visited: use `for_neighbours`.
  template <class Visit>
  void for_outgoing(Index vertex, Visit visit) const {
    const Index start = half_edge_of_[vertex];
    Index half_edge = start;
    do {
      visit(half_edge);
      half_edge = opposite_[previous(half_edge)];
    } while (half_edge != none && half_edge != start);
  }

  /// Calls `visit` with every vertex joined to `vertex` by an edge, once.
  template <class Visit>
  void for_neighbours(Index vertex, Visit visit) const {
    const Index start = half_edge_of_[vertex];
    Index half_edge = start;
    do {
      visit(target(half_edge));
      const Index arriving = previous(half_edge);
      half_edge = opposite_[arriving];
      if (half_edge == none) visit(origin(arriving));
    } while (half_edge != none && half_edge != start);
  }

  bool joined(Index a, Index b) const;      ///< whether an edge joins the two vertices
  std::size_t valence(Index vertex) const;  ///< number of neighbours

  /// Inserts a vertex on an inner edge, splitting its two triangles; returns the new vertex.
  Index split(Index half_edge, const Vector3& position);
  /// Inserts a vertex into a triangle, splitting it into three; returns the new vertex.
  Index insert(Index triangle, const Vector3& position);
  /// Replaces an inner edge by the other diagonal. The caller has made sure that the other diagonal is not an
  /// edge yet.
  void flip(Index half_edge);
  /// Whether removing the edge by moving its origin, not on the rim, onto its target leaves a manifold (link
  /// condition).
  bool can_collapse(Index half_edge) const;
  /// Removes the origin of an inner edge and its two triangles. Requires `can_collapse`.
  void collapse(Index half_edge);

  /// Whether a boundary half-edge can be removed by moving its origin (`onto_target`, else its target), which
  /// is not on the rim, onto its other end (link condition).
  bool can_collapse_at_boundary(Index half_edge, bool onto_target) const;
  /// Removes that end and the triangle at the half-edge. Requires `can_collapse_at_boundary`.
  void collapse_at_boundary(Index half_edge, bool onto_target);

  /// Whether the vertex, at the boundary and not on the rim, can be taken off it by a triangle with its two
  /// neighbours along the boundary: they are not joined yet.
  bool can_fill_at_boundary(Index vertex) const;
  /// Adds that triangle, and returns it: the vertex becomes an inner one. Requires `can_fill_at_boundary`.
  Index fill_at_boundary(Index vertex);

  /// Whether the vertex, at the boundary and not on the rim, is the tip of a single triangle that hangs
  /// together with others.
  bool can_remove_ear(Index vertex) const;
  /// Removes the vertex and that triangle. Requires `can_remove_ear`.
  void remove_ear(Index vertex);

  /// Closes the gaps. Rim vertices keep their numbers, the others their order.
  void compact();

 private:
  void connect();
  void join(Index half_edge, Index other);
  void start_fan(Index vertex, Index half_edge);

  std::size_t rim_size_;
  std::vector<Vector3> positions_;
  std::vector<Triangle> triangles_;
  std::vector<Index> opposite_;
  std::vector<Index> half_edge_of_;  // one that leaves the vertex; on the rim the first of its fan
};

}  // namespace meshcomplete
