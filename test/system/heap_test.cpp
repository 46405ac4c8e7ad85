// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

// The heap of a driver that runs for long does not grow. benchmark/heap_benchmark plays a whole day of the same story.

#include <gtest/gtest.h>

#include "support/heap_story.h"

namespace inverter_bus
{
namespace heap
{
namespace
{
constexpr double WARM_UP_S = 600.0;
constexpr double PART_S = 400.0;
// A sanitizer's build takes twenty times as long, and is not there to count.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr int PARTS = 1;
#else
constexpr int PARTS = 3;
#endif
/// Buffers may still reach the size of their largest content.
constexpr long long BOUND = 4 * 1024;

class HeapStages : public ::testing::TestWithParam<std::size_t>
{
};

TEST_P(HeapStages, doesNotGrowHoweverLongTheBusRuns)
{
  Story story(stages()[GetParam()], INVERTER_BUS_ROOT "/config/drives", 1);
  story.play(WARM_UP_S);
  ASSERT_TRUE(story.calm());
  const Live driver = live(Owner::DRIVER);
  const Live simulation = live(Owner::SIMULATION);
  // What is counted at all: a counter that stands still shows nothing.
  ASSERT_GT(driver.bytes, 10000);
  ASSERT_GT(simulation.bytes, 10000);
  for (int part = 0; part < PARTS; ++part)
  {
    story.play(PART_S);
    EXPECT_TRUE(story.calm());
    EXPECT_LE(live(Owner::DRIVER).bytes - driver.bytes, BOUND) << "driver, part " << part;
    EXPECT_LE(live(Owner::SIMULATION).bytes - simulation.bytes, BOUND) << "simulated bus, part " << part;
  }
  // It was a story in which everything happened.
  EXPECT_GT(story.events().publishers, 200U);
  EXPECT_GT(story.events().refused, 500U);
  EXPECT_GT(story.events().faults, 100U);
  EXPECT_GT(story.events().dumps, 10U);
  EXPECT_GT(story.reconnects(), 5U);
  EXPECT_GT(story.counters().timeouts, 100U);
}

INSTANTIATE_TEST_SUITE_P(Stages, HeapStages, ::testing::Range<std::size_t>(0, stages().size()));
}  // namespace
}  // namespace heap
}  // namespace inverter_bus
