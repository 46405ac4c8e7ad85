// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

// Four brands on one line, 9600 8E1: the one setting that suits them all.

#include <cmath>

#include "support/virtual_bus.h"

namespace inverter_bus
{
namespace
{
constexpr std::size_t BELT = 0;     // MX2
constexpr std::size_t CRUSHER = 1;  // RX
constexpr std::size_t PUMP = 2;     // VF-S15
constexpr std::size_t MIXER = 3;    // 7200MA
constexpr std::size_t DRIVES = 4;

const char* const NAMES[] = { "belt", "crusher", "pump", "mixer" };

const char* const FOUR = R"(
port: /dev/virtual
baud_rate: 9600
parity: even
scan_list:
  - {name: belt, node: 1, drive: omron_mx2}
  - {name: crusher, node: 2, drive: omron_rx}
  - {name: pump, node: 3, drive: toshiba_vfs15}
  - name: mixer
    node: 4
    drive: teco_7200ma
    confirm: [run_forward, fault_reset, frequency_scale, fault_coding]
    overrides: {reverse_word: 2, monitor_base: 0x0020}
)";

/// The frame that takes RUN off, from each drive's own manual; the check sum is left out.
const char* const STOPS[] = { "01 05 00 00 00 00", "02 05 00 00 00 00", "03 06 FA 00 C0 00",
                              "04 10 00 00 00 01 02 00 00" };

/// The beginnings of one read of each refresh.
const char* const REFRESHES[] = { "01 03 10 00", "02 03 10 00", "03 03 FD 00", "04 03 00 20" };

const double VELOCITIES[] = { 10.0, 15.0, 20.0, -12.0 };

/// Ten-second ramps: long enough for all of VELOCITIES.
constexpr double RAMP = 20.0;

double runCommand(VirtualBus& bus, std::size_t index)
{
  return bus.motor(NAMES[index], index == BELT || index == CRUSHER ? "run_coil" : "run_command");
}

void settle(VirtualBus& bus)
{
  bus.settleIn();
  bus.run(10.0);  // all settings read, in the lowest class
  bus.clearFrames();
}

void streamAll(VirtualBus& bus, double until)
{
  for (std::size_t index = 0; index < DRIVES; ++index)
  {
    bus.stream(index, VELOCITIES[index], 0.1, until);
  }
}

void expectAtSpeed(VirtualBus& bus, std::size_t index)
{
  EXPECT_NEAR(bus.motor(NAMES[index], "frequency"), std::abs(VELOCITIES[index]), 0.05) << NAMES[index];
  EXPECT_EQ(bus.motor(NAMES[index], "direction"), VELOCITIES[index] > 0.0 ? 1 : -1) << NAMES[index];
  const drive::Monitor& monitor = bus.status(index).monitor;
  ASSERT_TRUE(monitor.output_frequency.has_value()) << NAMES[index];
  EXPECT_NEAR(*monitor.output_frequency, std::abs(VELOCITIES[index]), 0.05) << NAMES[index];
  EXPECT_EQ(monitor.direction, VELOCITIES[index] > 0.0 ? 1 : -1) << NAMES[index];
  EXPECT_EQ(monitor.running, true) << NAMES[index];
  EXPECT_EQ(monitor.faulted, false) << NAMES[index];
}

/// [s] what the node prints at start-up as "worst stop latency X ms".
double printedWorstStop(VirtualBus& bus)
{
  const std::string words = "worst stop latency ";
  for (const bus::Finding& finding : bus.coordinator().budget())
  {
    const std::size_t at = finding.text.find(words);
    if (at != std::string::npos)
    {
      return std::stod(finding.text.substr(at + words.size())) * 1e-3;
    }
  }
  ADD_FAILURE() << "no worst stop latency is printed";
  return 0.0;
}

TEST(MixedBus, allBrandsRunAtOnceAndEachStopsAlone)
{
  VirtualBus bus(FOUR);
  settle(bus);
  streamAll(bus, RAMP + 60.0);
  bus.run(RAMP);
  for (std::size_t index = 0; index < DRIVES; ++index)
  {
    expectAtSpeed(bus, index);
  }
  EXPECT_EQ(bus.line().counters().timeouts, 0U);
  EXPECT_EQ(bus.line().counters().exceptions, 0U);
  for (std::size_t stopped = 0; stopped < DRIVES; ++stopped)
  {
    bus.clearFrames();
    const bus::Answer answer = bus.wait(bus.stop(stopped));
    EXPECT_TRUE(answer.success) << NAMES[stopped] << ": " << answer.message;
    EXPECT_EQ(runCommand(bus, stopped), 0.0) << NAMES[stopped];
    bus.run(12.0);
    EXPECT_EQ(bus.motor(NAMES[stopped], "frequency"), 0.0) << NAMES[stopped];
    // The streams go on through all of it: whoever was stopped stays so, the others go on.
    for (std::size_t index = 0; index < DRIVES; ++index)
    {
      EXPECT_EQ(bus.count(STOPS[index]), index == stopped ? 1U : 0U) << NAMES[index];
      EXPECT_EQ(runCommand(bus, index), index > stopped ? 1.0 : 0.0) << NAMES[index];
      EXPECT_EQ(bus.status(index).locked, index <= stopped) << NAMES[index];
    }
    for (std::size_t index = stopped + 1; index < DRIVES; ++index)
    {
      expectAtSpeed(bus, index);
    }
  }
}

TEST(MixedBus, aGroupSetsAllBrandsRunningAndAStopOfAllStopsThem)
{
  VirtualBus bus(FOUR);
  settle(bus);
  EXPECT_EQ(bus.group({ { MIXER, -12.0 }, { PUMP, 20.0 }, { BELT, 10.0 }, { CRUSHER, 15.0 } }), 0);
  bus.run(0.45);
  for (std::size_t index = 0; index < DRIVES; ++index)
  {
    EXPECT_EQ(runCommand(bus, index), 1.0) << NAMES[index];
  }
  bus.clearFrames();
  const bus::Answer answer = bus.wait(bus.stop(std::nullopt));
  EXPECT_TRUE(answer.success) << answer.message;
  for (std::size_t index = 0; index < DRIVES; ++index)
  {
    EXPECT_EQ(bus.count(STOPS[index]), 1U) << NAMES[index];
    EXPECT_EQ(runCommand(bus, index), 0.0) << NAMES[index];
  }
  // Address 0 is executed by every drive, and 0000H is another register on each brand.
  EXPECT_EQ(bus.count("00"), 0U);
}

TEST(MixedBus, stopsInAStormLeaveWithinThePrintedBound)
{
  VirtualBus bus(FOUR);
  settle(bus);
  const double printed = printedWorstStop(bus);
  // Nothing is lost here, so that the exchange in flight is all that a stop waits for: 33 characters (the slow values of the
  // MX2), three gaps and the drive's 10 ms, then the gap of the stop. 11 bits per character.
  const double character = 11.0 / 9600;
  const double bound = 33 * character + 4 * 3.5 * character + 0.010 + 0.0005;
  ASSERT_LT(bound, printed);
  const char* const parameters[] = { "F002", "A003", "F803", "0x0020" };
  streamAll(bus, 60.0);
  for (int call = 0; call < 160; ++call)
  {
    for (std::size_t index = 0; index < DRIVES; ++index)
    {
      bus.readParameter(index, parameters[index]);
      bus.readParameter(index, parameters[index]);
    }
    bus.run(0.013 + 0.0017 * (call % 37));
    bus.clearFrames();
    const std::size_t stopped = static_cast<std::size_t>(call) % DRIVES;
    const TimePoint called = bus.now();
    bus.stop(stopped);
    bus.run(0.25);
    bool found = false;
    for (const simulation::FrameRecord& frame : bus.frames())
    {
      if (!found && VirtualBus::hex(frame.bytes) == STOPS[stopped])
      {
        found = true;
        EXPECT_LE(toSeconds(frame.time - called), bound) << "call " << call << ", " << NAMES[stopped];
      }
    }
    EXPECT_TRUE(found) << "call " << call << ", " << NAMES[stopped];
  }
  const double latency = bus.coordinator().report(bus.now()).bus.stop_latency_max;
  EXPECT_GT(latency, 0.0);
  EXPECT_LE(latency, bound);
}

TEST(MixedBus, stopsLeaveWithinThePrintedBoundAlsoWhenRepliesAreLost)
{
  VirtualBus bus(FOUR);
  settle(bus);
  const double printed = printedWorstStop(bus);
  streamAll(bus, 60.0);
  for (int call = 0; call < 80; ++call)
  {
    const std::size_t stopped = static_cast<std::size_t>(call) % DRIVES;
    // Another one's reply is missing: its time-out is what the stop may have to wait for.
    bus.world(std::string(NAMES[(stopped + 1) % DRIVES]) + " lost_reply count 1");
    bus.run(0.013 + 0.0017 * (call % 37));
    bus.stop(stopped);
    bus.run(0.5);
  }
  const double latency = bus.coordinator().report(bus.now()).bus.stop_latency_max;
  EXPECT_GT(latency, 0.0);
  EXPECT_LE(latency, printed);
  EXPECT_GT(bus.line().counters().timeouts, 20U) << "the test's own means";
}

TEST(MixedBus, oneTripsWhileTheOthersGoOn)
{
  const int codes[] = { 12, 7, 16, 20 };
  for (std::size_t tripped = 0; tripped < DRIVES; ++tripped)
  {
    VirtualBus bus(FOUR);
    settle(bus);
    for (std::size_t index = 0; index < DRIVES; ++index)
    {
      bus.stream(index, VELOCITIES[index], 0.1, index == tripped ? RAMP : RAMP + 20.0);
    }
    bus.run(RAMP);
    bus.world(std::string(NAMES[tripped]) + " trip " + std::to_string(codes[tripped]));
    EXPECT_TRUE(bus.runUntil(2.0, [&] { return bus.status(tripped).monitor.fault_code == codes[tripped]; }))
        << NAMES[tripped];
    EXPECT_EQ(bus.status(tripped).monitor.faulted, true) << NAMES[tripped];
    bus.run(3.0);
    const auto expectOthersAtSpeed = [&] {
      for (std::size_t index = 0; index < DRIVES; ++index)
      {
        if (index != tripped)
        {
          expectAtSpeed(bus, index);
        }
      }
    };
    expectOthersAtSpeed();
    const bus::Answer answer = bus.wait(bus.reset(tripped));
    EXPECT_TRUE(answer.success) << NAMES[tripped] << ": " << answer.message;
    bus.run(3.0);
    EXPECT_EQ(bus.motor(NAMES[tripped], "tripped"), 0.0) << NAMES[tripped];
    EXPECT_EQ(bus.motor(NAMES[tripped], "frequency"), 0.0) << NAMES[tripped];
    EXPECT_EQ(runCommand(bus, tripped), 0.0) << NAMES[tripped];
    expectOthersAtSpeed();
  }
}

TEST(MixedBus, oneThatIsSwitchedOffMakesNothingElseSlower)
{
  constexpr double WINDOW = 20.0;
  for (std::size_t dead = 0; dead < DRIVES; ++dead)
  {
    VirtualBus bus(FOUR);
    settle(bus);
    bus.run(WINDOW);
    std::vector<std::size_t> before;
    for (const char* refresh : REFRESHES)
    {
      before.push_back(bus.count(refresh));
      ASSERT_GT(before.back(), 50U) << refresh;
    }
    bus.world(std::string(NAMES[dead]) + " power off");
    // Six lost frames. The VF-S15 has no 08H, so that each waits a second for the late reply of the one before.
    ASSERT_TRUE(bus.runUntil(8.0, [&] { return bus.status(dead).communication_error; })) << NAMES[dead];
    bus.run(1.0);
    bus.clearFrames();
    bus.run(WINDOW);
    for (std::size_t index = 0; index < DRIVES; ++index)
    {
      if (index != dead)
      {
        EXPECT_GE(static_cast<double>(bus.count(REFRESHES[index])), 0.95 * static_cast<double>(before[index]))
            << NAMES[index] << " without " << NAMES[dead];
        EXPECT_FALSE(bus.status(index).communication_error) << NAMES[index];
      }
    }
    bus.world(std::string(NAMES[dead]) + " power on");
    // 3 s from when it answers again; a drive needs some time to start.
    EXPECT_TRUE(bus.runUntil(8.0, [&] { return !bus.status(dead).communication_error; })) << NAMES[dead];
  }
}

TEST(MixedBus, the7200MaNeverMissesTheBus)
{
  VirtualBus bus(FOUR);
  settle(bus);
  streamAll(bus, 60.0);
  for (int call = 0; call < 100; ++call)
  {
    bus.at(0.5 * call, [&bus] {
      bus.readParameter(BELT, "F002");
      bus.readParameter(PUMP, "F803");
    });
  }
  bus.run(30.0);
  bus.world("crusher power off");
  bus.run(30.0);
  EXPECT_EQ(bus.motor("mixer", "alarms"), 0.0);
}

TEST(MixedBus, thirtyOneStationsComeOnlineAndAreServedInTurn)
{
  const char* const drives[] = { "omron_mx2", "omron_rx", "toshiba_vfs15", "teco_7200ma" };
  std::string yaml = "port: /dev/virtual\nbaud_rate: 9600\nparity: even\nscan_list:\n";
  for (unsigned node = 1; node <= 31; ++node)
  {
    yaml += "  - {name: drive_" + std::to_string(node) + ", node: " + std::to_string(node) +
            ", drive: " + drives[node % 4] + "}\n";
  }
  VirtualBus bus(yaml);
  const bool all = bus.runUntil(60.0, [&] {
    for (std::size_t index = 0; index < 31; ++index)
    {
      if (!bus.hasStatus(index) || bus.status(index).communication_error || bus.status(index).locked)
      {
        return false;
      }
    }
    return true;
  });
  EXPECT_TRUE(all);
  EXPECT_TRUE(bus.coordinator().report(bus.now()).bus.offline_nodes.empty());
  EXPECT_EQ(bus.line().counters().timeouts, 0U);
  // A cycle of all takes 4 s here; the 7200MA, which must hear something every second, may make it longer for the others,
  // but may not push them out.
  bus.clearFrames();
  bus.run(30.0);
  for (unsigned node = 1; node <= 31; ++node)
  {
    const char* const fast[] = { " 03 10 00", " 03 10 00", " 03 FD 00", " 03 00 00" };
    char station[4];
    std::snprintf(station, sizeof station, "%02X", node);
    EXPECT_GE(bus.count(station + std::string(fast[node % 4])), 3U) << "station " << node;
  }
  const bus::Answer answer = bus.wait(bus.stop(std::nullopt), 60.0);
  EXPECT_TRUE(answer.success) << answer.message;
  EXPECT_EQ(bus.count("00"), 0U);
}
}  // namespace
}  // namespace inverter_bus
