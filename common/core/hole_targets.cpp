#include "common/core/hole_targets.h"

#include <cstddef>

namespace meshcomplete {

bool is_targeted(const HoleReport& hole) {
  return hole.outcome == HoleOutcome::failed && hole.reason.empty();
}

void target_islands(const std::vector<BoundaryLoop>& loops, std::vector<HoleReport>& holes) {
  if (std::none_of(holes.begin(), holes.end(), is_targeted)) return;
  for (std::size_t i = 0; i < loops.size(); ++i) {
    if (loops[i].defect != LoopDefect::open_sheet || holes[i].reason != describe(LoopDefect::open_sheet))
      continue;
    holes[i].outcome = HoleOutcome::failed;
    holes[i].reason.clear();
  }
}

OpenMesh find_holes(const TriangleMesh& mesh, const MeshSelection& selection,
                    const HoleSelectionOptions& options, const Progress& progress) {
  OpenMesh open;
  open.topology = build_topology(mesh, progress.part(0, 0.5, "finding the boundary"));
  open.loops = trace_boundary_loops(mesh, open.topology, progress.part(0.5, 1, "tracing boundary loops"));
  open.holes = select_holes(mesh, open.loops, selection, options);
  target_islands(open.loops, open.holes);
  return open;
}

bool may_join(const BoundaryLoop& loop, const HoleReport& hole) {
  return loop.defect == LoopDefect::isolated_triangle &&
         hole.reason == describe(LoopDefect::isolated_triangle);
}

std::vector<const BoundaryLoop*> loops_to_close(const std::vector<BoundaryLoop>& loops,
                                                const std::vector<HoleReport>& holes) {
  std::vector<const BoundaryLoop*> result;
  for (std::size_t i = 0; i < loops.size(); ++i)
    if (is_targeted(holes[i]) || may_join(loops[i], holes[i])) result.push_back(&loops[i]);
  return result;
}

void refuse_sewn_rims(const TriangleMesh& mesh, const MeshTopology& merged,
                      const std::vector<BoundaryLoop>& loops, std::vector<HoleReport>& holes) {
  for (std::size_t i = 0; i < loops.size(); ++i)
    for (std::size_t k = 0; k < loops[i].faces.size() && is_targeted(holes[i]); ++k)
      if (merged.opposite[half_edge_at(mesh, loops[i], k)] != MeshTopology::boundary)
        holes[i].reason = "edges of this rim lie on each other; apply 'Merge Close Vertices' first";
}

}  // namespace meshcomplete
