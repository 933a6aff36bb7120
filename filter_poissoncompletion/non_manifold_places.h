// Where a surface made of triangles is no manifold.
#pragma once

#include <vector>

#include "common/core/mesh.h"

namespace meshcomplete {

/// For each edge that does not have two triangles, and each other vertex with more than one fan, the
/// triangles there. Ascending by the first of them. Cost: O(n log n).
std::vector<std::vector<Index>> non_manifold_places(const std::vector<Triangle>& triangles);

}  // namespace meshcomplete
