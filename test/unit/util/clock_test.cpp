// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "inverter_bus/util/clock.h"

#include <chrono>

#include <gtest/gtest.h>

namespace inverter_bus
{
namespace util
{
namespace
{
using std::chrono::milliseconds;

TEST(SteadyClockTest, sleepsUntilThenAndNotLonger)
{
  SteadyClock clock;
  const TimePoint time = clock.now() + milliseconds(2);
  clock.sleepUntil(time);
  EXPECT_GE(clock.now(), time);
  clock.sleepUntil(time - milliseconds(1));
}
}  // namespace
}  // namespace util
}  // namespace inverter_bus
