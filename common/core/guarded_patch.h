// Editing a patch without ever letting it meet itself or the mesh: every step is tested exactly before it is
// kept.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "common/core/dynamic_box_tree.h"
#include "common/core/mesh.h"
#include "common/core/patch_check.h"
#include "common/core/patch_mesh.h"
#include "common/core/patch_remeshing.h"

namespace meshcomplete {

/// What guards the steps of a patch. Each step is made only when no triangle that it makes or moves has
/// collinear corners or meets another triangle of the patch, of the input, or of `obstacles` in more than
/// shared corners and sides; otherwise the patch stays as it is. A patch that is clean stays clean, and one
/// that is not gets no worse. Positions are rounded to what will be stored. Refers to its arguments, which
/// must outlive it; the patch must not be edited otherwise meanwhile, and not be compacted. Not for more than
/// one thread. Cost of a step: O(triangles at it and near it + log faces).
class GuardedPatch {
 public:
  static constexpr Index none = PatchMesh::none;

  GuardedPatch(PatchMesh& patch, const InputNeighbourhood& input, const ForbiddenEdges& forbidden,
               const std::vector<std::array<Vector3, 3>>& obstacles);

  const PatchMesh& patch() const { return patch_; }

  /// Of a vertex that lies on a side of an input triangle without being one of its corners (a Steiner point
  /// of the rim): triangles at it do not count as meeting that input triangle.
  void rest(Index vertex, Index input_triangle);

  /// Whether a triangle has an area and meets nothing where it is.
  bool is_clean(Index triangle) const;

  bool move(Index vertex, const Vector3& to);
  /// The new vertex, or `none`. The edge's own triangles may bend when the position is not on the edge.
  Index split(Index half_edge, const Vector3& position);
  bool flip(Index half_edge);
  bool collapse(Index half_edge);
  bool collapse_at_boundary(Index half_edge, bool onto_target);
  /// Needs no guard: nothing is made or moved.
  bool remove_ear(Index vertex);
  /// Takes a vertex off the boundary, to another position. It rests on nothing any more.
  bool fill_at_boundary(Index vertex, const Vector3& position);

 private:
  using Corners = std::array<Vector3, 3>;
  struct Fresh {
    Corners corners;
    Triangle vertices;
  };

  Corners corners(const Triangle& triangle) const;
  bool forbidden(Index a, Index b) const;
  bool all_free(const std::vector<Fresh>& fresh, const std::vector<Index>& replaced) const;
  bool is_free(const Fresh& one, const std::vector<Index>& replaced) const;
  bool input_is_free(const Fresh& one) const;
  void update(Index triangle);
  void star(Index vertex, std::vector<Index>& triangles) const;
  bool collapse_is_free(Index gone, Index kept) const;

  PatchMesh& patch_;
  const InputNeighbourhood& input_;
  const ForbiddenEdges& forbidden_;
  const std::vector<Corners>& obstacles_;
  std::vector<Index> resting_;  // by vertex
  DynamicBoxTree boxes_, obstacle_boxes_;
};

}  // namespace meshcomplete
