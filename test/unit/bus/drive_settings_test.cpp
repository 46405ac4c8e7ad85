// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
// The drive's own settings that decide over safety (contract, sections 3.8, 3.12, 4.1 and 4.5).

#include "bus/inverter/drive_settings.h"

#include <cstdio>
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
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::Pair;
using testing::SizeIs;
using testing::StartsWith;
using testing::UnorderedElementsAre;

/// Requests of the parameters at station 1 and the values (raw) of a drive whose settings are all fine.
const std::map<std::string, std::string> REQUESTS{
  { "C078", "01 03 14 51 00 01" }, { "C077", "01 03 14 50 00 01" }, { "C076", "01 03 14 4F 00 01" },
  { "A001", "01 03 12 00 00 01" }, { "A002", "01 03 12 01 00 01" }, { "b001", "01 03 13 00 00 01" },
  { "b008", "01 03 13 08 00 01" },
};
const std::map<std::string, unsigned> FINE{ { "C078", 0 }, { "C077", 300 }, { "C076", 4 }, { "A001", 3 },
                                            { "A002", 3 }, { "b001", 0 },   { "b008", 0 } };

wire::Reply word(unsigned raw)
{
  char text[16];
  std::snprintf(text, sizeof(text), "03 02 %02X %02X", (raw >> 8) & 0xFF, raw & 0xFF);
  return reply(text);
}

std::string nameOf(const std::string& request)
{
  for (const auto& entry : REQUESTS)
  {
    if (entry.second == request)
    {
      return entry.first;
    }
  }
  ADD_FAILURE() << "unexpected request " << request;
  return "";
}

/// Reads everything from a drive with these settings; returns the parameters in the order of reading.
std::vector<std::string> readAll(DriveSettings& settings, std::map<std::string, unsigned> values)
{
  std::vector<std::string> names;
  while (settings.pending() && names.size() < 50)
  {
    names.push_back(nameOf(printed(settings.next())));
    settings.done(word(values[names.back()]));
  }
  return names;
}

class Mx2Settings : public testing::Test
{
protected:
  /// Findings of a drive whose settings are fine but for these.
  std::vector<std::string> findingsWith(const std::map<std::string, unsigned>& changes)
  {
    auto values = FINE;
    for (const auto& change : changes)
    {
      values[change.first] = change.second;
    }
    settings_.restart();
    readAll(settings_, values);
    std::vector<std::string> texts;
    for (const Finding& finding : settings_.findings())
    {
      EXPECT_EQ(finding.level, Level::Warn);
      texts.push_back(finding.text);
    }
    return texts;
  }

  const drive::Drive mx2_ = shipped("omron_mx2");
  DriveSettings settings_{ mx2_, 1 };
};

// --- reading ---------------------------------------------------------------------------------------------------------

TEST_F(Mx2Settings, readsEachSettingOnce)
{
  EXPECT_TRUE(settings_.pending());
  EXPECT_THAT(readAll(settings_, FINE), UnorderedElementsAre("C078", "C077", "C076", "A001", "A002", "b001", "b008"));
  EXPECT_FALSE(settings_.pending());
}

TEST_F(Mx2Settings, readsEverythingAgainAfterAReturn)
{
  readAll(settings_, FINE);
  settings_.restart();
  EXPECT_THAT(readAll(settings_, FINE), SizeIs(7));
}

TEST_F(Mx2Settings, readsASettingAgainThatWasWrittenThroughTheNode)
{
  readAll(settings_, FINE);
  settings_.reread("C077");
  EXPECT_THAT(readAll(settings_, { { "C077", 200 } }), ElementsAre("C077"));
  EXPECT_EQ(settings_.driveTimeout().value(), std::chrono::seconds(2));
}

TEST_F(Mx2Settings, parameterThatDecidesOverNothingIsNotRead)
{
  readAll(settings_, FINE);
  settings_.reread("F002");
  EXPECT_FALSE(settings_.pending());
}

TEST_F(Mx2Settings, lostReadIsAskedAgain)
{
  const std::string first = printed(settings_.next());
  settings_.done(lost());
  EXPECT_TRUE(settings_.pending());
  EXPECT_EQ(printed(settings_.next()), first);
}

