// What a surface's topology is, and how large its handles are.
#pragma once

#include <optional>
#include <vector>

#include "common/core/mesh.h"
#include "common/core/mesh_statistics.h"
#include "common/core/progress.h"

namespace meshcomplete {

/// A handle by a short loop round it, or through it if that is shorter: a closed path of edges that does not
/// cut the surface in two.
struct Handle {
  double length = 0;                 ///< of the loop, mesh units
  Vector3 centre = Vector3::Zero();  ///< mean of the loop's vertices
  std::vector<Index> loop;           ///< vertices in order
};

struct HandleReport {
  MeshStatistics statistics;  ///< genus, components, boundary loops; intersections not counted

  /// As many as the genus, by ascending length. Absent where the genus is, and where neighbouring faces do
  /// not run opposite ways.
  std::optional<std::vector<Handle>> handles;
};

/// Holes of the mesh count as covered: a loop round a hole is no handle. One loop is taken of every pair that
/// belongs to a handle (they cross once), the shorter one, and the handles are independent: a tiny tunnel in
/// a large ring is one tiny handle and one large one. Lengths are of paths along edges, and upper bounds:
/// loops of a basis (`loop_basis`), made as short as can be from where they are (`LoopShortener`).
/// Deterministic. Cost: O(n log n) for n faces, and for each handle a search round its loop; with many
/// handles O(g^2) besides.
HandleReport measure_handles(const TriangleMesh& mesh, const Progress& progress = Progress());

}  // namespace meshcomplete
