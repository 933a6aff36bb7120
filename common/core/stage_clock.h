// How long the stages of a completion take.
#pragma once

#include <chrono>

#include "common/core/patch.h"

namespace meshcomplete {

/// Writes wall seconds between the ends of stages into a report, which must outlive it.
class StageClock {
 public:
  explicit StageClock(CompletionReport& report) : report_(report) {}
  void end_of(const char* stage) {
    const auto now = std::chrono::steady_clock::now();
    report_.stage_seconds.emplace_back(stage, std::chrono::duration<double>(now - start_).count());
    start_ = now;
  }

 private:
  CompletionReport& report_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace meshcomplete
