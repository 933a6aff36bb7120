// The protection volume: what is so near to the input mesh that the refinement leaves it alone.
#pragma once

#include <functional>
#include <optional>

#include "common/core/mesh.h"
#include "common/core/triangle_blocks.h"

namespace meshcomplete {

/// All points nearer to the mesh than a radius that may change over the mesh, and with the side from which a
/// surface comes near it. Source: the paper, section 2.2: the cushion P_r(M). Refers to the blocks, which
/// must outlive it. Immutable; safe to ask from many threads if `radius` is.
class Cushion {
 public:
  /// The radius round a point of the mesh (mesh units, at least 0). `alike`: for surfaces that face as the
  /// mesh does there, which are the same sheet, rather than the other side of a wall.
  using Radius = std::function<double(const Vector3& on_mesh, bool alike)>;

  /// What of the mesh is nearest to a point; of several triangles the one with the lowest number.
  struct Nearest {
    Index triangle;
    Vector3 position;
    double distance;
  };

  /// `largest` (mesh units) bounds the radius: greater values of `radius` count as `largest`.
  Cushion(const TriangleBlocks& mesh, Radius radius, double largest);
  /// The same radius everywhere.
  Cushion(const TriangleBlocks& mesh, double radius);

  /// The nearest point of the mesh when it is nearer than `largest`. Cost: O(log faces + triangles in blocks
  /// that are nearer than that, or than what was found first).
  std::optional<Nearest> nearest(const Vector3& point) const;

  /// Whether what is nearest to a point is nearer than the radius there, so that the point is in the cushion.
  /// `outwards` is the direction in which the surface has its outside at the point.
  bool reaches(const Nearest& nearest, const Vector3& outwards) const;

 private:
  const TriangleBlocks& mesh_;
  Radius radius_;
  double largest_;
};

}  // namespace meshcomplete
