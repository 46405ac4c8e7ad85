// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

// The Modbus mapping of a simulated MX2 (P200-P310), its function 17h, and reads over reserved registers. Frames with a check
// sum are the makers' own (OMRON I585, Hitachi WJ200, and logs of a real drive), with two exceptions that say so.

#include <gtest/gtest.h>

#include "support/simulation_test_bus.h"

using namespace inverter_bus::simulation;

namespace
{
/// \p parameters as set at the panel before the drive was switched on, with the mapping in use.
std::string mapped(const std::string& parameters, const std::string& more = "")
{
  return "baud_rate: 19200\nscan_list: [{name: m, node: 1, drive: omron_mx2}]\n"
         "simulation: {m: {" +
         more + "parameters: {F002: 5.0, F003: 5.0, P200: 1, " + parameters + "}}}\n";
}

// Over d004 (1005h, 1006h): status coils 1E01h and command coils 1F01h.
const char* const OVER_D004 = "P201: 0x1005, P301: 0x1E01, P202: 0x1006, P302: 0x1F01";
const char* const READ_SIX = "01 03 10 00 00 06";
}  // namespace

TEST(SimulatedMapping, shownAsTheMakersShow)
{
  // A016 = 16 (1212h) seen at 4001h; A014 = 100 (1210h) over A001 (1201h).
  TestBus bus(mapped("A016: 16, P201: 0x4001, P301: 0x1212, P202: 0x1201, P302: 0x1210"));
  EXPECT_EQ("01 03 02 00 10 B9 88", bus.askRaw("01 03 40 00 00 01 91 CA"));
  EXPECT_EQ("01 03 02 00 64 B9 AF", bus.askRaw("01 03 12 00 00 01 81 72"));
  EXPECT_EQ("01 03 02 00 03", bus.ask("01 03 12 01 00 01"));  // A002 beside it is its own
  EXPECT_EQ("01 03 02 00 10", bus.ask("01 03 12 11 00 01"));  // the internal number stays where it is
  EXPECT_EQ("1", bus.shown("m", "mapping"));
}

TEST(SimulatedMapping, ratioDividesWhatIsReadAndMultipliesWhatIsWritten)
{
  TestBus bus(mapped("A016: 16, P201: 0x4001, P301: 0x1212, P221: 2.0"));
  EXPECT_EQ("01 03 02 00 08", bus.ask("01 03 40 00 00 01"));
  EXPECT_EQ("01 06 40 00 00 0A", bus.ask("01 06 40 00 00 0A"));
  EXPECT_EQ("ok A016 ram=20 eeprom=16", bus.command("m get A016"));
  EXPECT_EQ("01 86 21", bus.ask("01 06 40 00 00 10"));  // 32: above the internal register's range
}

TEST(SimulatedMapping, signedValuesAreTwosComplement)
{
  // b045 (132Fh) takes any word.
  TestBus bus(mapped("P203: 0x4003, P213: 1, P303: 0x132F, P204: 0x4004, P214: 1, P304: 0x132F, P224: 0.5"));
  EXPECT_EQ("01 06 40 02 FF FF 3C 7A", bus.askRaw("01 06 40 02 FF FF 3C 7A"));
  EXPECT_EQ("01 03 02 FF FF", bus.ask("01 03 13 2E 00 01"));
  EXPECT_EQ("01 03 02 FF FE", bus.ask("01 03 40 03 00 01"));  // -1 / 0.5
  bus.ask("01 06 13 2E 7F FF");
  EXPECT_EQ("01 03 02 7F FF", bus.ask("01 03 40 03 00 01"));  // 65534 is cut off at 32767
  EXPECT_EQ("01 06 40 03 80 00", bus.ask("01 06 40 03 80 00"));
  EXPECT_EQ("01 03 02 C0 00", bus.ask("01 03 13 2E 00 01"));  // -32768 x 0.5
}

