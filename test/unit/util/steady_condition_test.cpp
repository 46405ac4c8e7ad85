// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "util/steady_condition.h"

#include <chrono>
#include <mutex>
#include <thread>

#include <gtest/gtest.h>

#include "util/steady_event.h"
#include "util/timespec.h"

namespace inverter_bus
{
namespace util
{
namespace
{
using std::chrono::milliseconds;
using std::chrono::steady_clock;

constexpr Duration PATIENCE = std::chrono::seconds(60);

/// Something that another thread makes true.
struct Shared
{
  std::mutex mutex;
  SteadyCondition changed;
  bool done = false;
};

void finish(Shared& shared)
{
  {
    const std::lock_guard<std::mutex> guard(shared.mutex);
    shared.done = true;
  }
  shared.changed.notifyAll();
}

TEST(SteadyConditionTest, endsWaitsOfEveryKindWhenItHappens)
{
  Shared shared;
  std::thread other([&shared] { finish(shared); });
  std::unique_lock<std::mutex> lock(shared.mutex);
  const auto done = [&shared] { return shared.done; };
  EXPECT_TRUE(shared.changed.waitFor(lock, PATIENCE, done));
  EXPECT_TRUE(shared.changed.waitUntil(lock, steady_clock::now() + PATIENCE, done));
  shared.changed.wait(lock, done);
  EXPECT_TRUE(lock.owns_lock());
  lock.unlock();
  other.join();
}

TEST(SteadyConditionTest, waitsUntilTheDeadlineAndNotLonger)
{
  Shared shared;
  std::unique_lock<std::mutex> lock(shared.mutex);
  const auto never = [] { return false; };
  const TimePoint deadline = steady_clock::now() + milliseconds(5);
  EXPECT_FALSE(shared.changed.waitUntil(lock, deadline, never));
  EXPECT_GE(steady_clock::now(), deadline);
  EXPECT_TRUE(lock.owns_lock());
}

TEST(SteadyConditionTest, whatIsPastOrNegativeDoesNotWait)
{
  Shared shared;
  std::unique_lock<std::mutex> lock(shared.mutex);
  const auto never = [] { return false; };
  EXPECT_FALSE(shared.changed.waitUntil(lock, steady_clock::now() - milliseconds(1), never));
  EXPECT_FALSE(shared.changed.waitUntil(lock, TimePoint::min(), never));
  EXPECT_FALSE(shared.changed.waitFor(lock, milliseconds(-1), never));
  EXPECT_FALSE(shared.changed.waitFor(lock, Duration::min(), never));
}

TEST(SteadyConditionTest, whatLiesBeyondTheEndOfTheClockIsWaitedForAsLongAsItTakes)
{
  Shared shared;
  std::thread other([&shared] { finish(shared); });
  std::unique_lock<std::mutex> lock(shared.mutex);
  EXPECT_TRUE(shared.changed.waitFor(lock, Duration::max(), [&shared] { return shared.done; }));
  lock.unlock();
  other.join();
}

TEST(SteadyConditionTest, aNotificationWithoutTheEventDoesNotEndAWait)
{
  Shared shared;
  std::unique_lock<std::mutex> lock(shared.mutex);
  int asked = 0;
  std::thread other([&shared] {
    // Each round gets the mutex only while the other thread waits.
    for (int round = 0; round < 3; ++round)
    {
      const std::lock_guard<std::mutex> guard(shared.mutex);
      shared.changed.notifyOne();
    }
    finish(shared);
  });
  EXPECT_TRUE(shared.changed.waitFor(lock, PATIENCE, [&] {
    ++asked;
    return shared.done;
  }));
  EXPECT_GE(asked, 2);
  lock.unlock();
  other.join();
}

TEST(SteadyEventTest, isSetOnceAndForAll)
{
  SteadyEvent event;
  EXPECT_FALSE(event.isSet());
  EXPECT_FALSE(event.waitFor(milliseconds(1)));
  EXPECT_FALSE(event.waitFor(milliseconds(-1)));
  std::thread other([&event] { event.set(); });
  EXPECT_TRUE(event.waitFor(PATIENCE));
  EXPECT_TRUE(event.isSet());
  event.set();
  EXPECT_TRUE(event.waitFor(Duration::zero()));
  other.join();
}

TEST(MonotonicTimeTest, isSplitIntoSecondsAndNanoseconds)
{
  const timespec time = monotonicTime(TimePoint(std::chrono::nanoseconds(1999999999)));
  EXPECT_EQ(1, time.tv_sec);
  EXPECT_EQ(999999999, time.tv_nsec);
  EXPECT_EQ(0, monotonicTime(TimePoint::min()).tv_sec);
  EXPECT_EQ(0, monotonicTime(TimePoint::min()).tv_nsec);
}

TEST(MonotonicTimeTest, theSteadyClockIsTheMonotonicOne)
{
  const timespec before = monotonicTime(steady_clock::now());
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  const timespec after = monotonicTime(steady_clock::now());
  const auto total = [](const timespec& time) { return time.tv_sec * 1000000000LL + time.tv_nsec; };
  EXPECT_LE(total(before), total(now));
  EXPECT_LE(total(now), total(after));
}
}  // namespace
}  // namespace util
}  // namespace inverter_bus
