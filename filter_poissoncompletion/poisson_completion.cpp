#include "filter_poissoncompletion/poisson_completion.h"

#include "common/core/completion_oracle.h"
#include "common/core/hole_targets.h"
#include "common/core/parameter_checks.h"
#include "common/core/patch_check.h"
#include "common/core/piece_results.h"
#include "common/core/stage_clock.h"

namespace meshcomplete {

std::vector<std::pair<std::string, double>> named(const PoissonCompletionFigures& figures) {
  const auto number = [](std::size_t count) { return static_cast<double>(count); };
  const PoissonOracleFigures& oracle = figures.oracle;
  const RefinedCompletionFigures& refinement = figures.refinement;
  return {{"samples", number(oracle.samples)},
          {"octree cubes", number(oracle.cubes)},
          {"octree depth", oracle.depth},
          {"initial points", number(refinement.initial_points)},
          {"Delaunay vertices", number(refinement.points)},
          {"Delaunay cells", number(refinement.cells)},
          {"gaps closed at rims", number(refinement.gaps.closed)}};
}

void check_options(const PoissonCompletionOptions& o) {
  check_options(o.oracle);
  require(o.refinement.rings >= 1 && o.refinement.rings <= 100, "Rings must lie between 1 and 100.");
  require(!o.refinement.edge_length || positive(*o.refinement.edge_length),
          "EdgeLength must be positive, or 0 for that of the mesh round the hole.");
  require(!o.refinement.cushion_radius || positive(*o.refinement.cushion_radius),
          "CushionRadius must be positive, or 0 for one that goes with the edge length.");
}

PoissonCompletionResult complete_by_poisson(const TriangleMesh& mesh, const MeshSelection& selection,
                                            const PoissonCompletionOptions& options,
                                            const Progress& progress) {
  check_options(options);
  HoleSelectionOptions holes = options.holes;
  if (options.partial_fill) holes.selected_only = false;
  PoissonCompletionResult result;
  CompletionReport report;
  StageClock clock(report);
  OpenMesh open = find_holes(mesh, selection, holes, progress.part(0, 0.1, "finding the holes"));
  RefinedCompletionOptions refinement = options.refinement;
  if (options.partial_fill) {
    refinement.stretches = selected_stretches(mesh, open.loops, selection);
    target_stretches(mesh, *refinement.stretches, open);
  }
  clock.end_of("finding the holes");
  report.holes = open.holes;
  if (open.any_targeted()) {
    const InputNeighbourhood input(mesh);
    PoissonOracle oracle = make_completion_oracle(mesh, open, input, options.guides, options.oracle,
                                                  progress.part(0.1, 0.5, "building the oracle"));
    clock.end_of("building the oracle");
    RefinedCompletion refined =
        complete_by_refinement(mesh, open.topology, open.loops, input, oracle.field, refinement,
                               std::move(report), progress.part(0.5, 1, "refining the surface"));
    result.completion = std::move(refined.completion);
    result.figures = {std::move(oracle.figures), refined.figures};
  } else {
    result.completion = gather_pieces(mesh, {}, std::move(report));
  }
  result.completion.report.figures = named(result.figures);
  progress.update(1);
  return result;
}

}  // namespace meshcomplete
