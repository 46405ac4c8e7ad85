// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

// What a simulated MX2 does: motor, trips, watchdog, parameters, power.

#include <gtest/gtest.h>

#include "simulation/drives/hitachi/hitachi_model.h"
#include "support/simulation_test_bus.h"

using namespace inverter_bus::simulation;

namespace
{
/// Runs the motor at 50 Hz, up to speed.
void run(TestBus& bus)
{
  bus.ask(SPEED_50);
  bus.ask(RUN);
  bus.wait(10.0);
}
}  // namespace

TEST(SimulatedMotor, rampsUpAndDown)
{
  TestBus bus(oneMx2());
  bus.ask(SPEED_50);
  bus.ask(RUN);
  bus.wait(1.0);
  EXPECT_NEAR(10.5, bus.number("m", "frequency"), 0.3);  // from the start frequency b082 = 0.5 Hz, 10 Hz/s
  EXPECT_EQ("accelerating", bus.shown("m", "ramp"));
  bus.wait(5.0);
  EXPECT_EQ("50.00", bus.shown("m", "frequency"));
  EXPECT_EQ("1", bus.shown("m", "direction"));
  bus.ask(STOP);
  bus.wait(2.0);
  EXPECT_NEAR(30.0, bus.number("m", "frequency"), 0.3);
  EXPECT_EQ("decelerating", bus.shown("m", "ramp"));
  bus.wait(3.0);
  EXPECT_EQ("0.00", bus.shown("m", "frequency"));
  EXPECT_EQ("0", bus.shown("m", "direction"));
}

TEST(SimulatedMotor, rampIsTheSameInOneStepAndInMany)
{
  TestBus big(oneMx2());
  TestBus small(oneMx2());
  for (TestBus* bus : { &big, &small })
  {
    bus->ask(SPEED_50);
    bus->ask(RUN);
  }
  big.wait(3.21);
  for (int i = 0; i < 321; ++i)
  {
    small.wait(0.01);
    small.command("m show");
  }
  EXPECT_EQ(big.shown("m", "frequency"), small.shown("m", "frequency"));
}

TEST(SimulatedMotor, reversesThroughZero)
{
  TestBus bus(oneMx2());
  run(bus);
  bus.ask(REVERSE);
  bus.wait(4.5);
  EXPECT_EQ("1", bus.shown("m", "direction"));
  EXPECT_NEAR(5.0, bus.number("m", "frequency"), 0.3);
  EXPECT_EQ("01 03 06 00 03 00 01 00 07", bus.ask(READ_STATUS));  // forward to reverse
  bus.wait(1.5);
  EXPECT_EQ("-1", bus.shown("m", "direction"));
  bus.wait(5.0);
  EXPECT_EQ("50.00", bus.shown("m", "frequency"));
  EXPECT_EQ("01 03 02 00 02", bus.ask("01 03 10 03 00 01"));  // d003 = 2
  EXPECT_EQ("01 01 02 37 00", bus.ask("01 01 00 0E 00 0A"));  // run, reverse, ready, RUN, FA1
}

TEST(SimulatedMotor, nothingTurnsBelowTheStartFrequency)
{
  TestBus bus(oneMx2("b082: 2.0"));
  bus.ask("01 10 00 00 00 02 04 00 00 00 C7");  // 1.99 Hz
  bus.ask(RUN);
  bus.wait(5.0);
  EXPECT_EQ("0", bus.shown("m", "running"));
  bus.ask("01 10 00 00 00 02 04 00 00 00 C8");  // 2.00 Hz
  bus.wait(1.0);
  EXPECT_EQ("2.00", bus.shown("m", "frequency"));
}

TEST(SimulatedMotor, limitsAndStopModeAndDirectionLimit)
{
  TestBus bus(oneMx2("A061: 30.0, b091: 1, b035: 1"));
  run(bus);
  EXPECT_EQ("30.00", bus.shown("m", "frequency"));
  bus.ask(STOP);
  EXPECT_EQ("0.00", bus.shown("m", "frequency"));  // free run
  bus.ask(REVERSE);
  bus.ask(RUN);
  bus.wait(1.0);
  EXPECT_EQ("0", bus.shown("m", "running"));  // forward only
}

TEST(SimulatedMotor, freeRunInput)
{
  TestBus bus(oneMx2("C003: 11"));
  run(bus);
  bus.ask("01 05 00 08 FF 00");  // S3
  EXPECT_EQ("0.00", bus.shown("m", "frequency"));
}

