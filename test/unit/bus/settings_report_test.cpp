// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
// What users are told of a drive's settings (contract, 4.1 and 4.5).

#include "bus/inverter/settings_report.h"

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
using testing::Field;
using testing::HasSubstr;
using testing::Pair;
using testing::StartsWith;

/// A drive whose settings all read as \p raw.
SettingList allRead(const drive::Drive& drive, const std::string& pdu)
{
  SettingList settings(drive);
  while (settings.next() != nullptr)
  {
    settings.done(reply(pdu));
  }
  return settings;
}

TEST(SettingsReport, findingsAreWarningsWithWhatToSet)
{
  const drive::Drive mx2 = shipped("omron_mx2");
  // A001, A002, b001 and b008 are 2, and C077 is 0.02 s.
  const SettingList settings = allRead(mx2, "03 02 00 02");
  EXPECT_THAT(
      settingFindings(mx2, settings),
      ElementsAre(Field(&Finding::text, AllOf(StartsWith("not commanded by the bus: A001 = 2"), HasSubstr("set"))),
                  Field(&Finding::text, StartsWith("not commanded by the bus: A002 = 2")),
                  Field(&Finding::text, AllOf(StartsWith("runs on when"), HasSubstr("C076 = 2 (ignore)"))),
                  Field(&Finding::text, StartsWith("may restart by itself: b001 = 2")),
                  Field(&Finding::text, StartsWith("may restart by itself: b008 = 2"))));
}

TEST(SettingsReport, nothingIsFoundInWhatWasNotRead)
{
  const drive::Drive mx2 = shipped("omron_mx2");
  EXPECT_THAT(settingFindings(mx2, SettingList(mx2)), testing::IsEmpty());
}

TEST(SettingsReport, valuesSayWhatIsKnownAndWhyNot)
{
  const drive::Drive mx2 = shipped("omron_mx2");
  EXPECT_THAT(settingValues(mx2, SettingList(mx2)), Contains(Pair(StartsWith("C077"), "not read yet")));
  EXPECT_THAT(settingValues(mx2, allRead(mx2, "03 02 00 32")), Contains(Pair(StartsWith("C077"), "0.5 s")));
  SettingList refused(mx2);
  while (refused.next() != nullptr)
  {
    refused.done(exception(0x83, 0x02));
  }
  EXPECT_THAT(settingValues(mx2, refused), Contains(Pair(StartsWith("C077"), "the drive refuses the read")));
}

TEST(SettingsReport, whatIsReadUnderCommandSaysSo)
{
  const drive::Drive vfs15 = shipped("toshiba_vfs15");
  EXPECT_THAT(settingValues(vfs15, SettingList(vfs15)), Contains(Pair(testing::_, "read while a command is in force")));
}
}  // namespace
}  // namespace bus
}  // namespace inverter_bus
