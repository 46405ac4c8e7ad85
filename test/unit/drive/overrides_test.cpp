// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
// What a scan list entry may change in its profile.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/drive_fixture.h"

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
  changes.place = "bus.yaml:7: scan_list[1] 'fan'";
  changes.overrides = overridesOf(yaml, changes.place);
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

TEST(DriveOverrides, AnotherWayToReadAWordReplacesTheOldOne)
{
  const Item nonzero =
      shipped("omron_rx", overrides("status: {faulted: {nonzero: true}}")).profile().status.at("faulted");
  EXPECT_TRUE(nonzero.nonzero);
  EXPECT_TRUE(nonzero.values.empty());
  EXPECT_EQ(nonzero.number, 0x0004);
  const Item bit = shipped("omron_rx", overrides("status: {faulted: {bit: 1}}")).profile().status.at("faulted");
  EXPECT_EQ(bit.bit, 1U);
  EXPECT_TRUE(bit.values.empty());
  const Item values = shipped("toshiba_vfs15", overrides("status: {faulted: {register: 0xFC90, values: {0: 0, 1: 1}}}"))
                          .profile()
                          .status.at("faulted");
  EXPECT_FALSE(values.bit.has_value());
  EXPECT_EQ(values.values.size(), 2U);
}

TEST(DriveOverrides, OneMoreValueIsAddedToTheOthers)
{
  const Drive drive = shipped("omron_rx", overrides("status: {faulted: {values: {7: 1}}}"));
  EXPECT_EQ(drive.profile().status.at("faulted").values.size(), 4U);
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
  EXPECT_THAT(refusal("omron_mx2", overrides("[1, 2]")), AllOf(HasSubstr("'overrides'"), HasSubstr("a map")));
  EXPECT_THAT(refusal("omron_mx2", overrides("limits: {functions: [1, 3]}")), HasSubstr("needs function"));
}

TEST(DriveOverrides, NothingToOverrideIsFine)
{
  EXPECT_EQ(refusal("omron_mx2", ProfileChanges()), "");
  EXPECT_EQ(refusal("omron_mx2", overrides("{}")), "");
  EXPECT_EQ(refusal("omron_mx2", overrides("~")), "");
}

TEST(DriveOverrides, AConstantIsGivenAsAPlainNumberAtTheTop)
{
  EXPECT_EQ(shipped("teco_7200ma").sequence("reverse"), nullptr);
  const Drive drive = shipped("teco_7200ma", overrides("{reverse_word: 2, frequency_scale: 0.01}"));
  ASSERT_NE(drive.sequence("reverse"), nullptr);
  // Table 1 of the 7200MA manual has the frame; 0002H is the reverse of the drives with a bit of its own for it.
  EXPECT_EQ(printed(drive.command(1, drive.sequence("reverse")->steps.back())), "01 10 00 00 00 01 02 00 02");
  EXPECT_EQ(drive.sequence("forward"), nullptr);
  EXPECT_EQ(drive.missingFor("forward"), "run_forward");
}

TEST(DriveOverrides, AConstantIsGivenInItsSectionToo)
{
  for (const char* yaml : { "constants: {reverse_word: 3, frequency_scale: 0.01}",
                            "constants: {reverse_word: {value: 3}, frequency_scale: {value: 0.01}}" })
  {
    const Drive drive = shipped("teco_7200ma", overrides(yaml));
    ASSERT_NE(drive.sequence("reverse"), nullptr) << yaml;
    EXPECT_EQ(printed(drive.command(1, drive.sequence("reverse")->steps.back())), "01 10 00 00 00 01 02 00 03") << yaml;
  }
}

TEST(DriveOverrides, AConstantThatIsWrongIsRefusedByItsPlaceAndName)
{
  struct Wrong
  {
    const char* yaml;
    const char* key;
    const char* says;
  };
  for (const Wrong& wrong : { Wrong{ "{reverse_word: 2.5}", "key 'constants.reverse_word", "allowed: an integer" },
                              Wrong{ "{reverse_word: two}", "key 'constants.reverse_word", "value 'two'" },
                              Wrong{ "{frequency_scale: 0}", "key 'constants.frequency_scale", "a number above 0" },
                              Wrong{ "{monitor_base: -1}", "key 'constants.monitor_base", "from 0 to 65535" },
                              Wrong{ "{reverse: 2}", "key 'reverse'", "unknown key" } })
  {
    EXPECT_THAT(refusal("teco_7200ma", overrides(wrong.yaml)),
                AllOf(StartsWith("bus.yaml:7: scan_list[1] 'fan': "), HasSubstr(wrong.key), HasSubstr(wrong.says)))
        << wrong.yaml;
  }
  EXPECT_THAT(refusal("teco_7200ma", overrides("{reverse_word: 0x10000}")), HasSubstr("allowed: 0 to 65535"));
}

