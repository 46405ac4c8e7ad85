// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
// What a scan list entry may change in its profile.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "drive_fixture.h"

namespace inverter_bus
{
namespace drive
{
namespace
{
using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

ProfileChanges overrides(const std::string& yaml)
{
  ProfileChanges changes;
  changes.overrides_yaml = yaml;
  changes.place = "bus.yaml:7: scan_list[1] 'fan'";
  return changes;
}

ProfileChanges confirming(const std::vector<std::string>& names)
{
  ProfileChanges changes;
  changes.place = "bus.yaml:9: scan_list[1] 'fan'";
  changes.confirm = names;
  return changes;
}

std::string refusal(const std::string& name, const ProfileChanges& changes)
{
  try
  {
    loadProfile(name, profileDirectory(), changes);
    return "";
  }
  catch (const ConfigurationError& error)
  {
    return error.what();
  }
}

/// The small profile with an unconfirmed way to run and one to stop.
std::string openProfile(const std::string& stop_mark)
{
  std::string text = replaced(smallProfile(), "  forward: [{frequency: setpoint}, {direction: 0}, {run: 1}]\n",
                              "  forward: {unconfirmed: run_forward, steps: [{frequency: setpoint}, {run: 1}]}\n");
  return stop_mark.empty()
             ? text
             : replaced(text, "  stop: [{run: 0}]\n", "  stop: {unconfirmed: " + stop_mark + ", steps: [{run: 0}]}\n");
}

TEST(DriveOverrides, ReplaceASingleLeaf)
{
  const Drive drive = shipped("omron_mx2", overrides("points: {frequency: {resolution: 0.1}}"));
  EXPECT_EQ(drive.frequencyCounts(50.0), 500U);
  EXPECT_EQ(drive.profile().points.at("frequency").item.number, 1);
  EXPECT_EQ(drive.profile().points.at("frequency").item.size, 2U);
}

TEST(DriveOverrides, AddANewCommand)
{
  const Drive drive = shipped("omron_mx2", overrides("points: {free_run: {coil: 0x0009}}\n"
                                                     "sequences: {coast: [{free_run: 1}, {run: 0}]}\n"));
  ASSERT_NE(drive.sequence("coast"), nullptr);
  EXPECT_EQ(printed(drive.write(1, "free_run", 1)), "01 05 00 08 FF 00");
  EXPECT_NE(drive.sequence("stop"), nullptr);
}

TEST(DriveOverrides, NumbersMaySpellAKeyDifferently)
{
  const Drive drive = shipped("omron_mx2", overrides("exceptions: {33: other words}\nfaults: {table: {0x0C: twelve}}"));
  EXPECT_EQ(drive.exceptionText(0x8621), "exception 21H: other words");
  EXPECT_EQ(drive.faultText(12), "twelve");
}

TEST(DriveOverrides, ConfirmWhatTheySupply)
{
  const Drive drive = shipped("omron_rx", overrides("status: {output_current: {resolution: 0.01}}"));
  EXPECT_TRUE(drive.reports("output_current"));
  EXPECT_FALSE(drive.reports("dc_voltage"));
  // The trip memory's current has the same mark, but nobody has said anything about it.
  EXPECT_EQ(drive.profile().unconfirmed.count("current_scale"), 1U);
}

TEST(DriveOverrides, DoNotConfirmByChangingSomethingElse)
{
  EXPECT_FALSE(shipped("omron_rx", overrides("status: {output_current: {slow: true}}")).reports("output_current"));
  const Drive drive = shipped("omron_rx", overrides("parameters: {C077: {title: other}}"));
  EXPECT_FALSE(drive.findParameter("C077", false).has_value());
}

TEST(DriveOverrides, ARangeConfirmsTheRangeOnly)
{
  const Drive drive = shipped("omron_mx2", overrides("parameters: {F002: {range: [0.1, 100.0]}}"));
  EXPECT_FALSE(drive.encodeParameter(*drive.findParameter("F002", true), 200.0).ok);
  EXPECT_TRUE(drive.encodeParameter(*drive.findParameter("F003", true), 5000.0).ok);
}

TEST(DriveOverrides, ACoilReplacesARegisterAsAWhole)
{
  const Drive drive = shipped("omron_rx", overrides("status: {faulted: {coil: 0x0018}}"));
  EXPECT_EQ(drive.fastBlocks().size(), 2U);
  EXPECT_EQ(drive.profile().status.at("faulted").space, Space::Coil);
}

TEST(DriveOverrides, AListReplacesASequenceThatIsUnconfirmed)
{
  const ProfileFile file(openProfile(""));
  EXPECT_EQ(Drive(file.load()).sequence("forward"), nullptr);
  const Drive drive(file.load(overrides("sequences: {forward: [{frequency: setpoint}, {run: 1}]}")));
  ASSERT_NE(drive.sequence("forward"), nullptr);
  EXPECT_EQ(drive.missingFor("forward"), "");
}

TEST(DriveOverrides, AParameterOfTheUsersOwnCanBeAdded)
{
  const Drive drive =
      shipped("omron_mx2", overrides("parameters: {X01: {register: 0x1700, resolution: 0.5, unit: mm}}"));
  ASSERT_TRUE(drive.findParameter("X01", true).has_value());
  EXPECT_EQ(drive.encodeParameter(*drive.findParameter("X01", true), 1.5).raw, 3U);
}

TEST(DriveOverrides, CannotMakeACommandRegisterWritable)
{
  for (const char* yaml : { "parameters: {X01: {register: 0x1F01}}", "parameters: {X01: {register: 0x0900}}",
                            "parameters: {F001: {read_only: false}}" })
  {
    EXPECT_THAT(refusal("omron_mx2", overrides(yaml)), HasSubstr("command register")) << yaml;
  }
}

TEST(DriveOverrides, MistakesNameThePlaceAndTheKey)
{
  EXPECT_THAT(refusal("omron_mx2", overrides("points: {frequency: {resolution: -1}}")),
              AllOf(StartsWith("bus.yaml:7: scan_list[1] 'fan': key 'points.frequency.resolution': value '-1'"),
                    HasSubstr("allowed")));
  EXPECT_THAT(
      refusal("omron_mx2", overrides("no_such_key: 1")),
      AllOf(StartsWith("bus.yaml:7: scan_list[1] 'fan': "), HasSubstr("'no_such_key'"), HasSubstr("unknown key")));
  EXPECT_THAT(refusal("omron_mx2", overrides("{")), StartsWith("bus.yaml:7: scan_list[1] 'fan': not valid YAML"));
  EXPECT_THAT(refusal("omron_mx2", overrides("[1, 2]")), AllOf(HasSubstr("'overrides'"), HasSubstr("a map")));
  EXPECT_THAT(refusal("omron_mx2", overrides("limits: {functions: [1, 3]}")), HasSubstr("needs function"));
}

TEST(DriveOverrides, NothingToOverrideIsFine)
{
  EXPECT_EQ(refusal("omron_mx2", overrides("")), "");
  EXPECT_EQ(refusal("omron_mx2", overrides("{}")), "");
  EXPECT_EQ(refusal("omron_mx2", overrides("~")), "");
}

TEST(DriveConfirm, ANameUnlocksWhatCarriesIt)
{
  const ProfileFile file(openProfile(""));
  const Drive locked(file.load());
  EXPECT_EQ(locked.sequence("forward"), nullptr);
  EXPECT_EQ(locked.missingFor("forward"), "run_forward");
  EXPECT_EQ(locked.profile().unconfirmed.count("run_forward"), 1U);
  const Drive open(file.load(confirming({ "run_forward" })));
  EXPECT_NE(open.sequence("forward"), nullptr);
  EXPECT_THAT(open.profile().unconfirmed, IsEmpty());
}

TEST(DriveConfirm, MotionWaitsForTheStopToo)
{
  const ProfileFile file(openProfile("stop_word"));
  EXPECT_EQ(Drive(file.load()).missingFor("forward"), "run_forward, stop_word");
  const Drive half(file.load(confirming({ "run_forward" })));
  EXPECT_EQ(half.sequence("forward"), nullptr);
  EXPECT_EQ(half.missingFor("forward"), "stop_word");
  const Drive full(file.load(confirming({ "run_forward", "stop_word" })));
  EXPECT_NE(full.sequence("forward"), nullptr);
  EXPECT_NE(full.sequence("stop"), nullptr);
}

TEST(DriveConfirm, AnUnconfirmedPointLocksEverySequenceThatUsesIt)
{
  const ProfileFile file(replaced(smallProfile(), "  run: {coil: 1}", "  run: {coil: 1, unconfirmed: run_coil}"));
  const Drive locked(file.load());
  EXPECT_EQ(locked.sequence("forward"), nullptr);
  EXPECT_EQ(locked.sequence("stop"), nullptr);
  EXPECT_EQ(locked.missingFor("stop"), "run_coil");
  EXPECT_NE(Drive(file.load(confirming({ "run_coil" }))).sequence("stop"), nullptr);
}

TEST(DriveConfirm, AllConfirmsEverything)
{
  const Drive drive = shipped("omron_rx", confirming({ "all" }));
  EXPECT_THAT(drive.profile().unconfirmed, IsEmpty());
  EXPECT_THAT(drive.profile().unconfirmed_tables, IsEmpty());
  EXPECT_TRUE(drive.reports("output_current"));
  EXPECT_TRUE(drive.findParameter("C077", true).has_value());
}

TEST(DriveConfirm, AnUnknownNameListsTheNamesThereAre)
{
  EXPECT_THAT(refusal("omron_rx", confirming({ "current_scale", "curent_scale" })),
              AllOf(StartsWith("bus.yaml:9: scan_list[1] 'fan': key 'confirm': value 'curent_scale'"),
                    HasSubstr("allowed: all, current_scale, dc_bus_voltage")));
  const ProfileFile file(smallProfile());
  EXPECT_THAT(
      [&file] {
        try
        {
          file.load(confirming({ "anything" }));
          return std::string();
        }
        catch (const ConfigurationError& error)
        {
          return std::string(error.what());
        }
      }(),
      HasSubstr("nothing to confirm"));
}

TEST(DriveConfirm, ANameMayBeConfirmedAndOverriddenAtOnce)
{
  ProfileChanges changes = overrides("status: {temperature: {register: 0x1019}}");
  changes.confirm = { "heatsink_temperature" };
  EXPECT_EQ(refusal("omron_rx", changes), "");
}
}  // namespace
}  // namespace drive
}  // namespace inverter_bus
