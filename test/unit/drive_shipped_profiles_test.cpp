// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
// The profiles that come with the package, against the makers' documents.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "drive_fixture.h"

namespace inverter_bus
{
namespace drive
{
namespace
{
using testing::Contains;
using testing::ElementsAre;
using testing::IsEmpty;

struct Place
{
  const char* name;
  unsigned number;
  unsigned words;
  double resolution;
  const char* unit;
};

void expectPlaces(const Profile& profile, const std::vector<Place>& places)
{
  for (const Place& place : places)
  {
    const auto found = profile.parameters.find(place.name);
    ASSERT_NE(found, profile.parameters.end()) << place.name;
    const Item& item = found->second.item;
    EXPECT_EQ(item.number, place.number) << place.name;
    EXPECT_EQ(item.address, place.number - 1) << place.name;
    EXPECT_EQ(item.size, place.words) << place.name;
    EXPECT_DOUBLE_EQ(item.resolution, place.resolution) << place.name;
    EXPECT_EQ(item.unit, place.unit) << place.name;
  }
}

TEST(DriveShippedProfiles, AreFreeOfMistakes)
{
  const std::vector<std::string> names = knownProfiles(profileDirectory());
  EXPECT_THAT(names, Contains("omron_mx2"));
  EXPECT_THAT(names, Contains("omron_rx"));
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
}  // namespace
}  // namespace drive
}  // namespace inverter_bus
