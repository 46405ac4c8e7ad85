// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
// What a drive's settings mean for the bus (contract, 3.8, 3.10 and 3.12).

#include "bus/inverter/setting_facts.h"

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

/// Answers every question with \p raw, but \p name with \p its_raw.
void readAll(SettingList& settings, const std::string& name, unsigned its_raw, unsigned raw = 0)
{
  while (const Setting* next = settings.next())
  {
    const unsigned value = next->parameter.name == name ? its_raw : raw;
    wire::Reply answer = reply("03 02");
    answer.pdu.push_back(static_cast<std::uint8_t>(value >> 8));
    answer.pdu.push_back(static_cast<std::uint8_t>(value & 0xFF));
    settings.done(answer);
  }
}

TEST(SettingFacts, driveTimeoutIsTheSettingsAndOffIsNone)
{
  const drive::Drive mx2 = shipped("omron_mx2");
  SettingList settings(mx2);
  EXPECT_FALSE(driveTimeoutOf(mx2, settings));
  readAll(settings, "C077", 250);
  EXPECT_EQ(driveTimeoutOf(mx2, settings), Ms(2500));
  settings.reread("C077");
  readAll(settings, "C077", 0);
  EXPECT_FALSE(driveTimeoutOf(mx2, settings));
}

TEST(SettingFacts, assumedTimeoutCountsUntilTheSettingIsRead)
{
  drive::Profile profile = drive::loadProfile("omron_mx2", drive::profileDirectory());
  profile.communication_loss.assumed_timeout = 1.5;
  const drive::Drive drive(profile);
  SettingList settings(drive);
  EXPECT_EQ(driveTimeoutOf(drive, settings), Ms(1500));
  readAll(settings, "C077", 100);
  EXPECT_EQ(driveTimeoutOf(drive, settings), Ms(1000));
}

TEST(SettingFacts, replyDelayIsTheProfilesAndTheSettingsTogether)
{
  const drive::Drive mx2 = shipped("omron_mx2");
  SettingList settings(mx2);
  EXPECT_EQ(replyDelayOf(mx2, settings), Ms(5));
  readAll(settings, "C078", 40);
  EXPECT_EQ(replyDelayOf(mx2, settings), Ms(45));
}

TEST(SettingFacts, blockSlotsAreNoneBeforeAllAreRead)
{
  const drive::Drive vfs15 = shipped("toshiba_vfs15");
  SettingList settings(vfs15);
  EXPECT_FALSE(blockSlotsOf(vfs15, settings));
  readAll(settings, "F879", 14, 3);
  const auto slots = blockSlotsOf(vfs15, settings);
  ASSERT_TRUE(slots);
  EXPECT_THAT(slots->read, ElementsAre(3, 3, 3, 3, 14));
  EXPECT_THAT(slots->write, ElementsAre(3, 3));
  settings.reread("F879");
  EXPECT_FALSE(blockSlotsOf(vfs15, settings));
}

TEST(SettingFacts, driveWithoutABlockHasNoSlots)
{
  const drive::Drive mx2 = shipped("omron_mx2");
  SettingList settings(mx2);
  readAll(settings, "", 0);
  EXPECT_FALSE(blockSlotsOf(mx2, settings));
}

TEST(SettingFacts, ratingsAreWhatTheDriveTellsAndZeroIsNone)
{
  const drive::Drive vfs15 = shipped("toshiba_vfs15");
  SettingList settings(vfs15);
  EXPECT_FALSE(ratingsOf(vfs15, settings).current);
  readAll(settings, "FE70", 480);
  const drive::Ratings ratings = ratingsOf(vfs15, settings);
  ASSERT_TRUE(ratings.current);
  EXPECT_DOUBLE_EQ(*ratings.current, 48.0);
  EXPECT_FALSE(ratings.voltage);
}
}  // namespace
}  // namespace bus
}  // namespace inverter_bus
