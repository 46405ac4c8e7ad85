// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

// The rules of the contract's section 3 on a whole bus in virtual time.

#include <set>

#include "support/virtual_bus.h"

namespace inverter_bus
{
namespace
{
std::string belts(unsigned count, const std::string& more = "")
{
  std::ostringstream yaml;
  yaml << "port: /dev/virtual\nbaud_rate: 19200\n" << more << "defaults: {drive: omron_mx2}\nscan_list:\n";
  for (unsigned node = 1; node <= count; ++node)
  {
    yaml << "  - {name: belt_" << node << ", node: " << node << "}\n";
  }
  return yaml.str();
}

/// Station and function of a request's text.
std::string head(const std::string& request)
{
  return request.substr(0, 5);
}

bool isCommand(const std::string& request)
{
  const std::string function = request.substr(3, 2);
  return function == "05" || function == "10" || function == "06" || request.substr(6, 2) == "11";
}

TEST(Scheduling, aGroupGoesBackToBackInNodeOrder)
{
  VirtualBus bus(belts(4));
  bus.settleIn();
  bus.group({ { 2, 10.0 }, { 0, 20.0 }, { 1, -15.0 } });
  bus.run(0.5);
  std::vector<std::string> heads;
  bool inside = false;
  for (const std::string& request : bus.requests())
  {
    inside = inside || isCommand(request);
    if (inside && heads.size() < 9)
    {
      heads.push_back(head(request));
    }
  }
  // Each of them waits while another one has its frame: they take turns (rule 8.1), and nothing else comes between.
  const std::vector<std::string> expected{ "01 10", "02 10", "03 10", "01 05", "02 05",
                                           "03 05", "01 05", "02 05", "03 05" };
  EXPECT_EQ(heads, expected);
}

TEST(Scheduling, aGroupWithOneBadVelocityIsRefusedAsAWhole)
{
  VirtualBus bus(belts(2));
  bus.settleIn();
  EXPECT_EQ(bus.group({ { 0, 10.0 }, { 1, 1e6 } }), bus::ERROR_OUT_OF_RANGE);
  bus.run(1.0);
  EXPECT_EQ(bus.motor("belt_1", "run_coil"), 0);
  EXPECT_EQ(bus.status(0).error_id, bus::ERROR_OUT_OF_RANGE);
  EXPECT_EQ(bus.status(1).error_id, bus::ERROR_OUT_OF_RANGE);
}

TEST(Scheduling, aZeroInARefusedGroupStillStops)
{
  VirtualBus bus(belts(2));
  bus.settleIn();
  bus.command(0, 10.0);
  bus.run(0.3);
  ASSERT_EQ(bus.motor("belt_1", "run_coil"), 1);
  EXPECT_EQ(bus.group({ { 0, 0.0 }, { 1, 1e6 } }), bus::ERROR_OUT_OF_RANGE);
  bus.run(0.2);
  EXPECT_EQ(bus.motor("belt_1", "run_coil"), 0);
}

TEST(Scheduling, stopsWaitForTheExchangeInFlightOnlyAtAnyInstant)
{
  VirtualBus bus(belts(5));
  bus.settleIn();
  // Longest exchange of these drives: 10 slow registers, 33 characters, two gaps and 2 ms; then the gap.
  const double bound = 33 * 10.0 / 19200 + 3 * 35.0 / 19200 + 0.002 + 0.0005;
  for (int call = 0; call < 200; ++call)
  {
    for (std::size_t index = 0; index < 5; ++index)
    {
      bus.readParameter(index, "F002");
    }
    bus.run(0.011 + 0.0007 * (call % 37));
    bus.clearFrames();
    const TimePoint called = bus.now();
    bus.stop(call % 5);
    bus.run(0.1);
    const std::string off = "0" + std::to_string(call % 5 + 1) + " 05 00 00 00 00";
    bool found = false;
    for (const simulation::FrameRecord& frame : bus.frames())
    {
      if (!found && VirtualBus::hex(frame.bytes) == off)
      {
        found = true;
        EXPECT_LE(toSeconds(frame.time - called), bound) << "call " << call;
      }
    }
    EXPECT_TRUE(found) << "call " << call;
  }
}

TEST(Scheduling, aDeadInverterDelaysNoOthersStop)
{
  VirtualBus bus(belts(3));
  bus.settleIn();
  bus.world("belt_1 offline");
  bus.run(3.0);
  ASSERT_TRUE(bus.status(0).communication_error);
  bus.clearFrames();
  const auto all = bus.stop(std::nullopt);
  bus.run(0.25);
  EXPECT_EQ(bus.count("02 05 00 00 00 00"), 1U);
  EXPECT_EQ(bus.count("03 05 00 00 00 00"), 1U);
  EXPECT_EQ(bus.count("02 01 00 00 00 01"), 1U);
  EXPECT_EQ(bus.count("03 01 00 00 00 01"), 1U);
  const bus::Answer answer = bus.wait(all);
  EXPECT_FALSE(answer.success);
  EXPECT_EQ(answer.error_id, wire::ERROR_TIMEOUT);
  EXPECT_NE(answer.message.find("belt_1"), std::string::npos) << answer.message;
  EXPECT_EQ(answer.message.find("belt_2"), std::string::npos) << answer.message;
}

TEST(Scheduling, aStopOfADeadInverterGoesOnAndIsConfirmedOnItsReturn)
{
  VirtualBus bus(belts(2));
  bus.settleIn();
  bus.command(0, 20.0);
  bus.run(0.3);
  ASSERT_EQ(bus.motor("belt_1", "run_coil"), 1);
  bus.world("belt_1 offline");
  bus.wait(bus.stop(0));
  EXPECT_TRUE(bus.status(0).stop_active);
  bus.run(5.0);
  bus.world("belt_1 online");
  EXPECT_TRUE(bus.runUntil(3.0, [&] { return !bus.status(0).stop_active; }));
  EXPECT_EQ(bus.motor("belt_1", "run_coil"), 0);
}

TEST(Scheduling, velocitiesThatArriveDuringAStopAreRefused)
{
  VirtualBus bus(belts(2));
  bus.settleIn();
  bus.command(0, 20.0);
  bus.stop(0);
  EXPECT_EQ(bus.command(0, 20.0), bus::ERROR_CANCELLED);
  bus.run(0.3);
  EXPECT_EQ(bus.count("01 05 00 00 FF 00"), 0U);
  EXPECT_EQ(bus.command(0, 20.0), bus::ERROR_LOCKED);
}

TEST(Scheduling, otherCommandsRunAfterTheStop)
{
  VirtualBus bus(belts(1));
  bus.settleIn();
  const auto read = bus.readParameter(0, "F002");
  const auto stop = bus.stop(0);
  const bus::Answer answer = bus.wait(read);
  EXPECT_TRUE(answer.success);
  EXPECT_DOUBLE_EQ(answer.value, 10.0);
  ASSERT_TRUE(stop->has_value());
  const auto requests = bus.requests();
  const auto off = std::find(requests.begin(), requests.end(), "01 05 00 00 00 00");
  const auto parameter = std::find(requests.begin(), requests.end(), "01 03 11 02 00 02");
  EXPECT_LT(off - requests.begin(), parameter - requests.begin());
}

TEST(Scheduling, commandsOfOneExchangeGoKindByKindInNodeOrder)
{
  VirtualBus bus(belts(3));
  bus.settleIn();
  // The drives' settings have been read, too.
  bus.run(3.0);
  bus.clearFrames();
  for (const std::size_t index : { 2, 0, 1 })
  {
    bus.readParameter(index, "F002");
  }
  for (const std::size_t index : { 1, 2, 0 })
  {
    bus.command(index, 20.0);
  }
  bus.run(0.45);
  std::vector<std::string> order;
  for (const std::string& request : bus.requests())
  {
    if (isCommand(request) && (order.empty() || order.back() != head(request).substr(0, 2) + request.substr(5, 3)))
    {
      const std::string kind = request.substr(6, 2) == "11" ? " P" : " V";
      const std::string entry = request.substr(0, 2) + kind;
      if (order.empty() || order.back() != entry)
      {
        order.push_back(entry);
      }
    }
  }
  // Frequency, direction and RUN of three that wait for each other go frame by frame. A parameter of 1 may go before the
  // last frame of 3, which has just been refreshed: nobody gets two exchanges in a row while another one waits (rule 8.1).
  const auto first_parameter = std::find(order.begin(), order.end(), "01 P");
  EXPECT_GE(first_parameter - order.begin(), 8);
  const auto velocities =
      std::stable_partition(order.begin(), order.end(), [](const std::string& entry) { return entry.back() == 'V'; });
  const std::vector<std::string> turns{ "01 V", "02 V", "03 V", "01 V", "02 V", "03 V", "01 V", "02 V", "03 V" };
  const std::vector<std::string> parameters{ "01 P", "02 P", "03 P" };
  EXPECT_EQ(std::vector<std::string>(order.begin(), velocities), turns);
  EXPECT_EQ(std::vector<std::string>(velocities, order.end()), parameters);
}

TEST(Scheduling, commandsAndRefreshesAlternateInAStorm)
{
  VirtualBus bus(belts(3));
  bus.settleIn();
  std::vector<VirtualBus::Box> storm;
  for (int call = 0; call < 30; ++call)
  {
    storm.push_back(bus.readParameter(call % 3, "F002"));
  }
  bus.run(0.01);
  bus.clearFrames();
  bus.run(0.8);
  unsigned in_a_row = 0;
  unsigned most = 0;
  for (const std::string& request : bus.requests())
  {
    in_a_row = isCommand(request) ? in_a_row + 1 : 0;
    most = std::max(most, in_a_row);
  }
  EXPECT_EQ(most, 1U);
}

TEST(Scheduling, velocityIsCoalescedAndTheNewestWins)
{
  VirtualBus bus(belts(5));
  bus.settleIn();
  bus.run(0.01);
  bus.clearFrames();
  for (int value = 1; value <= 50; ++value)
  {
    bus.command(0, value);
  }
  bus.run(0.5);
  EXPECT_LE(bus.count("01 10"), 2U);
  EXPECT_EQ(bus.motor("belt_1", "reference"), 50.0);
}

TEST(Scheduling, deadInvertersCostAtMostFivePercentAndComeBackWithinThreeSeconds)
{
  VirtualBus bus(belts(5));
  bus.settleIn();
  bus.world("belt_2 offline");
  bus.world("belt_4 offline");
  bus.run(5.0);
  bus.clearFrames();
  const TimePoint start = bus.now();
  bus.run(60.0);
  double probing = 0.0;
  const auto& frames = bus.frames();
  for (std::size_t index = 0; index + 1 < frames.size(); ++index)
  {
    const bool dead = frames[index].source == simulation::FrameRecord::Source::Master &&
                      (frames[index].bytes[0] == 2 || frames[index].bytes[0] == 4);
    probing += dead ? toSeconds(frames[index + 1].time - frames[index].time) : 0.0;
  }
  EXPECT_GT(probing, 0.0);
  EXPECT_LE(probing / toSeconds(bus.now() - start), 0.06) << "5 % and the gap before the next frame";
  bus.world("belt_2 online");
  bus.world("belt_4 online");
  EXPECT_TRUE(
      bus.runUntil(3.0, [&] { return !bus.status(1).communication_error && !bus.status(3).communication_error; }));
}

TEST(Scheduling, theIntervalPausesTheCycleButNotACommand)
{
  VirtualBus bus(belts(1, "interval: 2.0\n"));
  bus.run(3.0);
  ASSERT_TRUE(bus.runUntil(5.0, [&] { return !bus.status(0).locked; }));
  bus.run(0.3);
  bus.clearFrames();
  const TimePoint called = bus.now();
  bus.command(0, 20.0);
  bus.run(0.1);
  ASSERT_GE(bus.frames().size(), 2U);
  EXPECT_EQ(bus.requests().front(), "01 10 00 00 00 02 04 00 00 07 D0");
  EXPECT_LE(toSeconds(bus.frames().front().time - called), 0.03);
}

TEST(Scheduling, aDriveWithItsOwnTimeOutIsServedDespiteTheInterval)
{
  VirtualBus bus(belts(2, "interval: 5.0\nsimulation: {belt_1: {parameters: {C076: 0, C077: 1.0}}}\n"));
  bus.run(30.0);
  EXPECT_EQ(bus.motor("belt_1", "tripped"), 0);
  EXPECT_EQ(bus.motor("belt_1", "trips"), 0);
}

TEST(Scheduling, everyFrameKeepsTheGapOfTheLine)
{
  VirtualBus bus(belts(3));
  bus.settleIn();
  bus.stream(0, 20.0, 0.05, 3.0);
  bus.run(3.0);
  for (unsigned node = 1; node <= 3; ++node)
  {
    EXPECT_EQ(bus.motor("belt_" + std::to_string(node), "lost_gap"), 0);
    EXPECT_EQ(bus.motor("belt_" + std::to_string(node), "unheard"), 0);
  }
}

TEST(Scheduling, anMx2sRunWordsTakeTwoExchangesPerRefresh)
{
  VirtualBus bus(belts(1));
  bus.settleIn();
  bus.clearFrames();
  bus.run(10.0);
  const double refreshes = static_cast<double>(bus.count("01 01 00 00 00 18"));
  EXPECT_GT(refreshes, 100);
  EXPECT_NEAR(static_cast<double>(bus.count("01 03 10 00 00 04")), refreshes, 1.0);
  // Three slow reads at about 1 Hz besides.
  EXPECT_LE(static_cast<double>(bus.requests().size()) - 2 * refreshes, 36.0);
}

TEST(Scheduling, thirtyOneStationsAreServedRoundRobin)
{
  VirtualBus bus(belts(31));
  bus.run(30.0);
  std::set<std::size_t> seen;
  for (std::size_t index = 0; index < 31; ++index)
  {
    ASSERT_TRUE(bus.hasStatus(index));
    EXPECT_LE(toSeconds(bus.now() - bus.status(index).stamp), 5.0);
  }
}
TEST(Scheduling, whoStopsAgainAndAgainDoesNotBlindTheDriver)
{
  VirtualBus bus(R"(
port: /dev/virtual
scan_list:
  - {name: belt_1, node: 1, drive: omron_mx2}
  - {name: belt_2, node: 2, drive: omron_mx2}
  - {name: belt_3, node: 3, drive: omron_mx2}
)");
  bus.settleIn();
  bus.world("belt_3 trip 7");
  const TimePoint end = bus.now() + seconds(5.0);
  while (bus.now() < end)
  {
    EXPECT_TRUE(bus.wait(bus.stop(0)).success);
  }
  EXPECT_TRUE(bus.status(2).monitor.faulted.value_or(false)) << "the trip of another drive was not seen";
  for (std::size_t index = 0; index < 3; ++index)
  {
    EXPECT_GT(bus.status(index).stamp, end - seconds(2.0)) << index;
  }
}
}  // namespace
}  // namespace inverter_bus
