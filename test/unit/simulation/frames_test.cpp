// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

// Frames of real drives and of manuals, byte by byte, both ways (sources: the makers' manuals and answers of a real MX2
// that its users published).

#include <gtest/gtest.h>

#include "support/simulation_test_bus.h"

using namespace inverter_bus::simulation;

namespace
{
std::string mx2At(int station, const std::string& extra = "")
{
  return "scan_list: [{name: m, node: " + std::to_string(station) + ", drive: omron_mx2" + extra + "}]";
}
}  // namespace

TEST(SimulatedMx2Frames, runIsEchoed)
{
  TestBus one(mx2At(1));
  EXPECT_EQ("01 05 00 00 FF 00 8C 3A", one.askRaw("01 05 00 00 FF 00 8C 3A"));
  TestBus eight(mx2At(8));
  EXPECT_EQ("08 05 00 00 FF 00 8C A3", eight.askRaw("08 05 00 00 FF 00 8C A3"));
  EXPECT_EQ("08 05 00 00 00 00 CD 53", eight.askRaw("08 05 00 00 00 00 CD 53"));
}

TEST(SimulatedMx2Frames, directionAndResetAreEchoed)
{
  TestBus bus(mx2At(1));
  EXPECT_EQ("01 05 00 01 FF 00 DD FA", bus.askRaw("01 05 00 01 FF 00 DD FA"));
  EXPECT_EQ("01 05 00 03 FF 00 7C 3A", bus.askRaw("01 05 00 03 FF 00 7C 3A"));
  EXPECT_EQ("01 05 00 03 00 00 3D CA", bus.askRaw("01 05 00 03 00 00 3D CA"));
}

TEST(SimulatedMx2Frames, inputsAreReadAsInTheManual)
{
  TestBus bus(mx2At(8));
  bus.ask("08 0F 00 06 00 06 01 17");
  EXPECT_EQ("08 01 01 17 12 1A", bus.askRaw("08 01 00 06 00 06 5C 90"));
}

TEST(SimulatedMx2Frames, elevenStatusCoils)
{
  TestBus bus(mx2At(1));
  EXPECT_EQ("01 01 02 04 00 BB 3C", bus.askRaw("01 01 00 0E 00 0B 1C 0E"));  // only ready
}

TEST(SimulatedMx2Frames, referenceAndStatusInOneRead)
{
  TestBus bus(mx2At(1));
  EXPECT_EQ("01 10 00 00 00 02 41 C8", bus.askRaw("01 10 00 00 00 02 04 00 00 13 88 FE F9"));
  EXPECT_EQ("01 03 0A 00 00 13 88 00 02 00 00 00 01", bus.ask("01 03 00 00 00 05"));
  EXPECT_EQ("01 06 00 01 13 88 D5 5C", bus.askRaw("01 06 00 01 13 88 D5 5C"));
}

TEST(SimulatedMx2Frames, lastTripAsARealDriveAnswered)
{
  TestBus bus(mx2At(1, ", rated_voltage: 235.46656"));
  bus.command("m trip 12");
  EXPECT_EQ("01 03 0C 00 0C 00 01 00 00 00 00 00 00 0D 02 24 E1", bus.askRaw("01 03 00 11 00 06 95 CD"));
}

TEST(SimulatedMx2Frames, fullTripBlock)
{
  TestBus bus(mx2At(1));
  bus.command("m trip 41");
  EXPECT_EQ("01 03 14 00 29 00 01 00 00 00 00 00 00 0C B5 00 00 01 2D 00 00 04 B1", bus.ask("01 03 00 11 00 0A"));
}

TEST(SimulatedMx2Frames, writeAndReadInOneExchange)
{
  TestBus bus(mx2At(1));
  EXPECT_EQ("01 17 04 00 00 00 00 F9 27", bus.askRaw("01 17 10 00 00 02 00 00 00 02 04 00 00 13 88 F4 86"));
  EXPECT_EQ("50.00", bus.shown("m", "reference"));
}

TEST(SimulatedMx2Frames, accelerationTime)
{
  TestBus bus(mx2At(1));
  EXPECT_EQ("01 10 11 02 00 02", bus.askRaw("01 10 11 02 00 02 04 00 00 03 E8 B2 98").substr(0, 17));
  EXPECT_EQ("ok F002 ram=10.00 eeprom=10.00", bus.command("m get F002"));
}

