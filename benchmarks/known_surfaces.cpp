#include "benchmarks/known_surfaces.h"

#include <cmath>

#include "common/core/patch.h"

namespace meshcomplete::benchmarks {
namespace {

constexpr double pi = 3.14159265358979323846;
constexpr double minor_radius = 0.4;         // of the torus, whose other radius is 1
constexpr std::size_t probe_count = 200000;  // points by which distances are measured
constexpr std::uint64_t sample_seed = 1, probe_seed = 2, result_seed = 3;

OrientedPoints points_of_sphere(std::size_t count, std::uint64_t seed) {
  OrientedPoints set;
  Uniform uniform(seed);
  while (set.points.size() < count) {
    const double z = 2 * uniform() - 1, angle = 2 * pi * uniform(), r = std::sqrt(1 - z * z);
    set.points.emplace_back(r * std::cos(angle), r * std::sin(angle), z);
  }
  set.normals = set.points;
  return set;
}

OrientedPoints points_of_torus(std::size_t count, std::uint64_t seed) {
  OrientedPoints set;
  Uniform uniform(seed);
  while (set.points.size() < count) {
    const double around = 2 * pi * uniform(), across = 2 * pi * uniform();
    const double radius = 1 + minor_radius * std::cos(across);
    if (uniform() * (1 + minor_radius) > radius) continue;  // evenly by area
    const Vector3 way(std::cos(around), std::sin(around), 0);
    set.points.push_back(radius * way + minor_radius * std::sin(across) * Vector3::UnitZ());
    set.normals.push_back(std::cos(across) * way + std::sin(across) * Vector3::UnitZ());
  }
  return set;
}

KnownSurface known(const std::string& name, OrientedPoints samples, OrientedPoints probes) {
  KnownSurface surface;
  surface.name = name;
  surface.samples = std::move(samples);
  for (Vector3& p : surface.samples.points) p = as_stored(p);
  surface.probes = std::move(probes.points);
  return surface;
}

}  // namespace

KnownSurface known_sphere(std::size_t samples) {
  KnownSurface surface =
      known("sphere", points_of_sphere(samples, sample_seed), points_of_sphere(probe_count, probe_seed));
  surface.distance = [](const Vector3& p) { return std::abs(p.norm() - 1); };
  surface.diagonal = 2 * std::sqrt(3.0);
  return surface;
}

KnownSurface known_torus(std::size_t samples) {
  KnownSurface surface =
      known("torus", points_of_torus(samples, sample_seed), points_of_torus(probe_count, probe_seed));
  surface.distance = [](const Vector3& p) {
    return std::abs(std::hypot(std::hypot(p[0], p[1]) - 1, p[2]) - minor_radius);
  };
  const double width = 2 * (1 + minor_radius), height = 2 * minor_radius;
  surface.diagonal = std::sqrt(2 * width * width + height * height);
  return surface;
}

KnownSurface known_mesh(const std::string& name, const TriangleMesh& mesh, std::size_t samples) {
  KnownSurface surface =
      known(name, points_on(mesh, samples, sample_seed), points_on(mesh, probe_count, probe_seed));
  surface.distance = distance_function(mesh);
  surface.diagonal = diagonal_of(mesh);
  return surface;
}

Accuracy accuracy_of(const TriangleMesh& result, const KnownSurface& truth) {
  const auto from_result = distance_function(result);
  const double unit = 1e3 / truth.diagonal;
  const Distance there = distance_of(truth.probes, from_result);
  Accuracy accuracy;
  accuracy.samples = unit * distance_of(truth.samples.points, from_result).root_mean_square;
  accuracy.from_truth = unit * there.root_mean_square;
  accuracy.greatest = unit * there.greatest;
  accuracy.to_truth =
      unit * distance_of(points_on(result, probe_count, result_seed).points, truth.distance).root_mean_square;
  return accuracy;
}

}  // namespace meshcomplete::benchmarks
