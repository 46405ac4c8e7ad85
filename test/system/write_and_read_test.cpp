// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

// 17H of an MX2: only to write, and then with the status (contract, 3.10 and 8.2).

#include "support/virtual_bus.h"

namespace inverter_bus
{
namespace
{
const char* const BELT = R"(
port: /dev/virtual
baud_rate: 19200
scan_list:
  - {name: belt, node: 1, drive: omron_mx2}
)";

const std::string WITH_READ = "01 17 10 00 00 04 00 00 00 02 04";

/// Changes its frequency by 0.01 Hz at 50 Hz for \p duration s.
void change(VirtualBus& bus, double duration)
{
  for (int step = 0; step < static_cast<int>(duration * 50.0); ++step)
  {
    bus.at(0.02 * step, [&bus, step] { bus.command(0, 20.0 + 0.01 * step); });
  }
}

TEST(WriteAndRead, frequencyOfARunningMotorChangesWithItsStatusInOneExchange)
{
  VirtualBus bus(BELT);
  bus.settleIn();
  change(bus, 10.0);
  bus.run(5.0);
  bus.clearFrames();
  bus.run(4.0);
  const std::size_t coils = bus.count("01 01 00 00 00 18");
  EXPECT_GT(bus.count(WITH_READ), coils / 2) << "most refreshes get their registers with a write";
  EXPECT_NEAR(*bus.status(0).monitor.output_frequency, bus.motor("belt", "frequency"), 0.1);
  EXPECT_EQ(bus.motor("belt", "run_coil"), 1);
}

TEST(WriteAndRead, settledCommandIsReadByThePlainRead)
{
  VirtualBus bus(BELT);
  bus.settleIn();
  bus.stream(0, 20.0, 0.1, 10.0);
  bus.run(2.0);
  bus.clearFrames();
  bus.run(5.0);
  EXPECT_EQ(bus.count("01 17"), 0U);
  EXPECT_GT(bus.count("01 03 10 00 00 04"), 50U);
}

TEST(WriteAndRead, lostOneIsFollowedByAPlainReadThenByPlainWrites)
{
  VirtualBus bus(BELT);
  bus.settleIn();
  change(bus, 10.0);
  bus.run(3.0);
  bus.clearFrames();
  bus.world("belt lost_reply function 0x17 count 1");
  ASSERT_TRUE(bus.runUntil(2.0, [&] { return bus.line().counters().timeouts > 0; }));
  ASSERT_EQ(bus.requests().back().substr(0, 5), "01 17");
  bus.clearFrames();
  ASSERT_TRUE(bus.runUntil(2.0, [&] { return bus.count("01 10 00 00") > 0; }));
  EXPECT_GT(bus.count("01 03 10 00 00 04"), 0U) << "what the drive took of it is read first";
  EXPECT_EQ(bus.count("01 17"), 0U);
}

TEST(WriteAndRead, driveThatDoesNotKnowItGetsPlainWritesForGood)
{
  VirtualBus bus(BELT);
  bus.settleIn();
  change(bus, 10.0);
  ASSERT_TRUE(bus.runUntil(5.0, [&] { return bus.count(WITH_READ) > 0; }));
  bus.world("belt exception 1 writes count 1");
  ASSERT_TRUE(bus.runUntil(2.0, [&] { return bus.line().counters().exceptions > 0; }));
  bus.clearFrames();
  bus.run(3.0);
  EXPECT_EQ(bus.status(0).error_id, 0);
  EXPECT_GT(bus.count("01 10 00 00 00 02"), 20U);
}
}  // namespace
}  // namespace inverter_bus
