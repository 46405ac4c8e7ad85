// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

// A simulated VF-S15 and VF-S11: frames of the communication manual E6581913 (p. 26-38) byte for byte, and what the
// drive does.

#include <gtest/gtest.h>

#include <set>

#include "simulation/drives/toshiba/toshiba_model.h"
#include "support/simulation_test_bus.h"

using namespace inverter_bus::simulation;

namespace
{
const char* const RUN_FORWARD = "01 06 FA 00 C4 00";
const char* const RUN_REVERSE = "01 06 FA 00 C6 00";
const char* const HALT = "01 06 FA 00 C0 00";
const char* const COAST = "01 06 FA 00 C8 00";
const char* const EMERGENCY = "01 06 FA 00 D0 00";
const char* const RESET = "01 06 FA 00 E0 00";
const char* const RELEASE = "01 06 FA 00 00 00";
const char* const SIXTY = "01 06 FA 01 17 70";
const char* const THIRTY = "01 06 FA 01 0B B8";

/// One drive at number 1 named m: 80 Hz in 1 s up and down.
std::string one(const std::string& parameters, const std::string& model, const std::string& details = "")
{
  return "baud_rate: 19200\nparity: even\nscan_list: [{name: m, node: 1, drive: " + model + "}]\nsimulation: {m: {" +
         details + "parameters: {ACC: 1.0, dEC: 1.0" + (parameters.empty() ? "" : ", " + parameters) + "}}}\n";
}

std::string vfs15(const std::string& parameters = "")
{
  return one(parameters, "toshiba_vfs15");
}

std::string vfs11(const std::string& parameters = "")
{
  return one(parameters, "toshiba_vfs11");
}

const char* const USEFUL_SLOTS = "F870: 1, F871: 3, F875: 1, F876: 2, F877: 3, F878: 4, F879: 5";

/// Runs the motor at 60 Hz, up to speed.
void run(TestBus& bus)
{
  ASSERT_EQ(SIXTY, bus.ask(SIXTY));
  ASSERT_EQ(RUN_FORWARD, bus.ask(RUN_FORWARD));
  bus.wait(2.0);
}

/// One register by its number: "FD 00". -1 for anything but a good reply.
int read(TestBus& bus, const std::string& number)
{
  const std::string reply = bus.ask("01 03 " + number + " 00 01");
  if (reply.size() != 14 || reply.substr(0, 8) != "01 03 02")
  {
    return -1;
  }
  return std::stoi(reply.substr(9, 2) + reply.substr(12, 2), nullptr, 16);
}

/// FD01 without its unstable bit.
int status(TestBus& bus)
{
  const int word = read(bus, "FD 01");
  return word < 0 ? word : word & 0x7FFF;
}

/// Asks until the reply has the unstable bit 15 of FD01 as the manual's example, where it is set.
std::string askRawUntil(TestBus& bus, const std::string& request, const std::string& start)
{
  std::string reply;
  for (int attempt = 0; attempt < 40 && reply.compare(0, start.size(), start) != 0; ++attempt)
  {
    reply = bus.askRaw(request);
  }
  return reply;
}

/// The state of the manual's block read: 60 Hz, 0.00 % current, 99.83 % voltage, low current alarm.
void showManualState(TestBus& bus)
{
  run(bus);
  bus.command("m set FD03 0");
  bus.command("m set FD05 9983");
  bus.command("m set FC91 128");
}
}  // namespace

TEST(ToshibaFrames, singleReadAndWrite)
{
  TestBus bus(vfs15());
  EXPECT_EQ("01 06 FA 01 17 70 E6 C6", bus.askRaw("01 06 FA 01 17 70 E6 C6"));
  EXPECT_EQ("01 06 FA 00 C4 00 EB D2", bus.askRaw("01 06 FA 00 C4 00 EB D2"));
  bus.wait(2.0);
  EXPECT_EQ("01 03 02 17 70 B6 50", bus.askRaw("01 03 FD 00 00 01 B5 A6"));
  EXPECT_EQ("01 86 02 C3 A1", bus.askRaw("01 06 FF FF 00 00 89 EE"));
  EXPECT_EQ("01 10 FA 01 00 01 60 D1", bus.askRaw("01 10 FA 01 00 01 02 17 70 F3 9A"));
}

TEST(ToshibaFrames, blockRead)
{
  TestBus bus(vfs15("F875: 1, F876: 2, F877: 3, F878: 4, F879: 5"));
  showManualState(bus);
  EXPECT_EQ("01 03 0A E4 04 17 70 00 00 26 FF 00 80 58 00", askRawUntil(bus, "01 03 18 75 00 05 92 B3", "01 03 0A E4"));
  EXPECT_EQ("01 03 04 E4 04 17 70 83 16", askRawUntil(bus, "01 03 18 75 00 02 D3 71", "01 03 04 E4"));
  EXPECT_EQ("01 83 03 01 31", bus.askRaw("01 03 18 75 00 06 D2 B2"));
  EXPECT_EQ("01 83 03 01 31", bus.askRaw("01 03 18 76 00 02 23 71"));
  EXPECT_EQ("01 83 03", bus.ask("01 03 18 75 00 01"));
}

TEST(ToshibaFrames, unselectedReadSlotIsZero)
{
  TestBus bus(vfs15("F875: 0, F876: 2"));
  run(bus);
  EXPECT_EQ("01 03 04 00 00 17 70 F4 27", bus.askRaw("01 03 18 75 00 02 D3 71"));
}

TEST(ToshibaFrames, directRead)
{
  TestBus bus(vfs15("F100: 50.0"));
  EXPECT_EQ("01 03 0A 00 04 00 06 00 0A 80 00 80 00 A0 77", bus.askRaw("01 03 01 30 00 05 84 3A"));
  EXPECT_EQ("01 03 04 00 0A 00 0A", bus.ask("01 03 00 09 00 02"));  // ACC and dEC: 0010 follows 0009
  EXPECT_EQ("01 83 02", bus.ask("01 03 01 33 00 02"));              // the first one is missing
  EXPECT_EQ("01 83 02", bus.ask("01 03 00 0A 00 02"));
  EXPECT_EQ("01 03 04 00 00 13 88", bus.ask("01 03 00 99 00 02"));  // SEt, then F100
  EXPECT_EQ("01 03 10", bus.ask("01 03 FD 00 00 08").substr(0, 8));
  EXPECT_EQ("01 83 03", bus.ask("01 03 FD 00 00 09"));
  EXPECT_EQ("01 83 03", bus.ask("01 03 FD 00 00 00"));
  EXPECT_EQ("01 83 02", bus.ask("01 03 FF 99 00 02"));
}

