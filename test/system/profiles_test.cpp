// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

// Drives that are a profile and nothing else: no line of code knows them. What counts is what the simulated motor does.

#include <gmock/gmock.h>

#include "support/drive_fixture.h"
#include "support/virtual_bus.h"

namespace inverter_bus
{
namespace
{
using ::testing::HasSubstr;

/// The WJ200 is the MX2 under its maker's name.
const char* const WJ200 = R"(
port: /dev/virtual
baud_rate: 19200
scan_list:
  - {name: motor, node: 1, drive: hitachi_wj200}
simulation:
  motor: {model: omron_mx2}
)";

/// 9600 8E1: how the port of a VF-S11 leaves the factory.
const char* const VFS11 = R"(
port: /dev/virtual
baud_rate: 9600
parity: even
scan_list:
  - {name: motor, node: 1, drive: toshiba_vfs11, confirm: [all]}
)";

/// What a user could write for an MX2, with the addresses as they are sent (MX2 manuals, counted from 0).
const char* const USERS_PROFILE = R"(drive: my_mx2
title: My own idea of an MX2
protocol: modbus_rtu
numbering: {register_offset: 0, coil_offset: 0}
stations: {first: 1, last: 31}
serial: {baud_rates: [9600, 19200], characters: [8N1, 8E1]}
limits: {functions: [0x01, 0x03, 0x05, 0x10], read_registers: 4, write_registers: 2, read_coils: 24}
spans: {coils: [[0x0000, 0x001F]]}
frequency: {maximum: 60.0}
constants:
  on: {value: 1}
points:
  frequency: {register: 0x0000, words: 2, resolution: 0.01, unit: Hz}
  run: {coil: 0x0000}
  direction: {coil: 0x0001}
  trip_reset: {coil: 0x0003}
sequences:
  forward: [{frequency: setpoint}, {direction: 0}, {run: on}]
  reverse: [{frequency: setpoint}, {direction: on}, {run: on}]
  stop: [{run: 0}]
  reset: [{trip_reset: on, pause: 0.1}, {trip_reset: 0}]
status:
  run_seen: {coil: 0x0000}
  running: {coil: 0x0012}
  faulted: {coil: 0x0017}
  fault_code: {register: 0x0011, when: faulted}
  output_frequency: {register: 0x1000, words: 2, resolution: 0.01, unit: Hz}
  direction: {register: 0x1003, values: {0: 0, 1: 1, 2: -1}}
faults:
  table: {9: undervoltage, 12: my own words for it}
timing: {deaf_after_reset: 1.0}
parameters:
  ramp_up: {register: 0x1102, words: 2, resolution: 0.01, unit: s, range: [0.01, 3600]}
drive_timeout: 0.0
drive_loss_action: runs_on
)";

std::string usersBus(const std::string& profile)
{
  return "port: /dev/virtual\nbaud_rate: 19200\nscan_list:\n  - {name: motor, node: 1, drive: " + profile +
         "}\nsimulation:\n  motor: {model: omron_mx2}\n";
}

/// Ramps of ten seconds up to the highest frequency: nothing takes longer than this.
constexpr double RAMP = 25.0;

void settle(VirtualBus& bus)
{
  bus.settleIn();
  bus.run(5.0);  // all settings read
  bus.clearFrames();
}

void expectMotor(VirtualBus& bus, double frequency, int direction)
{
  EXPECT_NEAR(bus.motor("motor", "frequency"), frequency, 0.02);
  EXPECT_EQ(bus.motor("motor", "direction"), direction);
  ASSERT_TRUE(bus.status(0).monitor.output_frequency.has_value());
  EXPECT_NEAR(*bus.status(0).monitor.output_frequency, frequency, 0.02);
  EXPECT_EQ(bus.status(0).monitor.direction, direction);
  EXPECT_EQ(bus.status(0).monitor.running, frequency > 0.0);
}