TEST(SimulatedMx2Frames, baseFrequencyInTenths)
{
  TestBus bus(mx2At(8));
  EXPECT_EQ("08 06 12 02 01 F4 2D FC", bus.askRaw("08 06 12 02 01 F4 2D FC"));
  EXPECT_EQ("ok A003 ram=50.0 eeprom=50.0", bus.command("m get A003"));
}

TEST(SimulatedRxFrames, baseFrequencyInWholeHertz)
{
  TestBus bus("scan_list: [{name: m, node: 5, drive: omron_rx}]");
  EXPECT_EQ("05 06 12 02 00 32 AD 23", bus.askRaw("05 06 12 02 00 32 AD 23"));
  EXPECT_EQ("ok A003 ram=50 eeprom=50", bus.command("m get A003"));
}

TEST(SimulatedMx2Frames, enterIsEchoed)
{
  TestBus eight(mx2At(8));
  EXPECT_EQ("08 06 08 FF 00 01 7A C3", eight.askRaw("08 06 08 FF 00 01 7A C3"));
  TestBus one(mx2At(1));
  EXPECT_EQ("01 06 08 FF 00 01 7A 5A", one.askRaw("01 06 08 FF 00 01 7A 5A"));
}

TEST(SimulatedMx2Frames, busyCoilAndMirror)
{
  TestBus bus(mx2At(1));
  EXPECT_EQ("01 01 01 00 51 88", bus.askRaw("01 01 00 48 00 06 3C 1E"));
  EXPECT_EQ("01 03 0A 00 02 01 00 00 00 00 20 00 00", bus.ask("01 03 1E 00 00 05"));
}

TEST(SimulatedMx2Frames, writeToAMonitorIsRefusedAsARealDriveDoes)
{
  TestBus bus(mx2At(1));
  EXPECT_EQ("01 90 23 0D D9", bus.askRaw("01 10 10 13 00 02 04 00 04 93 E0 53 CF"));
}

TEST(SimulatedMx2Frames, loopBack)
{
  TestBus bus(mx2At(1));
  EXPECT_EQ("01 08 00 00 01 F4 E0 1C", bus.askRaw("01 08 00 00 01 F4 E0 1C"));
  EXPECT_EQ("01 88 03", bus.ask("01 08 00 01 01 F4"));
}

TEST(SimulatedMx2Frames, fiveCoilsWithTwoDataBytes)
{
  TestBus bus(mx2At(1));
  EXPECT_EQ("01 0F 00 06 00 05 75 C9", bus.askRaw("01 0F 00 06 00 05 02 17 00 E9 BA"));
}

TEST(SimulatedMx2Frames, readWriteCoilsThroughTheMirrorRegister)
{
  TestBus bus(mx2At(1));
  bus.ask(SPEED_50);
  EXPECT_EQ("01 06 1F 00 00 02", bus.ask("01 06 1F 00 00 02"));
  EXPECT_EQ("1", bus.shown("m", "run_coil"));
  bus.wait(1.0);
  EXPECT_EQ("01 03 02 80 02", bus.ask("01 03 1F 00 00 01"));  // and the operation status in bit 15
}

TEST(SimulatedMx2Frames, exceptions)
{
  TestBus bus(mx2At(1));
  EXPECT_EQ("01 84 01", bus.ask("01 04 00 00 00 01"));
  EXPECT_EQ("01 82 01", bus.ask("01 02 00 00 00 01"));
  EXPECT_EQ("01 83 02", bus.ask("01 03 10 28 00 02"));  // 1029h is reserved, 102Ah doesn't exist
  EXPECT_EQ("01 83 03", bus.ask("01 03 10 00 00 11"));  // 17 registers
  EXPECT_EQ("01 83 03", bus.ask("01 03 10 00 00 00"));
  EXPECT_EQ("01 81 03", bus.ask("01 01 00 00 00 21"));  // 33 coils
  EXPECT_EQ("01 85 03", bus.ask("01 05 00 00 12 34"));
  EXPECT_EQ("01 85 23", bus.ask("01 05 00 0E FF 00"));                 // a status coil
  EXPECT_EQ("01 85 02", bus.ask("01 05 00 0D FF 00"));                 // the MX2 has no input S8
  EXPECT_EQ("01 86 21", bus.ask("01 06 12 00 00 05"));                 // A001 = 5 is no choice
  EXPECT_EQ("01 86 21", bus.ask("01 06 14 50 27 10"));                 // C077 = 100.00 s
  EXPECT_EQ("01 90 21", bus.ask("01 10 00 00 00 02 04 00 00 13 89"));  // above A004
  EXPECT_EQ("01 86 02", bus.ask("01 06 30 00 00 00"));
  EXPECT_EQ("13", bus.shown("m", "exceptions"));
  EXPECT_EQ("01 01 04 00 00 00 00", bus.ask("01 01 00 57 00 20"));  // past the last coil: zeros, no exception
}

