#include <algorithm>
#include <cstdio>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "benchmarks/marching_cubes.h"
#include "benchmarks/measuring.h"
#include "benchmarks/poisson_input.h"
#include "benchmarks/poisson_parts.h"
#include "benchmarks/reconstruction_programs.h"

namespace meshcomplete::benchmarks {
namespace {

constexpr int usual_depth = 8;

void solver_row(const KnownSurface& truth, int depth, const char* program,
                const std::optional<Reconstruction>& made) {
  std::printf("| %s | %d | %s |", truth.name.c_str(), depth, program);
  if (!made) {
    std::printf(" no result | | | | | | | |\n");
    return;
  }
  const Accuracy accuracy = accuracy_of(made->mesh, truth);
  std::printf(" %zu | %.3f | %.3f | %.2f | %.3f | %.1f | %.1f | %.0f |\n", made->mesh.triangles.size(),
              accuracy.samples, accuracy.from_truth, accuracy.greatest, accuracy.to_truth, made->use.seconds,
              made->use.processor_seconds, made->use.megabytes);
}

// What a level came to with so many iterations.
void residual_table(const KnownSurface& truth) {
  const std::vector<int> iterations = {5, 10, 20, 30, 60, 120};
  std::vector<std::vector<PoissonLevelFigures>> figures;
  for (int most : iterations) {
    ScreenedPoissonOptions options;
    options.iterations = most;
    options.tolerance = 0;
    figures.push_back(oracle_of(truth.samples, usual_depth, options).figures.levels);
  }
  figures.push_back(oracle_of(truth.samples, usual_depth).figures.levels);
  std::printf("\n%s\n\n| level | unknowns |", truth.name.c_str());
  for (int most : iterations) std::printf(" after %d |", most);
  std::printf(" iterations by default | residual |\n|---:|---:|");
  for (std::size_t i = 0; i < iterations.size(); ++i) std::printf("---:|");
  std::printf("---:|---:|\n");
  for (std::size_t level = 0; level < figures.back().size(); ++level) {
    std::printf("| %zu | %zu |", level + 1, figures.back()[level].unknowns);
    for (std::size_t i = 0; i < iterations.size(); ++i) std::printf(" %.1e |", figures[i][level].residual);
    std::printf(" %d | %.1e |\n", figures.back()[level].iterations, figures.back()[level].residual);
  }
}

void tolerance_rows(const KnownSurface& truth) {
  for (double tolerance : {1e-1, 1e-2, 1e-3, 1e-4, 1e-6, 1e-8}) {
    ScreenedPoissonOptions options;
    options.tolerance = tolerance;
    options.iterations = 1000;
    const double used = processor_seconds();
    const Clock::time_point start = Clock::now();
    const PoissonOracle oracle = oracle_of(truth.samples, usual_depth, options);
    const double seconds = seconds_since(start), processor = processor_seconds() - used;
    int iterations = 0;
    for (const PoissonLevelFigures& level : oracle.figures.levels) iterations += level.iterations;
    const Accuracy accuracy = accuracy_of(marching_cubes(oracle.field), truth);
    std::printf("| %s | %.0e | %d | %d | %.4f | %.4f | %.2f | %.2f |\n", truth.name.c_str(), tolerance,
                iterations, oracle.figures.levels.back().iterations, accuracy.samples, accuracy.from_truth,
                seconds, processor);
  }
}

struct Rate {
  double by_clock = 0, by_processor = 0;  // million values in a second
};

// With so many threads, each of which asks for the positions in its share.
Rate query_rate(const OctreeField& field, const std::vector<Vector3>& positions, std::size_t threads) {
  constexpr double least = 0.7;  // seconds to measure for
  std::vector<double> sums(threads);
  std::size_t asked = 0;
  const double used = processor_seconds();
  const Clock::time_point start = Clock::now();
  while (processor_seconds() - used < least) {
    std::vector<std::thread> running;
    for (std::size_t t = 0; t < threads; ++t)
      running.emplace_back([&, t] {
        double sum = 0;
        for (std::size_t i = t; i < positions.size(); i += threads) sum += field.value(positions[i]);
        sums[t] += sum;
      });
    for (std::thread& thread : running) thread.join();
    asked += positions.size();
  }
  const double millions = 1e-6 * static_cast<double>(asked);
  return {millions / seconds_since(start), millions / (processor_seconds() - used)};
}

std::vector<Vector3> anywhere(const OctreeField& field, std::size_t count) {
  const Lattice& lattice = field.lattice();
  Uniform uniform(1);
  std::vector<Vector3> positions;
  for (std::size_t i = 0; i < count; ++i) {
    const double x = uniform(), y = uniform(), z = uniform();
    positions.push_back(lattice.position({0, 0, 0}) + lattice.side() * Vector3(x, y, z));
  }
  return positions;
}

// One after the other as a refinement asks: near to each other.
std::vector<Vector3> along_surface(const KnownSurface& truth, const OctreeField& field) {
  std::vector<Vector3> positions = truth.samples.points;
  const double cube = field.lattice().side() / 256;
  Uniform uniform(1);
  for (Vector3& p : positions) p += cube * Vector3(uniform() - 0.5, uniform() - 0.5, uniform() - 0.5);
  const auto cell = [&](const Vector3& p) {
    const double size = 8 * cube;
    return std::make_tuple(std::floor(p[0] / size), std::floor(p[1] / size), std::floor(p[2] / size));
  };
  std::sort(positions.begin(), positions.end(),
            [&](const Vector3& a, const Vector3& b) { return cell(a) < cell(b); });
  return positions;
}

}  // namespace

void solver(const std::vector<KnownSurface>& truths, const std::filesystem::path& programs) {
  ReconstructionPrograms run(programs);
  std::printf(
      "\n| surface | depth | program | faces | from the samples | from the truth | at most | to the truth "
      "| s | processor s | MB |\n|---|---:|---|---:|---:|---:|---:|---:|---:|---:|---:|\n");
  for (int depth : {7, 8, 9})
    for (const KnownSurface& truth : truths) {
      run.set_points(truth.samples);
      solver_row(truth, depth, "MeshLab", run.meshlab(depth));
      solver_row(truth, depth, "ours", run.ours("cubes", {std::to_string(depth)}));
    }
  if (const auto alone = run.meshlab_alone())
    std::printf(
        "\nMeshLab only to start, read and write the last of these point sets: %.1f s, %.1f s of processor "
        "time, %.0f MB.\n",
        alone->seconds, alone->processor_seconds, alone->megabytes);
}

void convergence(const std::vector<KnownSurface>& truths) {
  residual_table(truths.front());
  std::printf(
      "\n| surface | tolerance | iterations, all levels | finest level | from the samples | from the truth "
      "| s | processor s |\n|---|---:|---:|---:|---:|---:|---:|---:|\n");
  for (const KnownSurface& truth : truths) tolerance_rows(truth);
}

void oracle(const std::vector<KnownSurface>& truths) {
  const KnownSurface& truth = truths.front();
  PoissonOracle oracle = oracle_of(truth.samples, usual_depth);
  const std::vector<Vector3> all = anywhere(oracle.field, 400000), near = along_surface(truth, oracle.field);
  std::printf(
      "\n%s, depth %d, %zu cubes; million values in a second by the clock and in one of processor time\n\n"
      "| interpolation | threads | anywhere in the cube | processor | along the surface | processor "
      "|\n|---|---:|---:|---:|---:|---:|\n",
      truth.name.c_str(), oracle.figures.depth, oracle.figures.cubes);
  for (auto [interpolation, name] : {std::make_pair(FieldInterpolation::trilinear, "trilinear"),
                                     std::make_pair(FieldInterpolation::tetrahedral, "tetrahedral")})
    for (std::size_t threads : {1, 2}) {
      oracle.field.set_interpolation(interpolation);
      const Rate far = query_rate(oracle.field, all, threads),
                 close = query_rate(oracle.field, near, threads);
      std::printf("| %s | %zu | %.2f | %.2f | %.2f | %.2f |\n", name, threads, far.by_clock, far.by_processor,
                  close.by_clock, close.by_processor);
    }
}

}  // namespace meshcomplete::benchmarks
