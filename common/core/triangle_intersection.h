// When do two triangles of a mesh meet in more than they should? Exact predicates, CGAL kept in the source
// file.
#pragma once

#include <cstddef>
#include <functional>
#include <utility>
#include <vector>

#include "common/core/mesh.h"
#include "common/core/progress.h"

namespace meshcomplete {

/// Whether three points lie on one line. Exact.
bool collinear(const Vector3& a, const Vector3& b, const Vector3& c);

/// Whether two triangles meet in more than the corners or the side that they share. Corners are shared when
/// their positions are equal. Touching counts as meeting. Neither triangle may be degenerate. Exact.
bool meet_improperly(const std::array<Vector3, 3>& a, const std::array<Vector3, 3>& b);

/// Whether the closed segment from `a` to `b` and the closed triangle have a point in common. Exact. The
/// triangle may not be degenerate.
bool segment_meets_triangle(const Vector3& a, const Vector3& b, const std::array<Vector3, 3>& triangle);

/// All improper pairs (i < j, ascending) among `triangles`; degenerate ones and those with a coordinate that
/// is not finite are left out. `limit` bounds the list (to its first ones), not the work. Threaded when there
/// are many. Throws `Cancelled`. Cost: O(n log n + pairs of overlapping boxes).
std::vector<std::pair<Index, Index>> improper_pairs(const std::vector<std::array<Vector3, 3>>& triangles,
                                                    std::size_t limit = static_cast<std::size_t>(-1),
                                                    const Progress& progress = Progress());

/// How many pairs `improper_pairs` would list, without the memory for them.
std::size_t count_improper_pairs(const std::vector<std::array<Vector3, 3>>& triangles,
                                 const Progress& progress = Progress());

/// All improper pairs (index in `a`, index in `b`), ascending; left out as in `improper_pairs`. Runs in the
/// calling thread.
std::vector<std::pair<Index, Index>> improper_pairs_between(const std::vector<std::array<Vector3, 3>>& a,
                                                            const std::vector<std::array<Vector3, 3>>& b);

}  // namespace meshcomplete
