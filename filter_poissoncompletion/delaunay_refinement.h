// Surfaces of implicit functions as subsets of a Delaunay triangulation that is refined until they are well
// shaped, everywhere or only where an input mesh leaves room.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "common/core/implicit_function.h"
#include "common/core/mesh.h"
#include "common/core/progress.h"
#include "filter_poissoncompletion/cushion.h"
#include "filter_poissoncompletion/delaunay_complex.h"

namespace meshcomplete {

/// What a good facet is. Source: the paper's Q, section 2.1; Boissonnat and Oudot (2006).
struct RefinementCriteria {
  /// Target length of the edges at a point (mesh units, positive). Required.
  std::function<double(const Vector3&)> edge_length;
  /// A facet whose longest edge is longer than this many target lengths is refined. With this default the
  /// mean edge of a surface comes out at the target length.
  double longest = 1.5;
  /// A facet with a smaller angle is refined (degrees, 0 to 30; above 30 there may be no end).
  double smallest_angle = 27;
  /// A facet further from the surface than this, measured along its axis, is refined (mesh units, positive).
  /// Absent: no matter.
  std::optional<double> distance;
};

/// The mesh that a refinement leaves alone.
struct ProtectedMesh {
  const TriangleMesh& mesh;
  const Cushion& cushion;             ///< where no point is inserted but vertices of the mesh
  const std::vector<Index>& initial;  ///< the mesh's vertex at each initial point
};

struct RefinementOptions {
  RefinementCriteria criteria;
  std::optional<ProtectedMesh> around;
  /// One per initial point: only facets with such a corner or an inserted one are refined, so that the
  /// refinement grows from there. Empty: all facets are.
  std::vector<char> seeds;
  /// Pairs of initial points between which the triangulation must have an edge: they are divided until it
  /// has.
  std::vector<std::pair<Index, Index>> protected_edges;
  /// Points are inserted until the surface is a closed manifold, as well. Not for use with a cushion.
  bool manifold = false;
  std::size_t max_points = 5000000;  ///< more inserted points throw CompletionError
};

/// Refines the Delaunay triangulation of the initial points until the facets between cells of unlike sign
/// meet the criteria, worst facets first; each time the point where the surface crosses the line between the
/// two cells' centres is inserted, rounded to what will be stored. Instead of a point in the cushion the
/// vertex of the mesh's triangle there that is nearest to it is inserted, if any is not yet. A cell's sign is
/// that of the function at its circumcentre, outside of a box three times as large as that of the points it
/// is outside. Places where the surface crosses such a line an even number of times are not seen. Source: the
/// paper, algorithm 1. Deterministic. Throws CompletionError (too many points, fewer than one initial point)
/// and Cancelled. Cost: O(n log n) for n initial points, threaded in part, and for each inserted one about 25
/// values of the function.
DelaunayComplex refine_delaunay(const ImplicitFunction& function, const std::vector<Vector3>& initial,
                                const RefinementOptions& options, const Progress& progress = Progress());

}  // namespace meshcomplete
