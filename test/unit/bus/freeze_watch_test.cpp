// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
// Time in which the bus thread itself did not run. Times by hand.

#include "bus/link/freeze_watch.h"

#include <gtest/gtest.h>

#include "support/bus_fixture.h"

namespace inverter_bus
{
namespace bus
{
namespace
{
TEST(FreezeWatch, aThreadThatIsInTimeWasNotFrozen)
{
  FreezeWatch watch;
  EXPECT_EQ(watch.back(at(60000)), Duration::zero()) << "nobody knows when it was to be back";
  watch.backBy(at(70000));
  EXPECT_EQ(watch.back(at(69000)), Duration::zero()) << "woken before";
  EXPECT_EQ(watch.back(at(69001)), Duration::zero());
}

TEST(FreezeWatch, aSleepThatWasAskedForIsNone)
{
  FreezeWatch watch;
  watch.backBy(at(10000));
  EXPECT_EQ(watch.back(at(10100)), Duration::zero());
}

TEST(FreezeWatch, aBusyMachineIsNone)
{
  FreezeWatch watch;
  for (int round = 0; round < 10; ++round)
  {
    watch.backBy(at(1000 * round));
    EXPECT_EQ(watch.back(at(1000 * round + 500)), Duration::zero());
  }
}

TEST(FreezeWatch, countsFromWhenItWasToBeBack)
{
  FreezeWatch watch;
  watch.backBy(at(1000));
  EXPECT_EQ(watch.back(at(4500)), Ms(3500));
  EXPECT_EQ(watch.back(at(4510)), Duration::zero()) << "once";
  EXPECT_EQ(watch.back(at(9510)), Ms(5000)) << "without a wait it is expected at once";
}
}  // namespace
}  // namespace bus
}  // namespace inverter_bus