TEST(SimulatedMapping, whatNoSlotCanDoIs31h)
{
  TestBus bus(
      mapped("P201: 0x6001, P202: 0x6002, P302: 0x1001, P203: 0x6003, P303: 0x5555, "
             "P204: 0x6004, P304: 0x1212, P205: 0x6004, P305: 0x1210, P206: 0x6006, P306: 0x0002"));
  EXPECT_EQ("01 83 31 80 E4", bus.askRaw("01 03 60 00 00 01 9A 0A"));  // no internal register
  EXPECT_EQ("01 83 31", bus.ask("01 03 60 01 00 01"));                 // d001 has two words
  EXPECT_EQ("01 83 31", bus.ask("01 03 60 02 00 01"));                 // does not exist
  EXPECT_EQ("01 83 31", bus.ask("01 03 60 03 00 01"));                 // external number in two slots
  EXPECT_EQ("01 83 31", bus.ask("01 03 60 05 00 01"));                 // half of F001
  EXPECT_EQ("01 86 31", bus.ask("01 06 60 02 00 01"));
  EXPECT_EQ("01 03 02 00 03", bus.ask("01 03 12 01 00 01"));  // the rest of the drive is as ever
}

TEST(SimulatedMapping, theOtherHalfOfAHiddenPairIs32h)
{
  // 1218h, 1219h: A021.
  TestBus bus(mapped("P201: 0x1218, P301: 0x1210, P202: 0x1005, P302: 0x1E01"));
  EXPECT_EQ("01 03 02 00 64", bus.ask("01 03 12 17 00 01"));
  EXPECT_EQ("01 83 32 C0 E5", bus.askRaw("01 03 12 18 00 01 01 75"));
  EXPECT_EQ("01 86 32", bus.ask("01 06 12 18 00 01"));
  EXPECT_EQ("01 83 32", bus.ask(READ_SIX));  // 1006h alone is half of d004
  EXPECT_EQ("01 03 04 00 00 00 00", bus.ask("01 03 12 19 00 02"));
}

TEST(SimulatedMapping, countsFromTheNextPowerOnAndOnlyWhenStored)
{
  TestBus bus(oneMx2());
  EXPECT_EQ("01 03 02 00 00", bus.ask("01 03 16 C7 00 01"));
  EXPECT_EQ("01 10 16 C8 00 02", bus.ask("01 10 16 C8 00 02 04 10 05 10 06"));
  EXPECT_EQ("01 10 16 E6 00 02", bus.ask("01 10 16 E6 00 02 04 1E 01 1F 01"));
  EXPECT_EQ("01 06 16 C7 00 01 FD BF", bus.askRaw("01 06 16 C7 00 01 FD BF"));  // put together here, not a maker's
  EXPECT_EQ("01 03 0C 00 00 00 00 00 00 00 00 00 00 00 00", bus.ask(READ_SIX)) << "not before a power cycle";
  bus.command("m power_cycle 3");
  bus.wait(4.0);
  EXPECT_EQ("0", bus.shown("m", "mapping")) << "it was in the RAM only";

  bus.ask("01 10 16 C8 00 02 04 10 05 10 06");
  bus.ask("01 10 16 E6 00 02 04 1E 01 1F 01");
  bus.ask("01 06 16 C7 00 01");
  EXPECT_EQ("01 06 08 FF 00 01 7A 5A", bus.askRaw("01 06 08 FF 00 01 7A 5A"));  // Enter
  bus.wait(1.0);
  EXPECT_EQ("01 03 0C 00 00 00 00 00 00 00 00 00 00 00 00", bus.ask(READ_SIX)) << "Enter alone is not enough";
  bus.command("m power_cycle 3");
  bus.wait(4.0);
  EXPECT_EQ("01 03 0C 00 00 00 00 00 00 00 00 00 02 00 00", bus.ask(READ_SIX)) << "1E01h: bit 1, ready";
  EXPECT_EQ("01 06 16 C7 00 00", bus.ask("01 06 16 C7 00 00"));
  EXPECT_EQ("1", bus.shown("m", "mapping")) << "switching it off waits for the power cycle too";
}

TEST(SimulatedMapping, oneReadBringsTheWholeStatus)
{
  TestBus bus(mapped(OVER_D004));
  bus.ask(SPEED_50);
  bus.ask(RUN);
  bus.wait(10.0);
  // d001 = 50.00 Hz, d002, d003 = 1 forward, 1E01h: ready, RUN, FA1; 1F01h: RUN, and coil 000Fh as bit 15.
  EXPECT_EQ("01 03 0C 00 00 13 88 00", bus.ask(READ_SIX).substr(0, 23));
  EXPECT_EQ("00 01 00 1A 80 02", bus.ask(READ_SIX).substr(27));
  EXPECT_EQ("01 06 10 05 00 06", bus.ask("01 06 10 05 00 06")) << "an external number can be written: RUN and reverse";
  bus.wait(11.0);
  EXPECT_EQ("00 02 00 1B 80 06", bus.ask(READ_SIX).substr(27));
}

