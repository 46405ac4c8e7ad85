// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

// The simulated OMRON 3G3JE and its CompoWay/F bus: frames byte by byte, end codes and response codes, and what the
// drive does.

#include <gtest/gtest.h>

#include "support/simulation_test_bus.h"

using namespace inverter_bus::simulation;

namespace
{
/// One 3G3JE named j at 9600 7E2, 60 Hz in 6 s up and down.
std::string oneJe(const std::string& options = "", const std::string& parameters = "", int station = 1)
{
  return "protocol: compoway_f\nbaud_rate: 9600\nscan_list: [{name: j, node: " + std::to_string(station) +
         ", drive: omron_3g3je}]\nsimulation: {j: {parameters: {acceleration: 6, deceleration: 6" +
         (parameters.empty() ? "" : ", " + parameters) + "}" + (options.empty() ? "" : ", " + options) + "}}\n";
}

const char* const FORWARD_RUN = "0100030051101";
const char* const REVERSE_RUN = "0100030051102";
const char* const STOP_OPERATION = "0100030051100";
const char* const RESET_OPERATION = "0100030051201";
const char* const TO_RAM = "0100030051401";
const char* const TO_BACKUP = "0100030051400";
const char* const TO_AREA_0 = "0100030051700";
const char* const TO_AREA_1 = "0100030051701";
const char* const OPERATED = "01000030050000";
const char* const OPERATION_REFUSED = "01000F30052203";
const char* const SPEED_30 = "010000102C100000000010000012C";
const char* const SPEED_60 = "010000102C1000000000100000258";
const char* const WRITTEN = "01000001020000";
const char* const READ_FREQUENCY = "010000101C00001000001";
const char* const READ_STATUS_WORD = "010000101C00003000001";

/// Up to 60 Hz.
void run(TestBus& bus)
{
  ASSERT_EQ(WRITTEN, bus.askBody(SPEED_60));
  ASSERT_EQ(OPERATED, bus.askBody(FORWARD_RUN));
  bus.wait(8.0);
  ASSERT_EQ("60.00", bus.shown("j", "frequency"));
}

std::string errorOf(const std::string& yaml)
{
  try
  {
    TestBus bus(yaml);
  }
  catch (const ConfigError& error)
  {
    return error.what();
  }
  return "no error";
}
}  // namespace

TEST(SimulatedJeFrames, attributes)
{
  TestBus bus(oneJe());
  EXPECT_EQ("02 30 31 30 30 30 30 30 35 30 33 30 30 30 30 33 47 33 4A 45 32 30 32 42 46 30 30 32 38 03 72",
            bus.askRaw("02 30 31 30 30 30 30 35 30 33 03 34"));
  TestBus zero(oneJe("", "", 0));
  EXPECT_EQ("000000050300003G3JE202BF0028", compowayBody(*fromHex(zero.askRaw("02 30 30 30 30 30 30 35 30 33 03 35"))));
  EXPECT_EQ("", zero.askBody("010000503"));
}

TEST(SimulatedJeFrames, readOneElement)
{
  TestBus bus(oneJe("", "P07: 50"));
  const std::string request = "02 30 31 30 30 30 30 31 30 31 43 30 30 30 30 31 30 30 30 30 30 31 03 41";
  EXPECT_EQ("02 30 31 30 30 30 30 30 31 30 31 30 30 30 30 30 30 30 30 30 30 30 30 03 02", bus.askRaw(request));
  bus.askBody(SPEED_60);
  bus.askBody(FORWARD_RUN);
  bus.wait(8.0);  // limited to 50 Hz by P07
  EXPECT_EQ("02 30 31 30 30 30 30 30 31 30 31 30 30 30 30 30 30 30 30 30 31 46 34 03 71", bus.askRaw(request));
}

TEST(SimulatedJeFrames, readSmallValues)
{
  TestBus bus(oneJe("", "P03: 0.1, P04: 0.2"));
  EXPECT_EQ("02 30 31 30 30 30 30 30 31 30 31 30 30 30 30 30 30 30 30 30 30 30 31 03 03",  // BCC = ETX
            bus.askRaw(toHex(compowayFrame("010000101C30002000001"))));
  EXPECT_EQ("02 30 31 30 30 30 30 30 31 30 31 30 30 30 30 30 30 30 30 30 30 30 32 03 00",  // BCC = 0
            bus.askRaw(toHex(compowayFrame("010000101C30003000001"))));
}

