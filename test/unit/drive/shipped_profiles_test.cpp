// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
// The profiles that come with the package, against the makers' documents.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/drive_fixture.h"

namespace inverter_bus
{
namespace drive
{
namespace
{
using testing::Contains;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::UnorderedElementsAre;

/// The sequences that may be sent.
std::vector<std::string> armed(const Drive& drive)
{
  std::vector<std::string> names;
  for (const char* name : { "forward", "reverse", "stop", "coast", "quick", "reset", "release", "store", "connect",
                            "open_setup", "close_setup" })
  {
    if (drive.sequence(name) != nullptr)
    {
      names.emplace_back(name);
    }
  }
  return names;
}

ProfileChanges changes(const std::vector<std::string>& confirm, const std::string& overrides = "{}")
{
  ProfileChanges result;
  result.confirm = confirm;
  result.overrides = overridesOf(overrides);
  return result;
}

struct Place
{
  const char* name;
  unsigned number;
  unsigned words;
  double resolution;
  const char* unit;
};

/// \p first: what the drive's manual calls the register with the wire address 0.
void expectPlaces(const Profile& profile, const std::vector<Place>& places, unsigned first = 1)
{
  for (const Place& place : places)
  {
    const auto found = profile.parameters.find(place.name);
    ASSERT_NE(found, profile.parameters.end()) << place.name;
    const Item& item = found->second.item;
    EXPECT_EQ(item.number, place.number) << place.name;
    EXPECT_EQ(item.address, place.number - first) << place.name;
    EXPECT_EQ(item.size, place.words) << place.name;
    EXPECT_DOUBLE_EQ(item.resolution, place.resolution) << place.name;
    EXPECT_EQ(item.unit, place.unit) << place.name;
  }
}

TEST(DriveShippedProfiles, AreFreeOfMistakes)
{
  const std::vector<std::string> names = knownProfiles(profileDirectory());
  EXPECT_THAT(names, ElementsAre("hitachi_wj200", "omron_3g3je", "omron_mx2", "omron_rx", "teco_7200ma",
                                 "toshiba_vfs11", "toshiba_vfs15"));
  for (const std::string& name : names)
  {
    EXPECT_THAT(checkProfile(profileDirectory() + "/" + name + ".yaml"), IsEmpty()) << name;
    EXPECT_EQ(loadProfile(name, profileDirectory()).name, name);
  }
}

TEST(DriveShippedProfiles, TheMx2HasTheLineOfItsManual)
{
  const Profile profile = loadProfile("omron_mx2", profileDirectory());
  EXPECT_EQ(profile.protocol, "modbus_rtu");
  EXPECT_EQ(profile.first_station, 1U);
  EXPECT_EQ(profile.last_station, 247U);
  EXPECT_THAT(profile.baud_rates, ElementsAre(2400, 4800, 9600, 19200, 38400, 57600, 76800, 115200));
  EXPECT_THAT(profile.parities, ElementsAre("even", "none", "odd"));
  EXPECT_THAT(profile.stop_bits, ElementsAre(1, 2));
  EXPECT_EQ(profile.read_registers, 16U);
  EXPECT_EQ(profile.read_coils, 32U);
  EXPECT_THAT(profile.functions, Contains(0x17));
  EXPECT_EQ(profile.writes, Writes::Ram);
  EXPECT_TRUE(profile.broadcast_stop);
  EXPECT_DOUBLE_EQ(profile.broadcast_turnaround, 0.02);
  EXPECT_THAT(profile.unconfirmed, IsEmpty());
}

TEST(DriveShippedProfiles, TheRxHasTheLineOfItsManual)
{
  const Profile profile = loadProfile("omron_rx", profileDirectory());
  EXPECT_EQ(profile.last_station, 32U);
  EXPECT_THAT(profile.baud_rates, ElementsAre(2400, 4800, 9600, 19200));
  EXPECT_EQ(profile.read_registers, 4U);
  EXPECT_EQ(profile.write_registers, 4U);
  EXPECT_THAT(profile.functions, testing::Not(Contains(0x17)));
  EXPECT_THAT(profile.unconfirmed,
              ElementsAre("current_scale", "dc_bus_voltage", "heatsink_temperature", "store_busy"));
}

TEST(DriveShippedProfiles, RunIsTheLastStepAndStopIsOne)
{
  for (const char* name : { "omron_mx2", "omron_rx" })
  {
    const Drive drive = shipped(name);
    for (const char* motion : { "forward", "reverse" })
    {
      const Sequence* sequence = drive.sequence(motion);
      ASSERT_NE(sequence, nullptr) << name;
      ASSERT_EQ(sequence->steps.size(), 3U);
      EXPECT_EQ(sequence->steps[0].point, "frequency");
      EXPECT_FALSE(sequence->steps[0].value.has_value());
      EXPECT_EQ(sequence->steps[1].point, "direction");
      EXPECT_EQ(*sequence->steps[1].value, std::string(motion) == "reverse" ? 1U : 0U);
      EXPECT_EQ(sequence->steps[2].point, "run");
      EXPECT_EQ(*sequence->steps[2].value, 1U);
    }
    ASSERT_NE(drive.sequence("stop"), nullptr);
    ASSERT_EQ(drive.sequence("stop")->steps.size(), 1U);
    EXPECT_NE(drive.sequence("reset"), nullptr);
    EXPECT_EQ(drive.sequence("coast"), nullptr);
    EXPECT_EQ(drive.sequence("quick"), nullptr);
    EXPECT_EQ(drive.missingFor("coast"), "");
  }
}

TEST(DriveShippedProfiles, TheMx2TableHasTheAddressesOfTheManuals)
{
  expectPlaces(
      loadProfile("omron_mx2", profileDirectory()),
      { { "F001", 0x0001, 2, 0.01, "Hz" },  { "F002", 0x1103, 2, 0.01, "s" },  { "F003", 0x1105, 2, 0.01, "s" },
        { "F203", 0x2105, 2, 0.01, "s" },   { "A001", 0x1201, 1, 1.0, "" },    { "A003", 0x1203, 1, 0.1, "Hz" },
        { "A004", 0x1204, 1, 0.1, "Hz" },   { "A020", 0x1216, 2, 0.01, "Hz" }, { "A021", 0x1218, 2, 0.01, "Hz" },
        { "A035", 0x1234, 2, 0.01, "Hz" },  { "A061", 0x124F, 2, 0.01, "Hz" }, { "A145", 0x12B3, 2, 0.01, "Hz" },
        { "b001", 0x1301, 1, 1.0, "" },     { "b012", 0x130D, 1, 0.1, "%" },   { "b212", 0x230C, 1, 0.1, "%" },
        { "b053", 0x1337, 2, 1.0, "" },     { "b082", 0x1355, 1, 0.01, "Hz" }, { "C071", 0x144B, 1, 1.0, "" },
        { "C077", 0x1451, 1, 0.01, "s" },   { "C078", 0x1452, 1, 1.0, "ms" },  { "H024", 0x151D, 2, 1.0, "" },
        { "P044", 0x162E, 1, 0.01, "s" },   { "P067", 0x164C, 2, 1.0, "" },    { "P131", 0x1685, 1, 1.0, "" },
        { "P400", 0x16F1, 1, 1.0, "" },     { "d002", 0x1003, 1, 0.01, "A" },  { "d013", 0x1011, 1, 0.1, "V" },
        { "d018", 0x1019, 1, 0.1, "degC" }, { "d102", 0x1026, 1, 0.1, "V" },   { "d086", 0x0044, 1, 1.0, "" } });
}

TEST(DriveShippedProfiles, TheRxTableDiffersWhereItsManualDoes)
{
  const Profile profile = loadProfile("omron_rx", profileDirectory());
  expectPlaces(profile, { { "A003", 0x1203, 1, 1.0, "Hz" },
                          { "A004", 0x1204, 1, 1.0, "Hz" },
                          { "d002", 0x1003, 1, 0.1, "A" },
                          { "C073", 0x144D, 1, 1.0, "" },
                          { "C079", 0x1453, 1, 1.0, "" },
                          { "A320", 0x3216, 2, 0.01, "Hz" },
                          { "F302", 0x3103, 2, 0.01, "s" } });
  EXPECT_EQ(profile.parameters.count("C096"), 0U);
  EXPECT_EQ(profile.parameters.count("P400"), 0U);
  EXPECT_EQ(profile.parameters.at("C072").range->second, 32.0);
}

TEST(DriveShippedProfiles, SupervisionKnowsTheSettingsThatMatter)
{
  for (const char* name : { "omron_mx2", "omron_rx" })
  {
    const Profile profile = loadProfile(name, profileDirectory());
    ASSERT_EQ(profile.command_source.size(), 2U);
    EXPECT_EQ(profile.command_source[0].parameter, "A001");
    EXPECT_THAT(profile.command_source[0].accept, ElementsAre(3));
    ASSERT_EQ(profile.self_restart.size(), 2U);
    EXPECT_EQ(profile.self_restart[1].parameter, "b008");
    EXPECT_THAT(profile.communication_loss.runs_on, ElementsAre(2));
  }
}

TEST(DriveShippedProfiles, TheCommunicationLossOfAnRxIsAssumedUntilItsParametersAreConfirmed)
{
  const Profile mx2 = loadProfile("omron_mx2", profileDirectory());
  EXPECT_EQ(mx2.communication_loss.timeout_parameter, "C077");
  EXPECT_EQ(mx2.communication_loss.action_parameter, "C076");
  EXPECT_EQ(mx2.reply_delay_parameter, "C078");

  const Profile rx = loadProfile("omron_rx", profileDirectory());
  EXPECT_EQ(rx.communication_loss.timeout_parameter, "");
  EXPECT_EQ(rx.communication_loss.assumed_action, "runs_on");
  EXPECT_EQ(rx.reply_delay_parameter, "");

  ProfileChanges changes;
  changes.confirm = { "parameter_C076", "parameter_C077", "parameter_C078" };
  const Profile confirmed = loadProfile("omron_rx", profileDirectory(), changes);
  EXPECT_EQ(confirmed.communication_loss.timeout_parameter, "C077");
  EXPECT_EQ(confirmed.reply_delay_parameter, "C078");
}

TEST(DriveShippedProfiles, TheStoreFlagOfAnRxIsNotAskedUntilConfirmed)
{
  EXPECT_FALSE(shipped("omron_rx").readStoreBusy(1).has_value());
  ProfileChanges changes;
  changes.confirm = { "store_busy" };
  EXPECT_TRUE(shipped("omron_rx", changes).readStoreBusy(1).has_value());
}

// --- what each drive does as shipped, and after what docs/commissioning.md has the user give ------------------------
TEST(DriveShippedProfiles, NoDriveHasAQuickStopThatMayTripIt)
{
  for (const std::string& name : knownProfiles(profileDirectory()))
  {
    EXPECT_EQ(shipped(name, changes({ "all" })).sequence("quick"), nullptr) << name;
    EXPECT_FALSE(shipped(name, changes({ "all" })).runsWithoutStop()) << name;
  }
}

TEST(DriveShippedProfiles, AVfs15IsArmedAsShipped)
{
  const Drive drive = shipped("toshiba_vfs15");
  EXPECT_THAT(armed(drive), UnorderedElementsAre("forward", "reverse", "stop", "coast", "reset", "release", "connect"));
  EXPECT_THAT(drive.profile().unconfirmed, ElementsAre("dc_voltage_base"));
  EXPECT_FALSE(drive.reports("dc_voltage"));
  EXPECT_TRUE(drive.reports("output_current"));
  EXPECT_TRUE(shipped("toshiba_vfs15", changes({ "dc_voltage_base" })).reports("dc_voltage"));
}

TEST(DriveShippedProfiles, AVfs11DoesNothingAsShipped)
{
  const Drive bare = shipped("toshiba_vfs11");
  EXPECT_THAT(armed(bare), IsEmpty());
  for (const auto& field : bare.profile().status)
  {
    EXPECT_FALSE(bare.reports(field.first)) << field.first;
  }
  EXPECT_FALSE(bare.findParameter("F803", false).has_value());
  EXPECT_EQ(bare.missingFor("forward"), "frequency_scale, run_forward, stop");
}

TEST(DriveShippedProfiles, AVfs11RunsAfterWhatCommissioningConfirms)
{
  const Drive drive = shipped("toshiba_vfs11", changes({ "status_bits", "frequency_scale", "stop", "run_forward",
                                                         "run_reverse", "fault_reset", "current_base" }));
  EXPECT_THAT(armed(drive), UnorderedElementsAre("forward", "reverse", "stop", "reset"));
  EXPECT_TRUE(drive.reports("output_current"));
  EXPECT_FALSE(drive.reports("output_voltage"));
  EXPECT_TRUE(drive.reports("faulted"));
  EXPECT_THAT(armed(shipped("toshiba_vfs11", changes({ "all" }))),
              UnorderedElementsAre("forward", "reverse", "stop", "coast", "reset", "release"));
}

TEST(DriveShippedProfiles, A7200MaOnlyStopsAsShipped)
{
  const Drive bare = shipped("teco_7200ma");
  EXPECT_THAT(armed(bare), ElementsAre("stop"));
  EXPECT_EQ(bare.missingFor("forward"), "frequency_scale, run_forward");
  EXPECT_EQ(bare.missingFor("reset"), "fault_reset");
  EXPECT_THAT(bare.armingAdvice("reverse"), testing::HasSubstr("'reverse_word'"));
  EXPECT_THAT(bare.profile().unconfirmed, testing::IsSupersetOf({ "run_forward", "run_reverse", "fault_reset",
                                                                  "frequency_scale", "monitor_base" }));
}

TEST(DriveShippedProfiles, A7200MaRunsAfterWhatCommissioningGives)
{
  const Drive drive = shipped("teco_7200ma", changes({ "run_forward", "fault_reset", "frequency_scale" },
                                                     "reverse_word: 2\nmonitor_base: 0x0020\n"
                                                     "spans: {registers: [[0x0020, 0x0027]]}\n"));
  EXPECT_THAT(armed(drive), UnorderedElementsAre("forward", "reverse", "stop", "reset"));
  EXPECT_TRUE(drive.reports("output_frequency"));
  EXPECT_EQ(drive.fastBlocks().size(), 1U) << "the span makes one read of two";
}

TEST(DriveShippedProfiles, A3G3JeCommandsNothingAsShipped)
{
  const Drive bare = shipped("omron_3g3je");
  EXPECT_THAT(armed(bare), IsEmpty());
  EXPECT_TRUE(bare.reports("output_frequency"));
  EXPECT_TRUE(bare.reports("raw_status"));
  EXPECT_FALSE(bare.reports("running"));
  EXPECT_FALSE(bare.reports("output_current"));
  for (const char* code :
       { "run_forward", "run_reverse", "stop", "fault_reset", "ram_write_mode", "setup_area_0", "setup_area_1" })
  {
    ASSERT_EQ(bare.profile().constants.count(code), 1U) << code;
    EXPECT_FALSE(bare.profile().constants.at(code).value.has_value()) << code;
  }
}

TEST(DriveShippedProfiles, A3G3JeRunsWithTheCodesOfItsOwner)
{
  // The codes are inventions of this test.
  const Drive drive = shipped("omron_3g3je", changes({ "current_scale", "controller_status_meaning" },
                                                     "operation_codes: {run_forward: \"AB01\", run_reverse: \"AB02\", "
                                                     "stop: \"AB00\", fault_reset: \"AB03\", ram_write_mode: "
                                                     "\"AB04\", setup_area_1: \"AB05\", setup_area_0: \"AB06\"}"));
  EXPECT_THAT(armed(drive),
              UnorderedElementsAre("forward", "reverse", "stop", "reset", "connect", "open_setup", "close_setup"));
  EXPECT_THAT(drive.profile().unconfirmed, IsEmpty());
  EXPECT_TRUE(drive.reports("running"));
  EXPECT_TRUE(drive.reports("output_current"));
}

TEST(DriveShippedProfiles, AWj200IsArmedAsShipped)
{
  const Drive drive = shipped("hitachi_wj200");
  EXPECT_THAT(armed(drive), UnorderedElementsAre("forward", "reverse", "stop", "reset", "store"));
  for (const char* field : { "run_seen", "operation", "running", "direction", "ready", "at_speed", "faulted",
                             "fault_code", "output_frequency", "output_current", "output_voltage", "dc_voltage" })
  {
    EXPECT_TRUE(drive.reports(field)) << field;
  }
  EXPECT_EQ(drive.profile().communication_loss.timeout_parameter, "");
  EXPECT_EQ(shipped("hitachi_wj200", changes({ "parameter_C077" })).profile().communication_loss.timeout_parameter,
            "C077");
}

TEST(DriveShippedProfiles, RunIsTheLastStepAndTheStopTheFirstEverywhere)
{
  const std::string codes = "operation_codes: {run_forward: \"AB01\", run_reverse: \"AB02\", stop: \"AB00\"}";
  for (const std::string& name : knownProfiles(profileDirectory()))
  {
    const std::string given = name == "omron_3g3je" ? codes : name == "teco_7200ma" ? "reverse_word: 2" : "{}";
    const Drive drive = shipped(name, changes({ "all" }, given));
    for (const char* motion : { "forward", "reverse" })
    {
      const Sequence* sequence = drive.sequence(motion);
      ASSERT_NE(sequence, nullptr) << name;
      EXPECT_EQ(sequence->steps.front().point, "frequency") << name;
      EXPECT_FALSE(sequence->steps.front().value.has_value()) << name;
      EXPECT_NE(sequence->steps.back().point, "frequency") << name;
      EXPECT_EQ(sequence->steps.back().point, drive.sequence("stop")->steps.front().point) << name;
    }
  }
}

// --- the lines ---------------------------------------------------------------------------------------------------------
TEST(DriveShippedProfiles, TheVfs15HasTheLineOfItsManual)
{
  const Profile profile = loadProfile("toshiba_vfs15", profileDirectory());
  EXPECT_EQ(profile.protocol, "modbus_rtu");
  EXPECT_EQ(profile.first_station, 1U);
  EXPECT_EQ(profile.last_station, 247U);
  EXPECT_THAT(profile.baud_rates, ElementsAre(9600, 19200, 38400));
  EXPECT_THAT(profile.data_bits, ElementsAre(8));
  EXPECT_THAT(profile.functions, ElementsAre(0x03, 0x06, 0x10, 0x17));
  EXPECT_EQ(profile.read_registers, 8U);
  EXPECT_EQ(profile.hole, 0x8000);
  EXPECT_TRUE(profile.decimal_numbers);
  EXPECT_EQ(profile.writes, Writes::Eeprom);
  EXPECT_EQ(profile.reply_delay_parameter, "F805");
  EXPECT_GE(profile.deaf_after_reset, 1.0);
  EXPECT_DOUBLE_EQ(profile.reply_delay, 0.01);
}

TEST(DriveShippedProfiles, TheVfs11HasWhatLinuxCncsDriverUses)
{
  const Profile profile = loadProfile("toshiba_vfs11", profileDirectory());
  EXPECT_THAT(profile.functions, ElementsAre(0x03, 0x06));
  EXPECT_EQ(profile.read_registers, 1U);
  EXPECT_EQ(profile.write_registers, 1U);
  EXPECT_THAT(profile.baud_rates, Contains(9600U));
  EXPECT_FALSE(profile.block.has_value());
  EXPECT_FALSE(profile.hole.has_value());
  EXPECT_EQ(profile.writes, Writes::Unknown);
  EXPECT_GE(profile.deaf_after_reset, 2.0);
}

TEST(DriveShippedProfiles, The7200MaHasTheLineOfItsManual)
{
  const Profile profile = loadProfile("teco_7200ma", profileDirectory());
  EXPECT_EQ(profile.first_station, 1U);
  EXPECT_EQ(profile.last_station, 31U);
  EXPECT_THAT(profile.baud_rates, ElementsAre(1200, 2400, 4800, 9600));
  EXPECT_THAT(profile.characters, ElementsAre("8E1", "8N2", "8O1"));
  EXPECT_THAT(profile.functions, ElementsAre(0x03, 0x08, 0x10));
  EXPECT_EQ(profile.read_registers, 16U);
  EXPECT_EQ(profile.write_registers, 16U);
  EXPECT_DOUBLE_EQ(profile.reply_delay, 0.005);
  EXPECT_TRUE(profile.broadcast_stop);
  EXPECT_EQ(profile.writes, Writes::Unknown);
  EXPECT_DOUBLE_EQ(profile.communication_loss.assumed_timeout, 1.0);
  EXPECT_EQ(profile.communication_loss.assumed_action, "decelerate");
  EXPECT_TRUE(profile.communication_loss.also_idle);
  ASSERT_TRUE(profile.keep_alive.has_value());
  EXPECT_EQ(profile.keep_alive->address, 0x0000);
  EXPECT_THAT(profile.faults, IsEmpty()) << "no text of a trip of this drive is known";
}

TEST(DriveShippedProfiles, The3G3JeHasTheLineOfItsManual)
{
  const Profile profile = loadProfile("omron_3g3je", profileDirectory());
  EXPECT_EQ(profile.protocol, "compoway_f");
  EXPECT_EQ(profile.first_station, 0U);
  EXPECT_EQ(profile.last_station, 99U);
  EXPECT_THAT(profile.baud_rates, ElementsAre(2400, 4800, 9600, 19200));
  EXPECT_THAT(profile.data_bits, ElementsAre(7, 8));
  EXPECT_THAT(profile.functions, ElementsAre(0x0101, 0x0102, 0x0503, 0x0601, 0x0801, 0x3005));
  EXPECT_EQ(profile.read_registers, 2U);
  EXPECT_EQ(profile.write_registers, 2U);
  EXPECT_EQ(profile.frame, 40U);
  EXPECT_DOUBLE_EQ(profile.maximum_frequency, 120.0);
  EXPECT_FALSE(profile.broadcast_stop);
  EXPECT_EQ(profile.communication_loss.assumed_action, "runs_on");
  EXPECT_DOUBLE_EQ(profile.communication_loss.assumed_timeout, 0.0);
  ASSERT_EQ(profile.identity.size(), 1U);
  EXPECT_EQ(profile.identity[0].model, "3G3JE");
  EXPECT_EQ(shipped("omron_3g3je").exceptionText(0x1103), "response code 1103: start address out of range");
}

TEST(DriveShippedProfiles, TheWj200HasTheLineOfItsManual)
{
  const Profile profile = loadProfile("hitachi_wj200", profileDirectory());
  EXPECT_EQ(profile.last_station, 247U);
  EXPECT_EQ(profile.read_registers, 16U);
  EXPECT_THAT(profile.functions, ElementsAre(0x01, 0x03, 0x05, 0x06, 0x08, 0x0F, 0x10, 0x17));
  EXPECT_EQ(profile.writes, Writes::Ram);
  EXPECT_DOUBLE_EQ(profile.maximum_frequency, 400.0);
  EXPECT_EQ(profile.communication_loss.assumed_action, "runs_on");
}

// --- the tables --------------------------------------------------------------------------------------------------------
TEST(DriveShippedProfiles, TheVfs15TableHasTheNumbersOfItsManual)
{
  const Profile profile = loadProfile("toshiba_vfs15", profileDirectory());
  expectPlaces(profile,
               { { "CMOD", 0x0003, 1, 1.0, "" },  { "FMOD", 0x0004, 1, 1.0, "" },  { "ACC", 0x0009, 1, 0.1, "s" },
                 { "dEC", 0x0010, 1, 0.1, "s" },  { "FH", 0x0011, 1, 0.01, "Hz" }, { "UL", 0x0012, 1, 0.01, "Hz" },
                 { "vL", 0x0014, 1, 0.01, "Hz" }, { "vLv", 0x0409, 1, 0.1, "V" },  { "tHr", 0x0600, 1, 1.0, "%" },
                 { "F301", 0x0301, 1, 1.0, "" },  { "F303", 0x0303, 1, 1.0, "" },  { "F500", 0x0500, 1, 0.1, "s" },
                 { "F800", 0x0800, 1, 1.0, "" },  { "F801", 0x0801, 1, 1.0, "" },  { "F802", 0x0802, 1, 1.0, "" },
                 { "F803", 0x0803, 1, 0.1, "s" }, { "F804", 0x0804, 1, 1.0, "" },  { "F805", 0x0805, 1, 0.01, "s" },
                 { "F870", 0x0870, 1, 1.0, "" },  { "F879", 0x0879, 1, 1.0, "" },  { "F899", 0x0899, 1, 1.0, "" },
                 { "FB07", 0xFB07, 1, 1.0, "" },  { "FD45", 0xFD45, 1, 1.0, "" },  { "FD46", 0xFD46, 1, 1.0, "" },
                 { "FE70", 0xFE70, 1, 0.1, "A" }, { "FE71", 0xFE71, 1, 0.1, "V" } },
               0);
  EXPECT_EQ(profile.rated_current_parameter, "FE70");
  EXPECT_EQ(profile.rated_voltage_parameter, "FE71");
  EXPECT_EQ(profile.parameters.at("FH").while_running, false);
  for (const char* serial : { "F800", "F801", "F802", "F829" })
  {
    EXPECT_TRUE(profile.parameters.at(serial).communication) << serial;
  }
  EXPECT_EQ(profile.parameters.count("F738"), 0U) << "the password";
}

TEST(DriveShippedProfiles, TheVfs15MonitorsHaveTheNumbersOfItsManual)
{
  const Profile profile = loadProfile("toshiba_vfs15", profileDirectory());
  struct Monitored
  {
    const char* field;
    unsigned number;
    double resolution;
    Base base;
  };
  for (const Monitored& monitored :
       { Monitored{ "output_frequency", 0xFD00, 0.01, Base::None }, Monitored{ "raw_status", 0xFD01, 1.0, Base::None },
         Monitored{ "output_current", 0xFD03, 0.01, Base::RatedCurrent },
         Monitored{ "output_voltage", 0xFD05, 0.01, Base::RatedVoltage },
         Monitored{ "torque", 0xFD18, 0.01, Base::None }, Monitored{ "fault_code", 0xFC90, 1.0, Base::None },
         Monitored{ "warning_code", 0xFC91, 1.0, Base::None }, Monitored{ "run_seen", 0xFA00, 1.0, Base::None },
         Monitored{ "restarted", 0xFA87, 1.0, Base::None } })
  {
    const Item& item = profile.status.at(monitored.field);
    EXPECT_EQ(item.number, monitored.number) << monitored.field;
    EXPECT_EQ(item.address, monitored.number) << monitored.field;
    EXPECT_DOUBLE_EQ(item.resolution, monitored.resolution) << monitored.field;
    EXPECT_EQ(item.base, monitored.base) << monitored.field;
  }
  EXPECT_EQ(profile.when_faulted.count("fault_code"), 1U);
}

TEST(DriveShippedProfiles, TheVfs15BlockIsThatOfItsManual)
{
  const Profile profile = loadProfile("toshiba_vfs15", profileDirectory());
  ASSERT_TRUE(profile.block.has_value());
  EXPECT_THAT(profile.block->read_slots, ElementsAre("F875", "F876", "F877", "F878", "F879"));
  EXPECT_THAT(profile.block->write_slots, ElementsAre("F870", "F871"));
  EXPECT_THAT(profile.block->select, ElementsAre(testing::Pair("command", 1U), testing::Pair("frequency", 3U)));
  EXPECT_EQ(profile.block->apply_parameter, "F899");
  EXPECT_EQ(profile.block->apply_value, 1U);
  // Code 13: p27 prints FE90, the value at the last trip; the table of monitors has FD90 for the present one.
  const unsigned numbers[] = { 0xFD01, 0xFD00, 0xFD03, 0xFD05, 0xFC91, 0xFD22, 0xFD06,
                               0xFD07, 0xFE35, 0xFE36, 0xFE37, 0xFD04, 0xFD90, 0xFD18 };
  ASSERT_EQ(profile.block->codes.size(), 15U);
  EXPECT_FALSE(profile.block->codes.at(0).item.has_value());
  for (unsigned code = 1; code <= 14; ++code)
  {
    ASSERT_TRUE(profile.block->codes.at(code).item.has_value()) << code;
    EXPECT_EQ(profile.block->codes.at(code).item->number, numbers[code - 1]) << code;
  }
}

TEST(DriveShippedProfiles, TheVfs15KnowsItsTripsAndAlarms)
{
  const Drive drive = shipped("toshiba_vfs15");
  // E6581913 p63: what a panel shows, in its order.
  const std::map<std::uint16_t, std::string> trips = {
    { 1, "OC1" },   { 2, "OC2" },   { 3, "OC3" },   { 4, "OCL" },   { 5, "OCA" },   { 8, "EPH1" },  { 10, "OP1" },
    { 11, "OP2" },  { 12, "OP3" },  { 13, "OL1" },  { 14, "OL2" },  { 15, "OLr" },  { 16, "OH" },   { 17, "E " },
    { 21, "Err2" }, { 22, "Err3" }, { 23, "Err4" }, { 24, "Err5" }, { 29, "UC" },   { 30, "UP1" },  { 32, "Ot" },
    { 34, "EF2" },  { 40, "Etn" },  { 41, "EtYP" }, { 45, "E-13" }, { 46, "OH2" },  { 47, "SOUt" }, { 50, "E-18" },
    { 58, "E-26" }, { 62, "OL3" },  { 71, "E-39" }, { 72, "OtC3" }, { 84, "Etn1" }, { 87, "E-27" }
  };
  for (const auto& [code, name] : trips)
  {
    EXPECT_THAT(drive.faultText(code), testing::StartsWith(name)) << code;
  }
  for (const int unused : { 6, 7, 25, 31, 33, 88, 255 })
  {
    EXPECT_EQ(drive.faultText(static_cast<std::uint16_t>(unused)), "unknown trip " + std::to_string(unused));
  }
  EXPECT_EQ(drive.faultText(0), "");
  // p61: several alarms at once are all named.
  EXPECT_THAT(drive.warningText(0x0006),
              testing::AllOf(testing::HasSubstr("inverter overload"), testing::HasSubstr("motor overload")));
  EXPECT_EQ(drive.warningText(0x2000).find("unknown"), std::string::npos);
  EXPECT_EQ(drive.warningText(0), "");
}

TEST(DriveShippedProfiles, BorrowedTripTextsSayThatTheyAre)
{
  EXPECT_THAT(shipped("toshiba_vfs11").faultText(16), testing::HasSubstr("(unconfirmed for this drive)"));
  EXPECT_THAT(shipped("toshiba_vfs11", changes({ "trip_texts" })).faultText(16),
              testing::Not(testing::HasSubstr("unconfirmed")));
  EXPECT_THAT(shipped("hitachi_wj200").faultText(9), testing::HasSubstr("(unconfirmed for this drive)"));
}

TEST(DriveShippedProfiles, The3G3JeTableHasTheAddressesOfItsManual)
{
  const Profile profile = loadProfile("omron_3g3je", profileDirectory());
  struct Element
  {
    const char* name;
    unsigned number;
    double resolution;
    double lowest;
    double highest;
  };
  for (const Element& element : { Element{ "P01", 0x0000, 0.1, 0.0, 2.5 }, Element{ "P02", 0x0001, 0.1, 0.0, 99.9 },
                                  Element{ "P05", 0x0004, 0.1, 0.0, 10.0 }, Element{ "P06", 0x0005, 0.1, 50.0, 120.0 },
                                  Element{ "P07", 0x0006, 0.1, 0.1, 120.0 }, Element{ "P08", 0x0007, 0.1, 0.0, 120.0 },
                                  Element{ "P09", 0x0008, 1.0, 0.0, 2.0 }, Element{ "P10", 0x0009, 1.0, 0.0, 1.0 } })
  {
    const Parameter& parameter = profile.parameters.at(element.name);
    EXPECT_EQ(parameter.item.space, Space::Variable) << element.name;
    EXPECT_EQ(parameter.item.area, 0xC3) << element.name;
    EXPECT_EQ(parameter.item.number, element.number) << element.name;
    EXPECT_DOUBLE_EQ(parameter.item.resolution, element.resolution) << element.name;
    ASSERT_TRUE(parameter.range.has_value()) << element.name;
    EXPECT_DOUBLE_EQ(parameter.range->first, element.lowest) << element.name;
    EXPECT_DOUBLE_EQ(parameter.range->second, element.highest) << element.name;
    EXPECT_TRUE(parameter.setup) << element.name;
  }
}

TEST(DriveShippedProfiles, TheWj200TableHasTheNumbersOfItsManual)
{
  const Profile profile = loadProfile("hitachi_wj200", profileDirectory());
  expectPlaces(profile, { { "F001", 0x0001, 2, 0.01, "Hz" },
                          { "d001", 0x1001, 2, 0.01, "Hz" },
                          { "d002", 0x1003, 1, 0.01, "A" },
                          { "d081", 0x0012, 1, 1.0, "" },
                          { "A001", 0x1201, 1, 1.0, "" },
                          { "A002", 0x1202, 1, 1.0, "" },
                          { "A021", 0x1218, 2, 0.01, "Hz" },
                          { "b001", 0x1301, 1, 1.0, "" } });
  EXPECT_TRUE(profile.parameters.at("F001").read_only);
}

TEST(DriveShippedProfiles, A7200MaParameterHasNoPlaceUntilItsOwnerGivesIt)
{
  const Drive drive = shipped("teco_7200ma", changes({ "all" }));
  ASSERT_FALSE(drive.profile().parameters.empty());
  for (const auto& entry : drive.profile().parameters)
  {
    EXPECT_FALSE(drive.findParameter(entry.first, false).has_value()) << entry.first;
    EXPECT_FALSE(drive.findParameter(entry.first, true).has_value()) << entry.first;
  }
  EXPECT_TRUE(drive.findParameter("0x0020", false).has_value()) << "looking for them must be possible";
}

TEST(DriveShippedProfiles, SupervisionOfTheToshibaDrivesJudgesOnlyWhileCommanded)
{
  const Profile profile = loadProfile("toshiba_vfs15", profileDirectory());
  ASSERT_EQ(profile.command_source.size(), 2U);
  EXPECT_EQ(profile.command_source[0].parameter, "FD45");
  EXPECT_THAT(profile.command_source[0].accept, ElementsAre(2));
  EXPECT_TRUE(profile.command_source[0].when_commanded);
  EXPECT_EQ(profile.command_source[1].parameter, "FD46");
  EXPECT_THAT(profile.command_source[1].accept, ElementsAre(4));
  ASSERT_EQ(profile.identity.size(), 1U);
  EXPECT_EQ(profile.identity[0].parameter, "FB07");
  EXPECT_THAT(profile.identity[0].accept, ElementsAre(224));
  EXPECT_EQ(profile.communication_loss.timeout_parameter, "F803");
  EXPECT_EQ(profile.communication_loss.action_parameter, "F804");
  EXPECT_THAT(profile.communication_loss.runs_on, ElementsAre(0));
  EXPECT_EQ(loadProfile("toshiba_vfs11", profileDirectory()).communication_loss.assumed_action, "runs_on");
}
}  // namespace
}  // namespace drive
}  // namespace inverter_bus
