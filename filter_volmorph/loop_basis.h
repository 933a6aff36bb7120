// Short loops that generate a surface's homology.
#pragma once

#include <vector>

#include "common/core/mesh.h"
#include "common/core/progress.h"
#include "filter_volmorph/capped_surface.h"

namespace meshcomplete {

/// A closed path of half-edges, each beginning where the last one ends; none of a cap.
struct SurfaceLoop {
  double length = 0;  ///< mesh units
  std::vector<Index> half_edges;
};

/// Of each half-edge, mesh units; infinite where it ends in the middle of a cap, so that no path goes there.
/// Cost: O(faces), 24 bytes for each; threaded.
std::vector<double> edge_lengths(const TriangleMesh& mesh, const CappedSurface& surface);

/// Two loops for each handle, by ascending length, from a tree of shortest paths and a tree of faces of the
/// greatest paths across it (Eppstein's tree and cotree, Erickson and Whittlesey's choice), without what the
/// way there and the way back have in common. `lengths`: `edge_lengths`. Cost: O(n log n) for n faces, and
/// the loops' edges.
std::vector<SurfaceLoop> loop_basis(const CappedSurface& surface, const std::vector<double>& lengths,
                                    const Progress& progress = Progress());

/// The edges (any of their half-edges) that a loop crosses when it is moved a little to its left.
std::vector<Index> edges_beside(const CappedSurface& surface, const SurfaceLoop& loop);

}  // namespace meshcomplete
