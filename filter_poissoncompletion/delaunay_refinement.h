// Surfaces of implicit functions as subsets of a Delaunay triangulation that is refined until they are well
// shaped, everywhere or only where an input mesh leaves room.
#pragma once

#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "common/core/implicit_function.h"
#include "common/core/mesh.h"
#include "common/core/progress.h"
#include "filter_poissoncompletion/delaunay_complex.h"
#include "filter_poissoncompletion/facet_quality.h"
#include "filter_poissoncompletion/mesh_guard.h"

namespace meshcomplete {

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
  /// Once so many points are inserted, facets are not refined for their distance any more.
  std::size_t points_for_distance = static_cast<std::size_t>(-1);
  std::size_t max_points = 5000000;  ///< more inserted points throw CompletionError
};

/// Refines the Delaunay triangulation of the initial points until the facets between cells of unlike sign
/// meet the criteria, worst facets first; each time the point where the surface crosses the line between the
/// two cells' centres is inserted, rounded to what will be stored. Instead of a point in the cushion the
/// vertex of the mesh's triangle there that is nearest to it is inserted, if any is not yet. A cell's sign is
/// that of the function at its circumcentre, outside of a box three times as large as that of the points it
/// is outside. Places where the surface crosses such a line an even number of times are not seen. Source: the
/// paper, algorithm 1. Deterministic. Throws CompletionError (too many points, initial
/// points at fewer than two positions) and Cancelled. Cost: O(n log n) for n initial points, threaded in
/// part, and for each inserted one about 25 values of the function.
DelaunayComplex refine_delaunay(const ImplicitFunction& function, const std::vector<Vector3>& initial,
                                const RefinementOptions& options, const Progress& progress = Progress());

}  // namespace meshcomplete
