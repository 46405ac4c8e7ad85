// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

// The wire: time, gaps, collisions, echo, unplugging.

#include <gtest/gtest.h>

#include "support/simulation_test_bus.h"

using namespace inverter_bus::simulation;

namespace
{
const std::string TWO = "scan_list: [{name: a, node: 1, drive: omron_mx2}, {name: b, node: 2, drive: omron_mx2}]";

Bytes request(const std::string& hex)
{
  return withModbusCrc(*fromHex(hex));
}
}  // namespace

TEST(SimulatedLine, characterAndGapTimes)
{
  LineSettings line;
  EXPECT_NEAR(10.0 / 19200, toSeconds(line.characterTime()), 1e-9);
  EXPECT_NEAR(35.0 / 19200, toSeconds(line.frameGap()), 1e-8);
  line.parity = Parity::Even;
  line.stop_bits = 2;
  EXPECT_NEAR(12.0 / 19200, toSeconds(line.characterTime()), 1e-9);
  line.baud_rate = 38400;
  EXPECT_NEAR(0.00175, toSeconds(line.frameGap()), 1e-9);
}

TEST(SimulatedLine, exchangeTakesItsTimeOnTheWire)
{
  for (const int baud : { 2400, 9600, 19200, 115200 })
  {
    TestBus bus("baud_rate: " + std::to_string(baud) + "\n" + TWO);
    const LineSettings& line = bus.bus.line().options().settings;
    const TimePoint sent = bus.now;
    bus.ask("01 03 10 00 00 04");
    const Duration expected = line.characterTime() * (8 + 13) + line.frameGap() + seconds(0.002);
    EXPECT_NEAR(toSeconds(expected), toSeconds(bus.last_byte - sent), 1e-6) << baud;
  }
}

TEST(SimulatedLine, bytesComeOutNoEarlierThanTheirTime)
{
  LineOptions options;
  options.delivery_step = std::chrono::microseconds(500);
  TestBus bus(TWO, options);
  const TimePoint sent = bus.now;
  bus.bus.send(request("01 03 10 00 00 04"), bus.now);
  const LineSettings line;
  const Duration first_start = line.characterTime() * 8 + line.frameGap() + seconds(0.002);
  int heard = 0;
  for (auto next = bus.bus.nextEvent(); next; next = bus.bus.nextEvent())
  {
    bus.now = *next;
    bus.bus.advance(bus.now);
    for (const Delivery& delivery : bus.bus.takeOutput(bus.now))
    {
      heard += static_cast<int>(delivery.bytes.size());
      EXPECT_NEAR(toSeconds(first_start + line.characterTime() * heard), toSeconds(delivery.time - sent), 1e-7);
      EXPECT_GE(bus.now, delivery.time);
      EXPECT_LE(delivery.bytes.size(), 2U);
    }
  }
  EXPECT_EQ(13, heard);
}

TEST(SimulatedLine, requestWithoutTheGapIsLost)
{
  TestBus bus(TWO);
  bus.bus.send(request("01 03 10 00 00 04"), bus.now);
  EXPECT_NE("", bus.listen());
  bus.now += std::chrono::milliseconds(1);  // 1.82 ms are needed
  EXPECT_EQ("", bus.ask("02 03 10 00 00 04"));
  EXPECT_EQ("1", bus.shown("b", "lost_gap"));
  EXPECT_EQ("0", bus.shown("a", "lost_gap"));
  EXPECT_NE("", bus.ask("02 03 10 00 00 04"));
  EXPECT_NE(std::string::npos, bus.command("bus frames").find("# lost: gap"));
}

TEST(SimulatedLine, requestALittleEarlyIsInTime)
{
  TestBus bus(TWO);
  bus.bus.send(request("01 03 10 00 00 04"), bus.now);
  bus.listen();
  bus.now += LineSettings().frameGap() - std::chrono::microseconds(250);
  EXPECT_NE("", bus.ask("02 03 10 00 00 04"));
}