TEST_F(Mx2Settings, refusedReadIsShownAndNotAskedAgain)
{
  const std::string refused = nameOf(printed(settings_.next()));
  settings_.done(exception(0x83, 0x02));
  EXPECT_THAT(readAll(settings_, FINE), AllOf(SizeIs(6), Not(Contains(refused))));
  EXPECT_THAT(settings_.values(), Contains(Pair(StartsWith(refused), HasSubstr("refuses"))));
}

TEST_F(Mx2Settings, readThatIsRefusedForTheMomentIsAskedAgainAfterTheOthersAndMoreAndMoreSeldom)
{
  const std::string refused = nameOf(printed(settings_.next()));
  settings_.done(exception(0x83, 0x04));
  EXPECT_THAT(settings_.values(), Contains(Pair(StartsWith(refused), HasSubstr("refuses"))));
  for (int other = 0; other < 6; ++other)
  {
    EXPECT_EQ(settings_.pauseBeforeNext(), Duration{ 0 });
    EXPECT_NE(nameOf(printed(settings_.next())), refused);
    settings_.done(word(100));
  }
  for (const int pause : { 1, 2, 4, 8, 16, 32, 64, 64 })
  {
    ASSERT_TRUE(settings_.pending());
    EXPECT_EQ(settings_.pauseBeforeNext(), std::chrono::seconds(pause));
    EXPECT_EQ(nameOf(printed(settings_.next())), refused);
    settings_.done(exception(0x83, 0x04));
  }
  settings_.done(word(100));
  EXPECT_FALSE(settings_.pending());
  EXPECT_EQ(settings_.pauseBeforeNext(), Duration{ 0 });
}

TEST_F(Mx2Settings, nothingIsClaimedBeforeItIsRead)
{
  EXPECT_THAT(settings_.findings(), IsEmpty());
  EXPECT_FALSE(settings_.driveTimeout());
  EXPECT_THAT(settings_.values(), Contains(Pair(StartsWith("C077"), HasSubstr("not read yet"))));
}

TEST_F(Mx2Settings, valuesAreShownWithTheirUnits)
{
  readAll(settings_, FINE);
  EXPECT_THAT(settings_.values(), Contains(Pair(StartsWith("C077"), "3 s")));
  EXPECT_THAT(settings_.values(), Contains(Pair(StartsWith("C078"), "0 ms")));
  EXPECT_THAT(settings_.values(), Contains(Pair(StartsWith("A001"), "3")));
}

// --- findings --------------------------------------------------------------------------------------------------------

TEST_F(Mx2Settings, fineSettingsGiveNoFinding)
{
  EXPECT_THAT(findingsWith({}), IsEmpty());
}

TEST_F(Mx2Settings, warnsWhenTheDrivesOwnTimeOutIsOff)
{
  EXPECT_THAT(findingsWith({ { "C077", 0 } }), ElementsAre(AllOf(HasSubstr("runs on when communication is lost"),
                                                                 HasSubstr("C077 = 0"), HasSubstr("set C077"))));
}

TEST_F(Mx2Settings, warnsWhenTheDriveIgnoresItsTimeOut)
{
  EXPECT_THAT(findingsWith({ { "C076", 2 } }),
              ElementsAre(AllOf(HasSubstr("runs on when communication is lost"), HasSubstr("C076 = 2"))));
}

TEST_F(Mx2Settings, factorySettingsOfTheTimeOutGiveOneWarningThatNamesBoth)
{
  EXPECT_THAT(findingsWith({ { "C077", 0 }, { "C076", 2 } }),
              ElementsAre(AllOf(HasSubstr("C077 = 0"), HasSubstr("C076 = 2"))));
}

TEST_F(Mx2Settings, everyReactionButIgnoreIsFine)
{
  for (const unsigned action : { 0U, 1U, 3U, 4U })
  {
    EXPECT_THAT(findingsWith({ { "C076", action } }), IsEmpty()) << action;
  }
}

TEST_F(Mx2Settings, warnsWhenTheFrequencyDoesNotComeFromTheBus)
{
  EXPECT_THAT(findingsWith({ { "A001", 2 } }), ElementsAre(AllOf(HasSubstr("not commanded by the bus"),
                                                                 HasSubstr("A001 = 2"), HasSubstr("set A001 = 3"))));
}

TEST_F(Mx2Settings, warnsWhenRunDoesNotComeFromTheBus)
{
  EXPECT_THAT(findingsWith({ { "A002", 1 } }), ElementsAre(AllOf(HasSubstr("not commanded by the bus"),
                                                                 HasSubstr("A002 = 1"), HasSubstr("set A002 = 3"))));
}