TEST(SimulatedMotor, currentFollowsTheLoad)
{
  TestBus bus(oneMx2());
  EXPECT_EQ("0.00", bus.shown("m", "current"));
  run(bus);
  const double light = bus.number("m", "current");
  bus.command("m load 1.0");
  EXPECT_NEAR(5.0, bus.number("m", "current"), 0.01);
  EXPECT_LT(light, 3.0);
  bus.command("m load 1.5");
  EXPECT_EQ("01 01 01 01", bus.ask("01 01 00 15 00 01"));  // OL
  bus.wait(90.0);
  EXPECT_EQ("5", bus.shown("m", "trip"));  // E05
}

TEST(SimulatedMotor, overcurrentTripsAtOnce)
{
  TestBus bus(oneMx2());
  run(bus);
  bus.command("m load 2.5");
  EXPECT_EQ("1", bus.shown("m", "trip"));  // E01: at constant speed
}

TEST(SimulatedDrive, runsOnlyWhenTheBusIsInCommand)
{
  TestBus bus(oneMx2("A002: 2"));
  run(bus);
  EXPECT_EQ("1", bus.shown("m", "run_coil"));
  EXPECT_EQ("0", bus.shown("m", "running"));
  bus.command("m set A002 3");
  bus.wait(1.0);
  EXPECT_EQ("1", bus.shown("m", "running"));  // the coil was still set
  bus.command("m set A001 2");
  bus.wait(20.0);
  EXPECT_EQ("0.00", bus.shown("m", "frequency"));  // the panel's A020 counts now
}

TEST(SimulatedDrive, tripKeepsTheRunCoilAndRestartsOnReset)
{
  TestBus bus(oneMx2());
  run(bus);
  bus.command("m trip 7");
  EXPECT_EQ("0.00", bus.shown("m", "frequency"));
  EXPECT_EQ("1", bus.shown("m", "run_coil"));
  EXPECT_EQ("01 03 06 00 08 00 02 00 01", bus.ask(READ_STATUS));
  EXPECT_EQ("01 01 02 00 02", bus.ask("01 01 00 0E 00 0A"));  // AL, not ready
  EXPECT_EQ(RESET_ON, bus.ask(RESET_ON));
  EXPECT_EQ("", bus.ask(RESET_OFF));  // about 1 s of silence
  EXPECT_EQ("0", bus.shown("m", "tripped"));
  bus.wait(1.1);
  EXPECT_EQ(RESET_OFF, bus.ask(RESET_OFF));
  EXPECT_EQ("1", bus.shown("m", "running"));
}

TEST(SimulatedDrive, resetActsOnTheRisingEdgeOnly)
{
  TestBus bus(oneMx2());
  bus.command("m trip 7");
  bus.ask(RESET_ON);
  bus.wait(1.1);
  bus.command("m trip 7");
  bus.ask(RESET_ON);
  EXPECT_EQ("1", bus.shown("m", "tripped"));
  bus.ask(RESET_OFF);
  bus.ask(RESET_ON);
  EXPECT_EQ("0", bus.shown("m", "tripped"));
}

TEST(SimulatedDrive, selfClearingCoils)
{
  TestBus bus("scan_list: [{name: m, node: 1, drive: omron_mx2}]\nsimulation: {m: {self_clearing_coils: true}}");
  for (int i = 0; i < 2; ++i)
  {
    bus.ask("01 05 00 02 FF 00");
    EXPECT_EQ("12", bus.shown("m", "trip"));
    bus.ask(RESET_ON);
    EXPECT_EQ("0", bus.shown("m", "tripped"));
    bus.wait(1.1);
  }
}

TEST(SimulatedDrive, tripHistoryIsNewestFirst)
{
  TestBus bus(oneMx2());
  for (int code = 1; code <= 7; ++code)
  {
    bus.command("m trip " + std::to_string(code));
  }
  EXPECT_EQ("01 03 02 00 07", bus.ask("01 03 00 10 00 01"));  // d080 counts all
  EXPECT_EQ("01 03 02 00 07", bus.ask("01 03 00 11 00 01"));
  EXPECT_EQ("01 03 02 00 06", bus.ask("01 03 00 1B 00 01"));
  EXPECT_EQ("01 03 02 00 02", bus.ask("01 03 00 43 00 01"));  // the sixth
  bus.command("m power_cycle 0.05");
  bus.wait(0.1);
  EXPECT_EQ("01 03 02 00 07", bus.ask("01 03 00 11 00 01"));
}

