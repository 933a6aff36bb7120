// Triangulating the unfolded rim (paper, section 3.2).
#pragma once

#include <Eigen/Core>
#include <vector>

#include "common/core/mesh.h"

namespace meshcomplete {

/// The constrained Delaunay triangulation of a simple polygon, counter-clockwise, without Steiner points: it
/// maximises the smallest angle among all triangulations of the polygon. Corners are positions in `polygon`.
/// Throws CompletionError when the polygon is not simple. Exact predicates. Cost: O(n log n).
std::vector<Triangle> triangulate_polygon(const std::vector<Eigen::Vector2d>& polygon);

}  // namespace meshcomplete