TEST(DriveOverrides, AnExplanationIsNoValue)
{
  const Drive drive = shipped("teco_7200ma", overrides("constants: {run_forward: {where: my own copy}}"));
  EXPECT_THAT(drive.missingFor("forward"), HasSubstr("run_forward"));
  EXPECT_THAT(drive.armingAdvice("forward"), HasSubstr("'run_forward'"));
}

TEST(DriveOverrides, TheMonitorBaseArmsWhatHangsOnItAndNothingElse)
{
  const Drive bare = shipped("teco_7200ma");
  for (const char* field : { "running", "direction", "faulted", "ready", "output_frequency", "output_voltage" })
  {
    EXPECT_FALSE(bare.reports(field)) << field;
  }
  const Drive drive = shipped("teco_7200ma", overrides("{monitor_base: 0x0120}"));
  for (const char* field : { "running", "direction", "faulted", "ready", "output_frequency", "output_voltage" })
  {
    EXPECT_TRUE(drive.reports(field)) << field;
  }
  // Its own mark: what lies at +1, +6 and +7 differs between the relatives.
  for (const char* field : { "fault_code", "dc_voltage", "output_current" })
  {
    EXPECT_FALSE(drive.reports(field)) << field;
  }
  EXPECT_EQ(drive.profile().status.at("output_frequency").address, 0x0124);
  EXPECT_EQ(drive.sequence("forward"), nullptr);
  EXPECT_EQ(drive.profile().unconfirmed.count("monitor_base"), 0U);
  EXPECT_EQ(drive.profile().unconfirmed.count("monitor_layout"), 1U);
}

TEST(DriveOverrides, BaseAndLayoutTogetherArmAllMonitors)
{
  ProfileChanges changes = overrides("{monitor_base: 0x0020}");
  changes.confirm = { "monitor_layout", "fault_coding" };
  const Drive drive = shipped("teco_7200ma", changes);
  for (const char* field : { "fault_code", "dc_voltage", "output_current", "output_frequency" })
  {
    EXPECT_TRUE(drive.reports(field)) << field;
  }
  EXPECT_EQ(drive.profile().status.at("output_current").address, 0x0027);
  // The keep-alive is for a drive that tells nothing.
  for (const ReadBlock& block : drive.fastBlocks())
  {
    EXPECT_NE(block.number, 0x0000);
  }
}

TEST(DriveOverrides, AParameterWithAnUnknownRegisterIsGivenOne)
{
  const Drive bare = shipped("teco_7200ma");
  EXPECT_FALSE(bare.findParameter("Sn-39", false).has_value());
  EXPECT_THAT(bare.parameterRefusal("Sn-39", false), HasSubstr("parameter_Sn-39"));
  const Drive drive = shipped("teco_7200ma", overrides("parameters: {Sn-39: {register: 0x0127}}"));
  const auto parameter = drive.findParameter("Sn-39", true);
  ASSERT_TRUE(parameter.has_value());
  EXPECT_EQ(printed(drive.readParameter(1, *parameter)), "01 03 01 27 00 01");
  EXPECT_EQ(printed(drive.writeParameter(1, *parameter, 1)), "01 10 01 27 00 01 02 00 01");
  EXPECT_FALSE(drive.encodeParameter(*parameter, 4.0).ok);
  EXPECT_FALSE(drive.findParameter("Cn-27", false).has_value());
  EXPECT_EQ(drive.profile().communication_loss.action_parameter, "Sn-39");
  EXPECT_EQ(drive.profile().communication_loss.timeout_parameter, "");
}

TEST(DriveOverrides, ATitleGivesAnUnknownRegisterNoPlace)
{
  const Drive drive = shipped("teco_7200ma", overrides("parameters: {Sn-39: {title: mine, unconfirmed: x}}"));
  EXPECT_FALSE(drive.findParameter("Sn-39", false).has_value());
}

TEST(DriveOverrides, OperationCodesArmTheDriveOneByOne)
{
  const Drive bare = shipped("omron_3g3je");
  for (const char* name : { "forward", "reverse", "stop", "reset", "connect", "open_setup", "close_setup" })
  {
    EXPECT_EQ(bare.sequence(name), nullptr) << name;
    EXPECT_THAT(bare.armingAdvice(name), HasSubstr("I548-E1")) << name;
  }
  // The codes are inventions of this test: what moves a real drive is not known here.
  const Drive half = shipped("omron_3g3je", overrides("operation_codes: {run_forward: \"AB01\"}"));
  EXPECT_EQ(half.sequence("forward"), nullptr) << "motion waits for the stop";
  EXPECT_EQ(half.missingFor("forward"), "stop");
  const Drive drive =
      shipped("omron_3g3je", overrides("operation_codes: {run_forward: \"AB01\", stop: {value: \"AB00\"}}"));
  ASSERT_NE(drive.sequence("forward"), nullptr);
  ASSERT_NE(drive.sequence("stop"), nullptr);
  EXPECT_EQ(drive.sequence("reverse"), nullptr);
  EXPECT_EQ(drive.missingFor("reverse"), "run_reverse");
  EXPECT_EQ(drive.sequence("stop")->steps.back().value, 0xAB00U);
}

