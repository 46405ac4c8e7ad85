// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
// Whether the drive is the one that its profile describes (contract, 4.5).

#include "bus/inverter/drive_identity.h"

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

/// The answer to a question for the model: service 0503, end of the request's own code.
wire::Reply modelReply(const std::string& model)
{
  const std::string text = "05030000" + model + std::string(10 - model.size(), ' ') + "00D2";
  wire::Reply answer = reply("");
  answer.pdu.assign(text.begin(), text.end());
  return answer;
}

drive::Profile withModel(const std::string& model)
{
  drive::Profile profile = drive::loadProfile("omron_3g3je", drive::profileDirectory());
  drive::Expectation expectation;
  expectation.model = model;
  expectation.advice = "see the type plate";
  profile.identity = { expectation };
  return profile;
}

TEST(DriveIdentity, profileThatExpectsNothingFitsEveryDrive)
{
  drive::Profile profile = drive::loadProfile("omron_mx2", drive::profileDirectory());
  profile.identity.clear();
  const drive::Drive drive(profile);
  const DriveIdentity identity(drive, 1);
  EXPECT_FALSE(identity.next());
  EXPECT_EQ(identity.judge(SettingList(drive)), Identity::Right);
  EXPECT_EQ(identity.text(SettingList(drive)), "");
  EXPECT_EQ(identity.modelText(), "");
}

TEST(DriveIdentity, modelIsAskedForAndJudgedByItsBeginning)
{
  const drive::Drive drive(withModel("3G3JE"));
  const SettingList settings(drive);
  DriveIdentity identity(drive, 1);
  ASSERT_TRUE(identity.next());
  EXPECT_EQ(identity.judge(settings), Identity::Unknown);
  EXPECT_THAT(identity.text(settings), HasSubstr("not reported yet"));
  EXPECT_EQ(identity.modelText(), "not reported");
  identity.done(modelReply("3G3JE-A4"));
  EXPECT_FALSE(identity.next());
  EXPECT_EQ(identity.judge(settings), Identity::Right);
  EXPECT_EQ(identity.model(), "3G3JE-A4");
}

TEST(DriveIdentity, otherModelIsTheWrongDrive)
{
  const drive::Drive drive(withModel("3G3JE"));
  const SettingList settings(drive);
  DriveIdentity identity(drive, 1);
  identity.done(modelReply("3G3MZ"));
  EXPECT_EQ(identity.judge(settings), Identity::Wrong);
  EXPECT_EQ(identity.text(settings), "wrong drive: its model is '3G3MZ'; see the type plate");
}

TEST(DriveIdentity, modelThatIsRefusedIsTheWrongDriveUntilItIsAskedAnew)
{
  const drive::Drive drive(withModel("3G3JE"));
  const SettingList settings(drive);
  DriveIdentity identity(drive, 1);
  wire::Reply refusal = exception(0x00, 0x00);
  refusal.error_id = 0x0401;  // CompoWay/F: no such service
  identity.done(refusal);
  EXPECT_EQ(identity.judge(settings), Identity::Wrong);
  EXPECT_THAT(identity.text(settings), HasSubstr("its model cannot be read"));
  identity.restart();
  EXPECT_TRUE(identity.next());
  EXPECT_EQ(identity.judge(settings), Identity::Unknown);
}

TEST(DriveIdentity, settingOfAnotherBrandIsTheWrongDrive)
{
  const drive::Drive vfs15 = shipped("toshiba_vfs15");
  ASSERT_FALSE(vfs15.profile().identity.empty());
  SettingList settings(vfs15);
  const DriveIdentity identity(vfs15, 1);
  EXPECT_EQ(identity.judge(settings), Identity::Unknown);
  ASSERT_EQ(settings.next()->parameter.name, vfs15.profile().identity.front().parameter);
  settings.done(reply("03 02 FF FF"));
  EXPECT_EQ(identity.judge(settings), Identity::Wrong);
  EXPECT_THAT(identity.text(settings), HasSubstr("is '65535'"));
}
}  // namespace
}  // namespace bus
}  // namespace inverter_bus