TEST(ToshibaFrames, blockWrite)
{
  TestBus bus(vfs15("F870: 1, F871: 3"));
  const char* const request = "01 10 18 70 00 02 04 C4 00 17 70 6D AF";
  bus.command("m busy 1");
  EXPECT_EQ("01 90 04 4D C3", bus.askRaw(request));
  EXPECT_EQ("0000", bus.shown("m", "command"));
  bus.wait(1.0);
  EXPECT_EQ("01 10 18 70 00 02 46 B3", bus.askRaw(request));
  EXPECT_EQ("C400", bus.shown("m", "command"));
  EXPECT_EQ("60.00", bus.shown("m", "reference"));
  EXPECT_EQ("01 90 03 0C 01", bus.askRaw("01 10 18 71 00 02 04 C4 00 17 70 AC 63"));
  EXPECT_EQ("01 90 03 0C 01", bus.askRaw("01 10 18 70 00 03 04 C4 00 17 70 6C 7E"));
  EXPECT_EQ("01 90 03", bus.ask("01 10 FA 00 00 02 04 C4 00 17 70"));
}

TEST(ToshibaFrames, emptyWriteSlotsRefuseAndHalfEmptyOnesIgnore)
{
  TestBus empty(vfs15());
  EXPECT_EQ("01 90 04 4D C3", empty.askRaw("01 10 18 70 00 02 04 C4 00 17 70 6D AF"));
  TestBus half(vfs15("F871: 3"));
  EXPECT_EQ("01 10 18 70 00 02", half.ask("01 10 18 70 00 02 04 C4 00 17 70"));
  EXPECT_EQ("0000", half.shown("m", "command"));
  EXPECT_EQ("60.00", half.shown("m", "reference"));
}

TEST(ToshibaFrames, identification)
{
  TestBus bus(vfs15("FE70: 17.5"));
  EXPECT_EQ(
      "01 2B 0E 01 01 00 00 03 00 07 54 4F 53 48 49 42 41 01 0C 56 46 53 31 35 2D 32 30 33 37 50 4D 02 04 30 31 30 30 "
      "13 45",
      bus.askRaw("01 2B 0E 01 00 70 77"));
  EXPECT_EQ(9, read(bus, "FB 05"));  // 3.7 kW
  EXPECT_EQ("01 AB 01", bus.ask("01 2B 0D 01 00"));
  EXPECT_EQ("01 AB 03", bus.ask("01 2B 0E 04 00"));
  EXPECT_EQ("", bus.ask("01 2B 0E 01 00 00"));
}

TEST(ToshibaFrames, readAndWriteInOne)
{
  TestBus bus(vfs15(USEFUL_SLOTS));
  const std::string start = bus.askRaw("01 17 18 75 00 05 18 70 00 02 04 C4 00 17 70 84 31").substr(0, 8);
  EXPECT_EQ("01 17 0A", start);
  EXPECT_EQ("C400", bus.shown("m", "command"));
  bus.wait(2.0);
  const std::string reply = bus.ask("01 17 18 75 00 02 18 70 00 02 04 C4 00 0B B8");
  EXPECT_EQ("01 17 04", reply.substr(0, 8));
  EXPECT_EQ("17 70", reply.substr(15));  // the write came first, but the ramp starts here
  EXPECT_EQ("30.00", bus.shown("m", "reference"));
  for (const char* wrong :
       { "01 17 18 75 00 06 18 70 00 02 04 C0 00 00 00", "01 17 18 75 00 01 18 70 00 02 04 C0 00 00 00",
         "01 17 18 76 00 02 18 70 00 02 04 C0 00 00 00", "01 17 FD 00 00 02 18 70 00 02 04 C0 00 00 00",
         "01 17 18 75 00 02 FA 00 00 02 04 C0 00 00 00", "01 17 18 75 00 02 18 70 00 01 02 C0 00" })
  {
    EXPECT_EQ("01 97 03", bus.ask(wrong)) << wrong;
  }
  EXPECT_EQ("C400", bus.shown("m", "command"));  // nothing of them was written
}

TEST(ToshibaFrames, commandWords)
{
  TestBus bus(vfs15());
  for (const char* frame : { "01 06 FA 00 C4 00 EB D2", "01 06 FA 00 C6 00 EA B2", "01 06 FA 00 C0 00 E9 12",
                             "01 06 FA 00 C8 00 EE D2", "01 06 FA 00 00 00 B9 12", "01 06 FA 00 D0 00 E4 D2" })
  {
    EXPECT_EQ(frame, bus.askRaw(frame));
  }
  EXPECT_EQ("", bus.askRaw("01 06 FA 00 E0 00 F0 D2"));
}

TEST(ToshibaFrames, broadcastIsExecutedAndNeverAnswered)
{
  TestBus bus(vfs15());
  run(bus);
  EXPECT_EQ("", bus.askRaw("00 06 FA 00 C0 00 E8 C3"));
  EXPECT_EQ("C000", bus.shown("m", "command"));
  EXPECT_EQ("", bus.ask("00 03 FD 00 00 01"));
}

TEST(ToshibaFrames, damagedAndForeignRequestsGetNoReply)
{
  TestBus bus(vfs15());
  EXPECT_EQ("", bus.askRaw("01 03 FD 00 00 01 B5 A7"));
  EXPECT_EQ("", bus.ask("02 03 FD 00 00 01"));
  EXPECT_EQ("1", bus.shown("m", "damaged_requests"));
}

TEST(ToshibaFrames, otherFunctionsAreUnknown)
{
  TestBus bus(vfs15());
  EXPECT_EQ("01 81 01", bus.ask("01 01 00 00 00 01"));
  EXPECT_EQ("01 84 01", bus.ask("01 04 FD 00 00 01"));
  EXPECT_EQ("01 88 01", bus.ask("01 08 00 00 12 34"));
  EXPECT_EQ("01 85 01", bus.ask("01 05 00 00 FF 00"));
}

TEST(ToshibaFrames, readOnlyAndUnknownNumbers)
{
  TestBus bus(vfs15());
  EXPECT_EQ("01 86 02", bus.ask("01 06 FD 00 00 00"));
  EXPECT_EQ("01 86 02", bus.ask("01 06 FE 70 00 30"));
  EXPECT_EQ("01 86 02", bus.ask("01 06 09 99 00 01"));
  EXPECT_EQ("01 86 02", bus.ask("01 06 18 70 00 00"));
  EXPECT_EQ("01 83 02", bus.ask("01 03 FC 93 00 01"));
  EXPECT_EQ("01 83 02", bus.ask("01 03 FE 09 00 01"));
}

