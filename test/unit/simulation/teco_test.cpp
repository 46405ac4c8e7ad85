// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

// The simulated TECO 7200MA: frames of its manual byte by byte, and what it does.

#include <gtest/gtest.h>

#include "support/simulation_test_bus.h"

using namespace inverter_bus::simulation;

namespace
{
/// One 7200MA named t on 9600 8N2, 60 Hz in 6 s up and down, in 3 s down with Bn-04; without supervision unless given.
std::string oneTeco(const std::string& parameters = "Cn-27: 0", const std::string& options = "", int station = 1)
{
  return "baud_rate: 9600\nstop_bits: 2\nscan_list: [{name: t, node: " + std::to_string(station) +
         ", drive: teco_7200ma}]\nsimulation: {t: {parameters: {Bn-01: 6, Bn-02: 6, Bn-04: 3, " + parameters + "}" +
         (options.empty() ? "" : ", " + options) + "}}\n";
}

const char* const TECO_RUN = "01 10 00 00 00 01 02 00 01";
const char* const TECO_STOP = "01 10 00 00 00 01 02 00 00";
const char* const RUN_60 = "01 10 00 00 00 02 04 00 01 17 70";
const char* const STOP_0 = "01 10 00 00 00 02 04 00 00 00 00";
const char* const READ_COMMAND = "01 03 00 00 00 01";
const char* const READ_MONITORS = "01 03 00 20 00 08";

/// Up to 60 Hz.
void run(TestBus& bus)
{
  bus.ask(RUN_60);
  bus.wait(8.0);
  ASSERT_EQ("60.00", bus.shown("t", "frequency"));
}
}  // namespace

TEST(SimulatedTecoFrames, ofTheManual)
{
  TestBus bus(oneTeco());
  EXPECT_EQ("01 03 02 00 00 B8 44", bus.askRaw("01 03 00 00 00 01 84 0A"));
  EXPECT_EQ("01 83 03 01 31", bus.askRaw("01 03 00 00 00 11 85 C6"));  // 17 registers
  EXPECT_EQ("01 08 00 00 AA 55 5E 94", bus.askRaw("01 08 00 00 AA 55 5E 94"));
  EXPECT_EQ("01 88 01 87 C0", bus.askRaw("01 08 00 01 AA 55 0F 54"));  // another test code
}

TEST(SimulatedTecoFrames, writes)
{
  TestBus bus(oneTeco());
  EXPECT_EQ("01 10 00 00 00 01 01 C9", bus.askRaw("01 10 00 00 00 01 02 00 01 67 90"));  // run
  EXPECT_EQ("1", bus.shown("t", "run_command"));
  EXPECT_EQ("01 10 00 00 00 01 01 C9", bus.askRaw("01 10 00 00 00 01 02 00 00 A6 50"));  // stop
  EXPECT_EQ("0", bus.shown("t", "run_command"));
  EXPECT_EQ("01 10 00 00 00 01 01 C9", bus.askRaw("01 10 00 00 00 01 02 00 08 A7 96"));  // reset
  EXPECT_EQ("01 10 00 01 00 01 50 09", bus.askRaw("01 10 00 01 00 01 02 13 88 AA D7"));  // 50 Hz
  EXPECT_EQ("50.00", bus.shown("t", "reference"));
  EXPECT_EQ("01 10 00 00 00 02 41 C8", bus.askRaw("01 10 00 00 00 02 04 00 01 17 70 AC 7B"));  // run, 60 Hz
  EXPECT_EQ("60.00", bus.shown("t", "reference"));
  EXPECT_EQ("01 10 00 00 00 02 41 C8", bus.askRaw("01 10 00 00 00 02 04 00 01 13 88 AF 39"));
  EXPECT_EQ("01 10 00 00 00 02 41 C8", bus.askRaw("01 10 00 00 00 02 04 00 00 00 00 F3 AF"));
  EXPECT_EQ("0", bus.shown("t", "run_command"));
  EXPECT_EQ("0.00", bus.shown("t", "reference"));
}

