#include "filter_poissoncompletion/poisson_completion.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "common/core/hole_targets.h"
#include "common/core/parameter_checks.h"
#include "common/core/patch_check.h"
#include "common/core/piece_results.h"
#include "common/core/rim.h"
#include "common/core/stage_clock.h"
#include "filter_poissoncompletion/edge_length_field.h"
#include "filter_poissoncompletion/wall_thickness.h"

namespace meshcomplete {
namespace {

// Cubes of the octree from one side of a wall to the other: with fewer its two sides run into one.
constexpr double cubes_in_wall = 3;
// Thinner walls than this part of an edge are taken for flaws of the scan.
constexpr double thinnest_wall = 0.25;

// Cubes grow by this share of the distance from the rims: a quarter of what a balanced octree allows, so that
// the surroundings of a hole are known well.
constexpr double cube_growth = 0.125;

// How fine the octree has to be at the rims: as their edges, and finer in thin walls.
EdgeLengthField resolution(const TriangleMesh& mesh, const OpenMesh& open, const InputNeighbourhood& input) {
  std::vector<RimSample> samples;
  for (const BoundaryLoop* loop : loops_to_close(open.loops, open.holes)) {
    const Rim rim = collect_rim(mesh, open.topology, *loop);
    std::vector<double> lengths = rim.edge_length;
    for (std::size_t k = 0; k < loop->faces.size(); ++k) {
      const Triangle& t = mesh.triangles[loop->faces[k]];
      const Vector3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
      const Vector3 normal = (b - a).cross(c - a).normalized();
      const auto wall = wall_thickness(input.blocks(), (a + b + c) / 3, normal, thinnest_wall * lengths[k],
                                       cubes_in_wall * lengths[k]);
      if (wall) lengths[k] = *wall / cubes_in_wall;
    }
    const std::vector<RimSample> more = smoothed_samples(rim.positions, lengths);
    samples.insert(samples.end(), more.begin(), more.end());
  }
  return EdgeLengthField(std::move(samples));
}

}  // namespace

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
  PoissonCompletionResult result;
  CompletionReport report;
  StageClock clock(report);
  const OpenMesh open =
      find_holes(mesh, selection, options.holes, progress.part(0, 0.1, "finding the holes"));
  clock.end_of("finding the holes");
  report.holes = open.holes;
  if (open.any_targeted()) {
    const InputNeighbourhood input(mesh);
    const EdgeLengthField cubes = resolution(mesh, open, input);
    const CubeSizes sizes{
        [&](const Vector3& at) { return std::max(cubes.at(at), cube_growth * cubes.distance(at)); },
        cubes.shortest()};
    PoissonOracle oracle = make_oracle(&mesh, options.guides, sizes, options.oracle,
                                       progress.part(0.1, 0.5, "building the oracle"));
    clock.end_of("building the oracle");
    RefinedCompletion refined =
        complete_by_refinement(mesh, open.topology, open.loops, input, oracle.field, options.refinement,
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
