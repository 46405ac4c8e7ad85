// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

// Faults that are injected by command, and the command grammar.

#include <gmock/gmock.h>

#include "support/simulation_test_bus.h"

using namespace inverter_bus::simulation;

namespace
{
const char* const READ = "01 03 10 00 00 04";
const char* const GOOD = "01 03 08 00 00 00 00 00 00 00 00";
}  // namespace

TEST(SimulatedFaults, damagedReply)
{
  TestBus bus(oneMx2());
  EXPECT_EQ("ok", bus.command("m damaged count 2"));
  for (int i = 0; i < 2; ++i)
  {
    const Bytes reply = *fromHex(bus.ask(READ));
    EXPECT_EQ(13U, reply.size());
    EXPECT_FALSE(modbusCrcFits(reply));
  }
  EXPECT_EQ(GOOD, bus.ask(READ));
}

TEST(SimulatedFaults, truncatedReply)
{
  TestBus bus(oneMx2());
  bus.command("m truncated 5");
  EXPECT_EQ("01 03 08 00 00", bus.ask(READ));
  bus.command("m truncated 0");
  EXPECT_EQ("", bus.ask(READ));
  EXPECT_EQ(GOOD, bus.ask(READ));
}

TEST(SimulatedFaults, noiseBeforeTheReply)
{
  TestBus bus(oneMx2());
  bus.command("m noise 4");
  const std::string reply = bus.askRaw(toHex(withModbusCrc(*fromHex(READ))));
  EXPECT_EQ(17U, fromHex(reply)->size());
  EXPECT_EQ(GOOD, reply.substr(12, std::string(GOOD).size()));
}

TEST(SimulatedFaults, lateReply)
{
  TestBus bus(oneMx2());
  const TimePoint start = bus.now;
  bus.ask(READ);
  const Duration usual = bus.last_byte - start;
  const TimePoint again = bus.now;
  bus.command("m late 0.25");
  EXPECT_EQ(GOOD, bus.ask(READ));
  EXPECT_NEAR(0.25, toSeconds(bus.last_byte - again - usual), 1e-6);
}

TEST(SimulatedFaults, foreignReply)
{
  TestBus bus(oneMx2());
  bus.command("m foreign");
  EXPECT_EQ("02 03 08 00 00 00 00 00 00 00 00", bus.ask(READ));
  bus.command("m foreign shape");
  EXPECT_EQ("01 03 0A 00 00 00 00 00 00 00 00 00 00", bus.ask(READ));
  bus.command("m foreign shape");
  EXPECT_EQ("01 03 02 00 00", bus.ask(STOP));
}

TEST(SimulatedFaults, exceptionIsNotExecuted)
{
  TestBus bus(oneMx2());
  bus.command("m exception 34");
  EXPECT_EQ("01 85 22", bus.ask(RUN));
  EXPECT_EQ("0", bus.shown("m", "run_coil"));
}

TEST(SimulatedFaults, lostRequestAndLostReply)
{
  TestBus bus(oneMx2());
  bus.command("m lost_request");
  EXPECT_EQ("", bus.ask(RUN));
  EXPECT_EQ("0", bus.shown("m", "run_coil"));
  bus.command("m lost_reply");
  EXPECT_EQ("", bus.ask(RUN));
  EXPECT_EQ("1", bus.shown("m", "run_coil"));
}

TEST(SimulatedFaults, functionAndDurationChooseTheExchange)
{
  TestBus bus(oneMx2());
  bus.command("m lost_reply function 0x05");
  EXPECT_EQ(GOOD, bus.ask(READ));
  EXPECT_EQ("", bus.ask(STOP));
  bus.command("m lost_reply for 0.5");
  EXPECT_EQ("", bus.ask(READ));
  EXPECT_EQ("", bus.ask(READ));
  bus.wait(0.5);
  EXPECT_EQ(GOOD, bus.ask(READ));
  bus.command("m lost_reply count 0");
  EXPECT_EQ("", bus.ask(READ));
  bus.command("m clear");
  EXPECT_EQ(GOOD, bus.ask(READ));
}

TEST(SimulatedFaults, onlyWritesOrOnlyReadsGetLost)
{
  TestBus bus(oneMx2());
  bus.command("m lost_request writes count 0");
  EXPECT_EQ("", bus.ask(RUN));
  EXPECT_EQ("0", bus.shown("m", "run_coil"));
  EXPECT_EQ(GOOD, bus.ask(READ));
  EXPECT_EQ("01 08 00 00 12 34", bus.ask("01 08 00 00 12 34"));
  bus.command("m clear");
  bus.command("m lost_reply reads for 1");
  EXPECT_EQ("", bus.ask(READ));
  EXPECT_EQ(RUN, bus.ask(RUN));
  EXPECT_EQ("1", bus.shown("m", "run_coil"));
  EXPECT_EQ("01 08 00 00 12 34", bus.ask("01 08 00 00 12 34"));
}