TEST(DriveOverrides, OperationCodesWithoutQuotesOrOfAnotherLengthAreRefused)
{
  for (const char* code : { "0x0101", "101", "\"101\"", "\"01 01\"", "\"01011\"", "\"01GG\"" })
  {
    EXPECT_THAT(refusal("omron_3g3je", overrides("operation_codes: {stop: " + std::string(code) + "}")),
                AllOf(StartsWith("bus.yaml:7: scan_list[1] 'fan': key 'operation_codes.stop"),
                      HasSubstr("four hexadecimal digits in quotes")))
        << code;
  }
  EXPECT_THAT(refusal("omron_3g3je", overrides("operation_codes: {halt: \"0101\"}")),
              AllOf(HasSubstr("'operation_codes.halt'"), HasSubstr("allowed: run_forward")));
}

TEST(DriveOverrides, AControllerStatusOverAVariableReplacesTheItem)
{
  const Drive drive = shipped("omron_3g3je", overrides("status: {faulted: {controller_status: true, bit: 3}}"));
  EXPECT_TRUE(drive.reports("faulted"));
  EXPECT_EQ(drive.profile().status.at("faulted").space, Space::ControllerStatus);
  const Drive variable = shipped("omron_3g3je", overrides("status: {raw_status: {variable: C0/0003}}"));
  EXPECT_EQ(variable.profile().status.at("raw_status").space, Space::Variable);
  EXPECT_EQ(variable.profile().status.at("raw_status").area, 0xC0);
}

TEST(DriveOverrides, ADriveOfOlderFirmwareReadsOneRegisterAtATime)
{
  const Drive drive = shipped("toshiba_vfs15", overrides("limits: {read_registers: 1}"));
  for (const ReadBlock& block : drive.fastBlocks())
  {
    EXPECT_EQ(block.count, 1U);
  }
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

TEST(DriveConfirm, AllDoesNotConfirmWhatNobodyKnows)
{
  const Drive teco = shipped("teco_7200ma", confirming({ "all" }));
  EXPECT_NE(teco.sequence("forward"), nullptr);
  EXPECT_NE(teco.sequence("reset"), nullptr);
  EXPECT_EQ(teco.sequence("reverse"), nullptr);
  EXPECT_FALSE(teco.reports("output_frequency"));
  EXPECT_FALSE(teco.reports("output_current"));
  EXPECT_FALSE(teco.findParameter("Sn-36", false).has_value());
  EXPECT_THAT(teco.profile().unconfirmed, testing::ElementsAre("monitor_base", "run_reverse"));

  const Drive je = shipped("omron_3g3je", confirming({ "all" }));
  for (const char* name : { "forward", "reverse", "stop", "reset", "connect", "open_setup", "close_setup" })
  {
    EXPECT_EQ(je.sequence(name), nullptr) << name;
  }
  EXPECT_TRUE(je.reports("output_current"));
}

TEST(DriveConfirm, ANameOfSomethingUnknownConfirmsNothing)
{
  const Drive drive = shipped("teco_7200ma", confirming({ "run_reverse", "monitor_base", "frequency_scale" }));
  EXPECT_EQ(drive.sequence("reverse"), nullptr);
  EXPECT_EQ(drive.missingFor("reverse"), "run_reverse");
  EXPECT_THAT(drive.armingAdvice("reverse"), AllOf(HasSubstr("'reverse_word'"), HasSubstr("pages 10 to 29")));
  EXPECT_FALSE(drive.reports("output_frequency"));
}

TEST(DriveConfirm, AConstantAnswersToItsOwnName)
{
  EXPECT_EQ(refusal("teco_7200ma", confirming({ "reverse_word" })), "") << "known, though there is nothing to confirm";
  const ProfileFile file(replaced(smallProfile(), "  stop: [{run: 0}]\n",
                                  "  stop: [{run: stop_word}]\n"
                                  "constants: {stop_word: {value: 0, unconfirmed: stop_bits}}\n"));
  EXPECT_EQ(Drive(file.load()).missingFor("stop"), "stop_bits");
  for (const char* name : { "stop_word", "stop_bits" })
  {
    EXPECT_NE(Drive(file.load(confirming({ name }))).sequence("stop"), nullptr) << name;
  }
}

TEST(DriveConfirm, AScaleThatIsUnconfirmedLocksTheMotion)
{
  const Drive half = shipped("teco_7200ma", confirming({ "run_forward" }));
  EXPECT_EQ(half.sequence("forward"), nullptr);
  EXPECT_EQ(half.missingFor("forward"), "frequency_scale");
  const Drive drive = shipped("teco_7200ma", confirming({ "run_forward", "frequency_scale" }));
  EXPECT_NE(drive.sequence("forward"), nullptr);
  EXPECT_EQ(drive.sequence("reset"), nullptr);
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