TEST(ToshibaFrames, replyDelay)
{
  const auto delay = [](const std::string& parameters, const std::string& request) {
    TestBus bus(one(parameters, "toshiba_vfs15", "turnaround: 0.003, "));
    const TimePoint start = bus.now;
    const double characters = 8 + 3.5 + (request[4] == '3' ? 7 : 8);  // request, silence, reply
    bus.ask(request);
    return toSeconds(bus.last_byte - start) - characters * 11 / 19200;
  };
  EXPECT_NEAR(0.003, delay("", SIXTY), 1e-5);
  EXPECT_NEAR(0.203, delay("F805: 0.20", SIXTY), 1e-5);
  EXPECT_NEAR(0.048, delay("", "01 06 00 09 00 64"), 1e-5);  // ACC goes to the EEPROM
  EXPECT_NEAR(0.003, delay("", "01 03 00 09 00 01"), 1e-5);
}

TEST(ToshibaFrames, olderModelTakesOneWordOnly)
{
  TestBus bus(vfs11());
  EXPECT_EQ("01 03 02 17 70", bus.ask("01 03 00 12 00 01"));
  EXPECT_EQ("01 83 03", bus.ask("01 03 FD 00 00 02"));
  EXPECT_EQ("01 83 02", bus.ask("01 03 18 75 00 01"));
  EXPECT_EQ("01 83 02", bus.ask("01 03 08 70 00 01"));
  EXPECT_EQ("01 90 01", bus.ask("01 10 FA 01 00 01 02 17 70"));
  EXPECT_EQ("01 97 01", bus.ask("01 17 18 75 00 02 18 70 00 02 04 C4 00 17 70"));
  EXPECT_EQ("01 AB 01", bus.ask("01 2B 0E 01 00"));
  EXPECT_EQ(211, read(bus, "FB 07"));
  EXPECT_NE(-1, read(bus, "FE 09"));
  EXPECT_EQ("ok F800 ram=4 eeprom=4", bus.command("m get F800"));  // commissioned
}

TEST(ToshibaMonitors, atRestAndRunning)
{
  TestBus bus(vfs15());
  EXPECT_EQ(0x4000, status(bus));
  EXPECT_EQ(1, read(bus, "FD 45"));  // from the factory the panel is in command
  EXPECT_EQ(0, read(bus, "FD 46"));
  run(bus);
  EXPECT_EQ(0x6400, status(bus));
  EXPECT_EQ(6000, read(bus, "FD 00"));
  EXPECT_EQ(6000, read(bus, "FE 00"));  // follows as long as there is no trip
  EXPECT_EQ(6000, read(bus, "FD 02"));
  EXPECT_EQ(10000, read(bus, "FD 05"));
  EXPECT_EQ(1800, read(bus, "FD 90"));  // 4 poles
  EXPECT_EQ(2, read(bus, "FD 45"));
  EXPECT_EQ(4, read(bus, "FD 46"));
  EXPECT_EQ(48, read(bus, "FE 70"));
  EXPECT_EQ(2000, read(bus, "FE 71"));
  EXPECT_EQ(4, read(bus, "FB 05"));
  EXPECT_EQ(224, read(bus, "FB 07"));
  EXPECT_EQ(3000, read(bus, "FD 18"));  // a load of 0.3
  // sqrt(0.4^2 + 0.84 * 0.3^2) of the rated current
  EXPECT_NEAR(4854, read(bus, "FD 03"), 1);
  bus.ask(RUN_REVERSE);
  bus.wait(0.4);
  EXPECT_EQ(500, read(bus, "FD 18"));  // brakes with 25 % of the rated torque
  bus.wait(2.0);
  EXPECT_EQ(0x6600, status(bus));
  EXPECT_EQ(-3000, static_cast<std::int16_t>(read(bus, "FD 18")));
  EXPECT_EQ("-1", bus.shown("m", "direction"));
}

TEST(ToshibaMonitors, currentIsAShareOfTheDrivesOwnRating)
{
  TestBus bus(vfs15("FE70: 17.5, FE71: 400.0"));
  bus.command("m load 1.0");
  run(bus);
  EXPECT_EQ(10000, read(bus, "FD 03"));
  EXPECT_EQ("17.50", bus.shown("m", "current"));
  EXPECT_EQ(10000, read(bus, "FD 05"));
  EXPECT_EQ(175, read(bus, "FE 70"));
  EXPECT_EQ(4000, read(bus, "FE 71"));
  EXPECT_EQ(44, read(bus, "FB 05"));  // 500 V class: 17.0 A (43) is too small
}

TEST(ToshibaMonitors, unstableBitsAreUnstable)
{
  TestBus bus(vfs15());
  for (const auto& item : { std::make_pair("FD 01", 15), std::make_pair("FD 06", 8), std::make_pair("FD 07", 3),
                            std::make_pair("FD 42", 0), std::make_pair("FD 49", 2) })
  {
    std::set<int> seen;
    for (int i = 0; i < 40; ++i)
    {
      seen.insert((read(bus, item.first) >> item.second) & 1);
    }
    EXPECT_EQ(2U, seen.size()) << item.first;
  }
}

TEST(ToshibaMonitors, status3)
{
  TestBus bus(vfs15());
  const auto bits = [&bus] { return read(bus, "FD 49") & 0xF400; };
  EXPECT_EQ(0x2000, bits());  // 0 Hz is F101
  bus.ask(SIXTY);
  bus.ask(RUN_FORWARD);
  bus.wait(0.3);
  EXPECT_EQ(0x4000, bits());
  bus.wait(2.0);
  EXPECT_EQ(0x1400, bits());
  bus.ask(HALT);
  bus.wait(0.3);
  EXPECT_EQ(0x8000, bits());
}

TEST(ToshibaMonitors, heartbeatTogglesEverySecond)
{
  TestBus bus(vfs15());
  const TimePoint start = bus.now;
  for (int second = 0; second < 5; ++second)
  {
    bus.now = start + seconds(second + 0.5);
    EXPECT_EQ(second % 2 == 1, (read(bus, "FD 49") & 0x0800) != 0) << second;
  }
}

TEST(ToshibaMonitors, pastTripsNewestFirst)
{
  TestBus bus(vfs15());
  const int codes[] = { 1, 2, 3, 10, 13, 14, 24, 58, 71 };
  for (const int code : codes)
  {
    EXPECT_EQ("ok", bus.command("m trip " + std::to_string(code)));
  }
  EXPECT_EQ("01 03 08 00 47 00 3A 00 18 00 0E", bus.ask("01 03 FE 10 00 04"));
  EXPECT_EQ("01 03 08 00 0D 00 0A 00 03 00 02", bus.ask("01 03 FD 10 00 04"));
  EXPECT_EQ(71, read(bus, "FC 90"));
  EXPECT_EQ(0x0003, status(bus));
  bus.command("m power_cycle 0.05");
  bus.wait(0.1);
  EXPECT_EQ(71, read(bus, "FE 10"));
  EXPECT_EQ(0, read(bus, "FC 90"));
  EXPECT_EQ("error: no trip code 6 (those of E6581913 p. 63: 1-5, 8-24, 26-30, 32, ... 87)", bus.command("m trip 6"));
}

