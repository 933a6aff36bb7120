// Where a range scan was looked at from.
#pragma once

#include "common/core/mesh.h"

namespace meshcomplete {

/// The lines along which a scanner measured: all parallel, all through one viewpoint, or to be estimated.
struct LineOfSight {
  enum class Kind { own_axis, parallel, viewpoint };
  Kind kind = Kind::own_axis;
  /// Towards the sensor, of any length above 0, for `parallel`; the sensor's place, mesh units, for
  /// `viewpoint`.
  Vector3 vector = Vector3::Zero();

  static LineOfSight own_axis() { return {}; }
  static LineOfSight parallel(const Vector3& towards_sensor) { return {Kind::parallel, towards_sensor}; }
  static LineOfSight from(const Vector3& viewpoint) { return {Kind::viewpoint, viewpoint}; }

  /// Unit, from a point of the surface towards the sensor. Not for `own_axis`.
  Vector3 towards_sensor(const Vector3& point) const {
    return (kind == Kind::parallel ? vector : Vector3(vector - point)).normalized();
  }
};

/// The scan's own axis, an estimate of the unit direction towards the sensor: where a triangulated range grid
/// crosses depth steps its edges run almost along the lines of sight, so the axis is the principal direction
/// of the edges that are longer than four median edges, on the side to which the surface looks. (On
/// Stanford's bunny and drill it is within 0.2 to 4.3 degrees of the sensor's axis, where the mean normal is
/// 7 to 34 degrees off.) Where there are fewer than 32 such edges, or they have no common direction, it is
/// the mean normal weighted with the areas, which is the direction that sees most of the surface.
///
/// Give it the scan as it was triangulated, faces across depth steps included. Throws CompletionError when
/// there is no face with an area or when their mean normal is zero (a closed mesh). Cost: O(faces).
Vector3 estimate_axis(const TriangleMesh& scan);

/// The median length of the edges of faces; 0 for a mesh without faces. Cost: O(faces).
double median_edge(const TriangleMesh& mesh);

}  // namespace meshcomplete
