#include "common/core/progress.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <string>
#include <thread>
#include <vector>

#include "common/core/error.h"

namespace meshcomplete {
namespace {

struct Call {
  double fraction;
  std::string stage;
  std::thread::id thread;
};

Progress recording(std::vector<Call>& calls) {
  return Progress([&calls](double fraction, const std::string& stage) {
    calls.push_back({fraction, stage, std::this_thread::get_id()});
    return true;
  });
}

void wait_until_due() { std::this_thread::sleep_for(std::chrono::milliseconds(40)); }

TEST(Progress, default_object_takes_everything_and_is_never_cancelled) {
  const Progress nobody;
  nobody.update(0.5);
  nobody.advance(0.5);
  nobody.check();
  nobody.part(0, 1, "inner").update(1);
}

TEST(Progress, parts_map_to_their_range_and_carry_their_stage) {
  std::vector<Call> calls;
  const Progress root = recording(calls);
  const Progress part = root.part(0.5, 0.75, "outer").part(0.2, 0.6, "inner");
  part.update(0.5);
  ASSERT_EQ(calls.size(), 1u);
  EXPECT_DOUBLE_EQ(calls[0].fraction, 0.5 + 0.25 * 0.4);
  EXPECT_EQ(calls[0].stage, "inner");
}

TEST(Progress, fractions_never_decrease_and_are_clamped) {
  std::vector<Call> calls;
  const Progress root = recording(calls);
  for (const double fraction : {-3.0, 0.5, 0.2, 0.7, 5.0, 0.1}) {
    root.update(fraction);
    wait_until_due();
  }
  ASSERT_GE(calls.size(), 5u);
  for (std::size_t i = 1; i < calls.size(); ++i) EXPECT_GE(calls[i].fraction, calls[i - 1].fraction);
  EXPECT_EQ(calls.front().fraction, 0);
  EXPECT_EQ(calls.back().fraction, 1);
}

TEST(Progress, the_end_is_reported_without_delay) {
  std::vector<Call> calls;
  const Progress root = recording(calls);
  root.update(0);
  root.update(0.5);
  root.update(1);
  ASSERT_EQ(calls.size(), 2u);
  EXPECT_EQ(calls.back().fraction, 1);
}

TEST(Progress, receiver_is_called_about_thirty_times_a_second_at_most) {
  std::vector<Call> calls;
  const Progress root = recording(calls);
  const auto start = std::chrono::steady_clock::now();
  while (std::chrono::steady_clock::now() - start < std::chrono::milliseconds(300)) root.update(0.5);
  EXPECT_GE(calls.size(), 2u);
  EXPECT_LE(calls.size(), 11u);
}

TEST(Progress, cancelling_throws_and_the_receiver_is_left_alone_afterwards) {
  int calls = 0;
  const Progress root([&calls](double, const std::string&) {
    ++calls;
    return false;
  });
  EXPECT_THROW(root.update(0.1), Cancelled);
  EXPECT_THROW(root.check(), Cancelled);
  EXPECT_THROW(root.part(0, 1, "later").advance(0.1), Cancelled);
  EXPECT_EQ(calls, 1);
}

TEST(Progress, check_notices_cancelling_by_itself) {
  bool stop = false;
  const Progress root([&stop](double, const std::string&) { return !stop; });
  root.update(0);
  root.check();
  stop = true;
  wait_until_due();
  EXPECT_THROW(root.check(), Cancelled);
}

TEST(Progress, other_threads_are_forwarded_by_the_owner_and_cancelled_too) {
  std::vector<Call> calls;
  bool stop = false;
  const Progress root([&](double fraction, const std::string& stage) {
    calls.push_back({fraction, stage, std::this_thread::get_id()});
    return !stop;
  });
  root.update(0);
  std::thread([&root] { root.part(0, 1, "worker").update(0.6); }).join();
  EXPECT_EQ(calls.size(), 1u);
  wait_until_due();
  root.check();
  ASSERT_EQ(calls.size(), 2u);
  EXPECT_EQ(calls[1].fraction, 0.6);
  EXPECT_EQ(calls[1].stage, "worker");
  EXPECT_EQ(calls[1].thread, std::this_thread::get_id());
  stop = true;
  wait_until_due();
  EXPECT_THROW(root.check(), Cancelled);
  bool worker_cancelled = false;
  std::thread([&] {
    try {
      root.update(0.7);
    } catch (const Cancelled&) {
      worker_cancelled = true;
    }
  }).join();
  EXPECT_TRUE(worker_cancelled);
}

TEST(Progress, advance_adds_up_from_many_threads) {
  std::vector<Call> calls;
  const Progress root = recording(calls);
  const Progress part = root.part(0.0, 0.5, "sum");
  std::vector<std::thread> threads;
  for (int t = 0; t < 4; ++t) {
    threads.emplace_back([&part] {
      for (int k = 0; k < 250; ++k) part.advance(1.0 / 1024);
    });
  }
  for (std::thread& thread : threads) thread.join();
  part.advance(24.0 / 1024);
  ASSERT_FALSE(calls.empty());
  EXPECT_DOUBLE_EQ(calls.back().fraction, 0.5);
}

}  // namespace
}  // namespace meshcomplete
