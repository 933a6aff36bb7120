#include "common/core/mesh.h"

#include <Eigen/Geometry>

namespace meshcomplete {

double bounding_box_diagonal(const TriangleMesh& mesh) {
  Eigen::AlignedBox3d box;
  for (const Triangle& triangle : mesh.triangles)
    for (Index corner : triangle) box.extend(mesh.vertices[corner]);
  return box.isEmpty() ? 0.0 : box.diagonal().norm();
}

}  // namespace meshcomplete