TEST(ToshibaMonitors, tripHoldsWhatWasGoingOn)
{
  TestBus bus(vfs15());
  run(bus);
  bus.command("m trip 10");
  EXPECT_EQ(0, read(bus, "FD 00"));
  EXPECT_EQ(6000, read(bus, "FE 00"));
  EXPECT_EQ(0x6400, read(bus, "FE 01") & 0x7FFF);
  EXPECT_NEAR(4854, read(bus, "FE 03"), 1);
}

TEST(ToshibaMonitors, clocksAndVersions)
{
  TestBus bus(vfs15());
  run(bus);
  EXPECT_EQ(301, read(bus, "FE 14"));
  EXPECT_EQ(120, read(bus, "FE 80"));
  bus.wait(24 * 3600.0);
  EXPECT_EQ(325, read(bus, "FE 14"));
  EXPECT_EQ(122, read(bus, "FE 80"));
  EXPECT_EQ(0x0100, read(bus, "FE 08"));
  EXPECT_EQ(0x0101, read(bus, "FE 73"));
  const int energy = read(bus, "FE 76");
  EXPECT_GT(energy, 0);
  bus.ask("01 06 FA 20 00 02");
  EXPECT_EQ(0, read(bus, "FE 76"));
}

TEST(ToshibaMonitors, pinnedByHandUntilSwitchedOff)
{
  TestBus bus(vfs15());
  bus.command("m set FC91 128");
  EXPECT_EQ(128, read(bus, "FC 91"));
  EXPECT_EQ(0x4004, status(bus));
  bus.command("m power_cycle 0.01");
  bus.wait(0.1);
  EXPECT_EQ(0, read(bus, "FC 91"));
}

TEST(ToshibaCommand, needsPriorityOrSources)
{
  TestBus bus(vfs15());
  bus.ask(SIXTY);
  bus.ask("01 06 FA 00 04 00");
  bus.wait(1.0);
  EXPECT_EQ("0", bus.shown("m", "running"));
  bus.ask("01 06 FA 00 84 00");  // runs, but the panel's FA03 counts
  bus.wait(1.0);
  EXPECT_EQ(0x6400, status(bus));
  EXPECT_EQ("0", bus.shown("m", "running"));
  bus.ask(RUN_FORWARD);
  bus.wait(1.0);
  EXPECT_EQ("60.00", bus.shown("m", "frequency"));
  bus.ask(RELEASE);
  bus.wait(2.0);
  EXPECT_EQ("0", bus.shown("m", "running"));
  TestBus sources(vfs15("CMOD: 2, FMOD: 4"));
  sources.ask(SIXTY);
  sources.ask("01 06 FA 00 04 00");
  sources.wait(2.0);
  EXPECT_EQ("60.00", sources.shown("m", "frequency"));
  EXPECT_EQ(2, read(sources, "FD 45"));
  EXPECT_EQ(4, read(sources, "FD 46"));
}

TEST(ToshibaCommand, rampsLimitsAndCoast)
{
  TestBus bus(vfs15("UL: 40.0, LL: 10.0, F500: 2.0"));
  bus.ask(SIXTY);
  bus.ask(RUN_FORWARD);
  bus.wait(0.25);
  EXPECT_NEAR(20.8, bus.number("m", "frequency"), 0.5);  // 80 Hz/s from the start frequency F240
  bus.wait(1.0);
  EXPECT_EQ("40.00", bus.shown("m", "frequency"));
  bus.ask("01 06 FA 01 00 64");  // 1 Hz: below LL
  bus.wait(1.0);
  EXPECT_EQ("10.00", bus.shown("m", "frequency"));
  bus.ask(COAST);
  EXPECT_EQ("0.00", bus.shown("m", "frequency"));
  EXPECT_EQ(0x4800, status(bus));
  bus.ask(SIXTY);
  bus.ask("01 06 FA 00 C4 40");  // second ramp: 40 Hz/s
  bus.wait(0.5);
  EXPECT_NEAR(20.8, bus.number("m", "frequency"), 0.5);
  EXPECT_EQ(0x6440, status(bus));
}

TEST(ToshibaCommand, presetsJogBrakeAndDirection)
{
  TestBus bus(vfs15("Sr3: 12.0, F287: 20.0, F294: 55.0, F260: 5.0, F311: 1"));
  bus.ask(SIXTY);
  const auto frequencyAt = [&bus](const std::string& word) {
    bus.ask("01 06 FA 00 " + word);
    bus.wait(2.0);
    return bus.shown("m", "frequency");
  };
  EXPECT_EQ("12.00", frequencyAt("C4 03"));
  EXPECT_EQ(255, read(bus, "FD 46"));
  EXPECT_EQ("20.00", frequencyAt("C4 08"));
  EXPECT_EQ("55.00", frequencyAt("C4 0F"));
  EXPECT_EQ("5.00", frequencyAt("C1 00"));
  EXPECT_EQ(0x6500, status(bus));
  EXPECT_EQ("0.00", frequencyAt("C6 00"));  // reverse is prohibited
  EXPECT_EQ("0.00", frequencyAt("C4 80"));
  EXPECT_EQ(0x4080, status(bus));
  EXPECT_EQ("2.40", bus.shown("m", "current"));  // F251: 50 % of 4.8 A
  EXPECT_EQ("60.00", frequencyAt("C4 00"));
}

TEST(ToshibaCommand, speedInRevolutions)
{
  TestBus bus(vfs15());
  EXPECT_EQ("01 06 FA 13 03 84", bus.ask("01 06 FA 13 03 84"));  // 900 per minute, 4 poles
  bus.ask(RUN_FORWARD);
  bus.wait(2.0);
  EXPECT_EQ("30.00", bus.shown("m", "frequency"));
  EXPECT_EQ("01 86 03", bus.ask("01 06 FA 13 09 61"));  // 2401: above FH = 80 Hz
  EXPECT_EQ("01 06 FA 13 09 60", bus.ask("01 06 FA 13 09 60"));
  bus.ask(SIXTY);
  bus.wait(2.0);
  EXPECT_EQ("60.00", bus.shown("m", "frequency"));
}

TEST(ToshibaCommand, frequencyAboveTheMaximumIsRefused)
{
  TestBus bus(vfs15());
  EXPECT_EQ("01 06 FA 01 1F 40", bus.ask("01 06 FA 01 1F 40"));
  EXPECT_EQ("01 86 03", bus.ask("01 06 FA 01 1F 41"));
  EXPECT_EQ(8000, read(bus, "FA 01"));
}

