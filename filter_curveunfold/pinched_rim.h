// Rims that pass one point twice: two vertices at the same position, as scans have them where pieces touch.
#pragma once

#include <vector>

#include "common/core/mesh.h"
#include "common/core/rim.h"

namespace meshcomplete {

/// A rim that passes every point once. Where the loop comes back to a position, the vertex there is covered
/// by a small flap: two triangles over its two rim edges, with a new corner a little behind (or before) the
/// surface. The hole then goes through between the flap and the other vertex, and can be unfolded like any
/// other.
struct OpenedRim {
  Rim rim;                       ///< with the flaps' corners in place of the covered vertices
  std::vector<Vector3> corners;  ///< the flaps' corners: new vertices, as they will be stored
  /// Corners below the loop's size are loop positions, any other c is `corners[c - size]`.
  std::vector<Triangle> flaps;
  std::vector<Index> vertex_of;  ///< per rim vertex: what it is, numbered like the flaps' corners
};

/// Whether two vertices of the rim lie at the same position.
bool is_pinched(const Rim& rim);

/// Opens a pinched rim; one that is not pinched comes back as it is. `height` is the flaps' size relative to
/// the rim's edges there, positive for corners behind the surface and negative before it. Cost: O(ring log
/// ring).
OpenedRim open_pinches(const Rim& rim, double height);

}  // namespace meshcomplete
