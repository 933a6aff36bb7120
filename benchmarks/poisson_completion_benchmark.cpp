// Prints what the Poisson-driven completion of punched meshes comes to with other numbers of rings and other
// cushions.
//
//   poisson_completion_benchmark [rings|cushion]... MESH MESH    without a word: both
//
// Into the first mesh a long winding hole is cut, into the second round ones; both are closed ones.

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <exception>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "benchmarks/arguments.h"
#include "benchmarks/cut_holes.h"
#include "benchmarks/measuring.h"
#include "benchmarks/mesh_file.h"
#include "benchmarks/surface_distance.h"
#include "common/core/mesh_topology.h"
#include "filter_poissoncompletion/poisson_completion.h"

namespace {

using namespace meshcomplete;
using namespace meshcomplete::benchmarks;

constexpr double degrees = 180 / 3.14159265358979323846;
constexpr std::size_t probes = 400000;  // over all of a mesh

struct Punched {
  std::string name;
  TriangleMesh truth, mesh;
};

Punched winding(const std::string& file) {
  Punched punched{file_name(file) + ", one winding hole", read_mesh(file), {}};
  const auto cut = cut_winding_hole(punched.truth, 200, benchmarks::Rim::any, 1, {}, 3);
  if (!cut) throw std::runtime_error(file + " has no room for the hole");
  punched.mesh = cut->mesh;
  return punched;
}

Punched round(const std::string& file) {
  Punched punched{file_name(file) + ", three round holes", read_mesh(file), {}};
  punched.mesh = punched.truth;
  const double radius = 0.05 * diagonal_of(punched.truth);
  const std::size_t count = punched.truth.vertices.size();
  int holes = 0;
  for (std::size_t v = 0; v < count && holes < 3; v += count / 40) {
    const auto cut = cut_round_hole(punched.mesh, {punched.truth.vertices[v], radius});
    if (!cut) continue;
    punched.mesh = cut->mesh;
    ++holes;
  }
  return punched;
}

/// The mean angle between the normals of patch and mesh along the rims, degrees.
double seam_jump(const TriangleMesh& whole, std::size_t faces_of_mesh) {
  const MeshTopology topology = build_topology(whole);
  const auto normal = [&](std::size_t face) -> Vector3 {
    const Triangle& t = whole.triangles[face];
    const Vector3& a = whole.vertices[t[0]];
    return (whole.vertices[t[1]] - a).cross(whole.vertices[t[2]] - a);
  };
  double sum = 0;
  std::size_t count = 0;
  for (std::size_t h = 3 * faces_of_mesh; h < topology.opposite.size(); ++h) {
    const Index other = topology.opposite[h];
    if (other >= 3 * faces_of_mesh) continue;
    const Vector3 a = normal(h / 3), b = normal(other / 3);
    sum += degrees * std::atan2(a.cross(b).norm(), a.dot(b));
    ++count;
  }
  return count == 0 ? std::nan("") : sum / static_cast<double>(count);
}

/// The root mean square distance between the patch and what was cut away, both ways, thousandths of the
/// diagonal.
double error(const Punched& punched, const TriangleMesh& whole) {
  TriangleMesh patch{whole.vertices,
                     {whole.triangles.begin() + static_cast<std::ptrdiff_t>(punched.mesh.triangles.size()),
                      whole.triangles.end()}};
  if (patch.triangles.empty()) return std::nan("");
  const double diagonal = diagonal_of(punched.truth);
  std::vector<Vector3> away = points_on(punched.truth, probes).points;
  const auto from_mesh = distance_function(punched.mesh);
  away.erase(std::remove_if(away.begin(), away.end(),
                            [&](const Vector3& p) { return from_mesh(p) < 1e-6 * diagonal; }),
             away.end());
  const double there = distance_of(away, distance_function(whole)).root_mean_square;
  const double back =
      distance_of(points_on(patch, away.size()).points, distance_function(punched.truth)).root_mean_square;
  return 1e3 * std::sqrt(0.5 * (there * there + back * back)) / diagonal;
}

struct Completed {
  std::string solid;
  double error, jump, seconds, processor;
};

Completed complete(const Punched& punched, PoissonCompletionOptions options, bool faired) {
  if (!faired) options.refinement.finishing.fairing.reset();
  const double used = processor_seconds();
  const Clock::time_point start = Clock::now();
  const Patch patch = complete_by_poisson(punched.mesh, MeshSelection(), options).completion.patch;
  const double seconds = seconds_since(start), processor = processor_seconds() - used;
  const TriangleMesh whole = completed(punched.mesh, patch);
  return {soundness(punched.mesh, patch), error(punched, whole),
          seam_jump(whole, punched.mesh.triangles.size()), seconds, processor};
}

void row(const Punched& punched, const std::string& value, const PoissonCompletionOptions& options) {
  const Completed faired = complete(punched, options, true), plain = complete(punched, options, false);
  std::printf("| %s | %s | %s | %.3f | %.1f | %s | %.3f | %.1f | %.2f | %.2f |\n", punched.name.c_str(),
              value.c_str(), faired.solid.c_str(), faired.error, faired.jump, plain.solid.c_str(),
              plain.error, plain.jump, faired.seconds, faired.processor);
}

void head(const char* value) {
  std::printf(
      "\n| mesh | %s | solid | error | jump at the seam | solid, not faired | error, not faired "
      "| jump, not faired | s | processor s |\n|---|---:|---|---:|---:|---|---:|---:|---:|---:|\n",
      value);
}

void rings(const std::vector<Punched>& meshes) {
  head("rings");
  for (const Punched& punched : meshes)
    for (int count : {1, 2, 3, 4, 8, 16}) {
      PoissonCompletionOptions options;
      options.refinement.rings = count;
      row(punched, std::to_string(count), options);
    }
}

void cushion(const std::vector<Punched>& meshes) {
  head("radius");
  for (const Punched& punched : meshes)
    for (double radius : {0.25, 0.5, 0.8, 1.05, 1.5, 2.0, 3.0}) {
      PoissonCompletionOptions options;
      options.refinement.cushion = radius;
      row(punched, text("%.2f", radius), options);
    }
}

}  // namespace

int main(int argc, char** argv) {
  std::setvbuf(stdout, nullptr, _IOLBF, 0);  // a table that grows as it is measured
  const Arguments arguments(argc, argv, {"rings", "cushion"});
  if (arguments.files.size() != 2) {
    std::fprintf(stderr, "usage: poisson_completion_benchmark [rings|cushion]... MESH MESH\n");
    return 2;
  }
  try {
    const std::vector<Punched> meshes = {winding(arguments.files[0]), round(arguments.files[1])};
    if (arguments.wanted("rings")) rings(meshes);
    if (arguments.wanted("cushion")) cushion(meshes);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
