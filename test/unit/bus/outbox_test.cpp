// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
// What goes out after a step.

#include "bus/report/outbox.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/bus_fixture.h"

namespace inverter_bus
{
namespace bus
{
namespace
{
using testing::ElementsAre;
using testing::IsEmpty;
using testing::SizeIs;

TEST(Outbox, keepsTheOrderAndIsEmptyAfterwards)
{
  Outbox outbox(1);
  outbox.log(Level::Warn, "first");
  outbox.log(Level::Error, "second", PORT_SUBJECT);
  outbox.trace("a trip");
  const Outputs outputs = outbox.takeOutputs();
  ASSERT_THAT(outputs.log, SizeIs(2));
  EXPECT_EQ(outputs.log[0].text, "first");
  EXPECT_EQ(outputs.log[1].subject, "the port");
  EXPECT_THAT(outputs.traces, ElementsAre("a trip"));
  EXPECT_THAT(outbox.takeOutputs().log, IsEmpty());
}

TEST(Outbox, eventsHaveTheTimeOfWhatIsDoneAndLogLinesAreEventsToo)
{
  Outbox outbox(1);
  outbox.at(at(5));
  outbox.event("a stop is accepted");
  outbox.at(at(7));
  outbox.log(Level::Warn, "the port is gone");
  const Outputs outputs = outbox.takeOutputs();
  ASSERT_THAT(outputs.events, SizeIs(2));
  EXPECT_EQ(outputs.events[0].time, at(5));
  EXPECT_STREQ(outputs.events[0].text.data(), "a stop is accepted");
  EXPECT_EQ(outputs.events[1].time, at(7));
  EXPECT_STREQ(outputs.events[1].text.data(), "the port is gone");
}

TEST(Outbox, aFloodOfEventsIsBounded)
{
  Outbox outbox(1);
  for (int number = 0; number < 10000; ++number)
  {
    outbox.event("refused");
  }
  EXPECT_THAT(outbox.takeOutputs().events, SizeIs(2048));
}

TEST(Outbox, anAnswerThatNobodyWaitsForIsNotKept)
{
  Outbox outbox(1);
  outbox.answer(AnswerCallback(), Answer());
  EXPECT_THAT(outbox.takeAnswers(), IsEmpty());
}

TEST(Outbox, aRefusalIsAnAnswerWithoutSuccess)
{
  Outbox outbox(1);
  outbox.refuse([](const Answer&) {}, ERROR_OFFLINE, "offline");
  const PendingAnswers answers = outbox.takeAnswers();
  ASSERT_THAT(answers, SizeIs(1));
  EXPECT_FALSE(answers[0].second.success);
  EXPECT_EQ(answers[0].second.error_id, ERROR_OFFLINE);
  EXPECT_EQ(answers[0].second.message, "offline");
}
}  // namespace
}  // namespace bus
}  // namespace inverter_bus
