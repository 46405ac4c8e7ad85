// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
// What the line has counted, as the others see it.

#include "bus/report/line_watch.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/bus_fixture.h"

namespace inverter_bus
{
namespace bus
{
namespace
{
using testing::HasSubstr;

wire::LineCounters withForeign(std::uint64_t frames)
{
  wire::LineCounters counters;
  counters.foreign_frames = frames;
  return counters;
}

TEST(LineWatch, keepsWhatWasNotedLast)
{
  LineWatch watch;
  EXPECT_FALSE(watch.echoFound());
  watch.note(at(0), withForeign(3), true, "unit 0 for all");
  EXPECT_TRUE(watch.echoFound());
  EXPECT_EQ(watch.counters().foreign_frames, 3U);
  EXPECT_EQ(watch.gatewayQuirk(), "unit 0 for all");
}

TEST(LineWatch, aForeignFrameIsShownForAMinute)
{
  LineWatch watch;
  EXPECT_FALSE(watch.foreignFinding(at(0), false));
  watch.note(at(1000), withForeign(1), false, "");
  watch.note(at(30000), withForeign(1), false, "");
  ASSERT_TRUE(watch.foreignFinding(at(60999), false));
  EXPECT_THAT(watch.foreignFinding(at(60999), false)->text, HasSubstr("a second master (1 so far)"));
  EXPECT_FALSE(watch.foreignFinding(at(61000), false));
}

TEST(LineWatch, behindAGatewayItIsAnotherClient)
{
  LineWatch watch;
  watch.note(at(0), withForeign(2), false, "");
  EXPECT_THAT(watch.foreignFinding(at(1), true)->text, HasSubstr("another client of the gateway"));
}
}  // namespace
}  // namespace bus
}  // namespace inverter_bus
