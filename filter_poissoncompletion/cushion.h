// The protection volume: what is so near to the input mesh that the refinement leaves it alone.
#pragma once

#include <functional>
#include <optional>

#include "common/core/mesh.h"
#include "common/core/triangle_blocks.h"

namespace meshcomplete {

/// All points nearer to the mesh than a radius that may change over the mesh. Source: the paper, section 2.2:
/// the cushion P_r(M). Refers to the blocks, which must outlive it. Immutable; safe to ask from many threads
/// if `radius` is.
class Cushion {
 public:
  /// The radius round a point of the mesh (mesh units, at least 0).
  using Radius = std::function<double(const Vector3& on_mesh)>;

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

  /// The nearest point of the mesh when it is nearer than `largest`. Cost: O(log faces + triangles whose
  /// boxes are nearer than what was found first).
  std::optional<Nearest> nearest(const Vector3& point) const;

  /// The nearest point of the mesh when the radius there is greater than its distance, so that the point is
  /// in the cushion. Cost: as `nearest`.
  std::optional<Nearest> within(const Vector3& point) const;
  bool contains(const Vector3& point) const { return within(point).has_value(); }

 private:
  const TriangleBlocks& mesh_;
  Radius radius_;
  double largest_;
};

}  // namespace meshcomplete
