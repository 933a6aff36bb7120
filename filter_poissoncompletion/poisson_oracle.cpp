#include "filter_poissoncompletion/poisson_oracle.h"

#include <algorithm>
#include <cmath>

#include "common/core/error.h"
#include "filter_poissoncompletion/edge_length_field.h"
#include "filter_poissoncompletion/surface_sampling.h"

namespace meshcomplete {
namespace {

constexpr const char* stage = "building the oracle";

// Cubes grow by this share of the distance from the rims: half of what a balanced octree allows, so that
// there are some of each size.
constexpr double growth = 0.125;

// What automatic depths stop at: cubes are then far smaller than anything else at a rim.
constexpr int most_automatic_depth = 14;

}  // namespace

double wanted_cube(const EdgeLengthField& cubes, const Vector3& point) {
  return std::max(cubes.at(point), growth * cubes.distance(point));
}

PoissonOracle make_oracle(const TriangleMesh& mesh, const PoissonGuides& guides, const EdgeLengthField& cubes,
                          const PoissonOracleOptions& options, const Progress& progress) {
  std::vector<const TriangleMesh*> meshes = {&mesh};
  for (const TriangleMesh& surface : guides.surfaces) meshes.push_back(&surface);
  const Lattice lattice = root_cube(meshes, guides.points, options.scale);
  SamplingOptions sampling;
  sampling.cube_size = [&](const Vector3& point) { return wanted_cube(cubes, point); };
  sampling.min_depth = options.poisson.min_depth;
  sampling.max_depth = most_automatic_depth;
  sampling.max_depth =
      std::max(sampling.min_depth, options.max_depth.value_or(depth_of(lattice, cubes.shortest(), sampling)));
  sampling.density = options.density;
  std::vector<OrientedSample> samples;
  for (const TriangleMesh* one : meshes) {
    const auto more = sample_surface(*one, lattice, sampling, progress.part(0, 0.2, stage));
    samples.insert(samples.end(), more.begin(), more.end());
  }
  const auto more =
      sample_points(guides.points, guides.normals, lattice, sampling, 10, progress.part(0.2, 0.3, stage));
  samples.insert(samples.end(), more.begin(), more.end());
  if (samples.empty()) throw CompletionError(stage, "The mesh has no faces with an area.");
  PoissonSolution solution =
      solve_screened_poisson(lattice, samples, options.poisson, progress.part(0.3, 1, stage));
  PoissonOracle oracle{std::move(solution.field), {}};
  oracle.field.set_interpolation(options.interpolation);
  oracle.figures.samples = samples.size();
  oracle.figures.cubes = oracle.field.octree().octree().size();
  oracle.figures.depth = oracle.field.octree().depth();
  oracle.figures.levels = std::move(solution.levels);
  return oracle;
}

}  // namespace meshcomplete