TEST(SimulatedDrive, tripRecordsWhatWasGoingOn)
{
  TestBus bus(oneMx2());
  run(bus);
  bus.wait(3600.0);
  bus.command("m trip 30");
  // E30 at constant speed, 50.00 Hz, 2.43 A, 323.3 V, 302 h of running, 1202 h of power
  EXPECT_EQ("01 03 14 00 1E 00 03 00 00 13 88 00 F3 0C A1 00 00 01 2E 00 00 04 B2", bus.ask("01 03 00 11 00 0A"));
}

TEST(SimulatedDrive, externalTripCoil)
{
  TestBus bus(oneMx2());
  run(bus);
  bus.ask("01 05 00 02 FF 00");
  EXPECT_EQ("12", bus.shown("m", "trip"));
}

TEST(SimulatedDrive, safeStopCanBeResetOnlyAfterItsRelease)
{
  TestBus bus(oneMx2());
  run(bus);
  bus.command("m sto on");
  EXPECT_EQ("37", bus.shown("m", "trip"));
  bus.ask(RESET_ON);
  bus.ask(RESET_OFF);
  EXPECT_EQ("1", bus.shown("m", "tripped"));
  bus.command("m sto off");
  bus.ask(RESET_ON);
  EXPECT_EQ("0", bus.shown("m", "tripped"));
}

class SimulatedWatchdog : public testing::TestWithParam<int>
{
};

TEST_P(SimulatedWatchdog, doesWhatC076Says)
{
  const int action = GetParam();
  TestBus bus(oneMx2("C077: 1.0, C076: " + std::to_string(action)));
  bus.wait(100.0);
  EXPECT_EQ("0", bus.shown("m", "tripped"));  // a master that never speaks causes nothing
  bus.ask(SPEED_50);
  bus.ask(RUN);
  for (int i = 0; i < 20; ++i)
  {
    bus.wait(0.9);
    bus.ask(READ_STATUS);
  }
  EXPECT_EQ("50.00", bus.shown("m", "frequency"));
  bus.wait(1.1);
  const bool trips_at_once = action == 0;
  const bool cuts = action == 0 || action == 3;
  EXPECT_EQ(trips_at_once ? "41" : "0", bus.shown("m", "trip"));
  EXPECT_EQ(cuts ? "0.00" : (action == 2 ? "50.00" : "decelerating"),
            bus.shown("m", action == 1 || action == 4 ? "ramp" : "frequency"));
  bus.wait(10.0);
  EXPECT_EQ(action <= 1 ? "41" : "0", bus.shown("m", "trip"));
  EXPECT_EQ(action == 2 ? "1" : "0", bus.shown("m", "running"));
  EXPECT_EQ("1", bus.shown("m", "run_coil"));
  bus.ask(READ_STATUS);
  bus.wait(0.5);
  EXPECT_EQ(action == 2 ? "1" : "0", bus.shown("m", "running"));  // being back is no RUN
}

INSTANTIATE_TEST_SUITE_P(AllActions, SimulatedWatchdog, testing::Values(0, 1, 2, 3, 4));

TEST(SimulatedDrive, watchdogIsExactHoweverLateOneLooks)
{
  TestBus bus(oneMx2("C077: 0.5, C076: 0"));
  bus.ask(SPEED_50);
  bus.ask(RUN);
  bus.wait(3000.0);
  // 0.5 s of ramp at 10 Hz/s from 0.5 Hz, and not 50 Hz, is what the trip found.
  const std::string reply = bus.ask("01 03 00 14 00 01");
  EXPECT_NEAR(550, std::stoi(reply.substr(9, 2) + reply.substr(12, 2), nullptr, 16), 20);
}

TEST(SimulatedDrive, otherStationsDoNotFeedTheWatchdogAndBroadcastsDo)
{
  TestBus bus(
      "scan_list: [{name: a, node: 1, drive: omron_mx2}, {name: b, node: 2, drive: omron_mx2}]\n"
      "simulation: {a: {parameters: {C076: 0, C077: 0.5}}, b: {parameters: {C076: 0, C077: 0.5}}}");
  bus.ask("01 03 00 02 00 01");
  bus.ask("02 03 00 02 00 01");
  for (int i = 0; i < 3; ++i)
  {
    bus.wait(0.3);
    bus.ask("00 05 00 00 00 00");
  }
  EXPECT_EQ("0", bus.shown("a", "trip"));
  for (int i = 0; i < 3; ++i)
  {
    bus.wait(0.3);
    bus.ask("02 03 00 02 00 01");
  }
  EXPECT_EQ("41", bus.shown("a", "trip"));
  EXPECT_EQ("0", bus.shown("b", "trip"));
}