TEST(SimulatedTecoFrames, refusals)
{
  TestBus bus(oneTeco());
  EXPECT_EQ("01 86 01 83 A0", bus.askRaw("01 06 00 01 17 70 D6 1E"));  // 06H
  EXPECT_EQ("01 90 02 CD C1", bus.askRaw(toHex(withModbusCrc(*fromHex("01 10 00 02 00 01 02 00 01")))));
  EXPECT_EQ("01 83 02 C0 F1", bus.askRaw(toHex(withModbusCrc(*fromHex("01 03 00 02 00 01")))));
  EXPECT_EQ("01 83 02 C0 F1", bus.askRaw("01 03 00 00 00 10 44 06"));  // 0002H isn't there
  EXPECT_EQ("01 90 21 8C 18", bus.askRaw(toHex(withModbusCrc(*fromHex("01 10 00 01 00 01 02 17 71")))));  // 60.01 Hz
  EXPECT_EQ("01 90 22 CC 19", bus.askRaw(toHex(withModbusCrc(*fromHex("01 10 00 20 00 01 02 00 00")))));  // monitor
  EXPECT_EQ("", bus.askRaw("01 03 00 00 00 01 84 0B"));                                                   // CRC
  EXPECT_EQ("", bus.ask("02 03 00 00 00 01"));
  std::string seventeen = "01 10 00 00 00 11 22";
  for (int i = 0; i < 34; ++i)
  {
    seventeen += " 00";
  }
  EXPECT_EQ("01 90 03 0C 01", bus.askRaw(toHex(withModbusCrc(*fromHex(seventeen)))));
  bus.command("t exception 1");
  EXPECT_EQ("01 90 01 8D C0", bus.askRaw("01 10 00 00 00 01 02 00 01 67 90"));
  EXPECT_EQ("0", bus.shown("t", "run_command"));
  for (const char* function :
       { "01 01 00 00 00 01", "01 04 00 00 00 01", "01 05 00 00 FF 00", "01 17 00 00 00 01 00 00 00 01 02 00 00" })
  {
    const std::string reply = bus.ask(function);
    EXPECT_EQ(" 01", reply.substr(5)) << function << ": " << reply;
  }
}

TEST(SimulatedTecoFrames, stationThirtyOne)
{
  TestBus bus(oneTeco("Cn-27: 0", "", 31));
  EXPECT_EQ("1F 03 02 00 00 10 46", bus.askRaw("1F 03 00 00 00 01 87 B4"));
  EXPECT_EQ("1F 10 00 00 00 01 02 77", bus.askRaw("1F 10 00 00 00 01 02 00 01 E6 30"));
}

TEST(SimulatedTecoFrames, broadcast)
{
  TestBus bus(oneTeco());
  EXPECT_EQ("", bus.askRaw("00 10 00 00 00 02 04 00 01 17 70 A8 87"));  // run, 60 Hz
  EXPECT_EQ("1", bus.shown("t", "run_command"));
  EXPECT_EQ("60.00", bus.shown("t", "reference"));
  EXPECT_EQ("", bus.askRaw("00 10 00 01 00 01 02 0B B8 AD 53"));  // 30 Hz
  EXPECT_EQ("30.00", bus.shown("t", "reference"));
  EXPECT_EQ("", bus.askRaw("00 10 00 00 00 01 02 00 00 AB C0"));  // stop
  EXPECT_EQ("0", bus.shown("t", "run_command"));
  EXPECT_EQ("", bus.ask("00 10 03 00 00 01 02 00 32"));  // Bn-01: not by broadcast
  EXPECT_EQ("ok Bn-01 ram=6.0 eeprom=6.0", bus.command("t get Bn-01"));
  EXPECT_EQ("", bus.ask("00 03 00 00 00 01"));
}

