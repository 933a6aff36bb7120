// How thick the solid is behind a point of its surface.
#pragma once

#include <optional>

#include "common/core/mesh.h"
#include "common/core/triangle_blocks.h"

namespace meshcomplete {

/// The distance from a point of the mesh, against its outward unit normal, to the nearest face that looks the
/// other way; nothing when there is none within `reach` (mesh units). Faces nearer than `skip` do not count:
/// those round the point itself. Cost: O(log faces + triangles whose boxes meet the way there).
std::optional<double> wall_thickness(const TriangleBlocks& mesh, const Vector3& point, const Vector3& normal,
                                     double skip, double reach);

}  // namespace meshcomplete