TEST(SimulatedDrive, watchdogWaitsForTheFirstRequestAfterAReset)
{
  TestBus bus(oneMx2("C077: 1.0, C076: 0"));
  bus.command("m trip 7");
  bus.ask(RESET_ON);
  EXPECT_EQ("waiting", bus.shown("m", "watchdog"));
  bus.wait(10.0);
  EXPECT_EQ("0", bus.shown("m", "tripped"));
}

TEST(SimulatedDrive, restartAfterTimeoutIsAChoice)
{
  TestBus bus(
      "scan_list: [{name: m, node: 1, drive: omron_mx2}]\n"
      "simulation: {m: {restart_after_timeout: true, parameters: {C076: 4, C077: 0.5, F002: 1, F003: 1}}}");
  bus.ask(SPEED_50);
  bus.ask(RUN);
  bus.wait(5.0);
  EXPECT_EQ("0", bus.shown("m", "running"));
  bus.ask(READ_STATUS);
  bus.wait(0.2);
  EXPECT_EQ("1", bus.shown("m", "running"));
}

TEST(SimulatedDrive, powerCycleClearsCoilsAndRam)
{
  TestBus bus(oneMx2());
  run(bus);
  bus.ask("01 10 11 02 00 02 04 00 00 00 64");  // F002 = 1.00 s, RAM only
  EXPECT_EQ("ok F002 ram=1.00 eeprom=5.00", bus.command("m get F002"));
  EXPECT_EQ("1", bus.shown("m", "ram_changes"));
  bus.command("m power_cycle 0.05");
  EXPECT_EQ("", bus.ask(READ_STATUS));
  bus.wait(0.1);
  EXPECT_EQ("01 03 06 00 02 00 00 00 01", bus.ask(READ_STATUS));
  EXPECT_EQ("0", bus.shown("m", "run_coil"));
  EXPECT_EQ("0.00", bus.shown("m", "reference"));
  EXPECT_EQ("ok F002 ram=5.00 eeprom=5.00", bus.command("m get F002"));
}

TEST(SimulatedDrive, isDeafForAWhileAfterPowerOn)
{
  TestBus bus(oneMx2());
  bus.command("m power off");
  bus.wait(5.0);
  bus.command("m power on");
  EXPECT_EQ("", bus.ask(READ_STATUS));
  bus.wait(0.9);
  EXPECT_EQ("", bus.ask(READ_STATUS));
  bus.wait(0.2);
  EXPECT_NE("", bus.ask(READ_STATUS));
}

TEST(SimulatedDrive, enterStoresEveryRamChange)
{
  TestBus bus(oneMx2());
  bus.ask("01 10 11 02 00 02 04 00 00 00 64");
  bus.ask("01 06 14 50 00 C8");  // C077 = 2.00 s
  EXPECT_EQ("0", bus.shown("m", "eeprom_writes"));
  EXPECT_EQ("01 06 08 FF 00 01", bus.ask("01 06 08 FF 00 01"));
  EXPECT_EQ("1", bus.shown("m", "eeprom_writes"));
  EXPECT_EQ("2", bus.shown("m", "stored_values"));
  EXPECT_EQ("01 01 01 01", bus.ask("01 01 00 48 00 01"));  // busy
  EXPECT_EQ("01 86 22", bus.ask("01 06 14 50 00 64"));     // not now
  EXPECT_EQ(STOP, bus.ask(STOP));                          // a command is
  bus.wait(0.5);
  EXPECT_EQ("01 01 01 00", bus.ask("01 01 00 48 00 01"));
  bus.command("m power_cycle 0.05");
  bus.wait(0.1);
  EXPECT_EQ("ok C077 ram=2.00 eeprom=2.00", bus.command("m get C077"));
}

TEST(SimulatedDrive, enterAndLockedParametersWhileRunning)
{
  TestBus bus(oneMx2());
  run(bus);
  EXPECT_EQ("01 86 22", bus.ask("01 06 08 FF 00 01"));
  EXPECT_EQ("01 86 22", bus.ask("01 06 12 03 01 F4"));                          // A004
  EXPECT_EQ("01 10 11 02 00 02", bus.ask("01 10 11 02 00 02 04 00 00 00 64"));  // F002
}

