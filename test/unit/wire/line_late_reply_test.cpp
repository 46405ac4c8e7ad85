// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include <algorithm>

#include "support/line_fixture.h"

namespace inverter_bus
{
namespace wire
{
namespace
{
using std::chrono::milliseconds;

class LineLateReply : public LineFixture
{
};

TEST_F(LineLateReply, aLostRequestMayNotBeRepeatedForASecond)
{
  ask(READ);
  EXPECT_FALSE(mayAsk(READ));
  EXPECT_FALSE(mayAsk("01 03 12 34 00 02")) << "its reply would look the same";
  EXPECT_TRUE(mayAsk(OTHER_READ));
  EXPECT_TRUE(mayAsk("02 03 00 00 00 02"));
  EXPECT_EQ(clock_.now() + milliseconds(1000), line_.mayAskAt(requestOf(withCrc(READ))));
  EXPECT_EQ(clock_.now(), line_.mayAskAt(requestOf(withCrc(OTHER_READ))));
  clock_.advance(milliseconds(1000));
  EXPECT_TRUE(mayAsk(READ));
}

/// Time goes on between any two looks at it, as it does outside of tests.
class RunningClock : public util::Clock
{
public:
  TimePoint now() const override
  {
    time_ += std::chrono::nanoseconds(1);
    return time_;
  }
  void sleepUntil(TimePoint time) override
  {
    time_ = std::max(time_, time);
  }

private:
  mutable TimePoint time_{ std::chrono::hours(1) };
};

TEST_F(LineLateReply, nothingIsBarredByTheTimeThatTheQuestionTakes)
{
  RunningClock clock;
  const Line line(port_, *protocol_, clock, LineTiming(19200, 10));
  EXPECT_TRUE(line.mayAsk(requestOf(withCrc(READ))));
  const std::unique_ptr<Protocol> tcp = makeModbusTcp();
  const Line gateway(port_, *tcp, clock, LineTiming(19200, 10));
  EXPECT_TRUE(gateway.mayAsk(requestOf(withCrc(READ))));
}

TEST_F(LineLateReply, aDamagedReplyBarsToo)
{
  answerNextRaw(hex("55 AA"));
  EXPECT_EQ(Outcome::Damaged, ask(READ).outcome);
  EXPECT_FALSE(mayAsk(READ));
}

TEST_F(LineLateReply, itIsTakenByNoOtherRequestAndLiftsTheBar)
{
  answerNext(REPLY, 120);
  EXPECT_EQ(Outcome::Timeout, ask(READ).outcome);
  answerNext(OTHER_REPLY, 30);
  const Reply reply = ask(OTHER_READ);
  EXPECT_EQ(Outcome::Ok, reply.outcome);
  EXPECT_EQ(hex("03 02 12 34"), reply.pdu);
  EXPECT_EQ("RRLA", seen());
  EXPECT_EQ(1u, line_.counters().late_replies);
  EXPECT_EQ(0u, line_.counters().foreign_frames);
  EXPECT_TRUE(mayAsk(READ));
}

TEST_F(LineLateReply, itIsNoDamageToTheRequestInFlight)
{
  answerNext(REPLY, 120);
  ask(READ);
  EXPECT_EQ(Outcome::Timeout, ask(OTHER_READ).outcome);
  EXPECT_EQ(2u, line_.counters().timeouts);
  EXPECT_EQ(0u, line_.counters().corrupt_replies);
}

TEST_F(LineLateReply, itIsMeasured)
{
  answerNext(REPLY, 150);
  ask(READ);
  ask(OTHER_READ);
  const std::vector<LateReply> late = line_.takeLateReplies();
  ASSERT_EQ(1u, late.size());
  EXPECT_EQ(1, late[0].station);
  EXPECT_EQ(ms(150) - timing_.characters(8), late[0].delay);
  EXPECT_EQ(1u, late[0].ticket);
  EXPECT_TRUE(line_.takeLateReplies().empty());
}

TEST_F(LineLateReply, itIsTakenInSettling)
{
  answerNext(REPLY, 150);
  ask(READ);
  clock_.advance(milliseconds(60));
  EXPECT_TRUE(line_.settle());
  EXPECT_EQ("RL", seen());
  EXPECT_TRUE(mayAsk(READ));
}

TEST_F(LineLateReply, itIsTakenInSettlingThoughItComesInPieces)
{
  const Bytes reply = withCrc(REPLY);
  port_.answerNext(
      { { ms(120), Bytes(reply.begin(), reply.begin() + 4) }, { ms(136), Bytes(reply.begin() + 4, reply.end()) } });
  ask(READ);
  clock_.advance(milliseconds(16));
  EXPECT_TRUE(line_.settle());
  EXPECT_EQ("RL", seen());
}

TEST_F(LineLateReply, itIsTakenInSettlingThoughNoiseStandsBefore)
{
  answerNextRaw(hex("05 03 7F") + withCrc(REPLY), 120);
  ask(READ);
  clock_.advance(milliseconds(30));
  EXPECT_TRUE(line_.settle());
  EXPECT_EQ("RLD", seen());
}

TEST_F(LineLateReply, aWriteOfAnotherValueDoesNotTakeIt)
{
  answerNext(WRITE, 120);
  ask(WRITE);
  EXPECT_EQ(Outcome::Timeout, ask("01 06 00 01 00 00").outcome);
  EXPECT_EQ("RRL", seen());
}

TEST_F(LineLateReply, aRefusalOfUnclearOriginIsNotTaken)
{
  // Two reads of different length: either may have been refused.
  answerNext("01 83 02", 120);
  ask(READ);
  EXPECT_EQ(Outcome::Timeout, ask(OTHER_READ).outcome);
  EXPECT_EQ("RRL", seen());
  EXPECT_FALSE(mayAsk(READ));
  EXPECT_EQ(0u, line_.counters().exceptions);
}

TEST_F(LineLateReply, aRefusalOfAnotherFunctionIsTaken)
{
  ask(READ);
  answerNext("01 86 02");
  EXPECT_EQ(Outcome::Exception, ask(WRITE).outcome);
}

TEST_F(LineLateReply, aLateRefusalInSettlingLiftsTheBar)
{
  answerNext("01 83 02", 120);
  ask(READ);
  clock_.advance(milliseconds(30));
  EXPECT_TRUE(line_.settle());
  EXPECT_EQ("RL", seen());
  EXPECT_TRUE(mayAsk(READ));
}

TEST_F(LineLateReply, aLoopBackWithAFreshNumberLiftsTheBar)
{
  ask(READ);
  answerNext(LOOP_BACK);
  EXPECT_EQ(Outcome::Ok, ask(LOOP_BACK).outcome);
  EXPECT_TRUE(mayAsk(READ));
}

TEST_F(LineLateReply, aLoopBackOfAnotherStationLiftsNothing)
{
  ask(READ);
  answerNext("02 08 00 00 12 34");
  ask("02 08 00 00 12 34");
  EXPECT_FALSE(mayAsk(READ));
}

TEST_F(LineLateReply, aLoopBackThatIsRefusedLiftsNothing)
{
  ask(READ);
  answerNext("01 88 01");
  EXPECT_EQ(Outcome::Exception, ask(LOOP_BACK).outcome);
  EXPECT_FALSE(mayAsk(READ));
}

TEST_F(LineLateReply, aLoopBackWithAUsedNumberLiftsNothing)
{
  ask(LOOP_BACK);
  ask(READ);
  answerNext(LOOP_BACK);
  EXPECT_EQ(Outcome::Ok, ask(LOOP_BACK).outcome);
  EXPECT_FALSE(mayAsk(READ));
}

TEST_F(LineLateReply, aStopThatIsRepeatedDespiteTheBarIsOwedBothReplies)
{
  ask(WRITE);
  ask(WRITE);
  port_.deliver(milliseconds(1), withCrc(WRITE));
  clock_.advance(milliseconds(2));
  line_.settle();
  EXPECT_FALSE(mayAsk(WRITE));
  port_.deliver(milliseconds(1), withCrc(WRITE));
  clock_.advance(milliseconds(2));
  line_.settle();
  EXPECT_TRUE(mayAsk(WRITE));
  EXPECT_EQ("RRLL", seen());
}

TEST_F(LineLateReply, anEvenLaterReplyIsNoSecondMaster)
{
  answerNext(REPLY, 3000);
  ask(READ);
  clock_.advance(milliseconds(3000));
  line_.settle();
  EXPECT_EQ(1u, line_.counters().late_replies);
  EXPECT_EQ(0u, line_.counters().foreign_frames);
}

class LineSettle : public LineFixture
{
};

TEST_F(LineSettle, keepsTheGapAfterAReply)
{
  answerNext(REPLY);
  const Reply reply = ask(READ);
  EXPECT_EQ(reply.finished_at + timing_.gap(3.5), line_.readyAt());
  EXPECT_TRUE(line_.settle());
  EXPECT_EQ(reply.finished_at + timing_.gap(3.5), clock_.now());
}

TEST_F(LineSettle, takesNoTimeOnAQuietLine)
{
  clock_.advance(milliseconds(10));
  startWatch();
  EXPECT_TRUE(line_.settle());
  EXPECT_EQ(Duration::zero(), elapsed());
  EXPECT_LE(line_.readyAt(), clock_.now());
}

TEST_F(LineSettle, waitsForAGapAfterAStrayByte)
{
  clock_.advance(milliseconds(10));
  port_.deliver(Duration::zero(), hex("FF"));
  startWatch();
  EXPECT_TRUE(line_.settle());
  EXPECT_EQ(timing_.gap(3.5), elapsed());
  EXPECT_EQ("D", seen());
  EXPECT_EQ(0u, line_.counters().corrupt_replies);
}

TEST_F(LineSettle, countsFramesOfASecondMaster)
{
  port_.deliver(Duration::zero(), withCrc("02 03 00 00 00 01"));
  port_.deliver(milliseconds(1), withCrc("02 03 02 00 00"));
  EXPECT_TRUE(line_.settle());
  EXPECT_EQ("FF", seen());
  EXPECT_EQ(2u, line_.counters().foreign_frames);
}

TEST_F(LineSettle, isBoundedUnderBabble)
{
  clock_.advance(milliseconds(10));
  for (int i = 0; i < 500; ++i)
  {
    port_.deliver(milliseconds(i), hex("01 03 55"));
  }
  startWatch();
  EXPECT_TRUE(line_.settle());
  EXPECT_LE(elapsed(), milliseconds(100));
  EXPECT_LE(line_.readyAt(), clock_.now()) << "a stop must be able to go out now";
}

TEST_F(LineSettle, isBoundedAfterTheTurnaroundOfABroadcastToo)
{
  const Reply reply = line_.exchange(requestOf(withCrc("00 06 FA 00 C0 00")), milliseconds(200));
  for (int i = 0; i < 500; ++i)
  {
    port_.deliver(milliseconds(i), hex("55"));
  }
  EXPECT_TRUE(line_.settle());
  EXPECT_LE(clock_.now(), reply.sent_at + timing_.characters(8) + milliseconds(300));
  EXPECT_GE(clock_.now(), reply.sent_at + milliseconds(200));
}

TEST_F(LineSettle, whatFollowsAReplyIsNotLost)
{
  answerNextRaw(withCrc(REPLY) + withCrc("02 03 02 00 00"));
  EXPECT_EQ(Outcome::Ok, ask(READ).outcome);
  EXPECT_TRUE(line_.settle());
  EXPECT_EQ("RAF", seen());
}

TEST_F(LineSettle, exchangeWithoutItSurvivesLeftovers)
{
  answerNextRaw(withCrc(REPLY) + hex("01 03 04"));
  EXPECT_EQ(Outcome::Ok, ask(READ).outcome);
  answerNext(REPLY);
  EXPECT_EQ(Outcome::Ok, line_.exchange(requestOf(withCrc(READ))).outcome);
  EXPECT_EQ("RADRA", seen());
}
}  // namespace
}  // namespace wire
}  // namespace inverter_bus