TEST(SimulatedJeFrames, readTwoElements)
{
  TestBus bus(oneJe("load: 0.93", "P01: 1.0"));  // 1.0 A * sqrt(0.16 + 0.84 * 0.93^2) = 0.94 A: not yet 1.0
  bus.askBody(SPEED_30);
  bus.askBody(FORWARD_RUN);
  bus.wait(8.0);
  bus.command("j load 1.0");
  EXPECT_EQ("02 30 31 30 30 30 30 30 31 30 31 30 30 30 30 30 30 30 30 30 31 32 43 30 30 30 30 30 30 30 41 03 03",
            bus.askRaw("02 30 31 30 30 30 30 31 30 31 43 30 30 30 30 31 30 30 30 30 30 32 03 42"));
}

TEST(SimulatedJeFrames, readNothing)
{
  TestBus bus(oneJe());
  EXPECT_EQ("02 30 31 30 30 30 30 30 31 30 31 30 30 30 30 03 02",
            bus.askRaw("02 30 31 30 30 30 30 31 30 31 43 30 30 30 30 30 30 30 30 30 30 30 03 41"));
}

TEST(SimulatedJeFrames, writes)
{
  TestBus bus(oneJe());
  const std::string accepted = "02 30 31 30 30 30 30 30 31 30 32 30 30 30 30 03 01";
  EXPECT_EQ(accepted, bus.askRaw("02 30 31 30 30 30 30 31 30 32 43 31 30 30 30 30 30 30 30 30 30 31 30 30 30 30 30 31 "
                                 "32 43 03 32"));
  EXPECT_EQ("30.00", bus.shown("j", "reference"));
  EXPECT_EQ(accepted, bus.askRaw("02 30 31 30 30 30 30 31 30 32 43 31 30 30 30 30 30 30 30 30 30 31 30 30 30 30 30 34 "
                                 "42 30 03 34"));
  EXPECT_EQ("120.00", bus.shown("j", "reference"));
  bus.askBody(TO_AREA_1);
  EXPECT_EQ(accepted, bus.askRaw("02 30 31 30 30 30 30 31 30 32 43 33 30 30 30 36 30 30 30 30 30 32 30 30 30 30 30 32 "
                                 "35 38 30 30 30 30 30 30 30 30 03 4A"));  // 40 bytes
}

TEST(SimulatedJeFrames, status)
{
  TestBus bus(oneJe());
  EXPECT_EQ("02 30 31 30 30 30 30 30 36 30 31 30 30 30 30 30 31 30 30 03 04",
            bus.askRaw("02 30 31 30 30 30 30 36 30 31 03 35"));
  run(bus);
  EXPECT_EQ("02 30 31 30 30 30 30 30 36 30 31 30 30 30 30 30 30 30 30 03 05",
            bus.askRaw("02 30 31 30 30 30 30 36 30 31 03 35"));
}

TEST(SimulatedJeFrames, echoback)
{
  TestBus bus(oneJe());
  EXPECT_EQ("02 30 31 30 30 30 30 30 38 30 31 30 30 30 30 31 32 33 03 3B",
            bus.askRaw("02 30 31 30 30 30 30 38 30 31 31 32 33 03 0B"));
  EXPECT_EQ(
      "02 30 31 30 30 30 30 30 38 30 31 30 30 30 30 41 42 43 44 45 46 47 48 49 4A 4B 4C 4D 4E 4F 50 51 52 53 54 "
      "55 56 57 03 4B",
      bus.askRaw("02 30 31 30 30 30 30 38 30 31 41 42 43 44 45 46 47 48 49 4A 4B 4C 4D 4E 4F 50 51 52 53 54 55 "
                 "56 57 03 7B"));
  EXPECT_EQ("01000008010000", bus.askBody("010000801"));
  EXPECT_EQ("01000F08011001", bus.askBody("010000801ABCDEFGHIJKLMNOPQRSTUVWX"));  // 24
  EXPECT_EQ("", bus.askBody("010000801A@B"));
  EXPECT_EQ("010014", bus.askBody("010000801A\x07"
                                  "B"));
}