TEST(ToshibaCommand, secondCommandWord)
{
  TestBus bus(vfs15("F510: 4.0"));
  EXPECT_EQ("01 86 03", bus.ask("01 06 FA 20 03 00"));
  bus.ask("01 06 FA 20 02 00");
  bus.ask(SIXTY);
  bus.ask(RUN_FORWARD);
  bus.wait(0.5);
  EXPECT_NEAR(10.6, bus.number("m", "frequency"), 0.3);  // third ramp: 20 Hz/s
  EXPECT_EQ(0x0200, read(bus, "FD 42") & 0x0380);
  bus.wait(3.0);
  bus.ask("01 06 FA 20 00 80");
  bus.wait(0.5);
  EXPECT_EQ("0", bus.shown("m", "running"));  // forced stop
  EXPECT_EQ(0x0080, read(bus, "FD 42") & 0x0380);
}

TEST(ToshibaCommand, outputTerminalsFollowData)
{
  TestBus bus(vfs15("F130: 92, F131: 95"));
  EXPECT_EQ(2, read(bus, "FD 07") & 7);
  bus.ask("01 06 FA 50 00 03");
  EXPECT_EQ(1, read(bus, "FD 07") & 7);
  bus.ask("01 06 FA 26 00 02");
  EXPECT_EQ(3, read(bus, "FD 07") & 7);
  EXPECT_EQ(2, read(bus, "FD 49") & 3);
  bus.command("m trip 1");
  EXPECT_EQ(4, read(bus, "FD 07") & 4);
}

TEST(ToshibaCommand, ramDataIsNoEepromWrite)
{
  TestBus bus(vfs15());
  run(bus);
  for (const char* number : { "FA 10", "FA 11", "FA 20", "FA 26", "FA 50", "FA 51", "FA 87" })
  {
    const std::string write = std::string("01 06 ") + number + " 00 01";
    EXPECT_EQ(write, bus.ask(write));
    EXPECT_EQ(1, read(bus, number));
  }
  EXPECT_EQ("0", bus.shown("m", "eeprom_writes"));
  bus.ask("01 06 00 09 00 14");
  bus.ask("01 10 00 09 00 01 02 00 14");
  EXPECT_EQ("2", bus.shown("m", "eeprom_writes"));
  bus.command("m power_cycle 0.01");
  bus.wait(0.1);
  EXPECT_EQ(0, read(bus, "FA 87"));
  EXPECT_EQ(0, read(bus, "FA 01"));
  EXPECT_EQ(0x14, read(bus, "00 09"));
}

TEST(ToshibaTrip, keepsTheRunCommandUntilTheResetAndComesBackEmpty)
{
  TestBus bus(vfs15());
  run(bus);
  bus.ask("01 06 FA 87 00 01");
  bus.command("m trip 10");
  EXPECT_EQ("0.00", bus.shown("m", "frequency"));
  EXPECT_EQ("C400", bus.shown("m", "command"));
  EXPECT_EQ(10, read(bus, "FC 90"));
  EXPECT_EQ("", bus.ask(RESET));
  EXPECT_EQ("", bus.ask(HALT));  // about 1 s of silence
  EXPECT_EQ("0000", bus.shown("m", "command"));
  bus.wait(1.0);
  EXPECT_EQ(0, read(bus, "FC 90"));
  EXPECT_EQ(0, read(bus, "FA 01"));
  EXPECT_EQ(0, read(bus, "FA 87"));
  EXPECT_EQ(0x4000, status(bus));
  bus.wait(1.0);
  EXPECT_EQ("0", bus.shown("m", "running"));
}

TEST(ToshibaTrip, resetOfAHealthyDriveDoesNothingInSilence)
{
  TestBus bus(vfs15());
  run(bus);
  EXPECT_EQ("", bus.ask(RESET));
  EXPECT_EQ(0x6400, status(bus));
  EXPECT_EQ("C400", bus.shown("m", "command"));
  EXPECT_EQ("60.00", bus.shown("m", "frequency"));
}

TEST(ToshibaTrip, resetGetsNoReplyInAnyFrame)
{
  TestBus bus(vfs15(USEFUL_SLOTS));
  EXPECT_EQ("", bus.ask("01 10 FA 00 00 01 02 E0 00"));
  EXPECT_EQ("", bus.ask("01 10 18 70 00 02 04 E0 00 00 00"));
  EXPECT_EQ("", bus.ask("01 17 18 75 00 02 18 70 00 02 04 E0 00 00 00"));
  bus.command("m trip 10");
  EXPECT_EQ("", bus.ask("00 06 FA 00 E0 00"));
  EXPECT_EQ("0", bus.shown("m", "tripped"));
}

TEST(ToshibaTrip, emergencyStopNeedsNoPriority)
{
  TestBus bus(vfs15());
  run(bus);
  EXPECT_EQ("01 06 FA 00 10 00", bus.ask("01 06 FA 00 10 00"));
  EXPECT_EQ("0.00", bus.shown("m", "frequency"));
  EXPECT_EQ(17, read(bus, "FC 90"));
  EXPECT_EQ(0x1003, status(bus));
  TestBus ramp(vfs15("F603: 1"));
  run(ramp);
  ramp.ask(EMERGENCY);
  ramp.wait(0.3);
  EXPECT_EQ("decelerating", ramp.shown("m", "ramp"));
  EXPECT_EQ("0", ramp.shown("m", "tripped"));
  ramp.wait(1.0);
  EXPECT_EQ("17", ramp.shown("m", "trip"));
}

TEST(ToshibaTrip, overloadCanBeResetOnlyWhenCooledDown)
{
  TestBus bus(vfs15());
  run(bus);
  bus.command("m load 1.4");
  bus.wait(60.0);
  EXPECT_EQ(0x6404, status(bus));  // a warning first
  EXPECT_EQ(4, read(bus, "FC 91") & 4);
  bus.wait(60.0);
  EXPECT_EQ("14", bus.shown("m", "trip"));
  TestBus hot(vfs15());
  run(hot);
  hot.command("m load 1.8");
  for (int i = 0; i < 1000 && hot.shown("m", "tripped") == "0"; ++i)
  {
    hot.wait(0.1);
  }
  hot.ask(RESET);
  hot.wait(1.1);
  EXPECT_EQ(14, read(hot, "FC 90"));
  hot.wait(60.0);
  hot.ask(RESET);
  hot.wait(1.1);
  EXPECT_EQ(0, read(hot, "FC 90"));
}

TEST(ToshibaTrip, overcurrentTripsAtOnce)
{
  TestBus bus(vfs15());
  run(bus);
  bus.command("m load 2.5");
  EXPECT_EQ("3", bus.shown("m", "trip"));  // at constant speed
}