TEST(SimulatedTecoFrames, answersFiveMillisecondsAfterTheSilence)
{
  TestBus bus(oneTeco());
  const TimePoint sent = bus.now;
  bus.ask(READ_COMMAND);
  const double character = 11.0 / 9600;
  EXPECT_NEAR(8 * character + 3.5 * character + 0.005 + 7 * character, toSeconds(bus.last_byte - sent), 1e-6);
}

TEST(SimulatedTeco, understandsCharactersOfElevenBitsOnly)
{
  const std::string drive = "\nscan_list: [{name: t, node: 1, drive: teco_7200ma}]";
  for (const char* line : { "stop_bits: 2", "parity: even", "parity: odd" })
  {
    TestBus bus(std::string("baud_rate: 9600\n") + line + drive);
    EXPECT_EQ("01 03 02 00 00", bus.ask(READ_COMMAND)) << line;
  }
  for (const char* line : { "stop_bits: 1", "parity: even\nstop_bits: 2", "data_bits: 7\nparity: even\nstop_bits: 2" })
  {
    TestBus bus(std::string("baud_rate: 2400\n") + line + drive);
    EXPECT_EQ("", bus.ask(READ_COMMAND)) << line;
  }
}

TEST(SimulatedTeco, refusesWhatItDoesNotHave)
{
  const auto error = [](const std::string& yaml) {
    try
    {
      TestBus bus(yaml);
    }
    catch (const ConfigError& refusal)
    {
      return std::string(refusal.what());
    }
    return std::string("no error");
  };
  EXPECT_EQ("t: teco_7200ma has no baud rate 19200 (1200-9600)",
            error("stop_bits: 2\nscan_list: [{name: t, node: 1, drive: teco_7200ma}]"));
  EXPECT_EQ("t: teco_7200ma has no station 32 (1-31)", error(oneTeco("Cn-27: 0", "", 32)));
  EXPECT_EQ("t: teco_7200ma: monitor_base 1 (allowed: 2 to 752)", error(oneTeco("Cn-27: 0", "monitor_base: 1")));
  EXPECT_EQ("simulation.t.reverse_word: 4 (allowed: 2, 3)", error(oneTeco("Cn-27: 0", "reverse_word: 4")));
}

TEST(SimulatedTeco, monitors)
{
  TestBus bus(oneTeco());
  EXPECT_EQ("01 03 10 00 04 00 00 00 00 00 00 00 00 00 00 01 45 00 00", bus.ask(READ_MONITORS));  // ready, 325 V
  run(bus);
  // run and ready, 60.00 Hz twice, 230.0 V, 323 V, 2.4 A: 5 A * sqrt(0.16 + 0.84 * 0.09)
  EXPECT_EQ("01 03 10 00 05 00 00 00 00 17 70 17 70 08 FC 01 43 00 18", bus.ask(READ_MONITORS));
  EXPECT_EQ("01 83 02", bus.ask("01 03 00 28 00 01"));
  bus.command("t trip 21");
  EXPECT_EQ("01 03 04 00 08 00 15", bus.ask("01 03 00 20 00 02"));  // fault, OL1
}

TEST(SimulatedTeco, monitorsElsewhere)
{
  TestBus bus(oneTeco("Cn-27: 0", "monitor_base: 0x0120"));
  EXPECT_EQ("01 03 02 00 04", bus.ask("01 03 01 20 00 01"));
  EXPECT_EQ("01 83 02", bus.ask("01 03 00 20 00 01"));
}

TEST(SimulatedTeco, reverseAsARunBitOfItsOwn)
{
  TestBus bus(oneTeco());
  bus.ask("01 10 00 00 00 02 04 00 02 17 70");
  bus.wait(8.0);
  EXPECT_EQ("-1", bus.shown("t", "direction"));
  EXPECT_EQ("01 03 02 00 07", bus.ask("01 03 00 20 00 01"));  // run, reverse, ready
  bus.ask("01 10 00 00 00 01 02 00 03");                      // both
  bus.wait(8.0);
  EXPECT_EQ("0", bus.shown("t", "running"));
}