TEST(SimulatedMapping, aDriveMayAnswerSingleReadsOnly)
{
  TestBus bus(mapped(OVER_D004, "mapped_reads_in_blocks: false, "));
  EXPECT_EQ("01 83 02", bus.ask(READ_SIX));
  EXPECT_EQ("01 03 02 00 02", bus.ask("01 03 10 04 00 01"));
  EXPECT_EQ("01 03 08 00 00 00 00 00 00 00 00", bus.ask("01 03 10 00 00 04"));
}

TEST(SimulatedMapping, onlyWithP200AndNotOnAnRx)
{
  TestBus off(
      "baud_rate: 19200\nscan_list: [{name: m, node: 1, drive: omron_mx2}]\n"
      "simulation: {m: {parameters: {P201: 0x1201, P301: 0x1210}}}\n");
  EXPECT_EQ("01 03 02 00 03", off.ask("01 03 12 00 00 01"));
  TestBus rx(oneRx());
  EXPECT_EQ("01 83 02", rx.ask("01 03 16 C7 00 01"));
}

TEST(SimulatedReadWrite, framesOfTheManualAndOfARealDrive)
{
  TestBus bus(oneMx2());
  const char* const ask = "01 17 10 00 00 02 00 00 00 02 04 00 00 13 88 F4 86";
  EXPECT_EQ("01 17 04 00 00 00 00 F9 27", bus.askRaw(ask));  // at rest
  bus.ask(RUN);
  bus.wait(10.0);
  EXPECT_EQ("01 17 04 00 00 13 88 F4 71", bus.askRaw(ask));
}

TEST(SimulatedReadWrite, writesBeforeItReadsAndNothingWhenRefused)
{
  TestBus bus(mapped(std::string(OVER_D004) + ", P203: 0x0003, P303: 0x1F01"));
  // Put together here: F001 = 50 Hz and, through the map, RUN; read d001 to 1006h.
  EXPECT_EQ("01 17 0C 00 00 00 00 00 00 00 00 00 02 00 02",
            bus.ask("01 17 10 00 00 06 00 00 00 03 06 00 00 13 88 00 02"))
      << "1006h already shows the RUN that the same frame wrote";
  EXPECT_EQ("01 97 21", bus.ask("01 17 10 00 00 06 00 00 00 02 04 00 00 FF FF")) << "above the maximum frequency";
  EXPECT_EQ("01 97 03", bus.ask("01 17 10 00 00 11 00 00 00 02 04 00 00 13 88")) << "17 registers";
  EXPECT_EQ("", bus.ask("00 17 10 00 00 02 00 00 00 02 04 00 00 13 88")) << "not with station 0";
  EXPECT_EQ("", bus.ask("FA 17 10 00 00 02 00 00 00 02 04 00 00 13 88")) << "nor with a group";
}

TEST(SimulatedReserved, canBeReadOverOrNot)
{
  TestBus open(oneMx2());
  EXPECT_EQ("01 03 20", open.ask("01 03 10 00 00 10").substr(0, 8));  // over 100Fh
  EXPECT_EQ("01 03 20", open.ask("01 03 00 02 00 10").substr(0, 8));  // over 0007h-0010h to d080 and d081
  EXPECT_EQ("01 03 20", open.ask("01 03 10 18 00 10").substr(0, 8));  // over 101Ah-101Ch, 1020h-1025h
  EXPECT_EQ("01 86 23", open.ask("01 06 10 28 00 01"));               // 1029h: as a real drive answered
  TestBus closed(
      "baud_rate: 19200\nscan_list: [{name: m, node: 1, drive: omron_mx2}]\n"
      "simulation: {m: {reserved_readable: false}}\n");
  EXPECT_EQ("01 83 02", closed.ask("01 03 10 00 00 10"));
  EXPECT_EQ("01 83 02", closed.ask("01 03 00 02 00 10"));
  EXPECT_EQ("01 03 1C", closed.ask("01 03 10 00 00 0E").substr(0, 8));  // 1001h-100Eh have no hole
}