TEST(ToshibaTrip, isLostOrKeptOverThePowerCycle)
{
  TestBus lost(vfs15());
  lost.command("m trip 10");
  lost.command("m power_cycle 0.05");
  lost.wait(0.1);
  EXPECT_EQ(0x4000, status(lost));
  TestBus kept(vfs15("F602: 1"));
  kept.command("m trip 10");
  kept.command("m power_cycle 0.05");
  kept.wait(0.1);
  EXPECT_EQ(10, read(kept, "FC 90"));
}

TEST(ToshibaPower, shortCycleLosesTheCommand)
{
  TestBus bus(vfs15());
  run(bus);
  bus.command("m power_cycle 0.02");
  EXPECT_EQ("", bus.ask("01 03 FD 01 00 01"));
  bus.wait(0.05);
  EXPECT_EQ(0x4000, status(bus));
  EXPECT_EQ("0000", bus.shown("m", "command"));
  bus.wait(1.0);
  EXPECT_EQ("0", bus.shown("m", "running"));
}

TEST(ToshibaPower, isDeafForAboutASecond)
{
  TestBus bus(vfs15());
  bus.command("m power off");
  bus.wait(5.0);
  bus.command("m power on");
  bus.wait(0.9);
  EXPECT_EQ(-1, status(bus));
  bus.wait(0.2);
  EXPECT_EQ(0x4000, status(bus));
}

class ToshibaTimeout : public testing::TestWithParam<int>
{
};

TEST_P(ToshibaTimeout, doesWhatF804Says)
{
  const int action = GetParam();
  TestBus bus(vfs15("F803: 1.0, F804: " + std::to_string(action)));
  bus.wait(100.0);
  EXPECT_EQ("0", bus.shown("m", "tripped"));  // a master that never speaks causes nothing
  run(bus);                                   // 2 s of silence
  const bool trips = action == 1;
  EXPECT_EQ(action == 0 ? "60.00" : "0.00", bus.shown("m", "frequency"));
  EXPECT_EQ(action == 0 ? "1000" : "0000", bus.shown("m", "alarms"));
  EXPECT_EQ(trips || action == 2 ? "24" : "0", bus.shown("m", "trip"));
  EXPECT_EQ("C400", bus.shown("m", "command"));
  EXPECT_EQ(action == 0 ? 0x6404 : 0x0003, status(bus));
  EXPECT_EQ(action == 0 ? 0x6400 : 0x0003, status(bus));  // the first of the two ended the alarm
}

INSTANTIATE_TEST_SUITE_P(AllActions, ToshibaTimeout, testing::Values(0, 1, 2));

TEST(ToshibaTimer, coastsOrRampsDown)
{
  TestBus ramp(vfs15("F803: 1.0, F804: 2"));
  TestBus coast(vfs15("F803: 1.0, F804: 1"));
  for (TestBus* bus : { &ramp, &coast })
  {
    bus->ask(SIXTY);
    bus->ask(RUN_FORWARD);
    bus->wait(1.2);
  }
  EXPECT_EQ("decelerating", ramp.shown("m", "ramp"));
  EXPECT_EQ("0", ramp.shown("m", "tripped"));
  EXPECT_EQ("24", coast.shown("m", "trip"));
  ramp.wait(1.0);
  EXPECT_EQ("24", ramp.shown("m", "trip"));
}

TEST(ToshibaTimer, isFedByAcceptedRequestsToThisStationOnly)
{
  const std::string bus_of_two =
      "baud_rate: 19200\nscan_list: [{name: m, node: 1, drive: toshiba_vfs15}, {name: n, node: 2, drive: "
      "toshiba_vfs15}]\n"
      "simulation: {m: {parameters: {F803: 1.0, F804: 1, F808: 0}}}\n";
  for (const char* request : { "02 03 FD 01 00 01", "00 06 FA 00 C0 00", "01 03 FF FF 00 01", "01 04 FD 01 00 01" })
  {
    TestBus bus(bus_of_two);
    bus.ask("01 03 FD 01 00 01");
    bus.wait(0.6);
    bus.ask(request);
    bus.wait(0.6);
    EXPECT_EQ("24", bus.shown("m", "trip")) << request;
  }
  TestBus fed(bus_of_two);
  for (int i = 0; i < 5; ++i)
  {
    fed.ask("01 03 FD 01 00 01");
    fed.wait(0.6);
  }
  EXPECT_EQ("0", fed.shown("m", "trip"));
}

TEST(ToshibaTimer, isArmedByF808)
{
  const auto tripAfter = [](const std::string& when, const char* command) {
    TestBus bus(vfs15("F803: 1.0, F804: 1, F808: " + when));
    bus.ask(SIXTY);
    bus.ask(command);
    bus.wait(2.0);
    return bus.shown("m", "trip");
  };
  EXPECT_EQ("24", tripAfter("0", RELEASE));
  EXPECT_EQ("0", tripAfter("1", RELEASE));
  EXPECT_EQ("24", tripAfter("1", HALT));
  EXPECT_EQ("0", tripAfter("2", HALT));
  EXPECT_EQ("24", tripAfter("2", RUN_FORWARD));
}

TEST(ToshibaTimer, startsWithTheFirstExchangeAfterItWasSet)
{
  TestBus bus(vfs15("F804: 1, F808: 0"));
  bus.ask("01 06 08 03 00 0A");
  EXPECT_EQ("waiting", bus.shown("m", "watchdog"));
  bus.wait(10.0);
  EXPECT_EQ("0", bus.shown("m", "trip"));
  bus.ask("01 03 FD 01 00 01");
  bus.wait(0.9);
  EXPECT_EQ("0", bus.shown("m", "trip"));
  bus.wait(0.2);
  EXPECT_EQ("24", bus.shown("m", "trip"));
}

TEST(ToshibaTimer, waitsAfterAReset)
{
  TestBus bus(vfs15("F803: 1.0, F804: 1, F808: 0"));
  bus.command("m trip 10");
  bus.ask(RESET);
  bus.wait(10.0);
  EXPECT_EQ("0", bus.shown("m", "tripped"));
  EXPECT_EQ("waiting", bus.shown("m", "watchdog"));
}