TEST(SimulatedTeco, reverseAsDirection)
{
  TestBus bus(oneTeco("Cn-27: 0", "reverse_word: 3"));
  bus.ask("01 10 00 00 00 02 04 00 02 17 70");
  bus.wait(8.0);
  EXPECT_EQ("0", bus.shown("t", "running"));
  bus.ask("01 10 00 00 00 01 02 00 03");
  bus.wait(8.0);
  EXPECT_EQ("-1", bus.shown("t", "direction"));
}

TEST(SimulatedTeco, runStaysOnThroughATripAndResetActsOnTheEdge)
{
  TestBus bus(oneTeco());
  run(bus);
  bus.command("t trip 21");
  EXPECT_EQ("0.00", bus.shown("t", "frequency"));
  EXPECT_EQ("1", bus.shown("t", "run_command"));
  bus.ask("01 10 00 00 00 01 02 00 09");  // reset with RUN still on
  EXPECT_EQ("0", bus.shown("t", "tripped"));
  bus.wait(1.0);
  EXPECT_EQ("1", bus.shown("t", "running"));  // as a real drive would
  bus.command("t trip 20");
  bus.ask("01 10 00 00 00 01 02 00 08");
  EXPECT_EQ("1", bus.shown("t", "tripped"));  // the bit was on already
  bus.ask(TECO_STOP);
  bus.ask("01 10 00 00 00 01 02 00 08");
  EXPECT_EQ("0", bus.shown("t", "tripped"));
  EXPECT_EQ("0", bus.shown("t", "running"));
  EXPECT_EQ("2", bus.shown("t", "trips"));
  bus.ask("01 10 00 00 00 01 02 00 04");
  EXPECT_EQ("37", bus.shown("t", "trip"));  // external fault
}

TEST(SimulatedTeco, parameters)
{
  TestBus bus(oneTeco());
  EXPECT_EQ("01 03 02 00 3C", bus.ask("01 03 03 00 00 01"));              // Bn-01 = 6.0 s
  EXPECT_EQ("01 10 03 2A 00 01", bus.ask("01 10 03 2A 00 01 02 00 14"));  // Cn-27 = 2.0 s
  EXPECT_EQ("ok Cn-27 ram=2.0 eeprom=2.0", bus.command("t get Cn-27"));
  EXPECT_EQ("1", bus.shown("t", "eeprom_writes"));
  EXPECT_EQ("01 90 21", bus.ask("01 10 03 2A 00 01 02 01 00"));  // 25.6 s
  EXPECT_EQ("01 03 02 00 14", bus.ask("01 03 00 20 00 01"));     // ready, data setting error
  EXPECT_EQ("01 90 02", bus.ask("01 10 03 02 00 01 02 00 00"));
  bus.ask("01 10 03 2A 00 01 02 00 00");
  run(bus);
  EXPECT_EQ("01 90 22", bus.ask("01 10 03 2A 00 01 02 00 14"));           // running
  EXPECT_EQ("01 10 03 00 00 01", bus.ask("01 10 03 00 00 01 02 00 1E"));  // Bn-01: allowed
  bus.command("t busy 1");
  EXPECT_EQ("01 90 22", bus.ask("01 10 03 00 00 01 02 00 3C"));
  EXPECT_EQ("01 10 00 00 00 01", bus.ask(TECO_STOP));
}

TEST(SimulatedTecoSupervision, deceleratesWithBn02)
{
  TestBus bus(oneTeco("Cn-27: 10"));
  run(bus);
  bus.wait(2.9);  // 10.9 s after the last request
  EXPECT_EQ("lit", bus.shown("t", "alarm"));
  EXPECT_EQ("1", bus.shown("t", "alarms"));
  EXPECT_NEAR(60.0 - 9.0, bus.number("t", "frequency"), 0.5);  // 0.9 s of 10 Hz/s
  bus.wait(6.0);
  EXPECT_EQ("0", bus.shown("t", "running"));
}

