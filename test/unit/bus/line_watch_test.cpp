// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
// What the line has counted, as the others see it.

#include "bus/report/line_watch.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/bus_fixture.h"

namespace inverter_bus
{
namespace bus
{
namespace
{
using testing::HasSubstr;

LineFacts withForeign(std::uint64_t frames)
{
  LineFacts facts;
  facts.counters.foreign_frames = frames;
  return facts;
}

TEST(LineWatch, keepsWhatWasNotedLast)
{
  LineWatch watch;
  EXPECT_FALSE(watch.facts().echo_found);
  EXPECT_EQ(watch.facts().last_loss, wire::Loss::None);
  LineFacts facts = withForeign(3);
  facts.echo_found = true;
  facts.gateway_quirk = "unit 0 for all";
  facts.telnet_found = true;
  facts.proven_since_open = true;
  facts.last_loss = wire::Loss::ClosedByPeer;
  facts.peer_words = "Port already in use";
  watch.note(at(0), facts);
  EXPECT_TRUE(watch.facts().echo_found);
  EXPECT_TRUE(watch.facts().telnet_found);
  EXPECT_TRUE(watch.facts().proven_since_open);
  EXPECT_EQ(watch.facts().counters.foreign_frames, 3U);
  EXPECT_EQ(watch.facts().gateway_quirk, "unit 0 for all");
  EXPECT_EQ(watch.facts().last_loss, wire::Loss::ClosedByPeer);
  EXPECT_EQ(watch.facts().peer_words, "Port already in use");
  watch.note(at(1), LineFacts());
  EXPECT_FALSE(watch.facts().echo_found);
  EXPECT_EQ(watch.facts().peer_words, "");
}

TEST(LineWatch, aForeignFrameIsShownForAMinute)
{
  LineWatch watch;
  EXPECT_FALSE(watch.foreignFinding(at(0), false));
  watch.note(at(1000), withForeign(1));
  watch.note(at(30000), withForeign(1));
  ASSERT_TRUE(watch.foreignFinding(at(60999), false));
  EXPECT_THAT(watch.foreignFinding(at(60999), false)->text, HasSubstr("a second master (1 so far)"));
  EXPECT_FALSE(watch.foreignFinding(at(61000), false));
}

TEST(LineWatch, behindAGatewayItIsAnotherClient)
{
  LineWatch watch;
  watch.note(at(0), withForeign(2));
  EXPECT_THAT(watch.foreignFinding(at(1), true)->text, HasSubstr("another client of the gateway"));
}
}  // namespace
}  // namespace bus
}  // namespace inverter_bus