TEST(ToshibaParameters, slotsTakeEffectAfterTheCommunicationReset)
{
  TestBus bus(vfs15());
  bus.ask("01 06 08 76 00 02");
  run(bus);
  EXPECT_EQ("01 03 04 00 00 00 00", bus.ask("01 03 18 75 00 02"));
  bus.command("m trip 10");
  EXPECT_EQ("01 86 04", bus.ask("01 06 08 99 00 01"));  // not while tripped
  bus.ask(RESET);                                       // takes effect here
  bus.wait(1.1);
  run(bus);
  EXPECT_EQ("01 03 04 00 00 17 70", bus.ask("01 03 18 75 00 02"));
  bus.ask("01 06 08 76 00 06");
  EXPECT_EQ("01 06 08 99 00 01", bus.ask("01 06 08 99 00 01"));
  EXPECT_EQ("01 03 04 00 00 00 00", bus.ask("01 03 18 75 00 02"));
  EXPECT_EQ(0, read(bus, "08 99"));
  EXPECT_EQ("60.00", bus.shown("m", "frequency"));  // nothing else was reset
}

TEST(ToshibaParameters, allReadSlotCodes)
{
  TestBus bus(vfs15());
  run(bus);
  bus.command("m set FD06 6");
  bus.command("m set FD07 7");
  const std::string expected[] = { "00 00", "",      "17 70", "",      "27 10", "00 00", "00 00", "00 06",
                                   "00 07", "00 00", "00 00", "00 00", "",      "07 08", "0B B8" };
  for (int code = 0; code <= 14; ++code)
  {
    bus.command("m set F875 " + std::to_string(code));
    bus.command("m set F899 1");
    const std::string value = bus.ask("01 03 18 75 00 02").substr(9, 5);
    EXPECT_TRUE(expected[code].empty() ? value != "00 00" : value == expected[code]) << code << ": " << value;
  }
  EXPECT_EQ("01 86 03", bus.ask("01 06 08 75 00 0F"));
}

TEST(ToshibaParameters, allWriteSlotCodes)
{
  TestBus bus(vfs15());
  const char* const numbers[] = { "FA 00", "FA 20", "FA 01", "FA 50", "FA 51", "FA 13" };
  for (int code = 1; code <= 6; ++code)
  {
    bus.command("m set F870 " + std::to_string(code));
    bus.command("m set F899 1");
    EXPECT_EQ("01 10 18 70 00 02", bus.ask("01 10 18 70 00 02 04 00 8" + std::to_string(code) + " 12 34"));
    EXPECT_EQ(0x80 + code, read(bus, numbers[code - 1]));
  }
}

TEST(ToshibaParameters, rangesAndLocks)
{
  TestBus bus(vfs15("UL: 60.0, LL: 10.0"));
  EXPECT_EQ("01 86 03", bus.ask("01 06 00 11 0B B7"));  // FH 29.99
  EXPECT_EQ("01 86 03", bus.ask("01 06 00 12 1F 41"));  // UL above FH
  EXPECT_EQ("01 86 03", bus.ask("01 06 00 13 17 71"));  // LL above UL
  EXPECT_EQ("01 86 03", bus.ask("01 06 00 18 03 E7"));  // Sr1 below LL
  EXPECT_EQ("01 86 03", bus.ask("01 06 FA 03 17 71"));  // panel frequency above UL
  EXPECT_EQ("01 86 03", bus.ask("01 06 08 03 03 E9"));  // F803 100.1
  EXPECT_EQ("01 86 03", bus.ask("01 06 08 00 00 02"));
  EXPECT_EQ("01 86 03", bus.ask("01 06 00 04 00 09"));  // FMOD has holes
  EXPECT_EQ("01 06 00 11 1B 58", bus.ask("01 06 00 11 1B 58"));
  run(bus);
  EXPECT_EQ("01 86 04", bus.ask("01 06 00 11 1F 40"));           // FH while running
  EXPECT_EQ("01 86 04", bus.ask("01 06 00 03 00 02"));           // CMOD while running: F736 = 1
  EXPECT_EQ("01 06 00 12 0F A0", bus.ask("01 06 00 12 0F A0"));  // UL
  bus.wait(1.0);
  EXPECT_EQ("40.00", bus.shown("m", "frequency"));
  bus.ask("01 06 07 36 00 00");
  EXPECT_EQ("01 06 00 03 00 02", bus.ask("01 06 00 03 00 02"));
}

TEST(ToshibaParameters, protectionByF700)
{
  TestBus bus(vfs15());
  bus.ask("01 06 07 00 00 02");
  EXPECT_EQ("01 86 04", bus.ask("01 06 00 09 00 64"));
  EXPECT_EQ(10, read(bus, "00 09"));
  bus.ask("01 06 07 00 00 04");
  EXPECT_EQ("01 83 04", bus.ask("01 03 00 09 00 01"));
  EXPECT_EQ(0x4000, status(bus));
  EXPECT_EQ(RUN_FORWARD, bus.ask(RUN_FORWARD));
  EXPECT_EQ("01 06 07 00 00 00", bus.ask("01 06 07 00 00 00"));
  EXPECT_EQ(10, read(bus, "00 09"));
}

TEST(ToshibaParameters, unitOfTheRampTimes)
{
  TestBus bus(vfs15());
  EXPECT_EQ(2, read(bus, "09 99"));
  bus.ask("01 06 05 19 00 01");
  EXPECT_EQ(1, read(bus, "09 99"));
  EXPECT_EQ(0, read(bus, "05 19"));
  EXPECT_EQ(100, read(bus, "00 09"));
  EXPECT_EQ("ok ACC ram=1.00 eeprom=1.00", bus.command("m get ACC"));
  bus.ask("01 06 00 09 00 C8");  // 2.00 s
  bus.ask(SIXTY);
  bus.ask(RUN_FORWARD);
  bus.wait(0.5);
  EXPECT_NEAR(20.8, bus.number("m", "frequency"), 0.5);
  TestBus commissioned(vfs15("F519: 1"));
  EXPECT_EQ(100, read(commissioned, "00 09"));
}

TEST(ToshibaParameters, stationIsTakenAtOnceAndZeroHearsBroadcastsOnly)
{
  TestBus bus(vfs15());
  EXPECT_EQ("01 06 08 02 00 09", bus.ask("01 06 08 02 00 09"));
  EXPECT_EQ("", bus.ask("01 03 FD 01 00 01"));
  EXPECT_NE("", bus.ask("09 03 FD 01 00 01"));
  bus.ask("09 06 08 02 00 00");
  EXPECT_EQ("", bus.ask("09 03 FD 01 00 01"));
  EXPECT_EQ("", bus.ask("00 03 FD 01 00 01"));
  EXPECT_EQ("", bus.ask("00 06 FA 00 C4 00"));
  EXPECT_EQ("C400", bus.shown("m", "command"));
}

TEST(ToshibaParameters, lineSettingsChangeWithTheReset)
{
  for (const char* change : { "08 00 00 03", "08 01 00 00", "08 29 00 00", "08 06 00 03" })
  {
    TestBus bus(vfs15());
    EXPECT_EQ(std::string("01 06 ") + change, bus.ask(std::string("01 06 ") + change));
    EXPECT_EQ(0x4000, status(bus)) << change;
    bus.command("m power_cycle 0.01");
    bus.wait(0.1);
    EXPECT_EQ(-1, status(bus)) << change;
  }
}

