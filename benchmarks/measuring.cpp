#include "benchmarks/measuring.h"

#include <malloc.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cstdio>
#include <ctime>
#include <fstream>

#include "common/core/mesh_statistics.h"
#include "common/core/mesh_topology.h"

namespace meshcomplete::benchmarks {
namespace {

// A line of /proc/self/status such as "VmHWM:   1234 kB", in bytes.
std::optional<std::size_t> status_line(const std::string& name) {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;) {
    std::size_t kilobytes = 0;
    if (word == name + ":" && status >> kilobytes) return 1024 * kilobytes;
  }
  return std::nullopt;
}

}  // namespace

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

double processor_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

std::string file_name(const std::string& path) { return path.substr(path.find_last_of('/') + 1); }

std::string load_average() {
  std::ifstream file("/proc/loadavg");
  std::string one;
  return file >> one ? one : "unknown";
}

double median(std::vector<double> list) {
  std::sort(list.begin(), list.end());
  const std::size_t half = list.size() / 2;
  return list.size() % 2 ? list[half] : 0.5 * (list[half - 1] + list[half]);
}

std::vector<BoundaryLoop> loops_of(const TriangleMesh& mesh) {
  return trace_boundary_loops(mesh, build_topology(mesh));
}

double area_of(const TriangleMesh& mesh) {
  double sum = 0;
  for (const Triangle& t : mesh.triangles) {
    const Vector3& a = mesh.vertices[t[0]];
    sum += 0.5 * (mesh.vertices[t[1]] - a).cross(mesh.vertices[t[2]] - a).norm();
  }
  return sum;
}

TriangleMesh completed(TriangleMesh mesh, const Patch& patch) {
  mesh.vertices.insert(mesh.vertices.end(), patch.vertices.begin(), patch.vertices.end());
  mesh.triangles.insert(mesh.triangles.end(), patch.triangles.begin(), patch.triangles.end());
  return mesh;
}

std::string soundness(const TriangleMesh& mesh, const Patch& patch) {
  const MeshStatistics after = measure(completed(mesh, patch), true);
  if (after.solid()) return "yes";
  if (after.boundary_edges > 0) return std::to_string(after.boundary_edges) + " edges open";
  const MeshStatistics before = measure(mesh, true);
  const std::size_t more = *after.self_intersecting_pairs - *before.self_intersecting_pairs;
  return more == 0 && after.non_manifold_edges == before.non_manifold_edges ? "as far as the mesh is" : "no";
}

std::string text(const char* format, double value) {
  char line[40];
  std::snprintf(line, sizeof line, format, value);
  return line;
}

PeakMemory::PeakMemory() {
  malloc_trim(0);  // what was freed counts as held until it is given back
  std::ofstream forget("/proc/self/clear_refs");
  forget << "5" << std::flush;  // Linux: sets the peak to what is held now
  if (forget) before_ = status_line("VmRSS");
}

std::optional<double> PeakMemory::megabytes() const {
  const std::optional<std::size_t> peak = status_line("VmHWM");
  if (!before_ || !peak) return std::nullopt;
  return static_cast<double>(*peak - std::min(*peak, *before_)) / 1e6;
}

}  // namespace meshcomplete::benchmarks