TEST(SimulatedJeFrames, operations)
{
  TestBus bus(oneJe("operation_codes: {run_forward: \"0100\", stop: \"0101\", ram_write_mode: \"0401\"}"));
  const std::string accepted = "02 30 31 30 30 30 30 33 30 30 35 30 30 30 30 03 04";
  EXPECT_EQ(accepted, bus.askRaw("02 30 31 30 30 30 33 30 30 35 30 31 30 30 03 35"));
  EXPECT_EQ("1", bus.shown("j", "run_command"));
  EXPECT_EQ(accepted, bus.askRaw("02 30 31 30 30 30 33 30 30 35 30 31 30 31 03 34"));
  EXPECT_EQ("0", bus.shown("j", "run_command"));
  EXPECT_EQ(accepted, bus.askRaw("02 30 31 30 30 30 33 30 30 35 30 34 30 31 03 31"));
  EXPECT_EQ("ram", bus.shown("j", "write_mode"));
}

TEST(SimulatedJeFrames, refusals)
{
  TestBus bus(oneJe());
  const auto ask = [&bus](const char* body) { return bus.askRaw(toHex(compowayFrame(body))); };
  EXPECT_EQ("02 30 31 30 30 30 46 30 31 30 31 31 31 30 33 03 77", ask("010000101C00004000001"));
  EXPECT_EQ("02 30 31 30 30 30 46 30 31 30 31 31 31 30 42 03 06", ask("010000101C00001000003"));
  EXPECT_EQ("02 30 31 30 30 30 46 30 31 30 32 31 31 30 30 03 77", ask("010000102C10000000001000004B1"));
  EXPECT_EQ("02 30 31 30 30 30 46 30 31 30 32 33 30 30 33 03 77", ask("010000102C000000000010000012C"));
  EXPECT_EQ("02 30 31 30 30 30 46 30 31 30 34 30 34 30 31 03 74", ask("010000104"));
  bus.askBody(TO_AREA_1);
  EXPECT_EQ("02 30 31 30 30 30 46 33 30 30 35 32 32 30 33 03 71", ask(FORWARD_RUN));
}

TEST(SimulatedJeFrames, endCodes)
{
  TestBus bus(oneJe());
  EXPECT_EQ("02 30 31 30 30 31 33 03 00", bus.askRaw("02 30 31 30 30 30 30 36 30 31 03 34"));  // BCC
  EXPECT_EQ("02 30 31 30 30 31 34 03 07", bus.askRaw("02 30 31 30 30 30 03 32"));              // no text
  EXPECT_EQ("02 30 31 30 41 31 36 03 74", bus.askRaw("02 30 31 30 41 03 73"));                 // sub-address 0A
  EXPECT_EQ("02 30 31 30 30 31 38 03 0B",
            bus.askRaw(toHex(compowayFrame("010000801ABCDEFGHIJKLMNOPQRSTUVWXYZ012"))));  // 41 bytes
  EXPECT_EQ("010014", bus.askBody("010000101c00001000001"));                              // lower case
  EXPECT_EQ("010014", bus.askBody("0100"));
  EXPECT_EQ("010014", bus.askBody("0100001"));  // no SRC
  EXPECT_EQ("010014", bus.askBody("010010101C00001000001"));
  EXPECT_EQ("010016", bus.askBody("01"));
  EXPECT_EQ("010016", bus.askBody("010"));
  EXPECT_EQ("010A16", bus.askBody("010A00601"));
  EXPECT_EQ("", bus.askBody("0"));  // station one character short
  EXPECT_EQ("", bus.askBody("020000601"));
  EXPECT_EQ("02 30 31 30 30 31 33 03 00", bus.askRaw("02 30 31 03 33"));  // no sub-address and a wrong BCC: BCC first
  EXPECT_EQ("010013", [&bus] {
    Bytes frame = compowayFrame("010A0060C");  // BCC before sub-address before format
    frame.back() ^= 0x01U;
    return compowayBody(*fromHex(bus.askRaw(toHex(frame))));
  }());
  EXPECT_EQ("13", bus.shown("j", "exceptions"));
  EXPECT_EQ("4", bus.shown("j", "damaged_requests"));
}

