// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

// A wait that ends because a stop comes (contract, 8.4).

#include "support/line_fixture.h"

namespace inverter_bus
{
namespace wire
{
namespace
{
/// 19200 8N1: a read request takes 4.17 ms, its reply of 9 characters 4.69 ms.
class LineCut : public LineFixture
{
protected:
  LineCut()
  {
    way_.silence = ms(15);
    way_.pause = ms(5);
    stopAfter(1e6);
  }

  /// From the beginning of the next exchange.
  void stopAfter(double milliseconds)
  {
    const TimePoint at = clock_.now() + ms(milliseconds);
    way_.stop_waits = [this, at] { return clock_.now() >= at; };
  }

  Reply askUntilStopped(const std::string& request)
  {
    EXPECT_TRUE(line_.settle(way_));
    startWatch();
    return line_.exchange(requestOf(withCrc(request)), Duration{ 0 }, way_);
  }

  GiveWay way_;
};

TEST_F(LineCut, aStopThatWaitsFromTheStartLeavesTheDriveItsTime)
{
  stopAfter(0);
  const Reply reply = askUntilStopped(READ);
  EXPECT_TRUE(reply.cut);
  EXPECT_EQ(reply.outcome, Outcome::Timeout);
  EXPECT_EQ(elapsed(), timing_.characters(8) + ms(15));
}

TEST_F(LineCut, aStopThatComesLaterIsNoticedWithinAMillisecond)
{
  ASSERT_TRUE(line_.settle());
  stopAfter(40.3);
  const Reply reply = askUntilStopped(READ);
  EXPECT_TRUE(reply.cut);
  EXPECT_GE(elapsed(), ms(40.3));
  EXPECT_LE(elapsed(), ms(41.3));
}

TEST_F(LineCut, withoutAStopTheFullTimeIsWaitedFor)
{
  const Reply reply = askUntilStopped(READ);
  EXPECT_FALSE(reply.cut);
  EXPECT_EQ(reply.outcome, Outcome::Timeout);
  EXPECT_GE(elapsed(), ms(104));
}

TEST_F(LineCut, aReplyInTimeIsTakenAlthoughAStopWaits)
{
  stopAfter(0);
  answerNext(REPLY, 18);
  const Reply reply = askUntilStopped(READ);
  EXPECT_EQ(reply.outcome, Outcome::Ok);
  EXPECT_FALSE(reply.cut);
}

TEST_F(LineCut, aReplyThatHasBegunIsWaitedForWhileBytesComeAndNoLonger)
{
  stopAfter(0);
  const Bytes frame = withCrc(REPLY);
  const auto piece = [&](std::ptrdiff_t from, std::ptrdiff_t to) {
    return Bytes(frame.begin() + from, frame.begin() + to);
  };
  port_.answerNext({ { ms(17), piece(0, 3) }, { ms(21.5), piece(3, 6) }, { ms(26), piece(6, 9) } });
  EXPECT_EQ(askUntilStopped(READ).outcome, Outcome::Ok);
  EXPECT_EQ(elapsed(), ms(26));
  stopAfter(0);
  port_.answerNext({ { ms(17), piece(0, 3) } });
  const Reply broken = askUntilStopped(READ);
  EXPECT_EQ(broken.outcome, Outcome::Damaged);
  EXPECT_TRUE(broken.cut);
  EXPECT_EQ(elapsed(), ms(22));
}

TEST_F(LineCut, noiseBeforeTheReplyDoesNotTakeTheDrivesTime)
{
  stopAfter(0);
  answerNextRaw({ 0xFF }, 6);
  const Reply reply = askUntilStopped(READ);
  EXPECT_TRUE(reply.cut);
  EXPECT_EQ(elapsed(), timing_.characters(8) + ms(15));
}

TEST_F(LineCut, whatWasCutIsBarredAndItsLateReplyIsNobodysAnswer)
{
  stopAfter(0);
  port_.answerNext({ { ms(50), withCrc(REPLY) } });
  ASSERT_TRUE(askUntilStopped(READ).cut);
  EXPECT_FALSE(mayAsk(READ));
  EXPECT_TRUE(mayAsk(OTHER_READ));
  way_.stop_waits = nullptr;
  port_.answerNext({ { ms(60), withCrc(OTHER_REPLY) } });
  const Reply other = askUntilStopped(OTHER_READ);
  EXPECT_EQ(other.outcome, Outcome::Ok);
  EXPECT_EQ(other.pdu, (Bytes{ 0x03, 0x02, 0x12, 0x34 }));
  ASSERT_EQ(line_.takeLateReplies().size(), 1U);
  EXPECT_TRUE(mayAsk(READ));
}

TEST_F(LineCut, countsAsNoTimeOutAndAsNoDamage)
{
  stopAfter(0);
  askUntilStopped(READ);
  port_.answerNext({ { ms(17), Bytes{ 0x01, 0x03 } } });
  askUntilStopped(OTHER_READ);
  EXPECT_EQ(line_.counters().requests, 2U);
  EXPECT_EQ(line_.counters().timeouts, 0U);
  EXPECT_EQ(line_.counters().corrupt_replies, 0U);
}

TEST_F(LineCut, halfALateFrameHoldsAStopUpForAPauseOnly)
{
  port_.deliver(ms(3), Bytes{ 0x01, 0x03, 0x04, 0x12 });
  stopAfter(0);
  clock_.advance(ms(3));
  startWatch();
  EXPECT_TRUE(line_.settle(way_));
  EXPECT_EQ(elapsed(), ms(5));
  port_.deliver(ms(3), Bytes{ 0x01, 0x03, 0x04, 0x12 });
  way_.stop_waits = [] { return false; };
  clock_.advance(ms(3));
  startWatch();
  EXPECT_TRUE(line_.settle(way_));
  EXPECT_EQ(elapsed(), ms(25));
}

TEST(LineTiming, aBriefPauseIs5MillisecondsOrAFifosAtLowRates)
{
  EXPECT_EQ(LineTiming(115200, 10).briefPause(), std::chrono::milliseconds(5));
  EXPECT_NEAR(toSeconds(LineTiming(9600, 10).briefPause()), 0.01875, 1e-9);
  EXPECT_NEAR(toSeconds(LineTiming(9600, 11, seconds(0.1)).briefPause()), 0.020625, 1e-9);
}
}  // namespace
}  // namespace wire
}  // namespace inverter_bus
