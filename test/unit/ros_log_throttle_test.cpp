// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "inverter_bus/ros/log_throttle.h"

#include <chrono>
#include <string>

#include <gtest/gtest.h>

namespace inverter_bus
{
namespace ros_node
{
namespace
{
using std::chrono::milliseconds;

TEST(LogThrottleTest, theSameTextComesOnceInFiveSeconds)
{
  LogThrottle throttle;
  const TimePoint start;
  EXPECT_TRUE(throttle.admit("a", start));
  EXPECT_FALSE(throttle.admit("a", start + milliseconds(4999)));
  EXPECT_TRUE(throttle.admit("b", start + milliseconds(4999)));
  EXPECT_TRUE(throttle.admit("a", start + milliseconds(5000)));
}

TEST(LogThrottleTest, whatIsKeptBackIsCounted)
{
  LogThrottle throttle;
  const TimePoint start;
  throttle.admit("a", start);
  throttle.admit("a", start);
  throttle.admit("a", start);
  EXPECT_EQ(2U, throttle.takeSuppressed());
  EXPECT_EQ(0U, throttle.takeSuppressed());
}

TEST(LogThrottleTest, textsThatAllDifferCannotFloodEither)
{
  LogThrottle throttle;
  int admitted = 0;
  for (int i = 0; i < 1000; ++i)
  {
    admitted += throttle.admit(std::to_string(i), TimePoint() + milliseconds(i)) ? 1 : 0;
  }
  EXPECT_EQ(50, admitted);
}
}  // namespace
}  // namespace ros_node
}  // namespace inverter_bus