TEST(SimulatedJeFrames, responseCodesInTheirOrder)
{
  TestBus bus(oneJe());
  const auto code = [&bus](const std::string& text) {
    const std::string reply = bus.askBody("01000" + text);
    return reply.substr(0, 10) == "01000F" + text.substr(0, 4) ? reply.substr(10) : reply;
  };
  EXPECT_EQ("0401", code("0201C0"));
  EXPECT_EQ("1001", code("0101C200000000010"));
  EXPECT_EQ("1002", code("0101C2000000000"));
  EXPECT_EQ("1101", code("0101C2FFFF010003"));
  EXPECT_EQ("1101", code("010181FFFF010003"));
  EXPECT_EQ("1103", code("0101C0FFFF010003"));
  EXPECT_EQ("110B", code("0101C00000010003"));
  EXPECT_EQ("1100", code("0101C00000010002"));
  EXPECT_EQ("1103", code("0101C00003000002"));  // beyond the end: our choice
  EXPECT_EQ("1002", code("0102C2FFFF01000"));
  EXPECT_EQ("1101", code("0102C2FFFF010003"));
  EXPECT_EQ("1103", code("0102C1FFFF010003"));
  EXPECT_EQ("1104", code("0102C10000010002"));
  EXPECT_EQ("1003", code("0102C10000010001"));
  EXPECT_EQ("1003", code("0102C3000001000300000000"));
  EXPECT_EQ("1100", code("0102C000000100010000FFFF"));
  EXPECT_EQ("1100", code("0102C10000000001000004B1"));
  EXPECT_EQ("1100", code("0102C30000000001FFFFFFFF"));
  EXPECT_EQ("3003", code("0102C000000000010000FFFF"));
  EXPECT_EQ("2203", code("0102C3000000000100000001"));
  EXPECT_EQ("1001", code("05030"));
  EXPECT_EQ("1001", code("06010"));
  EXPECT_EQ("1001", code("300511010"));
  EXPECT_EQ("1002", code("3005110"));
  EXPECT_EQ("1100", code("30050100"));  // a sister device's RUN
  EXPECT_EQ("0", bus.shown("j", "run_command"));
}

TEST(SimulatedJeFrames, broadcastIsExecutedAndNotAnswered)
{
  TestBus bus(
      "protocol: compoway_f\nbaud_rate: 9600\nscan_list: [{name: j, node: 1, drive: omron_3g3je}, "
      "{name: k, node: 99, drive: omron_3g3je}]");
  EXPECT_EQ("", bus.askRaw("02 58 58 30 30 30 30 31 30 32 43 31 30 30 30 30 30 30 30 30 30 31 30 30 30 30 30 30 30 30 "
                           "03 43"));
  EXPECT_EQ("0.00", bus.shown("j", "reference"));
  EXPECT_EQ("0.00", bus.shown("k", "reference"));
  EXPECT_EQ("", bus.askBody("XX00030051101"));
  EXPECT_EQ("1", bus.shown("j", "run_command"));
  EXPECT_EQ("1", bus.shown("k", "run_command"));
  EXPECT_EQ("", bus.askBody("XX0000601"));
  EXPECT_EQ(toHex(compowayFrame("9900000101000000000000")),
            bus.askRaw("02 39 39 30 30 30 30 31 30 31 43 33 30 30 30 42 30 30 30 30 30 31 03 30"));
}

TEST(SimulatedJeFrames, broadcastOfAnOperation)
{
  TestBus bus(oneJe("operation_codes: {run_forward: \"0101\"}"));
  EXPECT_EQ("", bus.askRaw("02 58 58 30 30 30 33 30 30 35 30 31 30 31 03 35"));
  EXPECT_EQ("1", bus.shown("j", "run_command"));
  EXPECT_EQ("1", bus.shown("j", "broadcasts"));
}

TEST(SimulatedJeLine, newStxStartsAfreshAndPausesDoNotMatter)
{
  TestBus bus(oneJe());
  const std::string status = "02 30 31 30 30 30 30 36 30 31 03 35";
  const std::string reply = "02 30 31 30 30 30 30 30 36 30 31 30 30 30 30 30 31 30 30 03 04";
  EXPECT_EQ(reply, bus.askRaw("02 30 31 30 30 " + status));
  EXPECT_EQ(reply, bus.askRaw("7F 00 7E " + status));
  EXPECT_EQ("", bus.askRaw("02 30 31 30 30 30 30 36 30 31 03"));  // waits for the BCC
  bus.wait(10.0);
  EXPECT_EQ(reply, bus.askRaw("35"));
  EXPECT_EQ("", bus.askRaw("02 30 31 30 30"));
  bus.wait(0.5);
  EXPECT_EQ(reply, bus.askRaw("30 30 36 30 31 03 35"));
  EXPECT_EQ("", bus.askRaw("02 30 31 30 30"));
  EXPECT_EQ(reply, bus.askRaw(status));
  EXPECT_EQ("", bus.askRaw("30 30 36 30 31 03 35"));  // no STX
}

TEST(SimulatedJeLine, exchangeTakesItsTime)
{
  TestBus bus(oneJe());
  const TimePoint sent = bus.now;
  bus.askBody(READ_FREQUENCY);
  EXPECT_NEAR((24 + 25) * 11.0 / 9600 + 0.002, toSeconds(bus.last_byte - sent), 1e-6);
}

