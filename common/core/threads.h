// Loops in threads that let no exception escape into the scheduler.
#pragma once

#include <cstddef>
#include <functional>

#include "common/core/progress.h"

namespace meshcomplete {

/// Runs `work(begin, end)` for consecutive ranges of at most `grain` of the numbers below `count`, in
/// threads; the same ranges on every run. Of the exceptions that were thrown the one of the first range is
/// thrown when all are done; once `progress` is cancelled, ranges that have not begun do not begin.
void for_ranges(std::size_t count, std::size_t grain, const Progress& progress,
                const std::function<void(std::size_t begin, std::size_t end)>& work);

/// The same, one number at a time; of the exceptions that of the lowest number is thrown.
template <class Work>
void for_each(std::size_t count, std::size_t grain, const Progress& progress, Work&& work) {
  for_ranges(count, grain, progress, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) work(i);
  });
}

}  // namespace meshcomplete
