// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "support/line_fixture.h"

namespace inverter_bus
{
namespace wire
{
namespace
{
using std::chrono::milliseconds;

class LineExchange : public LineFixture
{
};

TEST_F(LineExchange, aReplyEndsIt)
{
  answerNext(REPLY, 20);
  const Reply reply = ask(READ);
  EXPECT_EQ(Outcome::Ok, reply.outcome);
  EXPECT_EQ(0, reply.error_id);
  EXPECT_EQ(hex("03 04 12 34 56 78"), reply.pdu);
  EXPECT_EQ(reply.sent_at + ms(20), reply.finished_at);
  EXPECT_EQ(withCrc(READ), port_.sent().at(0));
  EXPECT_EQ("RA", seen());
  EXPECT_EQ(withCrc(REPLY), events_.at(1).bytes);
  EXPECT_EQ(1u, line_.counters().requests);
  EXPECT_EQ(1u, line_.counters().replies);
}

TEST_F(LineExchange, turnaroundIsTheSilenceBetweenRequestAndReply)
{
  // Nine bytes that are there 20 ms after the beginning of eight others.
  answerNext(REPLY, 20);
  const Reply reply = ask(READ);
  EXPECT_EQ(ms(20) - timing_.characters(8) - timing_.characters(9), reply.turnaround);
}

TEST_F(LineExchange, turnaroundIsNeverNegative)
{
  answerNext(REPLY, 6);
  EXPECT_EQ(Duration::zero(), ask(READ).turnaround);
}

TEST_F(LineExchange, anExceptionEndsIt)
{
  answerNext("01 83 02");
  const Reply reply = ask(READ);
  EXPECT_EQ(Outcome::Exception, reply.outcome);
  EXPECT_EQ(0x8302, reply.error_id);
  EXPECT_EQ(hex("83 02"), reply.pdu);
  EXPECT_EQ("RE", seen());
  EXPECT_EQ(1u, line_.counters().replies);
  EXPECT_EQ(1u, line_.counters().exceptions);
  EXPECT_TRUE(mayAsk(READ));
}

TEST_F(LineExchange, aGatewaysExceptionIsATimeoutThatEndsItAtOnce)
{
  for (const char* exception : { "01 83 0A", "01 83 0B" })
  {
    answerNext(exception, 20);
    const Reply reply = ask(READ);
    EXPECT_EQ(Outcome::Timeout, reply.outcome);
    EXPECT_EQ(ERROR_TIMEOUT, reply.error_id);
    EXPECT_EQ(reply.sent_at + ms(20), reply.finished_at);
    EXPECT_TRUE(mayAsk(READ)) << "the gateway has answered: no reply is owed";
  }
  EXPECT_EQ("RERE", seen());
  EXPECT_EQ(2u, line_.counters().timeouts);
  EXPECT_EQ(0u, line_.counters().replies) << "the drive has not answered";
  EXPECT_EQ(0u, line_.counters().exceptions);
}

TEST_F(LineExchange, silenceIsATimeoutAfterTheComputedTime)
{
  Request request = requestOf(withCrc(READ));
  request.reply_delay = milliseconds(7);
  request.response_timeout = milliseconds(50);
  const Reply reply = line_.exchange(request);
  EXPECT_EQ(Outcome::Timeout, reply.outcome);
  EXPECT_EQ(ERROR_TIMEOUT, reply.error_id);
  EXPECT_EQ(timing_.characters(8) + timing_.gap(3.5) + milliseconds(57), reply.finished_at - reply.sent_at);
  EXPECT_EQ(1u, line_.counters().timeouts);
  EXPECT_EQ(0u, line_.counters().corrupt_replies);
  EXPECT_EQ("R", seen());
}

TEST_F(LineExchange, aSlowPortIsWaitedForFromItsReturn)
{
  class SlowPort : public FakePort
  {
  public:
    explicit SlowPort(VirtualClock& clock) : FakePort(clock), clock_(clock)
    {
    }

    bool send(const Bytes& frame) override
    {
      clock_.advance(milliseconds(30));
      return FakePort::send(frame);
    }

  private:
    VirtualClock& clock_;
  } port(clock_);
  Line line(port, *protocol_, clock_, timing_);
  std::string error;
  line.open(error);
  const Reply reply = line.exchange(requestOf(withCrc(READ)));
  EXPECT_EQ(milliseconds(130) + timing_.gap(3.5), reply.finished_at - reply.sent_at);
}

TEST_F(LineExchange, aReplyInPiecesIsPutTogether)
{
  // As a USB adapter delivers it: whatever has come every 16 ms.
  const Bytes reply = withCrc(REPLY);
  port_.answerNext({ { ms(90), Bytes(reply.begin(), reply.begin() + 1) },
                     { ms(106), Bytes(reply.begin() + 1, reply.begin() + 8) },
                     { ms(122), Bytes(reply.begin() + 8, reply.end()) } });
  EXPECT_EQ(Outcome::Ok, ask(READ).outcome);
  EXPECT_EQ(1u, line_.counters().replies);
}

TEST_F(LineExchange, aReplyThatBreaksOffIsDamagedSoonAfter)
{
  const Bytes reply = withCrc(REPLY);
  answerNextRaw(Bytes(reply.begin(), reply.begin() + 5), 20);
  const Reply result = ask(READ);
  EXPECT_EQ(Outcome::Damaged, result.outcome);
  EXPECT_EQ(ERROR_DAMAGED, result.error_id);
  EXPECT_EQ(milliseconds(45), std::chrono::round<milliseconds>(result.finished_at - result.sent_at));
  EXPECT_EQ(1u, line_.counters().corrupt_replies);
  EXPECT_EQ(0u, line_.counters().timeouts);
  EXPECT_EQ("RD", seen());
  EXPECT_EQ(Bytes(reply.begin(), reply.begin() + 5), events_.at(1).bytes);
}

TEST_F(LineExchange, aReplyWithAWrongChecksumIsDamagedSoonAfter)
{
  Bytes reply = withCrc(REPLY);
  reply[4] ^= 1;
  answerNextRaw(reply, 20);
  const Reply result = ask(READ);
  EXPECT_EQ(Outcome::Damaged, result.outcome);
  EXPECT_LT(result.finished_at - result.sent_at, milliseconds(50));
  EXPECT_EQ(reply, events_.at(1).bytes);
}

TEST_F(LineExchange, noiseLongBeforeTheReplyDoesNotLoseIt)
{
  for (const Bytes& noise : { hex("00"), hex("FF 00"), hex("05"), hex("01"), hex("01 10"), hex("05 03 20") })
  {
    port_.answerNext({ { ms(5), noise }, { ms(80), withCrc(REPLY) } });
    const Reply reply = ask(READ);
    EXPECT_EQ(Outcome::Ok, reply.outcome);
    EXPECT_EQ(noise, events_.at(events_.size() - 2).bytes);
  }
  EXPECT_EQ("RDARDARDARDARDARDA", seen());
  EXPECT_EQ(0u, line_.counters().corrupt_replies);
}

TEST_F(LineExchange, noiseAloneIsDamagedAtTheDeadline)
{
  answerNextRaw(hex("00"), 20);
  const Reply reply = ask(READ);
  EXPECT_EQ(Outcome::Damaged, reply.outcome);
  EXPECT_EQ(timing_.characters(8) + timing_.gap(3.5) + milliseconds(100), reply.finished_at - reply.sent_at);
}

TEST_F(LineExchange, waitingIsBoundedUnderBabble)
{
  FakePort::Answers babble;
  for (int i = 1; i < 1000; ++i)
  {
    babble.push_back({ milliseconds(i), hex("01 03") });
  }
  port_.answerNext(babble);
  const Reply reply = ask(READ);
  EXPECT_EQ(Outcome::Damaged, reply.outcome);
  EXPECT_LE(reply.finished_at - reply.sent_at, timing_.characters(8 + 3.5 + 9 + 16) + milliseconds(131));
}

/// A port that never falls silent, be it only for a moment.
class BabblingPort : public FakePort
{
public:
  explicit BabblingPort(VirtualClock& clock) : FakePort(clock), clock_(clock)
  {
  }

