#include "common/core/wall_thickness.h"

#include <Eigen/Geometry>

namespace meshcomplete {

std::optional<double> wall_thickness(const TriangleBlocks& mesh, const Vector3& point, const Vector3& normal,
                                     double skip, double reach) {
  std::optional<double> nearest;
  const auto corner = [&](Index triangle, int k) -> const Vector3& {
    return mesh.mesh().vertices[mesh.mesh().triangles[triangle][k]];
  };
  mesh.visit(bounding_box(point, point, point - reach * normal), [&](Index triangle) {
    // Where the line meets the triangle: Moeller and Trumbore (1997). A miss by rounding does not matter.
    const Vector3 &a = corner(triangle, 0), u = corner(triangle, 1) - a, v = corner(triangle, 2) - a;
    const Vector3 across = v.cross(normal), from = point - a, along = from.cross(u);
    const double determinant = u.dot(across);
    // Faces that look the same way as the point's own have a positive one.
    if (!(u.cross(v).dot(normal) < 0) || determinant == 0) return true;
    const double s = from.dot(across) / determinant, t = -along.dot(normal) / determinant;
    const double distance = along.dot(v) / determinant;
    if (s >= 0 && t >= 0 && s + t <= 1 && distance > skip && distance < nearest.value_or(reach))
      nearest = distance;
    return true;
  });
  return nearest;
}

}  // namespace meshcomplete
