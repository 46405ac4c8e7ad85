// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
// Fields that a user leaves out, and fields that a wrong unit leaves out.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "support/drive_fixture.h"

namespace inverter_bus
{
namespace drive
{
namespace
{
using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

ProfileChanges skipping(const std::vector<std::string>& names)
{
  ProfileChanges changes;
  changes.skip = names;
  return changes;
}

std::vector<ReadBlock> allReads(const Drive& drive)
{
  std::vector<ReadBlock> reads = drive.fastBlocks();
  reads.insert(reads.end(), drive.slowBlocks().begin(), drive.slowBlocks().end());
  reads.insert(reads.end(), drive.faultBlocks().begin(), drive.faultBlocks().end());
  return reads;
}

std::set<std::string> fieldsRead(const Drive& drive)
{
  std::set<std::string> fields;
  for (const ReadBlock& block : allReads(drive))
  {
    fields.insert(block.fields.begin(), block.fields.end());
  }
  return fields;
}

/// Whether a plain read covers the register with this printed number.
bool reads(const Drive& drive, std::uint16_t number)
{
  const std::vector<ReadBlock> blocks = allReads(drive);
  return std::any_of(blocks.begin(), blocks.end(), [number](const ReadBlock& block) {
    return block.space == Space::Register && block.number <= number && number < block.number + block.count;
  });
}

TEST(DriveSkip, ASkippedFieldIsNeitherReadNorReported)
{
  const Drive whole = shipped("omron_mx2");
  ASSERT_TRUE(reads(whole, 0x1019) && reads(whole, 0x1010) && reads(whole, 0x1011));
  const Drive drive = shipped("omron_mx2", skipping({ "temperature", "torque" }));
  EXPECT_FALSE(reads(drive, 0x1019));
  EXPECT_FALSE(reads(drive, 0x1010));
  EXPECT_TRUE(reads(drive, 0x1011)) << "output_voltage stays";
  EXPECT_FALSE(drive.reports("temperature"));
  EXPECT_FALSE(drive.reports("torque"));
  EXPECT_TRUE(drive.reports("output_voltage"));
  EXPECT_THAT(fieldsRead(drive), Not(Contains("temperature")));
}

TEST(DriveSkip, WhatIsUnconfirmedInItIsNotReported)
{
  EXPECT_THAT(shipped("toshiba_vfs15").unconfirmedText(), HasSubstr("dc_voltage_base"));
  EXPECT_EQ("", shipped("toshiba_vfs15", skipping({ "dc_voltage" })).unconfirmedText());
  EXPECT_THAT(shipped("omron_rx", skipping({ "dc_voltage" })).unconfirmedText(),
              AllOf(Not(HasSubstr("dc_bus_voltage")), HasSubstr("current_scale"), HasSubstr("heatsink_temperature")));
  EXPECT_EQ(
      "", shipped("omron_rx", skipping({ "dc_voltage", "output_current", "temperature", "store_busy", "trip_memory" }))
              .unconfirmedText());
  EXPECT_EQ("", shipped("hitachi_wj200", skipping({ "store_busy", "warning_code", "trip_memory" })).unconfirmedText());
}

TEST(DriveSkip, DiagnosticsSayWhatCanBeLeftOut)
{
  EXPECT_THAT(shipped("toshiba_vfs15").unconfirmedText(), HasSubstr("skip: [dc_voltage]"));
  EXPECT_THAT(shipped("omron_rx").unconfirmedText(),
              HasSubstr("skip: [dc_voltage, output_current, store_busy, temperature, trip_memory]"));
  ProfileChanges changes = skipping({ "dc_voltage", "temperature" });
  changes.confirm = { "current_scale" };
  EXPECT_THAT(shipped("omron_rx", changes).unconfirmedText(), HasSubstr("skip: [store_busy]"));
  // Whoever leaves out what it names is done, as long as no command waits.
  EXPECT_THAT(shipped("teco_7200ma").unconfirmedText(), Not(HasSubstr("faulted")));
}

TEST(DriveSkip, AMarkThatSomethingElseHasTooStaysReported)
{
  // trip_codes marks fault_code too, which can't be left out.
  EXPECT_THAT(shipped("toshiba_vfs11", skipping({ "warning_code" })).unconfirmedText(), HasSubstr("trip_codes"));
  // monitor_layout marks the DC voltage and the current.
  EXPECT_THAT(shipped("teco_7200ma", skipping({ "dc_voltage" })).unconfirmedText(), HasSubstr("monitor_layout"));
  EXPECT_THAT(shipped("teco_7200ma", skipping({ "dc_voltage", "output_current" })).unconfirmedText(),
              AllOf(Not(HasSubstr("monitor_layout")), HasSubstr("monitor_base")));
}

TEST(DriveSkip, AConstantThatOnlyASkippedFieldNeedsIsNotAskedFor)
{
  const std::string constant = "constants: {scale: {value: 0.1, unconfirmed: current_step}}\n";
  const std::string current = "  output_current: {register: 0x0110, resolution: scale, unit: A}\n";
  const std::string text = constant + replaced(smallProfile(), "faults:", current + "faults:");
  EXPECT_THAT(Drive(ProfileFile(text).load()).unconfirmedText(), HasSubstr("current_step"));
  EXPECT_EQ("", Drive(ProfileFile(text).load(skipping({ "output_current" }))).unconfirmedText());
  const std::string voltage = "  output_voltage: {register: 0x0111, resolution: scale, unit: V}\n";
  const std::string both = replaced(text, "faults:", voltage + "faults:");
  EXPECT_THAT(Drive(ProfileFile(both).load(skipping({ "output_current" }))).unconfirmedText(),
              HasSubstr("current_step"));
}

TEST(DriveSkip, AReadOfChosenWordsDoesNotBringItEither)
{
  ProfileChanges changes = skipping({ "output_current" });
  const Drive drive = shipped("toshiba_vfs15", changes);
  const auto block = drive.chosenRead({ 1, 2, 3, 4, 14 });
  ASSERT_TRUE(block.has_value());
  EXPECT_THAT(block->fields, Not(Contains("output_current")));
  EXPECT_THAT(block->fields, Contains("raw_status"));
  for (const ReadBlock& beside : drive.fastBlocksBeside(*block))
  {
    EXPECT_THAT(beside.fields, Not(Contains("output_current")));
  }
}

TEST(DriveSkip, AFieldThatOverridesDescribeCanBeSkippedToo)
{
  ProfileChanges changes = skipping({ "temperature" });
  changes.overrides = overridesOf("status: {temperature: {register: 0x1019, resolution: 1, unit: degC}}");
  EXPECT_FALSE(shipped("omron_mx2", changes).reports("temperature"));
}

TEST(DriveSkip, WhatADriveDoesNotHaveIsSkippedAlready)
{
  const Drive drive = shipped("omron_3g3je", skipping({ "temperature", "torque", "trip_memory", "store_busy" }));
  EXPECT_THAT(fieldsRead(drive), Contains("output_frequency"));
}

TEST(DriveSkip, TheTripMemoryKeepsItsCodes)
{
  const Drive drive = shipped("omron_mx2", skipping({ "trip_memory" }));
  ASSERT_EQ(shipped("omron_mx2").faultEntries(), drive.faultEntries());
  for (const auto& entry : drive.profile().history.entries)
  {
    ASSERT_EQ(1U, entry.size());
    EXPECT_EQ("code", entry.begin()->first);
  }
}

TEST(DriveSkip, EveryFieldIsEitherSkippableOrProtected)
{
  for (const std::string& name : knownProfiles(profileDirectory()))
  {
    const Drive drive = shipped(name);
    for (const auto& entry : drive.profile().status)
    {
      EXPECT_EQ(1U, skippableFields().count(entry.first) + protectedFields().count(entry.first)) << entry.first;
    }
  }
  for (const char* field :
       { "run_seen", "operation", "running", "direction", "output_frequency", "faulted", "fault_code", "restarted" })
  {
    EXPECT_EQ(1U, protectedFields().count(field)) << field;
  }
}

// --- units -----------------------------------------------------------------------------------------------------------

std::string withField(const std::string& line)
{
  return replaced(smallProfile(), "faults:", "  " + line + "\nfaults:");
}

TEST(DriveUnits, AFieldWithAnotherUnitIsNotShownAndNamed)
{
  for (const std::string& line : std::vector<std::string>{
           "output_current: {register: 0x0110, unit: mA}", "output_current: {register: 0x0110, unit: kA}",
           "output_current: {register: 0x0110, unit: \"\\u00b5A\"}", "output_current: {register: 0x0110, unit: \"%\"}",
           "output_current: {register: 0x0110, unit: \"%\", of: rated_voltage}",
           "output_voltage: {register: 0x0110, unit: \"%\", of: rated_current}",
           "torque: {register: 0x0110, unit: \"%\", of: rated_current}", "torque: {register: 0x0110, unit: Nm}",
           "dc_voltage: {register: 0x0110, unit: kV}", "temperature: {register: 0x0110, unit: K}",
           "temperature: {register: 0x0110, unit: degF}" })
  {
    const ProfileFile file(withField(line));
    const Drive drive(file.load());
    const std::string field = line.substr(0, line.find(':'));
    EXPECT_FALSE(drive.reports(field)) << line;
    EXPECT_FALSE(reads(drive, 0x0110)) << line;
    EXPECT_THAT(drive.profile().mistakes,
                ElementsAre(AllOf(HasSubstr(file.path() + ":"), HasSubstr("'status." + field + "'"),
                                  HasSubstr("allowed: "), HasSubstr("not shown"))))
        << line;
    EXPECT_THAT(checkProfile(file.path()), ElementsAre(HasSubstr("status." + field))) << line;
  }
}

TEST(DriveUnits, TheFieldsOwnUnitCanBeSpelledInSeveralWaysOrBeLeftOut)
{
  for (const std::string& line : std::vector<std::string>{
           "output_current: {register: 0x0110, unit: A}", "output_current: {register: 0x0110}",
           "output_current: {register: 0x0110, unit: \"%\", of: rated_current}",
           "output_voltage: {register: 0x0110, unit: \"%\", of: rated_voltage}",
           "temperature: {register: 0x0110, unit: degC}", "temperature: {register: 0x0110, unit: \"\\u00b0C\"}",
           "temperature: {register: 0x0110, unit: C}", "dc_voltage: {register: 0x0110, unit: v}",
           "torque: {register: 0x0110, unit: \"%\"}" })
  {
    const ProfileFile file(withField(line));
    const Drive drive(file.load());
    EXPECT_THAT(drive.profile().mistakes, IsEmpty()) << line;
    EXPECT_TRUE(drive.reports(line.substr(0, line.find(':')))) << line;
  }
}

TEST(DriveUnits, OverridesAreJudgedToo)
{
  ProfileChanges changes;
  changes.place = "~scan_list[0] (belt)";
  changes.overrides = overridesOf("status: {output_current: {resolution: 10, unit: mA}}");
  const Drive drive = shipped("omron_mx2", changes);
  EXPECT_FALSE(drive.reports("output_current"));
  EXPECT_TRUE(drive.reports("output_frequency"));
  EXPECT_THAT(drive.profile().mistakes, ElementsAre(AllOf(HasSubstr("output_current"), HasSubstr("'mA'"))));
}

TEST(DriveUnits, TheTripMemoryIsJudgedTooAndKeepsTheRest)
{
  const ProfileFile file(
      replaced(smallProfile(), "faults:",
               "faults:\n  history: {first: 0x0200, stride: 4, count: 2, fields: {code: {offset: 0}, output_current: "
               "{offset: 1, unit: mA}, run_hours: {offset: 2, unit: d}, power_on_hours: {offset: 3, unit: h}}}"));
  const Profile profile = file.load();
  EXPECT_EQ(2U, profile.mistakes.size());
  ASSERT_EQ(2U, profile.history.entries.size());
  EXPECT_EQ(1U, profile.history.entries[0].count("code"));
  EXPECT_EQ(1U, profile.history.entries[0].count("power_on_hours"));
  EXPECT_EQ(0U, profile.history.entries[0].count("output_current"));
  EXPECT_EQ(0U, profile.history.entries[0].count("run_hours"));
}

TEST(DriveUnits, ASetPointInAnotherUnitIsAnError)
{
  // The motor would turn at another speed than commanded: nothing that a warning mends.
  const ProfileFile file(replaced(smallProfile(), "  frequency: {register: 0x0001, resolution: 0.01, unit: Hz}",
                                  "  frequency: {register: 0x0001, resolution: 0.01, unit: rpm}"));
  EXPECT_THROW(file.load(), ConfigurationError);
  EXPECT_THAT(checkProfile(file.path()), ElementsAre(AllOf(HasSubstr("points.frequency"), HasSubstr("'rpm'"))));
}

TEST(DriveUnits, ShippedProfilesHaveNoSuchMistake)
{
  for (const std::string& name : knownProfiles(profileDirectory()))
  {
    EXPECT_THAT(shipped(name).profile().mistakes, IsEmpty()) << name;
  }
}
}  // namespace
}  // namespace drive
}  // namespace inverter_bus