  ReceiveResult receive(Bytes& buffer, TimePoint) override
  {
    clock_.advance(std::chrono::microseconds(100));
    buffer.push_back(0x55);
    return ReceiveResult::Data;
  }

private:
  VirtualClock& clock_;
};

TEST_F(LineExchange, endlessBabbleStopsNothing)
{
  BabblingPort port(clock_);
  Line line(port, *protocol_, clock_, timing_);
  std::string error;
  line.open(error);
  startWatch();
  EXPECT_TRUE(line.settle());
  EXPECT_EQ(Outcome::Damaged, line.exchange(requestOf(withCrc(READ))).outcome);
  EXPECT_LT(elapsed(), milliseconds(300));
}

TEST_F(LineExchange, aForeignFrameIsCountedAndTheReplyStillTaken)
{
  port_.answerNext({ { ms(8), withCrc("02 03 02 00 00") }, { ms(30), withCrc(REPLY) } });
  const Reply reply = ask(READ);
  EXPECT_EQ(Outcome::Ok, reply.outcome);
  EXPECT_EQ("RFA", seen());
  EXPECT_EQ(1u, line_.counters().foreign_frames);
  EXPECT_EQ(ms(30) - timing_.characters(8 + 9), reply.turnaround);
}

TEST_F(LineExchange, aForeignFrameAloneIsNoReply)
{
  answerNext("02 03 04 12 34 56 78");
  EXPECT_EQ(Outcome::Damaged, ask(READ).outcome);
  EXPECT_EQ("RF", seen());
  EXPECT_EQ(1u, line_.counters().foreign_frames);
  EXPECT_EQ(1u, line_.counters().corrupt_replies);
}

TEST_F(LineExchange, aSecondMastersRequestIsForeign)
{
  answerNext("02 06 00 01 00 00");
  EXPECT_EQ(Outcome::Damaged, ask(READ).outcome);
  EXPECT_EQ(1u, line_.counters().foreign_frames);
}

TEST_F(LineExchange, aReplyOfAnotherLengthIsForeign)
{
  answerNext(OTHER_REPLY);
  EXPECT_EQ(Outcome::Damaged, ask(READ).outcome);
  EXPECT_EQ(1u, line_.counters().foreign_frames);
}

TEST_F(LineExchange, aBroadcastIsOverWhenItIsSentAndLeavesTheLineFree)
{
  const Request request = requestOf(withCrc("00 06 FA 00 C0 00"));
  const Reply reply = line_.exchange(request, milliseconds(20));
  const TimePoint request_end = reply.sent_at + timing_.characters(8);
  EXPECT_EQ(Outcome::Ok, reply.outcome);
  EXPECT_EQ(request_end + milliseconds(20), line_.readyAt());
  EXPECT_EQ(request_end + timing_.gap(3.5), clock_.now());
  EXPECT_TRUE(line_.settle());
  EXPECT_EQ(request_end + milliseconds(20), clock_.now());
  EXPECT_TRUE(line_.mayAsk(request));
  EXPECT_EQ(0u, line_.counters().timeouts);
}

TEST_F(LineExchange, aBroadcastKeepsTheGapAtLeast)
{
  const Reply reply = line_.exchange(requestOf(withCrc("00 06 FA 00 C0 00")), Duration::zero());
  EXPECT_EQ(reply.sent_at + timing_.characters(8) + timing_.gap(3.5), line_.readyAt());
}

class LineQuietBefore : public LineFixture
{
protected:
  LineQuietBefore()
  {
    request_.quiet_before = milliseconds(7);
  }

