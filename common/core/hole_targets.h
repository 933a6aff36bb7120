// Which boundary loops a completion of all holes at once works on.
#pragma once

#include <algorithm>
#include <vector>

#include "common/core/boundary_loops.h"
#include "common/core/hole_selection.h"
#include "common/core/mesh.h"
#include "common/core/mesh_topology.h"
#include "common/core/patch.h"
#include "common/core/progress.h"

namespace meshcomplete {

/// Whether a hole, as `select_holes` reports it, is to be worked on.
bool is_targeted(const HoleReport& hole);

/// Open sheets beside a surface whose holes are closed are islands: if any hole is targeted, the rims of
/// sheets that were only left out for being sheets become targets, to be closed together with the hole round
/// them if that takes less area. One report for each loop. Cost: O(loops).
void target_islands(const std::vector<BoundaryLoop>& loops, std::vector<HoleReport>& holes);

/// Where a mesh is open, and what of that is to be closed.
struct OpenMesh {
  MeshTopology topology;
  std::vector<BoundaryLoop> loops;
  std::vector<HoleReport> holes;  ///< one for each loop, as `select_holes` and `target_islands` leave them
  bool any_targeted() const { return std::any_of(holes.begin(), holes.end(), is_targeted); }
};

/// Throws as `build_topology` and `select_holes` do, and `Cancelled`. Cost: O(faces).
OpenMesh find_holes(const TriangleMesh& mesh, const MeshSelection& selection,
                    const HoleSelectionOptions& options, const Progress& progress = Progress());

/// A rim that no patch should close by itself, but that may be part of a larger hole: that of a single
/// triangle.
bool may_join(const BoundaryLoop& loop, const HoleReport& hole);

/// The loops that are targeted or may join one that is, in their order.
std::vector<const BoundaryLoop*> loops_to_close(const std::vector<BoundaryLoop>& loops,
                                                const std::vector<HoleReport>& holes);

/// Rims whose edges lie on each other have nothing between them that a patch could fill: those that are
/// targeted get this as their reason. `merged` is the topology of the mesh with the same faces whose rim
/// vertices at one position are one. Cost: O(boundary).
void refuse_sewn_rims(const TriangleMesh& mesh, const MeshTopology& merged,
                      const std::vector<BoundaryLoop>& loops, std::vector<HoleReport>& holes);

}  // namespace meshcomplete
