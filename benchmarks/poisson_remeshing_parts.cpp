#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <string>
#include <vector>

#include "benchmarks/measuring.h"
#include "benchmarks/poisson_parts.h"
#include "benchmarks/reconstruction_programs.h"
#include "common/core/mesh_statistics.h"

namespace meshcomplete::benchmarks {
namespace {

constexpr double degrees = 180 / 3.14159265358979323846;
const std::string depth = "8";

double smallest_angle(const TriangleMesh& mesh, const Triangle& t) {
  double least = 180;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vector3 a = mesh.vertices[t[(k + 1) % 3]] - mesh.vertices[t[k]];
    const Vector3 b = mesh.vertices[t[(k + 2) % 3]] - mesh.vertices[t[k]];
    least = std::min(least, degrees * std::atan2(a.cross(b).norm(), a.dot(b)));
  }
  return least;
}

// The smallest angles of the worst face, and of the one that is better than one in a hundred.
std::pair<double, double> worst_angles(const TriangleMesh& mesh) {
  std::vector<double> angles;
  for (const Triangle& t : mesh.triangles) angles.push_back(smallest_angle(mesh, t));
  std::sort(angles.begin(), angles.end());
  return {angles.front(), angles[angles.size() / 100]};
}

void remeshing_row(const KnownSurface& truth, const std::string& program,
                   const std::optional<Reconstruction>& made, double compared_with) {
  std::printf("| %s | %s |", truth.name.c_str(), program.c_str());
  if (!made) {
    std::printf(" no result | | | | | | | | |\n");
    return;
  }
  const Accuracy accuracy = accuracy_of(made->mesh, truth);
  const auto [worst, hundredth] = worst_angles(made->mesh);
  const double faces = static_cast<double>(made->mesh.triangles.size());
  std::printf(" %.0f | %.0f %% | %.3f | %.3f | %.2f | %.0f, %.0f | %s | %.1f | %.1f | %.0f |\n", faces,
              100 * faces / compared_with, accuracy.from_truth, accuracy.to_truth, accuracy.greatest, worst,
              hundredth, measure(made->mesh, true).solid() ? "yes" : "no", made->use.seconds,
              made->use.processor_seconds, made->use.megabytes);
}

void table_head(const char* compared_with) {
  std::printf(
      "\n| surface | program | faces | %s | from the truth | to the truth | at most | angles "
      "| solid | s | processor s | MB |\n|---|---|---:|---:|---:|---:|---:|---:|---|---:|---:|---:|\n",
      compared_with);
}

double faces_of(const std::optional<Reconstruction>& made) {
  return made ? static_cast<double>(made->mesh.triangles.size()) : std::nan("");
}

}  // namespace

void remeshing(const std::vector<KnownSurface>& truths, const std::filesystem::path& programs) {
  ReconstructionPrograms run(programs);
  table_head("of MeshLab's");
  for (const KnownSurface& truth : truths) {
    run.set_points(truth.samples);
    const std::optional<Reconstruction> meshlab = run.meshlab(std::stoi(depth));
    const double all = faces_of(meshlab);
    remeshing_row(truth, "MeshLab, Screened Poisson", meshlab, all);
    remeshing_row(truth, "ours, marching cubes", run.ours("cubes", {depth}), all);
    remeshing_row(truth, "ours, adaptive", run.ours("adaptive", {depth}), all);
    remeshing_row(truth, "ours, uniform", run.ours("uniform", {depth}), all);
    remeshing_row(truth, "CGAL", run.ours("cgal", {}), all);
  }
}

void criteria(const std::vector<KnownSurface>& truths, const std::filesystem::path& programs) {
  const std::vector<std::vector<std::string>> ways = {{"distance=0.1", "fitted=0"},
                                                      {"distance=0.1"},
                                                      {"distance=0.2", "fitted=0"},
                                                      {"distance=0.2"},
                                                      {"share=0.25"},
                                                      {"share=0.3"},
                                                      {"share=0.3", "angle=20"}};
  ReconstructionPrograms run(programs);
  const KnownSurface& truth = truths.front();
  run.set_points(truth.samples);
  const double all = faces_of(run.ours("cubes", {depth}));
  table_head("of marching cubes'");
  for (const std::vector<std::string>& way : ways) {
    std::vector<std::string> arguments = {depth};
    std::string name;
    for (const std::string& word : way) {
      arguments.push_back(word);
      name += (name.empty() ? "" : ", ") + word;
    }
    remeshing_row(truth, name, run.ours("adaptive", arguments), all);
  }
}

}  // namespace meshcomplete::benchmarks
