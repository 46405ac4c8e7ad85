// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
// What the flight recorder is told beside the frames (contract, section 4.11), on a whole bus in virtual time.

#include <gmock/gmock.h>

#include "support/virtual_bus.h"

namespace inverter_bus
{
namespace
{
using ::testing::Contains;
using ::testing::Each;
using ::testing::HasSubstr;
using ::testing::IsSupersetOf;
using ::testing::Not;
using ::testing::StartsWith;

const char* const TWO_BELTS = R"(
port: /dev/virtual
scan_list:
  - {name: belt, node: 1, drive: omron_mx2}
  - {name: feed, node: 2, drive: omron_mx2}
simulation:
  belt: {parameters: {F002: 1, F003: 1}}
)";

/// The event that begins so, and how many do.
std::size_t countOf(const VirtualBus& bus, const std::string& beginning)
{
  const auto texts = bus.eventTexts();
  return static_cast<std::size_t>(std::count_if(texts.begin(), texts.end(), [&](const std::string& text) {
    return text.compare(0, beginning.size(), beginning) == 0;
  }));
}

TEST(Trace, aCommandAStopAndALockAreEvents)
{
  VirtualBus bus(TWO_BELTS);
  bus.settleIn();
  EXPECT_THAT(bus.eventTexts(), IsSupersetOf({ "port /dev/virtual is open", "belt: is no longer locked" }));
  ASSERT_EQ(0U, bus.command(0, 20.0, "/teleop"));
  bus.run(1.0);
  ASSERT_EQ(bus::ERROR_OUT_OF_RANGE, bus.command(1, 2000.0, "/teleop"));
  ASSERT_TRUE(bus.wait(bus.stop(0)).success);
  bus.run(1.0);
  EXPECT_THAT(bus.eventTexts(),
              IsSupersetOf({ "accepted: belt 20 from /teleop", "refused (0xA000): feed 2000 from /teleop",
                             "belt: stop was called", "belt: a stop is accepted, which locks",
                             "belt: the stop is confirmed", "belt: is locked" }));
}

TEST(Trace, anEventHasTheTimeAtWhichItHappened)
{
  VirtualBus bus(TWO_BELTS);
  bus.settleIn();
  bus.run(0.0123);
  const TimePoint commanded = bus.now();
  ASSERT_EQ(0U, bus.command(0, 20.0));
  bus.run(0.5);
  const auto& events = bus.events();
  const auto found = std::find_if(events.begin(), events.end(), [](const bus::TraceEvent& event) {
    return std::string(event.text.data()) == "accepted: belt 20 from /user";
  });
  ASSERT_NE(found, events.end());
  EXPECT_EQ(commanded, found->time);
  EXPECT_TRUE(std::is_sorted(events.begin(), events.end(),
                             [](const bus::TraceEvent& a, const bus::TraceEvent& b) { return a.time < b.time; }));
}

TEST(Trace, aStreamOfEqualCommandsIsOneEventAndACount)
{
  VirtualBus bus(TWO_BELTS);
  bus.settleIn();
  for (int times = 0; times < 40; ++times)
  {
    bus.command(0, 20.0);
    bus.run(0.02);
  }
  bus.command(0, 25.0);
  bus.run(0.1);
  EXPECT_EQ(1U, countOf(bus, "accepted: belt 20"));
  EXPECT_THAT(bus.eventTexts(), Contains("39 more times: accepted: belt 20 from /user"));
  EXPECT_EQ(1U, countOf(bus, "accepted: belt 25"));
}

TEST(Trace, aLostReplyAndItsRepeatAreEventsAndSoIsTheWayOffline)
{
  VirtualBus bus(TWO_BELTS);
  bus.settleIn();
  bus.world("belt lost_reply");
  bus.run(1.0);
  EXPECT_EQ(1U, countOf(bus, "belt: no reply to a status read"));
  EXPECT_EQ(1U, countOf(bus, "belt: a status read is tried again"));
  bus.world("belt damaged");
  bus.run(1.0);
  EXPECT_EQ(1U, countOf(bus, "belt: damaged reply to a status read"));
  EXPECT_EQ(0U, countOf(bus, "belt: offline"));
  bus.world("belt offline");
  bus.run(30.0);
  EXPECT_EQ(1U, countOf(bus, "belt: offline"));
  EXPECT_LT(countOf(bus, "belt: no reply"), 10U) << "probes do not fill the record";
  bus.world("belt online");
  bus.run(5.0);
  EXPECT_EQ(2U, countOf(bus, "belt: online")) << "at the start and now";
  EXPECT_THAT(bus.eventTexts(), Each(Not(StartsWith("feed: no reply"))));
}

TEST(Trace, thePortIsAnEvent)
{
  VirtualBus bus(TWO_BELTS);
  bus.settleIn();
  bus.world("bus unplug");
  bus.run(1.0);
  EXPECT_EQ(1U, countOf(bus, "port /dev/virtual is gone"));
  bus.world("bus plug");
  bus.run(5.0);
  EXPECT_EQ(2U, countOf(bus, "port /dev/virtual is open"));
}
}  // namespace
}  // namespace inverter_bus