TEST(SimulatedFaults, onlyLongRepliesAreSpoiled)
{
  TestBus bus(oneMx2());
  const std::string two_words = "01 03 10 00 00 02";
  const std::string good = bus.ask(two_words);
  // Address, function, count, four or eight bytes, check sum: 9 and 13 bytes.
  bus.command("m damaged count 2 longer 12");
  EXPECT_EQ(good, bus.ask(two_words));
  EXPECT_NE(GOOD, bus.ask(READ));
  EXPECT_EQ(good, bus.ask(two_words));
  EXPECT_NE(GOOD, bus.ask(READ));
  EXPECT_EQ(GOOD, bus.ask(READ));
  bus.command("m lost_reply for 1 longer 12");
  EXPECT_EQ(good, bus.ask(two_words));
  EXPECT_EQ("", bus.ask(READ));
  EXPECT_THAT(bus.command("m lost_request longer 12"), ::testing::HasSubstr("longer BYTES is for faults of a reply"));
}

TEST(SimulatedFaults, broadcastUsesNoFaultUp)
{
  TestBus bus(oneMx2());
  bus.command("m lost_reply");
  bus.ask("00 05 00 00 00 00");
  EXPECT_EQ("", bus.ask(READ));
  EXPECT_EQ(GOOD, bus.ask(READ));
}

TEST(SimulatedFaults, offlineDriveRunsOn)
{
  TestBus bus(oneMx2());
  bus.ask(SPEED_50);
  bus.ask(RUN);
  bus.command("m offline 2.0");
  EXPECT_EQ("", bus.ask(READ));
  bus.wait(1.0);
  EXPECT_EQ("1", bus.shown("m", "running"));
  bus.wait(1.1);
  EXPECT_NE("", bus.ask(READ));
  bus.command("m offline");
  bus.wait(1000.0);
  EXPECT_EQ("", bus.ask(READ));
  bus.command("m online");
  EXPECT_NE("", bus.ask(READ));
}

TEST(SimulatedFaults, busy)
{
  TestBus bus(oneMx2());
  bus.command("m busy 1.0");
  EXPECT_EQ("01 86 22", bus.ask("01 06 14 50 00 64"));
  EXPECT_EQ("01 01 01 01", bus.ask("01 01 00 48 00 01"));
  bus.wait(1.0);
  EXPECT_EQ("01 06 14 50 00 64", bus.ask("01 06 14 50 00 64"));
  TestBus rx(oneRx());
  rx.command("m busy 1.0");
  EXPECT_EQ("01 86 26", rx.ask("01 06 14 50 00 64"));
}

TEST(SimulatedFaults, requestDuringAPowerCycleIsNotAnsweredLater)
{
  TestBus bus(oneMx2());
  bus.bus.send(withModbusCrc(*fromHex(READ)), bus.now);
  bus.now += std::chrono::milliseconds(7);  // heard, not yet answered
  bus.bus.advance(bus.now);
  bus.command("m power_cycle 0.05");
  EXPECT_EQ("", bus.listen());
}

TEST(SimulatedCommands, everyAnswerIsOneLine)
{
  TestBus bus(oneMx2());
  for (const char* line :
       { "help", "list", "bus show", "bus frames 5", "m show", "m get F002", "m set F002 3", "bus reset", "m power off",
         "m power on", "m panel 5", "m panel_stop", "m panel_release", "m sto off", "m load 0.5", "bus plug" })
  {
    const std::string answer = bus.command(line);
    EXPECT_EQ("ok", answer.substr(0, 2)) << line << ": " << answer;
    EXPECT_EQ(std::string::npos, answer.find('\n')) << line;
  }
}

TEST(SimulatedCommands, errorsSayWhatIsAllowed)
{
  TestBus bus(oneMx2());
  EXPECT_EQ("error: unknown target x (allowed: help list bus m)", bus.command("x show"));
  EXPECT_EQ("error: echo maybe (allowed: on, off)", bus.command("bus echo maybe"));
  EXPECT_EQ("error: delay x (allowed: 0 to 3600)", bus.command("m late x"));
  EXPECT_EQ("error: unexpected word often (allowed: count N, for S, function F, writes, reads, longer BYTES)",
            bus.command("m late 1 often"));
  EXPECT_EQ("error: unexpected word now (allowed: nothing more here; see help)", bus.command("m trip 12 now"));
  EXPECT_EQ("error: omron_mx2 has no parameter Z999 (see help)", bus.command("m get Z999"));
  EXPECT_EQ("error: value out of range (0.00-99.99)", bus.command("m set C077 100"));
  EXPECT_EQ("error: load 5 (allowed: 0 to 3)", bus.command("m load 5"));
  EXPECT_EQ("", bus.command("   "));
  EXPECT_EQ("", bus.command("# a comment"));
}