void runsChangesReversesAndStops(VirtualBus& bus)
{
  settle(bus);
  bus.stream(0, 20.0, 0.1, RAMP);
  bus.run(RAMP);
  expectMotor(bus, 20.0, 1);
  bus.stream(0, 35.0, 0.1, RAMP);
  bus.run(RAMP);
  expectMotor(bus, 35.0, 1);
  bus.stream(0, -12.5, 0.1, 2 * RAMP);
  bus.run(2 * RAMP);
  expectMotor(bus, 12.5, -1);
  const bus::Answer answer = bus.wait(bus.stop(0));
  EXPECT_TRUE(answer.success) << answer.message;
  bus.run(RAMP);
  expectMotor(bus, 0.0, 0);
  EXPECT_FALSE(bus.status(0).communication_error);
  EXPECT_EQ(bus.line().counters().timeouts, 0U);
  EXPECT_EQ(bus.line().counters().exceptions, 0U);
}

void tripsAndIsReset(VirtualBus& bus, int code, const std::string& text)
{
  settle(bus);
  bus.stream(0, 20.0, 0.1, 3.0);
  bus.run(3.0);
  ASSERT_GT(bus.motor("motor", "frequency"), 1.0);
  bus.world("motor trip " + std::to_string(code));
  EXPECT_TRUE(bus.runUntil(2.0, [&] { return bus.status(0).monitor.faulted.value_or(false); }));
  EXPECT_TRUE(bus.runUntil(2.0, [&] { return bus.status(0).monitor.fault_code == code; }));
  EXPECT_THAT(bus.diagnostics(0), HasSubstr(text));
  bus.run(1.0);
  const bus::Answer answer = bus.wait(bus.reset(0));
  EXPECT_TRUE(answer.success) << answer.message;
  bus.run(5.0);
  EXPECT_EQ(bus.motor("motor", "tripped"), 0.0);
  EXPECT_EQ(bus.motor("motor", "frequency"), 0.0) << "a reset starts nothing";
  EXPECT_EQ(bus.status(0).monitor.faulted, false);
  // It can be run again, by a command that comes afterwards.
  bus.stream(0, 10.0, 0.1, RAMP);
  bus.run(RAMP);
  expectMotor(bus, 10.0, 1);
}

TEST(ProfilesAlone, aWj200RunsChangesReversesAndStops)
{
  VirtualBus bus(WJ200);
  runsChangesReversesAndStops(bus);
}

TEST(ProfilesAlone, aWj200TripsAndIsReset)
{
  VirtualBus bus(WJ200);
  tripsAndIsReset(bus, 12, "E12");
}

TEST(ProfilesAlone, aWj200TellsItsParametersByNameAndByNumber)
{
  VirtualBus bus(WJ200);
  settle(bus);
  const bus::Answer source = bus.wait(bus.readParameter(0, "A002"));
  EXPECT_TRUE(source.success) << source.message;
  EXPECT_DOUBLE_EQ(source.value, 3.0);
  // F002 is 10 s; its entry in the table is unconfirmed, the register may be read all the same (low word, 0.01 s).
  EXPECT_EQ(bus.wait(bus.readParameter(0, "F002")).error_id, bus::ERROR_NOT_ARMED);
  const bus::Answer raw = bus.wait(bus.readParameter(0, "0x1104"));
  EXPECT_TRUE(raw.success) << raw.message;
  EXPECT_DOUBLE_EQ(raw.value, 1000.0);
  bus.world("motor trip 9");
  bus.run(2.0);
  const bus::Answer faults = bus.wait(bus.readFaults(0));
  ASSERT_TRUE(faults.success) << faults.message;
  EXPECT_EQ(faults.present.code, 9);
  ASSERT_FALSE(faults.faults.empty());
  EXPECT_EQ(faults.faults[0].code, 9);
}

TEST(ProfilesAlone, aVfs11RunsChangesReversesAndStops)
{
  VirtualBus bus(VFS11);
  runsChangesReversesAndStops(bus);
  // LinuxCNC's driver, which is all that is known of it, reads one register at a time with 03H and writes with 06H.
  for (const std::string& request : bus.requests())
  {
    const bool read = request.compare(0, 5, "01 03") == 0 && request.compare(12, 5, "00 01") == 0;
    EXPECT_TRUE(read || request.compare(0, 5, "01 06") == 0) << request;
  }
}

