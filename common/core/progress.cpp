#include "common/core/progress.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <mutex>
#include <thread>
#include <utility>

#include "common/core/error.h"

namespace meshcomplete {
namespace {

using Clock = std::chrono::steady_clock;

/// MeshLab redraws its window in the callback: more often than the eye can follow only costs time.
constexpr std::chrono::milliseconds least_interval{33};

/// Other threads take the lock only when there is something to see.
constexpr double least_visible_advance = 1e-3;

}  // namespace

struct Progress::Shared {
  Receiver receiver;
  std::thread::id owner = std::this_thread::get_id();
  std::atomic<bool> cancelled{false};
  std::atomic<double> seen{0};  // the greatest fraction that any thread has handed over

  std::mutex mutex;  // guards the two below
  double fraction = 0;
  std::string stage;

  // Only the owner touches these.
  Clock::time_point last_call{};
  bool called = false;
  bool finished = false;

  void hand_over(double reported, const std::string& reported_stage) {
    const std::lock_guard<std::mutex> lock(mutex);
    if (reported < fraction) return;
    fraction = reported;
    if (stage != reported_stage) stage = reported_stage;
    seen.store(fraction, std::memory_order_relaxed);
  }

  /// Calls the receiver when it is time to; `at_once` for the very end, which nobody should have to wait for.
  void call_receiver(bool at_once) {
    const Clock::time_point now = Clock::now();
    if (called && !at_once && now - last_call < least_interval) return;
    called = true;
    last_call = now;
    double current_fraction = 0;
    std::string current_stage;
    {
      const std::lock_guard<std::mutex> lock(mutex);
      current_fraction = fraction;
      current_stage = stage;
    }
    // Without the lock: the receiver may well report progress itself.
    if (!receiver(current_fraction, current_stage)) cancelled.store(true, std::memory_order_relaxed);
  }
};

struct Progress::Range {
  double from = 0;
  double to = 1;
  std::string stage;
  std::atomic<double> done{0};
};

Progress::Progress() = default;

Progress::Progress(Receiver receiver) {
  if (!receiver) return;
  shared_ = std::make_shared<Shared>();
  shared_->receiver = std::move(receiver);
  range_ = std::make_shared<Range>();
}

Progress Progress::part(double from, double to, std::string stage) const {
  Progress progress;
  if (!shared_) return progress;
  progress.shared_ = shared_;
  progress.range_ = std::make_shared<Range>();
  const double low = std::clamp(from, 0.0, 1.0);
  const double high = std::clamp(to, low, 1.0);
  progress.range_->from = range_->from + low * (range_->to - range_->from);
  progress.range_->to = range_->from + high * (range_->to - range_->from);
  progress.range_->stage = std::move(stage);
  return progress;
}

void Progress::update(double fraction) const {
  if (!shared_) return;
  if (shared_->cancelled.load(std::memory_order_relaxed)) throw Cancelled();
  const double clamped = fraction > 0 ? std::min(fraction, 1.0) : 0.0;  // not-a-number becomes 0
  const double overall = range_->from + clamped * (range_->to - range_->from);
  const double seen = shared_->seen.load(std::memory_order_relaxed);
  if (std::this_thread::get_id() != shared_->owner) {
    if (overall >= seen + least_visible_advance || overall >= 1) shared_->hand_over(overall, range_->stage);
    return;
  }
  const bool end = overall >= 1 && !shared_->finished;
  if (end) shared_->finished = true;
  const bool due = !shared_->called || Clock::now() - shared_->last_call >= least_interval;
  if (!end && !due) return;
  shared_->hand_over(overall, range_->stage);
  shared_->call_receiver(end);
  if (shared_->cancelled.load(std::memory_order_relaxed)) throw Cancelled();
}

void Progress::advance(double amount) const {
  if (!shared_) return;
  double before = range_->done.load(std::memory_order_relaxed);
  while (!range_->done.compare_exchange_weak(before, before + amount, std::memory_order_relaxed)) {
  }
  update(before + amount);
}

void Progress::check() const {
  if (!shared_) return;
  if (!shared_->cancelled.load(std::memory_order_relaxed) && std::this_thread::get_id() == shared_->owner) {
    shared_->call_receiver(false);
  }
  if (shared_->cancelled.load(std::memory_order_relaxed)) throw Cancelled();
}

}  // namespace meshcomplete
