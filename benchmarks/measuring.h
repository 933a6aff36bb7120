// Small things that the benchmarks share: time, memory, load, names.
#pragma once

#include <chrono>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "common/core/boundary_loops.h"
#include "common/core/mesh.h"
#include "common/core/patch.h"

namespace meshcomplete::benchmarks {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start);

/// That the process has used so far, of all threads together.
double processor_seconds();

/// The last part of a path.
std::string file_name(const std::string& path);

/// The one minute load average.
std::string load_average();

/// Of a list that is not empty.
double median(std::vector<double> list);

std::vector<BoundaryLoop> loops_of(const TriangleMesh& mesh);

double area_of(const TriangleMesh& mesh);

/// The mesh and its patch.
TriangleMesh completed(TriangleMesh mesh, const Patch& patch);

/// "yes" when the completed mesh is solid, or what is wrong. A mesh that is broken elsewhere is not solid
/// whatever the patch is like.
std::string soundness(const TriangleMesh& mesh, const Patch& patch);

/// A number in a table, by a format of printf.
std::string text(const char* format, double value);

/// The most memory that the process has held since it was created, in megabytes (10^6 bytes), beyond what it
/// held then.
class PeakMemory {
 public:
  /// Forgets the process's earlier peak.
  PeakMemory();

  /// Absent where the system cannot forget an earlier peak, or has no such figure.
  std::optional<double> megabytes() const;

 private:
  std::optional<std::size_t> before_;  // bytes
};

}  // namespace meshcomplete::benchmarks