TEST(ToshibaParameters, understandsItsLinesOnly)
{
  for (const char* line : { "baud_rate: 9600\nparity: none", "baud_rate: 38400\nparity: odd\nstop_bits: 2" })
  {
    TestBus bus(std::string(line) + "\nscan_list: [{name: m, node: 1, drive: toshiba_vfs15}]");
    EXPECT_EQ(0x4000, status(bus)) << line;
  }
  TestBus seven("data_bits: 7\nscan_list: [{name: m, node: 1, drive: toshiba_vfs15}]");
  EXPECT_EQ(-1, status(seven));
  TestBus mistaken(vfs15("F801: 2"));
  EXPECT_EQ(-1, status(mistaken));
  EXPECT_THROW(TestBus("baud_rate: 4800\nscan_list: [{name: m, node: 1, drive: toshiba_vfs15}]"), ConfigError);
  EXPECT_THROW(TestBus(vfs15("F998: 1")), ConfigError);
  EXPECT_THROW(TestBus(vfs15("F803: 100.1")), ConfigError);
}

TEST(ToshibaParameters, factorySettings)
{
  TestBus bus(vfs15());
  EXPECT_EQ("01 06 00 07 00 01", bus.ask("01 06 00 07 00 01"));
  EXPECT_EQ(5000, read(bus, "00 12"));
  bus.command("m set F802 1");
  EXPECT_EQ("01 06 00 07 00 03", bus.ask("01 06 00 07 00 03"));
  EXPECT_EQ("1", bus.shown("m", "busy"));
  EXPECT_EQ("ok ACC ram=10.0 eeprom=10.0", bus.command("m get ACC"));
  EXPECT_EQ(-1, status(bus));  // F802 = 0
}

TEST(ToshibaParameters, wholeTableIsReadable)
{
  for (const ToshibaModel* model : { &toshibaVfs15(), &toshibaVfs11() })
  {
    TestBus bus("scan_list: [{name: m, node: 1, drive: " + model->name + "}]");
    for (const Parameter& parameter : model->parameters)
    {
      const std::string number = toHex(
          { static_cast<std::uint8_t>(parameter.number >> 8), static_cast<std::uint8_t>(parameter.number & 0xFF) });
      EXPECT_NE(-1, read(bus, number)) << model->name << parameter.code;
      EXPECT_LE(parameter.minimum, parameter.initial) << parameter.code;
      EXPECT_LE(parameter.initial, parameter.maximum) << parameter.code;
    }
  }
}

TEST(ToshibaHand, panelTakesOverAndGivesBack)
{
  TestBus bus(vfs15());
  run(bus);
  EXPECT_EQ("ok", bus.command("m panel -20"));
  bus.wait(2.0);
  EXPECT_EQ("20.00", bus.shown("m", "frequency"));
  EXPECT_EQ("-1", bus.shown("m", "direction"));
  EXPECT_EQ(1, read(bus, "FD 45"));
  EXPECT_EQ(0, read(bus, "FD 46"));
  EXPECT_EQ(1, read(bus, "FA 08"));
  EXPECT_EQ(2000, read(bus, "FA 03"));
  EXPECT_EQ(HALT, bus.ask(HALT));
  bus.wait(2.0);
  EXPECT_EQ("20.00", bus.shown("m", "frequency"));  // the bus has no say
  bus.command("m panel_stop");
  bus.wait(2.0);
  EXPECT_EQ("0", bus.shown("m", "running"));
  bus.command("m panel_release");
  EXPECT_EQ(2, read(bus, "FD 45"));
  EXPECT_EQ("error: the panel has not taken over (see help)", bus.command("m panel_release"));
  EXPECT_EQ("error: above the maximum frequency FH = 80.00 Hz (see help)", bus.command("m panel 81"));
  EXPECT_EQ("0", bus.shown("m", "eeprom_writes"));
}

TEST(ToshibaHand, stopKeyHoldsUntilRunWasOff)
{
  TestBus bus(vfs15());
  run(bus);
  EXPECT_EQ("ok", bus.command("m panel_stop"));
  bus.wait(2.0);
  EXPECT_EQ(0x4000, status(bus));
  EXPECT_EQ("C400", bus.shown("m", "command"));
  bus.ask(RUN_FORWARD);
  bus.wait(1.0);
  EXPECT_EQ("0", bus.shown("m", "running"));
  bus.ask(HALT);
  bus.ask(RUN_FORWARD);
  bus.wait(1.0);
  EXPECT_EQ("1", bus.shown("m", "running"));
}

TEST(ToshibaHand, safeStopCoastsWithoutATrip)
{
  TestBus bus(vfs15());
  run(bus);
  bus.command("m sto on");
  EXPECT_EQ("0.00", bus.shown("m", "frequency"));
  EXPECT_EQ("0", bus.shown("m", "tripped"));
  EXPECT_EQ(0x4800, status(bus));
  bus.command("m sto off");
  bus.wait(1.0);
  EXPECT_EQ("1", bus.shown("m", "running"));  // F719 = 1 keeps the run command
  bus.ask("01 06 07 19 00 00");
  bus.command("m sto on");
  EXPECT_EQ("C000", bus.shown("m", "command"));
  bus.command("m sto off");
  bus.wait(1.0);
  EXPECT_EQ("0", bus.shown("m", "running"));
}

TEST(ToshibaHand, busyRefusesWritesAndAnswersReads)
{
  TestBus bus(vfs15());
  bus.command("m busy 0.5");
  EXPECT_EQ("01 86 04", bus.ask(RUN_FORWARD));
  EXPECT_EQ("01 86 02", bus.ask("01 06 FF FF 00 00"));
  EXPECT_EQ(0x4000, status(bus));
  bus.wait(0.5);
  EXPECT_EQ(RUN_FORWARD, bus.ask(RUN_FORWARD));
}

TEST(ToshibaHand, motorIsTheSameInOneStepAndInMany)
{
  TestBus big(vfs15("F102: 2.5"));
  TestBus small(vfs15("F102: 2.5"));
  big.command("m set ACC 5");
  small.command("m set ACC 5");
  for (TestBus* bus : { &big, &small })
  {
    bus->ask(THIRTY);
    bus->ask(RUN_FORWARD);
  }
  big.wait(1.5);
  for (int i = 0; i < 150; ++i)
  {
    small.wait(0.01);
    small.command("m show");
  }
  EXPECT_EQ(big.shown("m", "frequency"), small.shown("m", "frequency"));
}
