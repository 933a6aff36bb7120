// Short loops that generate a surface's homology, and which of them cross.
#pragma once

#include <cstdint>
#include <utility>
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

/// Two loops for each handle, by ascending length, from a tree of shortest paths and a tree of faces of the
/// greatest paths across it (Eppstein's tree and cotree, Erickson and Whittlesey's choice), without what the
/// way there and the way back have in common. Cost: O(n log n) for n faces, and the loops' edges.
std::vector<SurfaceLoop> loop_basis(const TriangleMesh& mesh, const CappedSurface& surface,
                                    const Progress& progress = Progress());

/// The edges (any of their half-edges) that a loop crosses when it is moved a little to its left.
std::vector<Index> edges_beside(const CappedSurface& surface, const SurfaceLoop& loop);

/// The pairs of loops (i < j) that cross an odd number of times, ascending. Cost: O(edges of the loops and
/// round them), times a logarithm.
std::vector<std::pair<Index, Index>> crossing_loops(const CappedSurface& surface,
                                                    const std::vector<SurfaceLoop>& loops,
                                                    const Progress& progress = Progress());

/// Two loops that cross, both led round the handles of all other pairs.
struct LoopPair {
  Index first = 0, second = 0;               ///< the loops as they were; `first` is not the longer one
  std::vector<Index> first_sum, second_sum;  ///< the loops (themselves, too) that they are the sum of now
};

/// Pairs up loops by ascending length that are a basis: the shortest one with the shortest that crosses it,
/// what crosses one of them is continued along the other, and so on. By ascending `first`. Cost: O(c^3 / 64)
/// for the most loops c that are connected by crossings.
std::vector<LoopPair> pair_loops(std::size_t loops, const std::vector<std::pair<Index, Index>>& crossings,
                                 const Progress& progress = Progress());

}  // namespace meshcomplete