TEST(SimulatedLine, gapCountsFromWhenTheMasterCouldSeeTheReply)
{
  TestBus bus(TWO);
  bus.bus.send(request("01 03 10 00 00 04"), bus.now);
  bus.bus.advance(bus.now + std::chrono::milliseconds(50));  // the simulator was late and hands over now
  bus.now += std::chrono::milliseconds(50);
  EXPECT_EQ(1U, bus.bus.takeOutput(bus.now).size());
  bus.now += std::chrono::milliseconds(1);
  EXPECT_EQ("", bus.ask("02 03 10 00 00 04"));
  EXPECT_EQ("1", bus.shown("b", "lost_gap"));
}

TEST(SimulatedLine, earlyRequestIsServedAndCountedOnDemand)
{
  LineOptions options;
  options.gap = GapRule::Ignore;
  TestBus bus(TWO, options);
  bus.bus.send(request("01 03 10 00 00 04"), bus.now);
  bus.listen();
  EXPECT_NE("", bus.ask("02 03 10 00 00 04"));
  EXPECT_EQ("1", bus.shown("b", "early"));
}

TEST(SimulatedLine, twoRequestsBackToBackAreOneBrokenFrame)
{
  TestBus bus(TWO);
  bus.bus.send(request("00 05 00 00 00 00"), bus.now);
  bus.bus.send(request("01 03 10 00 00 04"), bus.now + std::chrono::milliseconds(1));
  EXPECT_EQ("", bus.listen());
  LineOptions options;
  options.gap = GapRule::Ignore;
  TestBus patient(TWO, options);
  patient.bus.send(request("00 05 00 00 00 00"), patient.now);
  patient.bus.send(request("01 03 10 00 00 04"), patient.now + std::chrono::milliseconds(1));
  EXPECT_NE("", patient.listen());
  EXPECT_EQ("1", patient.shown("b", "broadcasts"));
}

TEST(SimulatedLine, bytesOfOneFrameMayComeInPieces)
{
  TestBus bus(TWO);
  const Bytes frame = request("01 03 10 00 00 04");
  for (const std::uint8_t byte : frame)
  {
    bus.bus.send({ byte }, bus.now);
    bus.now += std::chrono::microseconds(600);
  }
  EXPECT_NE("", bus.listen());
}

TEST(SimulatedLine, transmissionsAtOnceDamageEachOther)
{
  TestBus bus(TWO);
  bus.bus.send(request("01 03 10 00 00 04"), bus.now);
  bus.now += LineSettings().characterTime() * 12 + std::chrono::milliseconds(4);  // in the middle of the reply
  bus.bus.send(request("02 03 10 00 00 04"), bus.now);
  const Bytes heard = *fromHex(bus.listen());
  EXPECT_EQ(13U, heard.size());
  EXPECT_FALSE(modbusCrcFits(heard));
  EXPECT_NE(std::string::npos, bus.command("bus show").find("collisions=2"));
  EXPECT_NE(std::string::npos, bus.command("bus frames").find("# damaged: collision"));
}

TEST(SimulatedLine, lateReplyMeetsTheNextExchange)
{
  TestBus bus(TWO);
  bus.command("a late 0.1");
  bus.bus.send(request("01 03 10 00 00 04"), bus.now);
  // a's reply starts about 108 ms after its request, b's 8 ms after its own
  bus.now += std::chrono::milliseconds(101);
  bus.bus.send(request("02 03 10 00 00 04"), bus.now);
  EXPECT_FALSE(modbusCrcFits(*fromHex(bus.listen())));
}

TEST(SimulatedLine, driveThatOwesAReplyHearsNothing)
{
  TestBus bus(TWO);
  bus.command("a late 0.2");
  bus.bus.send(request("01 03 10 00 00 04"), bus.now);
  bus.now += std::chrono::milliseconds(100);
  bus.bus.send(request("01 03 10 00 00 01"), bus.now);
  EXPECT_EQ("01 03 08 00 00 00 00 00 00 00 00 95 D7", bus.listen());
  EXPECT_EQ("1", bus.shown("a", "lost_busy"));
}