TEST(SimulatedDrive, writeModeStoresTheNextWriteOnly)
{
  TestBus bus(oneMx2());
  bus.ask("01 06 09 01 00 01");
  bus.ask("01 06 14 50 00 C8");
  EXPECT_EQ("ok C077 ram=2.00 eeprom=2.00", bus.command("m get C077"));
  bus.wait(0.5);
  bus.ask("01 06 14 50 00 64");
  EXPECT_EQ("ok C077 ram=1.00 eeprom=2.00", bus.command("m get C077"));
  bus.ask("01 06 09 01 00 01");
  bus.ask(READ_STATUS);  // ends the mode
  bus.ask("01 06 14 50 00 32");
  EXPECT_EQ("ok C077 ram=0.50 eeprom=2.00", bus.command("m get C077"));
}

TEST(SimulatedDrive, oneWordOfTwo)
{
  TestBus bus(oneMx2());
  bus.ask("01 10 11 02 00 02 04 00 01 00 64");
  EXPECT_EQ("01 06 11 03 00 C8", bus.ask("01 06 11 03 00 C8"));
  EXPECT_EQ("01 03 04 00 01 00 C8", bus.ask("01 03 11 02 00 02"));
  EXPECT_EQ("01 10 11 02 00 02", bus.ask("01 10 11 02 00 02 04 00 00 00 64"));
}

TEST(SimulatedDrive, wholeTableIsReadable)
{
  for (const HitachiModel* model : { &omronMx2(), &omronRx() })
  {
    TestBus bus("scan_list: [{name: m, node: 1, drive: " + model->name + "}]");
    for (const Parameter& parameter : model->parameters)
    {
      const Bytes request{ 1,
                           3,
                           static_cast<std::uint8_t>((parameter.number - 1) >> 8),
                           static_cast<std::uint8_t>(parameter.number - 1),
                           0,
                           static_cast<std::uint8_t>(parameter.words) };
      const std::string reply = bus.ask(toHex(request));
      EXPECT_EQ(parameter.words == 2 ? "01 03 04" : "01 03 02", reply.substr(0, 8)) << model->name << parameter.code;
    }
  }
}

TEST(SimulatedDrive, stationAndBaudChangeWithThePowerCycle)
{
  TestBus bus(oneMx2());
  bus.command("m set C072 9");
  EXPECT_NE("", bus.ask(READ_STATUS));
  bus.command("m power_cycle 0.01");
  bus.wait(0.1);
  EXPECT_EQ("", bus.ask(READ_STATUS));
  EXPECT_NE("", bus.ask("09 03 00 02 00 03"));
  bus.command("m set C071 5");
  bus.command("m power_cycle 0.01");
  bus.wait(0.1);
  EXPECT_EQ("", bus.ask("09 03 00 02 00 03"));
}

TEST(SimulatedDrive, panelTakesOverAndGivesBack)
{
  TestBus bus(oneMx2());
  bus.command("m panel -20");
  bus.wait(10.0);
  EXPECT_EQ("20.00", bus.shown("m", "frequency"));
  EXPECT_EQ("-1", bus.shown("m", "direction"));
  EXPECT_EQ("01 03 04 00 02 00 02", bus.ask("01 03 12 00 00 02"));  // A001, A002
  bus.ask(STOP);
  bus.wait(10.0);
  EXPECT_EQ("20.00", bus.shown("m", "frequency"));  // the bus has no say
  bus.command("m panel_release");
  bus.wait(10.0);
  EXPECT_EQ("0.00", bus.shown("m", "frequency"));
  EXPECT_EQ("01 03 04 00 03 00 03", bus.ask("01 03 12 00 00 02"));
}

TEST(SimulatedDrive, stopKeyHoldsUntilRunWasOff)
{
  TestBus bus(oneMx2());
  run(bus);
  EXPECT_EQ("ok", bus.command("m panel_stop"));
  bus.wait(10.0);
  EXPECT_EQ("0.00", bus.shown("m", "frequency"));
  EXPECT_EQ("1", bus.shown("m", "run_coil"));
  bus.ask(RUN);
  bus.wait(1.0);
  EXPECT_EQ("0.00", bus.shown("m", "frequency"));
  bus.ask(STOP);
  bus.ask(RUN);
  bus.wait(1.0);
  EXPECT_NE("0.00", bus.shown("m", "frequency"));
}

TEST(SimulatedDrive, aDayPassesQuicklyAndExactly)
{
  TestBus bus(oneMx2());
  run(bus);
  bus.wait(86400.0);
  bus.ask(READ_STATUS);
  EXPECT_EQ("01 03 04 00 00 01 45", bus.ask("01 03 10 14 00 02"));  // 301 + 24 h
}
