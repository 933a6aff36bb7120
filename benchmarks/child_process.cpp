#include "benchmarks/child_process.h"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <cstdlib>

#include "benchmarks/measuring.h"

namespace meshcomplete::benchmarks {
namespace {

double seconds_of(const timeval& time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

// In the new process: does not return.
[[noreturn]] void become(const std::vector<std::string>& command, int output, double limit) {
  std::vector<char*> words;
  for (const std::string& word : command) words.push_back(const_cast<char*>(word.c_str()));
  words.push_back(nullptr);
  const int nothing = open("/dev/null", O_RDWR);
  dup2(nothing, STDIN_FILENO);
  dup2(output, STDOUT_FILENO);
  dup2(nothing, STDERR_FILENO);
  setenv("LC_ALL", "C", 1);
  setenv("OMP_WAIT_POLICY", "passive", 1);         // threads that wait use no processor time
  alarm(static_cast<unsigned>(std::ceil(limit)));  // kept by the program that takes over
  execvp(words[0], words.data());
  _exit(127);
}

std::string read_all(int file) {
  std::string text;
  std::array<char, 4096> part;
  for (ssize_t count; (count = read(file, part.data(), part.size())) > 0;)
    text.append(part.data(), static_cast<std::size_t>(count));
  return text;
}

}  // namespace

std::optional<ProcessUse> run_process(const std::vector<std::string>& command, double limit) {
  int ends[2];
  if (pipe(ends) != 0) return std::nullopt;
  const Clock::time_point start = Clock::now();
  const pid_t child = fork();
  if (child == 0) {
    close(ends[0]);
    become(command, ends[1], limit);
  }
  close(ends[1]);
  ProcessUse use;
  use.output = read_all(ends[0]);
  close(ends[0]);
  int status = 1;
  rusage usage{};
  if (child < 0 || wait4(child, &status, 0, &usage) != child || !WIFEXITED(status)) return std::nullopt;
  use.exit_code = WEXITSTATUS(status);
  use.seconds = seconds_since(start);
  use.processor_seconds = seconds_of(usage.ru_utime) + seconds_of(usage.ru_stime);
  use.megabytes = 1024e-6 * static_cast<double>(usage.ru_maxrss);
  return use;
}

}  // namespace meshcomplete::benchmarks