TEST(SimulatedTecoSupervision, coasts)
{
  TestBus bus(oneTeco("Cn-27: 10, Sn-39: 1"));
  run(bus);
  bus.wait(2.1);
  EXPECT_EQ("0.00", bus.shown("t", "frequency"));
  EXPECT_EQ("lit", bus.shown("t", "alarm"));
}

TEST(SimulatedTecoSupervision, deceleratesWithBn04)
{
  TestBus bus(oneTeco("Cn-27: 10, Sn-39: 2"));
  run(bus);
  bus.wait(2.9);
  EXPECT_NEAR(60.0 - 18.0, bus.number("t", "frequency"), 1.0);  // 20 Hz/s
}

TEST(SimulatedTecoSupervision, runsOnAndFlashes)
{
  TestBus bus(oneTeco("Cn-27: 10, Sn-39: 3"));
  run(bus);
  bus.wait(60.0);
  EXPECT_EQ("60.00", bus.shown("t", "frequency"));
  EXPECT_EQ("flashing", bus.shown("t", "alarm"));
  EXPECT_EQ("1", bus.shown("t", "alarms"));
  EXPECT_EQ("ok", bus.command("t panel_stop"));
  bus.wait(8.0);
  EXPECT_EQ("0", bus.shown("t", "running"));
}

TEST(SimulatedTecoSupervision, motorStaysStoppedUntilRunWasOff)
{
  TestBus bus(oneTeco("Cn-27: 10"));
  run(bus);
  bus.wait(20.0);
  bus.ask(RUN_60);
  EXPECT_EQ("off", bus.shown("t", "alarm"));  // the message ended it
  bus.wait(5.0);
  EXPECT_EQ("0", bus.shown("t", "running"));
  bus.ask(TECO_STOP);
  bus.ask(RUN_60);
  bus.wait(5.0);
  EXPECT_EQ("1", bus.shown("t", "running"));
}

TEST(SimulatedTecoSupervision, alsoWhenIdle)
{
  TestBus bus(oneTeco("Cn-27: 1"));
  bus.ask(READ_COMMAND);
  bus.wait(0.9);
  EXPECT_EQ("0", bus.shown("t", "alarms"));
  bus.ask(READ_COMMAND);
  bus.wait(0.9);
  EXPECT_EQ("0", bus.shown("t", "alarms"));
  bus.wait(0.2);
  EXPECT_EQ("1", bus.shown("t", "alarms"));
  bus.ask(TECO_RUN);
  EXPECT_EQ("0", bus.shown("t", "held"));  // nothing was running: nothing is held
}

TEST(SimulatedTecoSupervision, onlyOwnRequestsAndItsBroadcastsFeedIt)
{
  TestBus bus(oneTeco("Cn-27: 1"));
  for (const char* request : { "02 03 00 00 00 01", "00 10 03 00 00 01 02 00 32", "00 03 00 00 00 01" })
  {
    bus.ask(READ_COMMAND);
    const double before = bus.number("t", "alarms");
    bus.wait(0.7);
    bus.ask(request);
    bus.wait(0.7);
    EXPECT_EQ(before + 1, bus.number("t", "alarms")) << request;
  }
  bus.ask(READ_COMMAND);
  const double before = bus.number("t", "alarms");
  bus.wait(0.7);
  bus.ask("00 10 00 00 00 01 02 00 00");
  bus.wait(0.7);
  EXPECT_EQ(before, bus.number("t", "alarms"));
}

TEST(SimulatedTecoSupervision, alarmWithoutAMessageInFiveSeconds)
{
  TestBus bus(oneTeco());
  bus.wait(4.9);
  EXPECT_EQ("off", bus.shown("t", "alarm"));
  bus.wait(0.2);
  EXPECT_EQ("lit", bus.shown("t", "alarm"));
  bus.ask(READ_COMMAND);
  EXPECT_EQ("off", bus.shown("t", "alarm"));
  EXPECT_EQ("1", bus.shown("t", "alarms"));
  bus.command("t power_cycle");
  bus.wait(3.0 + 4.9);
  EXPECT_EQ("1", bus.shown("t", "alarms"));
  bus.wait(0.2);
  EXPECT_EQ("2", bus.shown("t", "alarms"));
}