TEST(SimulatedJeLine, twoMillisecondsOfSilenceBeforeARequest)
{
  TestBus bus(oneJe());
  const Bytes request = compowayFrame(READ_FREQUENCY);
  bus.bus.send(request, bus.now);
  EXPECT_NE("", bus.listen());
  bus.now += std::chrono::microseconds(1500);
  EXPECT_EQ("", bus.askRaw(toHex(request)));
  EXPECT_EQ("1", bus.shown("j", "lost_gap"));
  bus.bus.send(request, bus.now);
  EXPECT_NE("", bus.listen());
  bus.now += std::chrono::microseconds(2000);
  EXPECT_NE("", bus.askRaw(toHex(request)));
  EXPECT_EQ("1", bus.shown("j", "lost_gap"));
}

TEST(SimulatedJeLine, sendsSevenBits)
{
  TestBus bus(oneJe());
  EXPECT_EQ("02 30 31 30 30 30 30 30 36 30 31 30 30 30 30 30 31 30 30 03 04",
            bus.askRaw("82 B0 31 30 30 30 30 36 30 31 03 B5"));
  TestBus eight(
      "protocol: compoway_f\ndata_bits: 8\nstop_bits: 1\nscan_list: [{name: j, node: 1, drive: omron_3g3je}]");
  EXPECT_EQ("", eight.askRaw("82 B0 31 30 30 30 30 36 30 31 03 B5"));
  EXPECT_EQ("01000008010000\xA1\xFE", eight.askBody("010000801\xA1\xFE"));
  EXPECT_EQ("010014", eight.askBody("010000801\xA0"));
}

TEST(SimulatedJe, configuration)
{
  const BusConfig config = busConfigFromText(oneJe());
  EXPECT_EQ(Protocol::CompowayF, config.line.protocol);
  EXPECT_EQ(7, config.line.data_bits);
  EXPECT_EQ(Parity::Even, config.line.parity);
  EXPECT_EQ(2, config.line.stop_bits);
  const std::string list = "scan_list: [{name: j, node: 1, drive: ";
  EXPECT_EQ(Parity::None,
            busConfigFromText("protocol: compoway_f\nparity: none\n" + list + "omron_3g3je}]").line.parity);
  EXPECT_EQ(
      "drive: omron_3g3je of j speaks compoway_f, the bus speaks modbus_rtu (allowed: drives of one protocol, "
      "named by protocol)",
      errorOf(list + "omron_3g3je}]"));
  EXPECT_EQ(
      "drive: omron_mx2 of j speaks modbus_rtu, the bus speaks compoway_f (allowed: drives of one protocol, "
      "named by protocol)",
      errorOf("protocol: compoway_f\n" + list + "omron_mx2}]"));
  EXPECT_EQ("protocol: can (allowed: modbus_rtu, compoway_f)", errorOf("protocol: can\n" + list + "omron_3g3je}]"));
  EXPECT_EQ("j: omron_3g3je has no baud rate 38400 (2400-19200)",
            errorOf("protocol: compoway_f\nbaud_rate: 38400\n" + list + "omron_3g3je}]"));
  EXPECT_EQ("j: omron_3g3je has no station 100 (0-99)", errorOf(oneJe("", "", 100)));
  EXPECT_EQ(
      "j: operation_codes: unknown operation fly (allowed: run_forward, run_reverse, stop, fault_reset, "
      "ram_write_mode, backup_write_mode, setup_area_0, setup_area_1)",
      errorOf(oneJe("operation_codes: {fly: \"0100\"}")));
  EXPECT_EQ("j: operation_codes: stop is 1g00 (allowed: four digits 0-9, A-F)",
            errorOf(oneJe("operation_codes: {stop: 1g00}")));
  EXPECT_EQ("j: operation_codes: 1101 is taken twice (allowed: each code once)",
            errorOf(oneJe("operation_codes: {stop: \"1101\"}")));
}

