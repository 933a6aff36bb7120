#include "common/core/poisson_oracle.h"

#include <algorithm>
#include <cmath>

#include "common/core/error.h"
#include "common/core/parameter_checks.h"
#include "common/core/surface_sampling.h"

namespace meshcomplete {
namespace {

constexpr const char* stage = "building the oracle";

// What automatic depths stop at: cubes are then far smaller than anything else at a rim.
constexpr int most_automatic_depth = 14;

}  // namespace

void check_options(const PoissonOracleOptions& o) {
  require(o.poisson.min_depth >= 1 && o.poisson.min_depth <= 8, "MinDepth must lie between 1 and 8.");
  require(!o.max_depth || (*o.max_depth >= o.poisson.min_depth && *o.max_depth <= 16),
          "MaxDepth must lie between MinDepth and 16, or be 0 for one that is chosen automatically.");
  require(std::isfinite(o.scale) && o.scale > 1 && o.scale <= 10,
          "Scale must lie above 1 and be at most 10.");
  require(positive(o.density), "Samples must be positive.");
  require(std::isfinite(o.poisson.screening) && o.poisson.screening >= 0, "Screening must not be negative.");
}

PoissonOracle make_oracle(const TriangleMesh* mesh, const OrientedSurfaces& others, const CubeSizes& cubes,
                          const PoissonOracleOptions& options, const Progress& progress) {
  std::vector<const TriangleMesh*> meshes;
  if (mesh != nullptr) meshes.push_back(mesh);
  for (const TriangleMesh& surface : others.meshes) meshes.push_back(&surface);
  const Lattice lattice = root_cube(meshes, others.points, options.scale);
  SamplingOptions sampling;
  sampling.cube_size = cubes.at;
  sampling.min_depth = options.poisson.min_depth;
  sampling.max_depth = most_automatic_depth;
  sampling.max_depth =
      std::max(sampling.min_depth, options.max_depth.value_or(depth_of(lattice, cubes.smallest, sampling)));
  sampling.density = options.density;
  std::vector<OrientedSample> samples;
  for (const TriangleMesh* one : meshes) {
    const auto more = sample_surface(*one, lattice, sampling, progress.part(0, 0.2, stage));
    samples.insert(samples.end(), more.begin(), more.end());
    sampling.max_samples -= more.size();
  }
  const auto more =
      sample_points(others.points, others.normals, lattice, sampling, progress.part(0.2, 0.3, stage));
  samples.insert(samples.end(), more.begin(), more.end());
  if (samples.empty())
    throw CompletionError(stage, "There is nothing to reconstruct: no faces with an area and no points.");
  PoissonSolution solution =
      solve_screened_poisson(lattice, samples, options.poisson, progress.part(0.3, 1, stage));
  PoissonOracle oracle{std::move(solution.field), std::move(samples), {}};
  oracle.field.set_interpolation(options.interpolation);
  oracle.figures.samples = oracle.samples.size();
  oracle.figures.cubes = oracle.field.octree().octree().size();
  oracle.figures.depth = oracle.field.octree().depth();
  oracle.figures.levels = std::move(solution.levels);
  return oracle;
}

}  // namespace meshcomplete