TEST(SimulatedTecoSupervision, noAlarmWhenThePanelCommands)
{
  TestBus bus(oneTeco("Sn-04: 0, Sn-05: 0"));
  bus.wait(60.0);
  EXPECT_EQ("0", bus.shown("t", "alarms"));
}

TEST(SimulatedTeco, panelAndPower)
{
  TestBus bus(oneTeco());
  run(bus);
  EXPECT_EQ("ok", bus.command("t panel -10"));
  bus.wait(10.0);
  EXPECT_EQ("-1", bus.shown("t", "direction"));
  EXPECT_EQ("10.00", bus.shown("t", "frequency"));
  EXPECT_EQ("0", bus.shown("t", "command_source"));
  bus.command("t panel_release");
  bus.wait(10.0);
  EXPECT_EQ("60.00", bus.shown("t", "frequency"));  // RUN was still on
  bus.command("t panel_stop");
  bus.wait(8.0);
  EXPECT_EQ("0", bus.shown("t", "running"));
  EXPECT_EQ("error: teco_7200ma has no safe torque off (see help)", bus.command("t sto on"));
  bus.command("t power_cycle");
  bus.wait(2.5);
  EXPECT_EQ("", bus.ask(READ_COMMAND));
  bus.wait(1.0);
  EXPECT_EQ("01 03 04 00 00 00 00", bus.ask("01 03 00 00 00 02"));
  bus.ask(STOP_0);
}

TEST(SimulatedTeco, stationAndLineCountAfterAPowerCycle)
{
  TestBus bus(oneTeco());
  bus.command("t set Sn-36 7");
  EXPECT_EQ("01 03 02 00 00", bus.ask(READ_COMMAND));
  bus.command("t power_cycle");
  bus.wait(3.1);
  EXPECT_EQ("", bus.ask(READ_COMMAND));
  EXPECT_EQ("07 03 02 00 00", bus.ask("07 03 00 00 00 01"));
}

TEST(SimulatedTeco, overcurrentTrips)
{
  TestBus bus(oneTeco());
  run(bus);
  bus.command("t load 2.5");
  EXPECT_EQ("20", bus.shown("t", "trip"));
}

TEST(SimulatedMixedBus, oneScanListOfThreeBrands)
{
  TestBus bus(
      "baud_rate: 9600\nparity: even\n"
      "scan_list: [{name: m, node: 1, drive: omron_mx2}, {name: r, node: 2, drive: omron_rx},"
      " {name: t, node: 3, drive: teco_7200ma}, {name: v, node: 4, drive: toshiba_vfs15}]\n"
      "simulation: {t: {parameters: {Cn-27: 0}}}");
  for (const char* station : { "01", "02", "03" })
  {
    EXPECT_EQ(std::string(station) + " 03 04 00 00 00 00", bus.ask(std::string(station) + " 03 00 00 00 02"));
  }
  // Everybody hears a broadcast: 0000H, 0001H of the 7200MA is the frequency F001 of the others.
  bus.ask("00 10 00 00 00 02 04 00 00 13 88");
  EXPECT_EQ("50.00", bus.shown("m", "reference"));
  EXPECT_EQ("50.00", bus.shown("r", "reference"));
  EXPECT_EQ("50.00", bus.shown("t", "reference"));
  bus.ask("00 10 00 00 00 01 02 00 01");
  EXPECT_EQ("1", bus.shown("t", "run_command"));
  EXPECT_EQ("0", bus.shown("m", "run_coil"));
  for (const char* name : { "m", "r", "t" })
  {
    EXPECT_EQ("2", bus.shown(name, "broadcasts")) << name;
  }
}
