#include "filter_poissoncompletion/poisson_remeshing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <unordered_set>

#include "common/core/parameter_checks.h"
#include "common/core/patch.h"
#include "common/core/stage_clock.h"
#include "common/core/surface_sampling.h"
#include "filter_poissoncompletion/surface_fitting.h"
#include "filter_poissoncompletion/surface_meshing.h"

namespace meshcomplete {
namespace {

constexpr int usual_depth = 8;

// In the octree's finest cubes: edges of facets that all have one size, edges of flat facets, how near to the
// surface adaptive ones need not be, and how exactly its first points are on it.
constexpr double uniform_edge = 1.6, longest_edge = 8, least_distance = 0.005, point_tolerance = 0.1;

// Starts are as far apart as the longest edges: a start in each cube of so many levels above the finest that
// holds a sample. No component that is larger is missed.
constexpr int levels_above = 3;

std::vector<Vector3> starts(const OctreeField& field, const std::vector<OrientedSample>& samples) {
  const int depth = std::max(1, field.octree().depth() - levels_above);
  std::unordered_set<Index> taken;
  std::vector<Vector3> result;
  for (const OrientedSample& sample : samples)
    if (taken.insert(field.octree().octree().find(field.lattice().snap(sample.position), depth)).second)
      result.push_back(sample.position);
  return result;
}

// The faces that marching cubes would make: where a leaf's corners differ a polygon with a corner on each
// edge whose ends do.
double marching_cubes_faces(const OctreeField& field) {
  const Octree& octree = field.octree().octree();
  double faces = 0;
  for (Index cube = 1; cube < octree.size(); ++cube) {
    if (!octree.is_leaf(cube)) continue;
    const std::array<double, 8> values = field.corner_values(cube);
    int crossed = 0;
    for (std::size_t corner = 0; corner < 8; ++corner)
      for (std::size_t bit : {1, 2, 4})
        if (!(corner & bit)) crossed += (values[corner] < 0) != (values[corner | bit] < 0);
    faces += std::max(0, crossed - 2);
  }
  return faces;
}

}  // namespace

void check_options(const PoissonRemeshingOptions& o) {
  check_options(o.oracle);
  require(!o.edge_length || positive(*o.edge_length),
          "EdgeLength must be positive, or 0 for one that goes with the octree.");
  require(!o.distance || positive(*o.distance),
          "Distance must be positive, or 0 for one that goes with the octree.");
  require(positive(o.share) && o.share <= 10, "Share must lie above 0 and be at most 10.");
  require(o.smallest_angle >= 0 && o.smallest_angle <= 30, "Angle must lie between 0 and 30 degrees.");
}

PoissonRemeshingResult remesh_by_poisson(const OrientedSurfaces& surface,
                                         const PoissonRemeshingOptions& options, const Progress& progress) {
  check_options(options);
  PoissonRemeshingResult result;
  CompletionReport report;
  StageClock clock(report);
  PoissonOracleOptions oracle_options = options.oracle;
  if (!oracle_options.max_depth)
    oracle_options.max_depth = std::max(usual_depth, oracle_options.poisson.min_depth);
  // Cubes as small as the depth allows everywhere.
  const double smallest = std::numeric_limits<double>::min();
  PoissonOracle oracle = make_oracle(nullptr, surface, {[=](const Vector3&) { return smallest; }, smallest},
                                     oracle_options, progress.part(0, 0.5, "building the oracle"));
  clock.end_of("building the oracle");
  const OctreeField& field = oracle.field;
  const double cube = field.lattice().side() / std::exp2(oracle.figures.depth);
  SurfaceMeshingOptions meshing;
  const double length = options.edge_length.value_or((options.adaptive ? longest_edge : uniform_edge) * cube);
  meshing.criteria.edge_length = [length](const Vector3&) { return length; };
  meshing.criteria.smallest_angle = options.smallest_angle;
  if (options.adaptive) {
    meshing.criteria.distance = options.distance.value_or(least_distance * cube);
    if (!options.distance)  // closed meshes have half as many vertices
      meshing.vertices_for_distance =
          static_cast<std::size_t>(0.5 * options.share * marching_cubes_faces(field));
  }
  const std::vector<Vector3> points =
      find_surface_points(field, starts(field, oracle.samples), longest_edge * cube, point_tolerance * cube,
                          progress.part(0.5, 0.55, "finding the surface"));
  result.mesh = mesh_surface(field, points, meshing, progress.part(0.55, 0.95, "meshing the surface"));
  clock.end_of("meshing the surface");
  if (options.fitted) {
    fit_to_surface(field, result.mesh, progress.part(0.95, 1, "fitting the surface"));
    clock.end_of("fitting the surface");
  }
  result.oracle = std::move(oracle.figures);
  result.stage_seconds = std::move(report.stage_seconds);
  progress.update(1);
  return result;
}

}  // namespace meshcomplete
