// Programs run in a process of their own, so that what they need can be compared.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace meshcomplete::benchmarks {

struct ProcessUse {
  int exit_code = 0;
  double seconds = 0, processor_seconds = 0;
  double megabytes = 0;  ///< 10^6 bytes, the most that the process had in memory
  std::string output;    ///< what it wrote to standard output
};

/// Runs a command, with what it needs of `PATH`; what it writes to standard error is dropped; OpenMP's
/// threads wait without using a processor. Nothing when it
/// crashed or took longer than `limit` seconds.
std::optional<ProcessUse> run_process(const std::vector<std::string>& command, double limit);

}  // namespace meshcomplete::benchmarks