TEST(SimulatedJe, runsBothWays)
{
  TestBus bus(oneJe());
  run(bus);
  EXPECT_EQ("1", bus.shown("j", "direction"));
  EXPECT_EQ("0100000101000000003000", bus.askBody(READ_STATUS_WORD));
  EXPECT_EQ(OPERATED, bus.askBody(REVERSE_RUN));
  bus.wait(3.0);
  EXPECT_NEAR(30.0, bus.number("j", "frequency"), 1.0);
  EXPECT_EQ("1", bus.shown("j", "direction"));
  bus.wait(12.0);
  EXPECT_EQ("-1", bus.shown("j", "direction"));
  EXPECT_EQ("0100000101000000007000", bus.askBody(READ_STATUS_WORD));
  EXPECT_EQ("0100000101000000000258", bus.askBody(READ_FREQUENCY));  // unsigned
  EXPECT_EQ(OPERATED, bus.askBody(STOP_OPERATION));
  bus.wait(8.0);
  EXPECT_EQ("0", bus.shown("j", "running"));
  EXPECT_EQ("010000060100000100", bus.askBody("010000601"));
}

TEST(SimulatedJe, referenceIsLimitedWhenUsed)
{
  TestBus bus(oneJe("", "P07: 40, P08: 5"));
  bus.askBody(SPEED_60);
  bus.askBody(FORWARD_RUN);
  bus.wait(8.0);
  EXPECT_EQ("40.00", bus.shown("j", "frequency"));
  EXPECT_EQ("0100000101000000000258", bus.askBody("010000101C10000000001"));
  EXPECT_EQ("0100000101000000000258", bus.askBody("010000101C00000000001"));
  bus.askBody("010000102C1000000000100000000");
  bus.wait(8.0);
  EXPECT_EQ("5.00", bus.shown("j", "frequency"));
}

TEST(SimulatedJe, tripKeepsRunAndResetRestarts)
{
  TestBus bus(oneJe());
  run(bus);
  bus.command("j trip 5");
  EXPECT_EQ("0", bus.shown("j", "running"));
  EXPECT_EQ("0100000101000000009080", bus.askBody(READ_STATUS_WORD));  // tripped, charged, fin
  EXPECT_EQ("010000060100000100", bus.askBody("010000601"));
  EXPECT_EQ(OPERATED, bus.askBody(RESET_OPERATION));
  bus.wait(1.0);
  EXPECT_EQ("1", bus.shown("j", "running"));
  bus.askBody(STOP_OPERATION);
  bus.command("j trip 50");
  EXPECT_EQ("0100000101000000009000", bus.askBody(READ_STATUS_WORD));
  bus.askBody(RESET_OPERATION);
  EXPECT_EQ("0100000101000000001000", bus.askBody(READ_STATUS_WORD));
  EXPECT_EQ("2", bus.shown("j", "trips"));
}

TEST(SimulatedJe, writeModes)
{
  TestBus bus(oneJe());
  EXPECT_EQ("backup", bus.shown("j", "write_mode"));
  bus.askBody(SPEED_30);
  bus.askBody(SPEED_60);
  EXPECT_EQ("2", bus.shown("j", "eeprom_writes"));
  EXPECT_EQ(OPERATED, bus.askBody(TO_RAM));
  bus.askBody(SPEED_30);
  EXPECT_EQ("2", bus.shown("j", "eeprom_writes"));
  EXPECT_EQ("30.00", bus.shown("j", "reference"));
  bus.command("j power_cycle");
  bus.wait(3.1);
  EXPECT_EQ("backup", bus.shown("j", "write_mode"));
  EXPECT_EQ("60.00", bus.shown("j", "reference"));  // what the EEPROM kept
  bus.askBody(TO_RAM);
  bus.askBody(SPEED_30);
  EXPECT_EQ(OPERATED, bus.askBody(TO_BACKUP));
  EXPECT_EQ("3", bus.shown("j", "eeprom_writes"));
}

TEST(SimulatedJe, setupAreas)
{
  TestBus bus(oneJe());
  run(bus);
  EXPECT_EQ("01000F01022203", bus.askBody("010000102C3000800000100000001"));
  EXPECT_EQ("0100000101000000000000", bus.askBody("010000101C30008000001"));
  EXPECT_EQ(OPERATED, bus.askBody(TO_AREA_1));
  EXPECT_EQ("0", bus.shown("j", "run_command"));
  bus.wait(8.0);
  EXPECT_EQ("0", bus.shown("j", "running"));
  EXPECT_EQ(WRITTEN, bus.askBody("010000102C3000800000100000001"));
  EXPECT_EQ("ok P09 ram=1 eeprom=1", bus.command("j get P09"));
  EXPECT_EQ(OPERATION_REFUSED, bus.askBody(FORWARD_RUN));
  EXPECT_EQ(OPERATION_REFUSED, bus.askBody(TO_RAM));
  EXPECT_EQ(OPERATED, bus.askBody(STOP_OPERATION));
  EXPECT_EQ(OPERATED, bus.askBody(TO_AREA_0));
  bus.wait(1.0);
  EXPECT_EQ("0", bus.shown("j", "running"));  // RUN is over
  EXPECT_EQ(OPERATED, bus.askBody(FORWARD_RUN));
  TestBus closed(oneJe("area_1_readable: false"));
  EXPECT_EQ("01000F01012203", closed.askBody("010000101C30008000001"));
  closed.askBody(TO_AREA_1);
  EXPECT_EQ("0100000101000000000000", closed.askBody("010000101C30008000001"));
}