TEST(SimulatedLine, echo)
{
  TestBus bus(TWO);
  EXPECT_EQ("ok", bus.command("bus echo on"));
  EXPECT_EQ("01 05 00 00 00 00 CD CA 01 05 00 00 00 00 CD CA", bus.askRaw("01 05 00 00 00 00 CD CA"));
  bus.command("bus echo off");
  EXPECT_EQ("01 05 00 00 00 00 CD CA", bus.askRaw("01 05 00 00 00 00 CD CA"));
}

TEST(SimulatedLine, foreignMasterIsHeardAndAnswered)
{
  TestBus bus(TWO);
  EXPECT_EQ("ok frame=01 05 00 00 FF 00 8C 3A", bus.command("bus foreign 01 05 00 00 FF 00"));
  EXPECT_EQ("01 05 00 00 FF 00 8C 3A 01 05 00 00 FF 00 8C 3A", bus.listen());
  EXPECT_EQ("1", bus.shown("a", "run_coil"));
}

TEST(SimulatedLine, foreignMasterAtOnceSpoilsARequest)
{
  TestBus bus(TWO);
  bus.bus.send(request("01 03 10 00 00 04"), bus.now);
  bus.command("bus foreign 02 03 10 00 00 04 now");
  bus.listen();
  EXPECT_EQ("0", bus.shown("a", "exchanges"));
  EXPECT_EQ("0", bus.shown("b", "exchanges"));
}

TEST(SimulatedLine, cutLineIsSilentForAWhile)
{
  TestBus bus(TWO);
  bus.command("bus silent 1.0");
  EXPECT_EQ("", bus.ask("01 03 10 00 00 04"));
  bus.wait(1.0);
  EXPECT_NE("", bus.ask("01 03 10 00 00 04"));
}

TEST(SimulatedLine, unpluggedAdapter)
{
  TestBus bus(TWO);
  bus.bus.send(request("01 03 10 00 00 04"), bus.now);
  bus.now += std::chrono::milliseconds(2);  // in the middle of the request
  EXPECT_EQ("ok", bus.command("bus unplug 0.5"));
  EXPECT_FALSE(bus.bus.pluggedIn());
  EXPECT_EQ("", bus.listen());
  EXPECT_EQ("0", bus.shown("a", "exchanges"));
  bus.wait(0.5);
  EXPECT_TRUE(bus.bus.pluggedIn());
  EXPECT_NE("", bus.ask("01 03 10 00 00 04"));
}

TEST(SimulatedLine, noise)
{
  TestBus bus(TWO);
  EXPECT_EQ("ok", bus.command("bus noise 5"));
  EXPECT_EQ(5U, fromHex(bus.listen())->size());
}

TEST(SimulatedLine, sameSeedSameDamage)
{
  const auto play = [](std::uint64_t seed) {
    LineOptions options;
    options.seed = seed;
    TestBus bus(TWO, options);
    bus.command("a noise 4 count 0");
    bus.command("a damaged count 0");
    return bus.askRaw("01 03 10 00 00 04 40 C9");
  };
  EXPECT_EQ(play(7), play(7));
  EXPECT_NE(play(7), play(8));
}

TEST(SimulatedLine, aMillionExchangesAreQuick)
{
  TestBus bus("baud_rate: 115200\n" + TWO);
  const Bytes frame = request("01 03 10 00 00 04");
  for (int i = 0; i < 20000; ++i)
  {
    bus.bus.send(frame, bus.now);
    for (auto next = bus.bus.nextEvent(); next; next = bus.bus.nextEvent())
    {
      bus.now = *next;
      bus.bus.advance(bus.now);
      bus.bus.takeOutput(bus.now);
    }
    bus.now += std::chrono::milliseconds(2);
  }
  EXPECT_EQ("20000", bus.shown("a", "exchanges"));
}