TEST(ProfilesAlone, aVfs11TripsAndIsReset)
{
  VirtualBus bus(VFS11);
  tripsAndIsReset(bus, 16, "OH overheat");
}

TEST(ProfilesAlone, aVfs11TellsItsParameters)
{
  VirtualBus bus(VFS11);
  settle(bus);
  const bus::Answer acceleration = bus.wait(bus.readParameter(0, "ACC"));
  EXPECT_TRUE(acceleration.success) << acceleration.message;
  EXPECT_DOUBLE_EQ(acceleration.value, 10.0);
  EXPECT_EQ(acceleration.unit, "s");
  // Whether a write reaches the EEPROM is not known: the caller has to accept either.
  EXPECT_EQ(bus.wait(bus.writeParameter(0, "ACC", 5.0, true)).error_id, bus::ERROR_NOT_OFFERED);
}

TEST(ProfilesAlone, aVfs11AsShippedIsFoundAndNotCommanded)
{
  std::string yaml = VFS11;
  const std::string confirm = ", confirm: [all]";
  yaml.erase(yaml.find(confirm), confirm.size());
  VirtualBus bus(yaml);
  bus.run(3.0);
  EXPECT_FALSE(bus.status(0).communication_error);
  EXPECT_FALSE(bus.status(0).monitor.running.has_value());
  EXPECT_EQ(bus.command(0, 10.0), bus::ERROR_NOT_ARMED);
  bus.run(1.0);
  EXPECT_EQ(bus.count("01 06"), 0U);
  EXPECT_FALSE(bus.wait(bus.stop(0)).success) << "nobody knows how to stop it";
  EXPECT_EQ(bus.count("01 06"), 0U);
}

TEST(ProfilesAlone, aUsersOwnProfileRunsChangesReversesAndStops)
{
  const drive::ProfileFile file(USERS_PROFILE);
  VirtualBus bus(usersBus(file.path()));
  runsChangesReversesAndStops(bus);
}

TEST(ProfilesAlone, aUsersOwnProfileTripsAndIsReset)
{
  const drive::ProfileFile file(USERS_PROFILE);
  VirtualBus bus(usersBus(file.path()));
  tripsAndIsReset(bus, 12, "my own words for it");
}

TEST(ProfilesAlone, aUsersOwnProfileReadsAndWritesItsParameters)
{
  const drive::ProfileFile file(USERS_PROFILE);
  VirtualBus bus(usersBus(file.path()));
  settle(bus);
  const bus::Answer before = bus.wait(bus.readParameter(0, "ramp_up"));
  EXPECT_TRUE(before.success) << before.message;
  EXPECT_DOUBLE_EQ(before.value, 10.0);
  EXPECT_EQ(before.unit, "s");
  const bus::Answer written = bus.wait(bus.writeParameter(0, "ramp_up", 2.5, false));
  EXPECT_TRUE(written.success) << written.message;
  EXPECT_THAT(bus.world("motor get F002"), HasSubstr("ram=2.50"));
  EXPECT_EQ(bus.wait(bus.writeParameter(0, "ramp_up", 0.0, false)).error_id, bus::ERROR_OUT_OF_RANGE);
  EXPECT_FALSE(bus.wait(bus.readParameter(0, "F002")).success) << "a name of another profile";
  // It has no Enter command, so that nothing can be made to last.
  EXPECT_EQ(bus.wait(bus.writeParameter(0, "ramp_up", 3.0, true)).error_id, bus::ERROR_NOT_OFFERED);
}

TEST(ProfilesAlone, aUsersOwnProfileWithAMistakeStopsTheBusBeforeItStarts)
{
  const drive::ProfileFile file(drive::replaced(USERS_PROFILE, "  run: {coil: 0x0000}", "  run: {coil: 0x10000}"));
  try
  {
    const VirtualBus bus(usersBus(file.path()));
    ADD_FAILURE() << "a bus with a wrong profile must not start";
  }
  catch (const drive::ConfigurationError& error)
  {
    EXPECT_THAT(error.what(), HasSubstr(file.path() + ":14: key 'points.run.coil': value '0x10000'"));
  }
}
}  // namespace
}  // namespace inverter_bus
