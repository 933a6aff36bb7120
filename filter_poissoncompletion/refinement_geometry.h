// Places that the refinement of a Delaunay triangulation asks for.
#pragma once

#include <Eigen/Geometry>
#include <array>

#include "common/core/mesh.h"

namespace meshcomplete {

/// The centre of the ball through a tetrahedron's corners. Not finite where these lie in a plane.
Vector3 circumcentre(const std::array<Vector3, 4>& corners);

/// How many times `way` leads from a point in a box to its side. Infinite for no way.
double share_to_wall(const Eigen::AlignedBox3d& box, const Vector3& from, const Vector3& way);

/// Where the piece from `a` to `b` of a protected edge is divided: in the middle, or, where one of them is
/// the end of an edge that is in pieces already, so that the part there has a power of two as its length.
/// Then edges that meet at that end do not divide each other for ever.
Vector3 edge_division(const Vector3& a, const Vector3& b, bool a_is_end, bool b_is_end);

}  // namespace meshcomplete
