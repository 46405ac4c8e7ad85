// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
// Which of a drive's own settings is read next (contract, 4.5).

#include "bus/inverter/setting_list.h"

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
using testing::Not;
using testing::UnorderedElementsAre;

/// Reads what is due, every answer 1; returns the names in order.
std::vector<std::string> readAll(SettingList& settings)
{
  std::vector<std::string> names;
  for (const Setting* next = settings.next(); next != nullptr && names.size() < 50; next = settings.next())
  {
    names.push_back(next->parameter.name);
    settings.done(reply("03 02 00 01"));
  }
  return names;
}

TEST(SettingList, whatTellsWhatTheDriveIsGoesFirst)
{
  const drive::Drive vfs15 = shipped("toshiba_vfs15");
  SettingList settings(vfs15);
  EXPECT_TRUE(settings.urgent());
  EXPECT_EQ(readAll(settings).front(), vfs15.profile().identity.front().parameter);
  EXPECT_FALSE(settings.urgent());
}

TEST(SettingList, whoCommandsTheDriveIsReadWhileACommandIsInForceOnly)
{
  const drive::Drive vfs15 = shipped("toshiba_vfs15");
  std::vector<std::string> under_command;
  for (const drive::Expectation& expectation : vfs15.profile().command_source)
  {
    if (expectation.when_commanded)
    {
      under_command.push_back(expectation.parameter);
    }
  }
  ASSERT_FALSE(under_command.empty());
  SettingList settings(vfs15);
  EXPECT_THAT(readAll(settings), Not(Contains(under_command.front())));
  settings.commanded();
  EXPECT_TRUE(settings.underCommand());
  EXPECT_THAT(readAll(settings), testing::UnorderedElementsAreArray(under_command));
  settings.commanded();
  EXPECT_THAT(readAll(settings), testing::UnorderedElementsAreArray(under_command)) << "it is looked at anew";
  ASSERT_NE(settings.known(under_command.front()), nullptr);
  settings.released();
  EXPECT_EQ(settings.known(under_command.front()), nullptr);
  EXPECT_EQ(settings.next(), nullptr);
}

class Mx2SettingList : public testing::Test
{
protected:
  const drive::Drive mx2_ = shipped("omron_mx2");
  SettingList settings_{ mx2_ };
};

TEST_F(Mx2SettingList, eachIsReadOnceAndAgainAfterARestartOrAWrite)
{
  EXPECT_THAT(readAll(settings_), UnorderedElementsAre("C078", "C077", "C076", "A001", "A002", "b001", "b008"));
  settings_.reread("A001");
  EXPECT_THAT(readAll(settings_), ElementsAre("A001"));
  settings_.restart();
  EXPECT_EQ(readAll(settings_).size(), 7U);
}

TEST_F(Mx2SettingList, oneThatIsNotReadIsNotKnown)
{
  ASSERT_NE(settings_.find("C077"), nullptr);
  EXPECT_EQ(settings_.known("C077"), nullptr);
  EXPECT_EQ(settings_.find("F002"), nullptr);
  readAll(settings_);
  ASSERT_NE(settings_.known("C077"), nullptr);
  EXPECT_EQ(settings_.known("C077")->raw, 1U);
}

TEST_F(Mx2SettingList, refusalForGoodEndsTheQuestionOneForTheMomentPutsItOff)
{
  const std::string first = settings_.next()->parameter.name;
  settings_.done(exception(0x83, 0x02));
  EXPECT_NE(settings_.next()->parameter.name, first);
  const std::string second = settings_.next()->parameter.name;
  settings_.done(exception(0x83, 0x06));
  while (settings_.next()->parameter.name != second)
  {
    EXPECT_EQ(settings_.pauseBeforeNext(), Duration{ 0 });
    settings_.done(reply("03 02 00 01"));
  }
  EXPECT_EQ(settings_.pauseBeforeNext(), std::chrono::seconds(1));
  settings_.done(exception(0x83, 0x06));
  EXPECT_EQ(settings_.pauseBeforeNext(), std::chrono::seconds(2));
}
}  // namespace
}  // namespace bus
}  // namespace inverter_bus