TEST(SimulatedJe, factoryParameters)
{
  TestBus bus(oneJe());
  const char* const values[] = { "0000000A", "000000C8", "0000001E", "00000000", "00000005", "00000258",
                                 "00000258", "00000000", "00000000", "00000000", "00000000" };
  for (int i = 0; i < 11; ++i)
  {
    EXPECT_EQ(std::string("01000001010000") + values[i],
              bus.askBody("010000101C3000" + hexDigits(static_cast<unsigned>(i), 1) + "000001"))
        << i;
  }
}

TEST(SimulatedJe, terminalsInCommandRefuseRunAndStop)
{
  TestBus bus(oneJe("", "P10: 1"));
  EXPECT_EQ(OPERATION_REFUSED, bus.askBody(FORWARD_RUN));
  EXPECT_EQ(OPERATION_REFUSED, bus.askBody(STOP_OPERATION));
  EXPECT_EQ(WRITTEN, bus.askBody(SPEED_30));
  EXPECT_EQ("0", bus.shown("j", "run_command"));
}

TEST(SimulatedJe, panel)
{
  TestBus bus(oneJe());
  run(bus);
  EXPECT_EQ("ok", bus.command("j panel -20"));
  bus.wait(10.0);
  EXPECT_EQ("20.00", bus.shown("j", "frequency"));
  EXPECT_EQ("-1", bus.shown("j", "direction"));
  EXPECT_EQ("0100000101000000000001", bus.askBody("010000101C30009000001"));
  EXPECT_EQ(OPERATION_REFUSED, bus.askBody(STOP_OPERATION));
  EXPECT_EQ("ok", bus.command("j panel_release"));
  EXPECT_EQ(OPERATED, bus.askBody(STOP_OPERATION));
  bus.wait(10.0);
  EXPECT_EQ("0", bus.shown("j", "running"));
  run(bus);
  bus.command("j panel_stop");
  bus.askBody(FORWARD_RUN);
  bus.wait(8.0);
  EXPECT_EQ("0", bus.shown("j", "running"));
  bus.askBody(STOP_OPERATION);
  run(bus);
}

TEST(SimulatedJe, powerCut)
{
  TestBus bus(oneJe());
  run(bus);
  bus.command("j power_cycle");
  bus.wait(2.9);
  EXPECT_EQ("", bus.askBody(READ_FREQUENCY));
  bus.wait(0.2);
  EXPECT_EQ("0100000101000000000000", bus.askBody(READ_FREQUENCY));
  run(bus);
  bus.command("j set P09 1");
  bus.command("j power_cycle 0.4");
  bus.wait(1.0);
  EXPECT_EQ("1", bus.shown("j", "running"));
  bus.command("j power_cycle 0.6");
  bus.wait(1.0);
  EXPECT_EQ("0", bus.shown("j", "running"));
  run(bus);
  bus.command("j set P09 2");
  bus.command("j power_cycle 30");
  bus.wait(31.0);
  EXPECT_EQ("1", bus.shown("j", "running"));
}

TEST(SimulatedJe, runsOnWhenTheMasterIsGone)
{
  TestBus bus(oneJe());
  run(bus);
  bus.wait(3600.0);
  EXPECT_EQ("60.00", bus.shown("j", "frequency"));
}

TEST(SimulatedJe, overcurrentTrips)
{
  TestBus bus(oneJe());
  run(bus);
  bus.command("j load 2.5");
  EXPECT_EQ("1", bus.shown("j", "trip"));
  EXPECT_EQ("error: omron_3g3je has no safe torque off (see help)", bus.command("j sto on"));
}