TEST_F(Mx2Settings, warnsWhenTheDriveRestartsAfterAPowerFailure)
{
  EXPECT_THAT(findingsWith({ { "b001", 1 } }),
              ElementsAre(AllOf(HasSubstr("may restart by itself"), HasSubstr("b001 = 1"), HasSubstr("set b001 = 0"))));
}

TEST_F(Mx2Settings, warnsWhenTheDriveRestartsAfterATrip)
{
  EXPECT_THAT(findingsWith({ { "b008", 3 } }),
              ElementsAre(AllOf(HasSubstr("may restart by itself"), HasSubstr("b008 = 3"), HasSubstr("set b008 = 0"))));
}

TEST_F(Mx2Settings, everyWrongSettingHasItsFinding)
{
  EXPECT_THAT(findingsWith({ { "A001", 1 }, { "A002", 2 }, { "b001", 2 }, { "b008", 1 }, { "C077", 0 } }), SizeIs(5));
}

// --- times -----------------------------------------------------------------------------------------------------------

TEST_F(Mx2Settings, driveTimeoutIsC077InHundredthsOfASecond)
{
  readAll(settings_, FINE);
  EXPECT_EQ(settings_.driveTimeout().value(), std::chrono::seconds(3));
  settings_.reread("C077");
  readAll(settings_, { { "C077", 50 } });
  EXPECT_EQ(settings_.driveTimeout().value(), Ms(500));
}

TEST_F(Mx2Settings, timeOutThatIsOffIsNone)
{
  findingsWith({ { "C077", 0 } });
  EXPECT_FALSE(settings_.driveTimeout());
}

TEST_F(Mx2Settings, replyDelayIsTheProfilesUntilC078IsRead)
{
  EXPECT_EQ(settings_.replyDelay(), Ms(5));
}

TEST_F(Mx2Settings, replyDelayContainsC078InMilliseconds)
{
  findingsWith({ { "C078", 20 } });
  EXPECT_EQ(settings_.replyDelay(), Ms(25));
}

// --- RX: C076 to C078 are printed for the MX2 only -------------------------------------------------------------------

TEST(RxSettings, doesNotReadUnconfirmedParameters)
{
  const drive::Drive rx = shipped("omron_rx");
  DriveSettings settings(rx, 1);
  EXPECT_THAT(readAll(settings, FINE), UnorderedElementsAre("A001", "A002", "b001", "b008"));
}

TEST(RxSettings, assumesThatTheDriveRunsOnAndSaysThatItIsAssumed)
{
  const drive::Drive rx = shipped("omron_rx");
  DriveSettings settings(rx, 1);
  readAll(settings, FINE);
  ASSERT_THAT(settings.findings(), SizeIs(1));
  EXPECT_THAT(settings.findings().front().text, AllOf(HasSubstr("runs on"), HasSubstr("assumed")));
  EXPECT_FALSE(settings.driveTimeout());
  EXPECT_THAT(settings.values(), Contains(Pair(testing::_, HasSubstr("assumed"))));
}

TEST(RxSettings, readsThemOnceTheyAreConfirmed)
{
  drive::ProfileChanges changes;
  changes.confirm = { "parameter_C076", "parameter_C077", "parameter_C078" };
  const drive::Drive rx = shipped("omron_rx", changes);
  DriveSettings settings(rx, 1);
  EXPECT_THAT(readAll(settings, FINE), SizeIs(7));
  EXPECT_THAT(settings.findings(), IsEmpty());
  EXPECT_EQ(settings.driveTimeout().value(), std::chrono::seconds(3));
}

TEST(DriveSettings, assumedTimeOutCountsWhereNoneCanBeRead)
{
  drive::Profile profile = drive::loadProfile("omron_mx2", drive::profileDirectory());
  profile.communication_loss = drive::CommunicationLoss();
  profile.communication_loss.assumed_timeout = 1.0;
  profile.communication_loss.assumed_action = "decelerate";
  const drive::Drive drive(profile);
  DriveSettings settings(drive, 1);
  EXPECT_EQ(settings.driveTimeout().value(), std::chrono::seconds(1));
  EXPECT_THAT(settings.findings(), IsEmpty());
  EXPECT_THAT(settings.values(), Contains(Pair(testing::_, AllOf(HasSubstr("assumed"), HasSubstr("1 s")))));
}
}  // namespace
}  // namespace bus
}  // namespace inverter_bus
