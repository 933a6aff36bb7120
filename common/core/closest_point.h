// The point of a triangle that is closest to another point.
#pragma once

#include <algorithm>

#include "common/core/box_tree.h"
#include "common/core/mesh.h"

namespace meshcomplete {

/// A point of a triangle and what it lies on. On a side and on a corner it counts as there, not as in the
/// face.
struct ClosestPoint {
  enum Place { face = -1, edge = 0, corner = 3 };  ///< `edge` + k from corner k to the next, `corner` + k
  Vector3 position = Vector3::Zero();
  int place = face;
};

/// The point of triangle abc that is closest to `p`, rounded; a coordinate that is not a number where the
/// corners are on one line and the point is nearest to none of its sides. Source: Ericson, "Real-Time
/// Collision Detection" (2005), section 5.1.5. Cost: O(1).
ClosestPoint closest_point(const Vector3& p, const Vector3& a, const Vector3& b, const Vector3& c);

/// The squared distance of `p` from a box; 0 in it. Infinite for an empty box.
inline double squared_distance(const Box& box, const Vector3& p) {
  double sum = 0;
  for (int k = 0; k < 3; ++k) {
    const double outside = std::max(std::max(box.low[k] - p[k], p[k] - box.high[k]), 0.0);
    sum += outside * outside;
  }
  return sum;
}

}  // namespace meshcomplete
