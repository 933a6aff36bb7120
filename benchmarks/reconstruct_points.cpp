// Makes a surface of points with normals, in a process of its own so that what it takes can be measured.
//
//   reconstruct_points cubes|adaptive|uniform IN.ply OUT.ply DEPTH [NAME=VALUE...]
//   reconstruct_points cgal IN.ply OUT.ply
//
// cubes: screened Poisson and marching cubes over its octree; adaptive and uniform: Surface Reconstruction:
// Poisson Delaunay; cgal: CGAL's poisson_surface_reconstruction_delaunay. NAME: distance and length (in
// cubes), angle (degrees), fitted (0 or 1). Prints the seconds of each stage.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <optional>
#include <string>
#include <vector>

#include "benchmarks/cgal_reconstruction.h"
#include "benchmarks/marching_cubes.h"
#include "benchmarks/measuring.h"
#include "benchmarks/mesh_file.h"
#include "benchmarks/point_file.h"
#include "benchmarks/poisson_input.h"
#include "common/core/surface_sampling.h"
#include "filter_poissoncompletion/poisson_remeshing.h"

namespace {

using namespace meshcomplete;
using benchmarks::Clock;
using benchmarks::seconds_since;

void print_stage(const std::string& name, double seconds) {
  std::printf("%s: %.3f\n", name.c_str(), seconds);
}

TriangleMesh cubes(const benchmarks::OrientedPoints& set, int depth) {
  Clock::time_point start = Clock::now();
  const PoissonOracle oracle = benchmarks::oracle_of(set, depth);
  print_stage("solve", seconds_since(start));
  start = Clock::now();
  TriangleMesh mesh = benchmarks::marching_cubes(oracle.field);
  print_stage("mesh", seconds_since(start));
  return mesh;
}

TriangleMesh remeshed(const benchmarks::OrientedPoints& set, const PoissonRemeshingOptions& options) {
  PoissonRemeshingResult result = remesh_by_poisson({{}, set.points, set.normals}, options);
  for (const auto& [stage, seconds] : result.stage_seconds) print_stage(stage, seconds);
  return std::move(result.mesh);
}

// What the word NAME=VALUE gives, if it is among the words.
std::optional<double> value_of(const std::string& name, const std::vector<std::string>& words) {
  for (const std::string& word : words)
    if (word.rfind(name + "=", 0) == 0) return std::atof(word.c_str() + name.size() + 1);
  return std::nullopt;
}

PoissonRemeshingOptions options_of(bool adaptive, const benchmarks::OrientedPoints& set,
                                   const std::vector<std::string>& words) {
  PoissonRemeshingOptions options;
  options.oracle.scale = benchmarks::meshlab_scale;
  options.oracle.max_depth = std::atoi(words.at(0).c_str());
  options.adaptive = adaptive;
  const double cube =
      root_cube({}, set.points, options.oracle.scale).side() / std::exp2(*options.oracle.max_depth);
  if (const auto distance = value_of("distance", words)) options.distance = *distance * cube;
  if (const auto length = value_of("length", words)) options.edge_length = *length * cube;
  options.share = value_of("share", words).value_or(options.share);
  options.smallest_angle = value_of("angle", words).value_or(options.smallest_angle);
  options.fitted = value_of("fitted", words).value_or(1) != 0;
  return options;
}

TriangleMesh reconstruct(const std::string& method, const benchmarks::OrientedPoints& set,
                         const std::vector<std::string>& words) {
  if (method == "cgal") return benchmarks::reconstruct_with_cgal(set);
  if (method == "cubes") return cubes(set, std::atoi(words.at(0).c_str()));
  return remeshed(set, options_of(method == "adaptive", set, words));
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 4) {
    std::fprintf(stderr, "usage: reconstruct_points cubes|adaptive|uniform|cgal IN.ply OUT.ply [DEPTH]\n");
    return 2;
  }
  try {
    const auto set = benchmarks::read_points(argv[2]);
    benchmarks::write_ply(argv[3], reconstruct(argv[1], set, {argv + 4, argv + argc}));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