  Request request_ = requestOf(withCrc(READ));
};

TEST_F(LineQuietBefore, countsFromTheLastByteReceived)
{
  answerNext(REPLY);
  const Reply first = ask(READ);
  EXPECT_TRUE(line_.settle());
  EXPECT_EQ(first.finished_at + milliseconds(7), line_.exchange(request_).sent_at);
}

TEST_F(LineQuietBefore, aPortThatIsGoneMeanwhileEndsAnExchangeThatHasTakenNoTime)
{
  answerNext(REPLY);
  ask(READ);
  EXPECT_TRUE(line_.settle());
  const TimePoint begun = clock_.now();
  port_.unplug();
  const Reply reply = line_.exchange(request_);
  EXPECT_EQ(Outcome::PortLost, reply.outcome);
  EXPECT_EQ(begun, reply.sent_at);
  EXPECT_EQ(0U, reply.ticket) << "nothing was sent";
}

TEST_F(LineQuietBefore, countsFromTheLastByteSent)
{
  const Reply first = line_.exchange(requestOf(withCrc("00 06 FA 00 C0 00")));
  EXPECT_EQ(first.sent_at + timing_.characters(8) + milliseconds(7), line_.exchange(request_).sent_at);
}

TEST_F(LineQuietBefore, countsFromTheOpening)
{
  EXPECT_EQ(start_ + milliseconds(7), line_.exchange(request_).sent_at);
}

TEST_F(LineQuietBefore, isLongOverOnAQuietLine)
{
  clock_.advance(milliseconds(20));
  const TimePoint now = clock_.now();
  EXPECT_EQ(now, line_.exchange(request_).sent_at);
}

TEST_F(LineQuietBefore, neverShortensTheGapOrTheTurnaround)
{
  request_.quiet_before = std::chrono::microseconds(10);
  const Reply first = line_.exchange(requestOf(withCrc("00 06 FA 00 C0 00")), milliseconds(20));
  EXPECT_EQ(first.sent_at + timing_.characters(8) + milliseconds(20), line_.exchange(request_).sent_at);
}

TEST_F(LineQuietBefore, beginsAnewWithWhatArrivesMeanwhile)
{
  answerNext(REPLY);
  ask(READ);
  port_.deliver(milliseconds(6), withCrc("02 03 02 00 00"));
  const TimePoint foreign_at = clock_.now() + milliseconds(6);
  EXPECT_EQ(foreign_at + milliseconds(7), line_.exchange(request_).sent_at);
  EXPECT_EQ("RAFR", seen());
}

TEST_F(LineQuietBefore, isBoundedUnderBabble)
{
  for (int i = 0; i < 500; ++i)
  {
    port_.deliver(milliseconds(i), hex("55"));
  }
  EXPECT_LE(line_.exchange(request_).sent_at - start_, milliseconds(107));
}

TEST_F(LineQuietBefore, noticesThatThePortIsGone)
{
  port_.unplug();
  EXPECT_EQ(Outcome::PortLost, line_.exchange(request_).outcome);
  EXPECT_EQ(0u, line_.counters().requests);
}

TEST_F(LineQuietBefore, isPartOfTheCost)
{
  const Duration rest = timing_.characters(8) + timing_.gap(3.5);
  EXPECT_EQ(milliseconds(7) + rest + milliseconds(5) + timing_.characters(9), line_.cost(request_, milliseconds(5)));
  EXPECT_EQ(milliseconds(7) + rest + milliseconds(100), line_.costUnanswered(request_));
  request_.quiet_before = std::chrono::microseconds(10);
  EXPECT_EQ(timing_.gap(3.5) + rest + milliseconds(100), line_.costUnanswered(request_)) << "the gap is longer";
}

class LineSilentRequest : public LineFixture
{
protected:
  Reply reset()
  {
    Request request = requestOf(withCrc("01 06 FA 00 E0 00"));
    request.expects_reply = false;
    EXPECT_TRUE(line_.settle());
    return line_.exchange(request);
  }
};

TEST_F(LineSilentRequest, silenceIsItsNormalEnd)
{
  const Reply reply = reset();
  EXPECT_EQ(Outcome::Ok, reply.outcome);
  EXPECT_EQ(timing_.characters(8) + timing_.gap(3.5), reply.finished_at - reply.sent_at);
  EXPECT_EQ(0u, line_.counters().timeouts);
  EXPECT_TRUE(mayAsk("01 06 FA 00 E0 00"));
}

TEST_F(LineSilentRequest, aReplyAfterwardsIsNotForeign)
{
  answerNext("01 06 FA 00 E0 00", 12);
  EXPECT_EQ(Outcome::Ok, reset().outcome);
  clock_.advance(milliseconds(20));
  EXPECT_TRUE(line_.settle());
  EXPECT_EQ("RA", seen());
  EXPECT_EQ(0u, line_.counters().foreign_frames);
}

TEST_F(LineSilentRequest, aRefusalAfterwardsIsNotForeign)
{
  answerNext("01 86 04", 12);
  reset();
  clock_.advance(milliseconds(20));
  EXPECT_TRUE(line_.settle());
  EXPECT_EQ("RE", seen());
  EXPECT_EQ(1u, line_.counters().exceptions);
  EXPECT_EQ(0u, line_.counters().foreign_frames);
}

TEST_F(LineSilentRequest, aReplyInTimeIsTaken)
{
  answerNext("01 86 04", 5);
  EXPECT_EQ(Outcome::Exception, reset().outcome);
}

class LinePortLost : public LineFixture
{
};

TEST_F(LinePortLost, aClosedPortSendsNothing)
{
  line_.close();
  EXPECT_FALSE(line_.isOpen());
  EXPECT_FALSE(line_.settle());
  const Reply reply = line_.exchange(requestOf(withCrc(READ)));
  EXPECT_EQ(Outcome::PortLost, reply.outcome);
  EXPECT_EQ(ERROR_PORT_LOST, reply.error_id);
  EXPECT_EQ(0u, line_.counters().requests);
}

TEST_F(LinePortLost, aPortThatGoesInSendingIsLost)
{
  port_.unplug();
  EXPECT_EQ(Outcome::PortLost, line_.exchange(requestOf(withCrc(READ))).outcome);
  EXPECT_FALSE(line_.isOpen());
}

TEST_F(LinePortLost, aPortThatGoesInSettlingIsLost)
{
  port_.unplug();
  EXPECT_FALSE(line_.settle());
  EXPECT_FALSE(line_.isOpen());
}

TEST_F(LinePortLost, aPortThatGoesInWaitingIsLost)
{
  class CutPort : public FakePort
  {
  public:
    using FakePort::FakePort;
    ReceiveResult receive(Bytes&, TimePoint) override
    {
      return ReceiveResult::Gone;
    }
  } port(clock_);
  Line line(port, *protocol_, clock_, timing_);
  std::string error;
  line.open(error);
  EXPECT_EQ(Outcome::PortLost, line.exchange(requestOf(withCrc(READ))).outcome);
  EXPECT_EQ(1u, line.counters().requests);
  EXPECT_EQ(0u, line.counters().timeouts);
}

TEST_F(LinePortLost, openingAgainForgetsWhatWas)
{
  ask(READ);
  EXPECT_FALSE(mayAsk(READ));
  port_.unplug();
  std::string error;
  EXPECT_EQ(OpenResult::NotThere, line_.open(error));
  EXPECT_EQ("unplugged", error);
  port_.plugIn();
  EXPECT_EQ(OpenResult::Opened, line_.open(error));
  EXPECT_TRUE(mayAsk(READ));
  EXPECT_GT(line_.readyAt(), clock_.now());
}

class LineCost : public LineFixture
{
};

TEST_F(LineCost, anAnsweredExchangeCostsGapsAndCharacters)
{
  const Request request = requestOf(withCrc(READ));
  EXPECT_EQ(timing_.gap(3.5) + timing_.characters(8) + timing_.gap(3.5) + milliseconds(5) + timing_.characters(9),
            line_.cost(request, milliseconds(5)));
}

TEST_F(LineCost, anUnansweredExchangeCostsItsTimeout)
{
  Request request = requestOf(withCrc(READ));
  request.reply_delay = milliseconds(3);
  request.response_timeout = milliseconds(200);
  EXPECT_EQ(timing_.gap(3.5) + timing_.characters(8) + timing_.gap(3.5) + milliseconds(203),
            line_.costUnanswered(request));
}

TEST_F(LineCost, aBroadcastCostsItsOwnTimeOnly)
{
  const Request request = requestOf(withCrc("00 06 FA 00 C0 00"));
  EXPECT_EQ(timing_.gap(3.5) + timing_.characters(8), line_.cost(request, milliseconds(5)));
  EXPECT_EQ(timing_.gap(3.5) + timing_.characters(8), line_.costUnanswered(request));
}

TEST_F(LineCost, whatIsRealisedIsWhatWasComputed)
{
  const Request request = requestOf(withCrc(READ));
  const Duration drive_delay = milliseconds(5);
  const Duration answered = timing_.characters(8) + timing_.gap(3.5) + drive_delay + timing_.characters(9);
  port_.answerNext({ { answered, withCrc(REPLY) } });
  ask(READ);
  line_.settle();
  startWatch();
  port_.answerNext({ { answered, withCrc(REPLY) } });
  ask(READ);
  line_.settle();
  EXPECT_EQ(line_.cost(request, drive_delay), elapsed());
}
}  // namespace
}  // namespace wire
}  // namespace inverter_bus
