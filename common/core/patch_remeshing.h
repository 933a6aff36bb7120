// Giving a patch the resolution and the well-shaped triangles of the mesh around it.
#pragma once

#include <functional>
#include <utility>
#include <vector>

#include "common/core/patch_mesh.h"
#include "common/core/progress.h"

namespace meshcomplete {

/// What must not become an edge of the patch: two rim vertices that are joined by an edge of the input
/// already. Sorted pairs (smaller first) of rim vertices.
using ForbiddenEdges = std::vector<std::pair<Index, Index>>;

/// Whether an inner edge may be replaced by the other diagonal of its two triangles: that is no edge yet, and
/// not forbidden.
bool can_flip(const PatchMesh& patch, Index half_edge, const ForbiddenEdges& forbidden);

struct RemeshOptions {
  ForbiddenEdges forbidden;
  int rounds = 3;                      ///< of split, collapse, flip and smooth, 0 to 100
  double longest = 4.0 / 3.0;          ///< an edge is split when it is longer than this many target lengths
  std::size_t max_vertices = 5000000;  ///< beyond this many `refine` and `remesh` throw CompletionError
  double shortest = 4.0 / 5.0;  ///< an edge is collapsed when it is shorter than this many target lengths
};

/// Splits inner edges, longest first, until none is longer than `options.longest` times the mean target
/// length of its ends, keeping the triangulation Delaunay (least sum of cotangents) by flips. `target` holds
/// the target edge length of every vertex and grows with the mesh: a new vertex gets the mean of its edge's
/// ends. Flat facets stay flat: this changes the triangulation, and the shape only where a flip does. Cost:
/// O(n log n) for n vertices.
void refine(PatchMesh& patch, std::vector<double>& target, const RemeshOptions& options,
            const Progress& progress = Progress());

/// Rounds of splitting long edges, collapsing short ones, flipping towards Delaunay and smoothing along the
/// surface. Positions inside the patch move tangentially only. Compacts the patch. Cost: O(n) per round.
void remesh(PatchMesh& patch, std::vector<double>& target, const RemeshOptions& options,
            const Progress& progress = Progress());

}  // namespace meshcomplete
