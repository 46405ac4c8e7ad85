// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "bus/report/refusal_log.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/bus_fixture.h"

namespace inverter_bus
{
namespace bus
{
namespace
{
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

TEST(RefusalLog, tellsTheFirstOfItsKindAtOnceAndTheOthersInOneLine)
{
  RefusalLog log(2);
  for (int time = 0; time < 5000; time += 50)
  {
    log.refused(at(time), 0, ERROR_LOCKED, "line " + std::to_string(time));
    EXPECT_THAT(log.takeLines(at(time)), SizeIs(time == 0 ? 1U : 0U));
  }
  EXPECT_THAT(log.takeLines(at(5000)), ElementsAre("line 4950 (the last of 99 since the previous line)"));
  EXPECT_THAT(log.takeLines(at(20000)), IsEmpty());
}

TEST(RefusalLog, aStreamIsToldOnceInFiveSeconds)
{
  RefusalLog log(1);
  std::size_t lines = 0;
  for (int time = 0; time < 60000; time += 10)
  {
    log.refused(at(time), 0, ERROR_OUT_OF_RANGE, "too fast");
    lines += log.takeLines(at(time)).size();
  }
  EXPECT_EQ(lines, 12U);
}

TEST(RefusalLog, whatWasSilentForLongIsNewAgain)
{
  RefusalLog log(1);
  log.refused(at(0), 0, ERROR_LOCKED, "locked");
  EXPECT_THAT(log.takeLines(at(5000)), ElementsAre("locked"));
  log.refused(at(6000), 0, ERROR_LOCKED, "locked");
  EXPECT_THAT(log.takeLines(at(6000)), ElementsAre("locked"));
}

TEST(RefusalLog, invertersAndReasonsAreToldApart)
{
  RefusalLog log(2);
  log.refused(at(0), 0, ERROR_LOCKED, "a locked");
  log.refused(at(0), 1, ERROR_LOCKED, "b locked");
  log.refused(at(0), 0, ERROR_OUT_OF_RANGE, "a too fast");
  log.refused(at(0), std::nullopt, ERROR_OUT_OF_RANGE, "who is c");
  EXPECT_THAT(log.takeLines(at(0)), ElementsAre("a locked", "b locked", "a too fast", "who is c"));
}

TEST(RefusalLog, theWatchdogsReasonCountsWhatWasRefusedSinceTheLastAcceptedCommand)
{
  RefusalLog log(2);
  EXPECT_EQ(log.watchdogReason(0, 0.5), "no command for 0.5 s (command_timeout)");
  log.notCommanded(0, "old");
  log.accepted(0);
  EXPECT_EQ(log.watchdogReason(0, 0.25), "no command for 0.25 s (command_timeout)");
  log.notCommanded(0, "too fast");
  EXPECT_EQ(log.watchdogReason(0, 0.5), "1 command came in 0.5 s (command_timeout) and was refused: too fast");
  log.notCommanded(0, "much too fast");
  EXPECT_EQ(log.watchdogReason(0, 0.5),
            "2 commands came in 0.5 s (command_timeout) and all were refused, the last: much too fast");
  EXPECT_EQ(log.watchdogReason(1, 0.5), "no command for 0.5 s (command_timeout)");
}

TEST(RefusedVelocity, namesTheValueOnce)
{
  EXPECT_EQ(refusedVelocity(0.3, ERROR_LOCKED, "locked"), "velocity 0.3: locked");
  EXPECT_EQ(refusedVelocity(9.0, ERROR_OUT_OF_RANGE, "velocity 9 is out of range"), "velocity 9 is out of range");
}
}  // namespace
}  // namespace bus
}  // namespace inverter_bus
