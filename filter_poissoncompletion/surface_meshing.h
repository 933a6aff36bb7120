// A closed, well-shaped triangle mesh of the surface of an implicit function.
#pragma once

#include <cstddef>
#include <vector>

#include "common/core/implicit_function.h"
#include "common/core/mesh.h"
#include "common/core/progress.h"
#include "filter_poissoncompletion/delaunay_refinement.h"

namespace meshcomplete {

struct SurfaceMeshingOptions {
  RefinementCriteria criteria;
  /// Facets are not refined for their distance any more once there are about so many vertices.
  std::size_t vertices_for_distance = static_cast<std::size_t>(-1);
  std::size_t max_points = 5000000;  ///< more vertices throw CompletionError
};

/// Points of the surface, one for each start from which the surface is found within `reach` (mesh units,
/// positive): along the function's slope there, else along lines in directions that are always the same.
/// Rounded to what will be stored. Threaded. Cost: some ten values of the function for each start.
std::vector<Vector3> find_surface_points(const ImplicitFunction& function, const std::vector<Vector3>& starts,
                                         double reach, double tolerance,
                                         const Progress& progress = Progress());

/// Meshes all components of the surface that have one of the `points`, which are on it or near, at least some
/// three to each; four in all that are not in one plane. The mesh is closed and manifold, its positions are
/// rounded to what will be stored, the outside is before its triangles, and they do not intersect but where
/// fans that touch had to be moved apart. Source: the paper, section 4.4, and Boissonnat and Oudot (2006).
/// Deterministic. Throws CompletionError (too many points, no surface found) and Cancelled. Cost: as
/// `refine_delaunay`.
TriangleMesh mesh_surface(const ImplicitFunction& function, const std::vector<Vector3>& points,
                          const SurfaceMeshingOptions& options, const Progress& progress = Progress());

}  // namespace meshcomplete
