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

/// The scan's own axis: the direction towards the sensor from which the face that is seen most grazingly is
/// seen least so, which is the axis of the narrowest cone that holds all normals. A triangulated range grid
/// is a height field over its sensor's image, and the faces across its depth steps stand almost along the
/// lines of sight, on all sides; so this finds the sensor's direction where the mean normal only finds where
/// the surface looks to. Where the normals fit into no half-space (the mesh is no height field) it is the
/// mean normal weighted with the areas.
///
/// Give it the scan as it was triangulated, faces across depth steps included. Throws CompletionError when
/// there is no face with an area or when their mean normal is zero (a closed mesh). Cost: O(faces).
Vector3 estimate_axis(const TriangleMesh& scan);

}  // namespace meshcomplete