TEST(SimulatedJeFaults, exceptionAndBusy)
{
  TestBus bus(oneJe());
  EXPECT_EQ("ok", bus.command("j exception 0x1103"));
  EXPECT_EQ("01000F01021103", bus.askBody(SPEED_30));
  EXPECT_EQ("10.00", bus.shown("j", "reference"));
  EXPECT_EQ("ok", bus.command("j exception 0x13"));
  EXPECT_EQ("010013", bus.askBody(SPEED_30));
  EXPECT_EQ("ok", bus.command("j busy 1"));
  EXPECT_EQ("01000F01022203", bus.askBody(SPEED_30));
  EXPECT_EQ(OPERATED, bus.askBody(STOP_OPERATION));
  bus.wait(1.0);
  EXPECT_EQ(WRITTEN, bus.askBody(SPEED_30));
  EXPECT_EQ("3", bus.shown("j", "exceptions"));
  TestBus modbus(oneMx2());
  EXPECT_EQ("error: exception code 0x1103 (allowed: 1 to 255)", modbus.command("m exception 0x1103"));
}

TEST(SimulatedJeFaults, ofTheReply)
{
  TestBus bus(oneJe());
  const std::string good = "0100000101000000000000";
  for (int i = 0; i < 50; ++i)
  {
    bus.command("j damaged");
    const Bytes damaged = *fromHex(bus.askRaw(toHex(compowayFrame(READ_FREQUENCY))));
    EXPECT_EQ(25U, damaged.size());
    EXPECT_NE(compowayFrame(good), damaged);
  }
  bus.command("j truncated 5");
  EXPECT_EQ("02 30 31 30 30", bus.askBody(READ_FREQUENCY));
  bus.command("j noise 4");
  EXPECT_EQ(29U, fromHex(bus.askRaw(toHex(compowayFrame(READ_FREQUENCY))))->size());
  bus.command("j foreign");
  EXPECT_EQ("0200000101000000000000", bus.askBody(READ_FREQUENCY));
  bus.command("j foreign shape");
  EXPECT_EQ(good + "00000000", bus.askBody(READ_FREQUENCY));
  bus.command("j foreign shape");
  EXPECT_EQ(good, bus.askBody(SPEED_30));
  bus.command("j lost_reply function 0x3005");
  EXPECT_EQ(good, bus.askBody(READ_FREQUENCY));
  EXPECT_EQ("", bus.askBody(FORWARD_RUN));
  EXPECT_EQ("1", bus.shown("j", "run_command"));
  bus.command("j lost_request");
  EXPECT_EQ("", bus.askBody(STOP_OPERATION));
  EXPECT_EQ("1", bus.shown("j", "run_command"));
  bus.command("j offline 1");
  EXPECT_EQ("", bus.askBody(STOP_OPERATION));
  bus.wait(1.0);
  EXPECT_EQ(OPERATED, bus.askBody(STOP_OPERATION));
  const TimePoint sent = bus.now;
  bus.command("j late 0.25");
  bus.askBody("010000601");
  EXPECT_NEAR((12 + 21) * 11.0 / 9600 + 0.252, toSeconds(bus.last_byte - sent), 1e-6);
}

TEST(SimulatedJeFaults, foreignMasterAndEcho)
{
  TestBus bus(oneJe());
  EXPECT_EQ("ok frame=02 30 31 30 30 30 33 30 30 35 31 31 30 31 03 35", bus.command("bus foreign 0100030051101"));
  bus.listen();
  EXPECT_EQ("1", bus.shown("j", "run_command"));
  EXPECT_EQ("ok frame=02 30", bus.command("bus foreign 02 30 raw"));
  EXPECT_EQ(
      "error: frame xyz (allowed: hexadecimal bytes such as 01 03 10 00 00 02, or a body such as 010000601 "
      "without raw)",
      bus.command("bus foreign xyz raw"));
  bus.listen();
  bus.wait(0.1);
  bus.command("bus echo on");
  EXPECT_EQ(toHex(compowayFrame("010000601")) + " " + toHex(compowayFrame("010000060100000000")),
            bus.askRaw(toHex(compowayFrame("010000601"))));
  const std::string frames = bus.command("bus frames 2");
  EXPECT_NE(std::string::npos, frames.find(" master 01 02 30 31")) << frames;
  EXPECT_NE(std::string::npos, frames.find(" drive 01 02 30 31")) << frames;
}

TEST(SimulatedJeFaults, collisionsDamageTheFrame)
{
  TestBus bus(oneJe());
  bus.bus.send(compowayFrame(FORWARD_RUN), bus.now);
  bus.command("bus noise 3");
  bus.listen();
  EXPECT_EQ("0", bus.shown("j", "run_command"));
}
