#include "common/core/threads.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <exception>
#include <mutex>

namespace meshcomplete {

void for_ranges(std::size_t count, std::size_t grain, const Progress& progress,
                const std::function<void(std::size_t begin, std::size_t end)>& work) {
  const std::size_t ranges = (count + grain - 1) / grain;
  std::mutex mutex;
  std::exception_ptr error;
  std::size_t first = ranges;
  tbb::parallel_for(std::size_t(0), ranges, [&](std::size_t range) {
    try {
      progress.check();
      work(range * grain, std::min(count, (range + 1) * grain));
    } catch (...) {
      const std::lock_guard<std::mutex> lock(mutex);
      if (range < first) {
        first = range;
        error = std::current_exception();
      }
    }
  });
  if (error) std::rethrow_exception(error);
}

}  // namespace meshcomplete
