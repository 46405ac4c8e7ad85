// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
// Which reads make a status, and how long their values count (contract, section 2 and rule 3.10).

#include "bus/inverter/refresh.h"

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/bus_fixture.h"

namespace inverter_bus
{
namespace bus
{
namespace
{
using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::Ge;
using testing::Le;
using testing::Not;

using Frames = std::vector<std::string>;

// Requests of an MX2 at station 1.
const std::string COILS = "01 01 00 00 00 18";
const std::string REGISTERS = "01 03 10 00 00 04";
const std::string FREQUENCY = "01 03 10 00 00 02";
const std::string CURRENT_AND_DIRECTION = "01 03 10 02 00 02";
const std::string WARNING = "01 03 00 4D 00 01";
const std::string TORQUE_TO_TEMPERATURE = "01 03 10 0F 00 0A";
const std::string TORQUE_AND_VOLTAGE = "01 03 10 0F 00 02";
const std::string TEMPERATURE = "01 03 10 18 00 01";
const std::string DC_VOLTAGE = "01 03 10 25 00 01";
const std::string FAULT = "01 03 00 11 00 01";

/// RUN, operation, ready, running and at_speed on.
const std::string RUNNING_COILS = "01 03 01 40 0D";
/// The alarm coil alone.
const std::string TRIPPED_COILS = "01 03 00 00 80";

class Mx2Refresh : public testing::Test
{
protected:
  /// The next read, answered 10 ms later as laid down. Returns the request.
  std::string exchange()
  {
    const std::string request = printed(mx2_.read(1, refresh_.next(at(time_), leave_)));
    const int sent_at = time_;
    time_ += 10;
    const auto refusal = refused_.find(request);
    if (refusal != refused_.end())
    {
      more_ = refresh_.refused(exception(refusal->second == 1 ? 0x81 : 0x83, 0x02, at(time_)));
      return request;
    }
    EXPECT_EQ(answers_.count(request), 1U) << request;
    more_ = refresh_.received(reply(answers_[request], at(time_), at(sent_at)));
    return request;
  }

  /// One refresh; begins \p pause ms after the one before.
  Frames refresh(int pause = 0)
  {
    time_ += pause;
    Frames frames;
    do
    {
      frames.push_back(exchange());
    } while (more_ && frames.size() < 30);
    return frames;
  }

  drive::Monitor monitor() const
  {
    return refresh_.monitor(at(time_));
  }

