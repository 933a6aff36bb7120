// Cancelling at any step of a run.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <utility>

#include "common/core/error.h"
#include "common/core/progress.h"

namespace meshcomplete {
namespace test {

/// Runs `work(progress)` again and again, cancelled later each time until it is not any more: it throws
/// `Cancelled` exactly when it was asked to stop.
template <class Work>
void expect_cancels_at_any_step(Work&& work) {
  bool asked = true;
  for (int last = 1; asked; last *= 2) {
    int count = 0;
    bool thrown = false;
    asked = false;
    const Progress stop([&](double, const std::string&) {
      asked = ++count >= last;  // how often this is called depends on the clock
      return !asked;
    });
    try {
      work(stop);
    } catch (const Cancelled&) {
      thrown = true;
    }
    EXPECT_EQ(thrown, asked) << "asked at call " << last;
    EXPECT_TRUE(thrown || last > 1) << "progress was never reported";
  }
}

}  // namespace test
}  // namespace meshcomplete