TEST(SimulatedMx2Frames, silentOnWhatIsNotForIt)
{
  TestBus bus(mx2At(1));
  EXPECT_EQ("", bus.askRaw("01 03 10 00 00 02 C0 CA"));     // CRC
  EXPECT_EQ("", bus.ask("02 03 10 00 00 02"));              // station
  EXPECT_EQ("", bus.ask("01 03 10 00 00"));                 // length
  EXPECT_EQ("", bus.ask("01 10 00 00 00 02 04 00 00 13"));  // length
  EXPECT_EQ("3", bus.shown("m", "damaged_requests"));
}

TEST(SimulatedMx2Frames, broadcastIsExecutedAndNotAnswered)
{
  TestBus bus("scan_list: [{name: a, node: 1, drive: omron_mx2}, {name: b, node: 12, drive: omron_mx2}]");
  EXPECT_EQ("", bus.ask("00 10 00 00 00 02 04 00 00 13 88"));
  EXPECT_EQ("50.00", bus.shown("a", "reference"));
  EXPECT_EQ("50.00", bus.shown("b", "reference"));
  EXPECT_EQ("", bus.ask("00 03 00 00 00 02"));  // a read makes no sense
  EXPECT_EQ("", bus.ask("FB 05 00 00 FF 00"));  // 251: stations 10-19
  EXPECT_EQ("0", bus.shown("a", "run_coil"));
  EXPECT_EQ("1", bus.shown("b", "run_coil"));
}

TEST(SimulatedMx2Frames, answerDelayC078)
{
  TestBus bus(oneMx2("C078: 100"));
  const TimePoint sent = bus.now;
  bus.ask("01 03 10 00 00 02");
  const LineSettings line;
  const Duration expected =
      line.characterTime() * 8 + line.frameGap() + seconds(0.002) + seconds(0.100) + line.characterTime() * 9;
  EXPECT_NEAR(toSeconds(expected), toSeconds(bus.last_byte - sent), 1e-6);
}

TEST(SimulatedRxFrames, limits)
{
  TestBus bus(oneRx());
  EXPECT_EQ("01 83 03", bus.ask("01 03 10 00 00 05"));  // 5 registers
  EXPECT_EQ("01 03 08 00 00 00 00 00 00 00 00", bus.ask("01 03 10 00 00 04"));
  EXPECT_EQ("01 90 03", bus.ask("01 10 12 15 00 06 0C 00 00 00 00 00 00 00 00 00 00 00 00"));
  EXPECT_EQ("01 97 01", bus.ask("01 17 10 00 00 02 00 00 00 02 04 00 00 13 88"));
  EXPECT_EQ("01 83 02", bus.ask("01 03 1E 00 00 01"));           // no coil mirror
  EXPECT_EQ("01 05 00 0D FF 00", bus.ask("01 05 00 0D FF 00"));  // input S8
  EXPECT_EQ("01 86 02", bus.ask("01 06 16 C8 00 00"));           // no P200
  EXPECT_EQ("", bus.ask("FA 05 00 00 FF 00"));                   // no groups
  EXPECT_EQ("0", bus.shown("m", "run_coil"));
}

TEST(SimulatedRxFrames, scales)
{
  TestBus bus(oneRx());
  bus.ask(SPEED_50);
  bus.ask(RUN);
  bus.wait(10.0);
  const double current = bus.number("m", "current");
  const std::string reply = bus.ask("01 03 10 02 00 01");
  EXPECT_NEAR(current * 10.0, std::stoi(reply.substr(9, 2) + reply.substr(12, 2), nullptr, 16), 0.6);
  bus.command("m trip 14");
  EXPECT_EQ("01 03 06 00 0E 00 03 00 00", bus.ask("01 03 00 11 00 03"));
  const std::string block = bus.ask("01 03 00 14 00 03");
  EXPECT_EQ("13 88", block.substr(9, 5));                                                      // 50.00 Hz
  EXPECT_NEAR(325.0, std::stoi(block.substr(21, 2) + block.substr(24, 2), nullptr, 16), 5.0);  // whole volts
}