  const drive::Drive mx2_ = shipped("omron_mx2");
  Refresh refresh_{ mx2_ };
  SlowLeave leave_;
  int time_ = 0;
  bool more_ = false;
  /// Replies by request.
  std::map<std::string, std::string> answers_{
    { COILS, RUNNING_COILS },
    { REGISTERS, "03 08 00 00 13 88 00 EA 00 01" },
    { FREQUENCY, "03 04 00 00 13 88" },
    { CURRENT_AND_DIRECTION, "03 04 00 EA 00 01" },
    { WARNING, "03 02 00 00" },
    { TORQUE_TO_TEMPERATURE, "03 14 FF FB 07 D5 00 00 00 00 00 00 00 00 00 00 00 00 00 00 01 59" },
    { TORQUE_AND_VOLTAGE, "03 04 FF FB 07 D5" },
    { TEMPERATURE, "03 02 01 59" },
    { DC_VOLTAGE, "03 02 0D 02" },
    { FAULT, "03 02 00 0C" },
    { "01 01 00 00 00 01", "01 01 01" },
    { "01 01 00 0E 00 0A", "01 02 35 00" },
  };
  /// Requests that the drive refuses, with their function code.
  std::map<std::string, int> refused_;
};

TEST_F(Mx2Refresh, wordsThatHaveBecomeOldBeforeTheLastOneCameAreReadAgainOnce)
{
  refresh();
  EXPECT_TRUE(refresh_.takeComplete());
  leave_.open = false;
  EXPECT_EQ(exchange(), COILS);
  refresh_.draft().lost();
  time_ += 600;
  EXPECT_EQ(exchange(), REGISTERS);
  EXPECT_TRUE(more_);
  EXPECT_FALSE(refresh_.takeComplete());
  EXPECT_EQ(exchange(), COILS);
  refresh_.draft().lost();
  time_ += 600;
  EXPECT_EQ(exchange(), REGISTERS);
  EXPECT_FALSE(more_) << "on the slowest lines that is how long it takes";
  EXPECT_TRUE(refresh_.takeComplete());
}

TEST_F(Mx2Refresh, wordsThatCameSlowlyButWithoutALossAreAStatus)
{
  refresh();
  EXPECT_TRUE(refresh_.takeComplete());
  leave_.open = false;
  EXPECT_EQ(exchange(), COILS);
  time_ += 600;
  EXPECT_EQ(exchange(), REGISTERS);
  EXPECT_FALSE(more_);
  EXPECT_TRUE(refresh_.takeComplete());
}

// --- reads -----------------------------------------------------------------------------------------------------------

TEST_F(Mx2Refresh, firstRefreshIsTwoFastExchanges)
{
  EXPECT_THAT(refresh(), ElementsAre(COILS, REGISTERS));
}

TEST_F(Mx2Refresh, eachLaterRefreshBringsAtMostOneSlowRead)
{
  refresh();
  EXPECT_THAT(refresh(), ElementsAre(WARNING, COILS, REGISTERS));
  EXPECT_THAT(refresh(), ElementsAre(TORQUE_TO_TEMPERATURE, COILS, REGISTERS));
  EXPECT_THAT(refresh(), ElementsAre(DC_VOLTAGE, COILS, REGISTERS));
  EXPECT_THAT(refresh(), ElementsAre(COILS, REGISTERS));
}

TEST_F(Mx2Refresh, slowReadsComeOnceInTheirPeriod)
{
  leave_.period = Ms(2000);
  std::map<std::string, int> counts;
  while (time_ < 20000)
  {
    for (const std::string& frame : refresh(20))
    {
      ++counts[frame];
    }
  }
  for (const std::string& slow : { WARNING, TORQUE_TO_TEMPERATURE, DC_VOLTAGE })
  {
    EXPECT_THAT(counts[slow], AllOf(Ge(9), Le(10))) << slow;
  }
}

TEST_F(Mx2Refresh, slowReadsWaitForTheirShareOfTheWire)
{
  leave_.open = false;
  for (int count = 0; count < 10; ++count)
  {
    EXPECT_THAT(refresh(500), ElementsAre(COILS, REGISTERS));
  }
  leave_.open = true;
  EXPECT_THAT(refresh(), ElementsAre(WARNING, COILS, REGISTERS));
}

TEST_F(Mx2Refresh, slowReadsNeverComeWithoutAPeriod)
{
  leave_.period = Duration{ 0 };
  for (int count = 0; count < 10; ++count)
  {
    EXPECT_THAT(refresh(500), ElementsAre(COILS, REGISTERS));
  }
}

TEST_F(Mx2Refresh, slowValuesAreNeverMissingWhileTheirPeriodIsShort)
{
  while (time_ < 1000)
  {
    refresh(20);
  }
  while (time_ < 20000)
  {
    refresh(20);
    const drive::Monitor shown = monitor();
    ASSERT_TRUE(shown.torque && shown.output_voltage && shown.temperature && shown.dc_voltage && shown.warning_code);
  }
}

TEST_F(Mx2Refresh, slowReadsTakeTurnsWhenTheCycleIsSlow)
{
  refresh();
  EXPECT_THAT(refresh(2000), Contains(WARNING));
  EXPECT_THAT(refresh(2000), Contains(TORQUE_TO_TEMPERATURE));
  EXPECT_THAT(refresh(2000), Contains(DC_VOLTAGE));
  EXPECT_THAT(refresh(2000), Contains(WARNING));
}

TEST_F(Mx2Refresh, warningWordIsReadNextWhenATripComesOrGoes)
{
  leave_.period = Ms(60000);
  for (int count = 0; count < 5; ++count)
  {
    refresh();
  }
  ASSERT_THAT(refresh(), ElementsAre(COILS, REGISTERS));
  answers_[COILS] = TRIPPED_COILS;
  refresh();
  EXPECT_TRUE(refresh_.asksForWarning(at(time_)));
  leave_.open = false;
  EXPECT_THAT(refresh(), ElementsAre(COILS, REGISTERS, FAULT)) << "within the share";
  leave_.open = true;
  EXPECT_THAT(refresh(), ElementsAre(WARNING, COILS, REGISTERS, FAULT));
  EXPECT_FALSE(refresh_.asksForWarning(at(time_)));
  EXPECT_THAT(refresh(), ElementsAre(COILS, REGISTERS, FAULT));
  answers_[COILS] = RUNNING_COILS;
  refresh();
  EXPECT_THAT(refresh(), ElementsAre(WARNING, COILS, REGISTERS));
}

// --- values ----------------------------------------------------------------------------------------------------------

TEST_F(Mx2Refresh, statusHasWhatTheDriveSays)
{
  refresh();
  const drive::Monitor shown = monitor();
  EXPECT_EQ(shown.run_seen, true);
  EXPECT_EQ(shown.operation, true);
  EXPECT_EQ(shown.running, true);
  EXPECT_EQ(shown.faulted, false);
  EXPECT_EQ(shown.direction, 1);
  EXPECT_DOUBLE_EQ(shown.output_frequency.value(), 50.0);
  EXPECT_DOUBLE_EQ(shown.output_current.value(), 2.34);
}

TEST_F(Mx2Refresh, whatWasNotReadYetIsNotKnown)
{
  refresh();
  const drive::Monitor shown = monitor();
  EXPECT_FALSE(shown.output_voltage);
  EXPECT_FALSE(shown.dc_voltage);
  EXPECT_FALSE(shown.torque);
}

TEST_F(Mx2Refresh, slowValuesLeaveTheStatusAfterTenSecondsOrTwoAndAHalfPeriods)
{
  refresh();
  refresh();
  ASSERT_THAT(refresh(), Contains(TORQUE_TO_TEMPERATURE));
  const int read_at = time_ - 20;
  EXPECT_DOUBLE_EQ(refresh_.monitor(at(read_at + 10000)).output_voltage.value(), 200.5);
  EXPECT_DOUBLE_EQ(refresh_.monitor(at(read_at + 10000)).torque.value(), -5.0);
  EXPECT_DOUBLE_EQ(refresh_.monitor(at(read_at + 10000)).temperature.value(), 34.5);
  EXPECT_FALSE(refresh_.monitor(at(read_at + 10001)).output_voltage);
  EXPECT_FALSE(refresh_.monitor(at(read_at + 10001)).torque);
  EXPECT_FALSE(refresh_.monitor(at(read_at + 10001)).temperature);
  leave_.period = Ms(6000);
  refresh();
  EXPECT_TRUE(refresh_.monitor(at(read_at + 15000)).torque);
  EXPECT_FALSE(refresh_.monitor(at(read_at + 15001)).torque);
}

TEST_F(Mx2Refresh, stampIsTheArrivalOfTheLastFastReply)
{
  EXPECT_FALSE(refresh_.stamp());
  time_ = 500;
  refresh();
  EXPECT_EQ(refresh_.stamp(), at(520));
}

TEST_F(Mx2Refresh, runWordsAreAsOldAsTheirRequest)
{
  refresh();
  time_ = 500;
  refresh();
  // The warning goes before the coils.
  EXPECT_EQ(refresh_.fresh().sent_at, at(510));
}

TEST_F(Mx2Refresh, isCompleteOnceAfterTheLastRead)
{
  exchange();
  EXPECT_FALSE(refresh_.takeComplete());
  exchange();
  EXPECT_TRUE(refresh_.takeComplete());
  EXPECT_FALSE(refresh_.takeComplete());
}

TEST_F(Mx2Refresh, halfARefreshChangesNothingThatIsShown)
{
  refresh();
  answers_[COILS] = TRIPPED_COILS;
  while (exchange() != COILS)
  {
  }
  EXPECT_EQ(monitor().faulted, false);
  EXPECT_EQ(monitor().run_seen, true);
}

TEST_F(Mx2Refresh, failedRefreshHasNoResultAndTheNextOneBeginsAnew)
{
  refresh();
  refresh_.takeComplete();
  answers_[COILS] = TRIPPED_COILS;
  while (exchange() != COILS)
  {
  }
  refresh_.failed();
  EXPECT_FALSE(refresh_.takeComplete());
  EXPECT_EQ(monitor().faulted, false);
  answers_[COILS] = RUNNING_COILS;
  EXPECT_THAT(refresh(), AllOf(Contains(COILS), Contains(REGISTERS)));
  EXPECT_EQ(monitor().faulted, false);
}

TEST_F(Mx2Refresh, nothingCountsAnyMoreOnceTheInverterIsOffline)
{
  for (int count = 0; count < 5; ++count)
  {
    refresh();
  }
  ASSERT_TRUE(monitor().output_voltage);
  refresh_.forget();
  const drive::Monitor shown = monitor();
  EXPECT_FALSE(shown.run_seen);
  EXPECT_FALSE(shown.output_frequency);
  EXPECT_FALSE(shown.output_voltage);
  EXPECT_FALSE(shown.dc_voltage);
  EXPECT_FALSE(refresh_.takeComplete());
}

// --- trips -----------------------------------------------------------------------------------------------------------

TEST_F(Mx2Refresh, faultIsNotReadWhileTheDriveIsHealthy)
{
  for (int count = 0; count < 50; ++count)
  {
    EXPECT_THAT(refresh(20), Not(Contains(FAULT)));
  }
  EXPECT_EQ(monitor().fault_code, 0);
}

TEST_F(Mx2Refresh, reasonOfATripIsReadInTheFirstRefreshThatShowsIt)
{
  refresh();
  refresh_.takeComplete();
  answers_[COILS] = TRIPPED_COILS;
  const Frames frames = refresh();
  EXPECT_EQ(frames.back(), FAULT);
  EXPECT_TRUE(refresh_.takeComplete());
  EXPECT_EQ(refresh_.fresh().monitor.faulted, true);
  EXPECT_EQ(refresh_.fresh().monitor.fault_code, 12);
  EXPECT_EQ(monitor().fault_code, 12);
}

TEST_F(Mx2Refresh, faultReadDoesNotMoveTheStampOfTheRunWords)
{
  answers_[COILS] = TRIPPED_COILS;
  EXPECT_THAT(refresh(), ElementsAre(COILS, REGISTERS, FAULT));
  EXPECT_EQ(refresh_.stamp(), at(20));
}

TEST_F(Mx2Refresh, reasonIsGoneWithTheTrip)
{
  answers_[COILS] = TRIPPED_COILS;
  refresh();
  ASSERT_EQ(monitor().fault_code, 12);
  answers_[COILS] = RUNNING_COILS;
  EXPECT_THAT(refresh(), Not(Contains(FAULT)));
  EXPECT_EQ(monitor().fault_code, 0);
}

TEST_F(Mx2Refresh, tripWhoseReasonIsRefusedIsATripAllTheSame)
{
  answers_[COILS] = TRIPPED_COILS;
  refused_[FAULT] = 3;
  EXPECT_THAT(refresh(), ElementsAre(COILS, REGISTERS, FAULT));
  EXPECT_TRUE(refresh_.takeComplete());
  EXPECT_EQ(monitor().faulted, true);
  EXPECT_FALSE(monitor().fault_code);
}

// --- refused reads ---------------------------------------------------------------------------------------------------

TEST_F(Mx2Refresh, refusedBlockIsReadInPieces)
{
  refused_[REGISTERS] = 3;
  EXPECT_THAT(refresh(), AllOf(Contains(FREQUENCY), Contains(CURRENT_AND_DIRECTION)));
  EXPECT_TRUE(refresh_.takeComplete());
  EXPECT_THAT(refresh(),
              AllOf(Contains(COILS), Contains(FREQUENCY), Contains(CURRENT_AND_DIRECTION), Not(Contains(REGISTERS))));
  EXPECT_DOUBLE_EQ(monitor().output_frequency.value(), 50.0);
  EXPECT_DOUBLE_EQ(monitor().output_current.value(), 2.34);
}

TEST_F(Mx2Refresh, refusedSingleValueIsLeftOutForHalfAMinute)
{
  refused_ = { { REGISTERS, 3 }, { FREQUENCY, 3 } };
  refresh();
  EXPECT_FALSE(monitor().output_frequency);
  EXPECT_DOUBLE_EQ(monitor().output_current.value(), 2.34);
  while (time_ < 29000)
  {
    EXPECT_THAT(refresh(200), Not(Contains(FREQUENCY)));
  }
  refused_.clear();
  time_ = 31000;
  EXPECT_THAT(refresh(), Contains(FREQUENCY));
  EXPECT_DOUBLE_EQ(monitor().output_frequency.value(), 50.0);
}

TEST_F(Mx2Refresh, readAcrossAHoleIsCutForGood)
{
  refused_[TORQUE_TO_TEMPERATURE] = 3;
  for (int count = 0; count < 8; ++count)
  {
    refresh();
  }
  refresh_.forget();
  Frames all;
  for (int count = 0; count < 8; ++count)
  {
    const Frames frames = refresh();
    all.insert(all.end(), frames.begin(), frames.end());
  }
  EXPECT_THAT(all, AllOf(Contains(TORQUE_AND_VOLTAGE), Contains(TEMPERATURE), Not(Contains(TORQUE_TO_TEMPERATURE))));
}

TEST_F(Mx2Refresh, refusedSlowBlockIsCutAtItsWidestGap)
{
  refused_[TORQUE_TO_TEMPERATURE] = 3;
  Frames all;
  for (int count = 0; count < 8; ++count)
  {
    const Frames frames = refresh();
    all.insert(all.end(), frames.begin(), frames.end());
  }
  EXPECT_THAT(all, AllOf(Contains(TORQUE_AND_VOLTAGE), Contains(TEMPERATURE)));
  EXPECT_EQ(std::count(all.begin(), all.end(), TORQUE_TO_TEMPERATURE), 1);
  EXPECT_DOUBLE_EQ(monitor().output_voltage.value(), 200.5);
  EXPECT_DOUBLE_EQ(monitor().temperature.value(), 34.5);
}

TEST_F(Mx2Refresh, refusedSlowValueIsLeftOutAndTheOthersGoOn)
{
  refused_[DC_VOLTAGE] = 3;
  int asked = 0;
  while (time_ < 20000)
  {
    const Frames frames = refresh(50);
    asked += static_cast<int>(std::count(frames.begin(), frames.end(), DC_VOLTAGE));
  }
  EXPECT_EQ(asked, 1);
  EXPECT_FALSE(monitor().dc_voltage);
  EXPECT_TRUE(monitor().output_voltage);
}

TEST_F(Mx2Refresh, refusedCoilsAreReadWithoutThePackedWord)
{
  refused_[COILS] = 1;
  EXPECT_THAT(refresh(), ElementsAre(COILS, "01 01 00 00 00 01", "01 01 00 0E 00 0A", REGISTERS));
  const drive::Monitor shown = monitor();
  EXPECT_EQ(shown.run_seen, true);
  EXPECT_EQ(shown.operation, true);
  EXPECT_EQ(shown.running, true);
  EXPECT_EQ(shown.faulted, false);
  EXPECT_FALSE(shown.raw_status);
}

TEST_F(Mx2Refresh, driveThatRefusesEverythingIsStillAskedForSomething)
{
  refused_ = { { COILS, 1 },
               { REGISTERS, 3 },
               { FREQUENCY, 3 },
               { CURRENT_AND_DIRECTION, 3 },
               { "01 01 00 00 00 01", 1 },
               { "01 01 00 0E 00 0A", 1 } };
  answers_.clear();
  for (int count = 0; count < 50; ++count)
  {
    const std::string request = printed(mx2_.read(1, refresh_.next(at(time_))));
    ASSERT_THAT(request, testing::StartsWith("01 0"));
    time_ += 10;
    refresh_.refused(exception(request[4] == '1' ? 0x81 : 0x83, 0x02, at(time_)));
  }
  EXPECT_FALSE(monitor().output_frequency);
}
}  // namespace
}  // namespace bus
}  // namespace inverter_bus
