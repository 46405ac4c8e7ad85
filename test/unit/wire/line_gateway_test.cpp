// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include <tuple>

#include "support/line_fixture.h"

namespace inverter_bus
{
namespace wire
{
namespace
{
using std::chrono::milliseconds;
using std::chrono::seconds;

/// A Modbus TCP gateway that numbers its replies and names units in its own way.
class GatewayFixture : public LineFixture
{
protected:
  enum class Number
  {
    Kept,
    Zero,
    PlusOne,
    Swapped
  };

  GatewayFixture() : LineFixture(makeModbusTcp())
  {
  }

  Bytes frameOf(unsigned asked, int unit, const std::string& pdu) const
  {
    const unsigned swapped = (asked >> 8U | asked << 8U) & 0xFFFFU;
    const unsigned number = number_ == Number::Kept      ? asked
                            : number_ == Number::Zero    ? 0
                            : number_ == Number::Swapped ? swapped
                                                         : (asked + 1) & 0xFFFFU;
    const Bytes body = hex(pdu);
    Bytes frame{ static_cast<std::uint8_t>(number >> 8U),
                 static_cast<std::uint8_t>(number),
                 0,
                 0,
                 0,
                 static_cast<std::uint8_t>(1 + body.size()),
                 static_cast<std::uint8_t>(unit_ < 0 ? unit : unit_) };
    return frame + body;
  }

  /// The number of the next request.
  unsigned next() const
  {
    return static_cast<unsigned>(line_.counters().requests) + 1;
  }

  /// The answer to the next request.
  void willAnswer(int unit, const std::string& pdu, double after_ms = 30)
  {
    port_.answerNext({ { ms(after_ms), frameOf(next(), unit, pdu) } });
  }

  Reply good(const std::string& request, const std::string& pdu)
  {
    willAnswer(hex(request)[0], pdu);
    return ask(request);
  }

  void earnTrust()
  {
    for (int i = 0; i < 3; ++i)
    {
      ASSERT_FALSE(line_.gatewayTrusted());
      ASSERT_EQ(Outcome::Ok, good(READ, "03 04 00 00 00 00").outcome);
    }
    ASSERT_TRUE(line_.gatewayTrusted());
  }

  void reopen()
  {
    std::string error;
    line_.abandon();
    ASSERT_EQ(OpenResult::Opened, line_.open(error));
  }

  Number number_ = Number::Kept;
  /// -1: that of the request.
  int unit_ = -1;
};

class OddGateway : public GatewayFixture, public testing::WithParamInterface<std::tuple<int, int>>
{
protected:
  OddGateway()
  {
    number_ = static_cast<Number>(std::get<0>(GetParam()));
    unit_ = std::get<1>(GetParam());
  }

  bool odd() const
  {
    return number_ != Number::Kept || unit_ >= 0;
  }

  const std::string READ_5 = "05 03 00 00 00 02";
  const std::string OTHER_5 = "05 03 00 00 00 01";
};

TEST_P(OddGateway, isUsedAndNamed)
{
  EXPECT_EQ("", line_.gatewayQuirk());
  for (int i = 0; i < 4; ++i)
  {
    const Reply reply = good(READ_5, "03 04 12 34 56 78");
    ASSERT_EQ(Outcome::Ok, reply.outcome);
    ASSERT_EQ(hex("03 04 12 34 56 78"), reply.pdu);
  }
  EXPECT_EQ(Outcome::Ok, good("05 06 00 01 13 88", "06 00 01 13 88").outcome);
  EXPECT_EQ(0x8302, good(READ_5, "83 02").error_id);
  EXPECT_EQ(0u, line_.counters().foreign_frames);
  EXPECT_EQ(!odd(), line_.gatewayTrusted());
  EXPECT_EQ(!odd(), line_.gatewayQuirk().empty());
  EXPECT_EQ(number_ != Number::Kept, line_.gatewayQuirk().find("transaction number") != std::string::npos);
  EXPECT_EQ(unit_ >= 0, line_.gatewayQuirk().find("unit " + std::to_string(unit_)) != std::string::npos);
  EXPECT_EQ("", line_.mustReopen());
}

TEST_P(OddGateway, neverAnswersWithTheReplyToTheRequestBefore)
{
  // As seen in the field: the first answer comes after its time-out, all others one request late.
  willAnswer(5, "03 04 00 00 00 01", 150);
  EXPECT_EQ(Outcome::Timeout, ask(READ_5).outcome);
  const std::uint64_t lost = line_.outstanding().at(0).ticket;
  willAnswer(5, "03 04 00 00 00 02", 150);
  const Reply reply = ask(READ_5);
  EXPECT_NE(Outcome::Ok, reply.outcome) << "its answer has not come yet";
  const std::vector<LateReply> late = line_.takeLateReplies();
  ASSERT_EQ(1u, late.size());
  EXPECT_EQ(lost, late[0].ticket);
  EXPECT_EQ(5, late[0].station);
  ASSERT_EQ(1u, line_.outstanding().size());
  EXPECT_EQ(reply.ticket, line_.outstanding()[0].ticket);
}

TEST_P(OddGateway, aLateReplyAloneIsKnownByItsRequest)
{
  willAnswer(5, "83 02", 150);
  const Reply reply = ask(READ_5);
  clock_.advance(milliseconds(40));
  ASSERT_TRUE(line_.settle());
  const std::vector<LateReply> late = line_.takeLateReplies();
  ASSERT_EQ(1u, late.size());
  EXPECT_EQ(reply.ticket, late[0].ticket);
  EXPECT_TRUE(late[0].exception);
  EXPECT_EQ(5, late[0].station);
  EXPECT_TRUE(line_.outstanding().empty());
  EXPECT_TRUE(mayAsk(READ_5));
  EXPECT_EQ(0u, line_.counters().foreign_frames);
}

TEST_P(OddGateway, aLostRequestBarsItsShapeUntilTheConnectionIsNew)
{
  good(READ_5, "03 04 00 00 00 00");
  if (!odd())
  {
    good(READ_5, "03 04 00 00 00 00");
    good(READ_5, "03 04 00 00 00 00");
  }
  EXPECT_EQ(Outcome::Timeout, ask(READ_5).outcome);
  EXPECT_EQ(!odd(), mayAsk(READ_5));
  EXPECT_EQ(!odd(), mayAsk("07 03 00 00 00 02")) << "the station does not tell";
  EXPECT_TRUE(mayAsk(OTHER_5));
  EXPECT_EQ("", line_.mustReopen());
  clock_.advance(milliseconds(3100));
  EXPECT_EQ(!odd(), mayAsk(READ_5)) << "no end to it";
  EXPECT_EQ(odd(), !line_.mustReopen().empty()) << line_.mustReopen();
  reopen();
  EXPECT_EQ("", line_.mustReopen());
  EXPECT_TRUE(mayAsk(READ_5));
  EXPECT_TRUE(line_.outstanding().empty());
  EXPECT_EQ(!odd(), line_.gatewayQuirk().empty()) << "what was seen stays true";
}

TEST_P(OddGateway, aReplyToAnotherShapeAskedLaterEndsTheBar)
{
  good(READ_5, "03 04 00 00 00 00");
  ask(READ_5);
  EXPECT_EQ(Outcome::Ok, good(OTHER_5, "03 02 00 00").outcome);
  EXPECT_TRUE(mayAsk(READ_5));
  EXPECT_TRUE(line_.outstanding().empty());
}

TEST_P(OddGateway, aStopThatIsRepeatedIsNotConfirmedByTheAnswerToTheFirst)
{
  const std::string STOP = "05 06 00 01 00 00";
  good(READ_5, "03 04 00 00 00 00");
  ask(STOP);
  // Exempt from bars. Both are answered now, in order.
  const unsigned first = next() - 1;
  port_.answerNext(
      { { ms(20), frameOf(first, 5, "06 00 01 00 00") }, { ms(60), frameOf(first + 1, 5, "06 00 01 00 00") } });
  const Reply reply = ask(STOP);
  if (odd())
  {
    EXPECT_EQ(Outcome::Timeout, reply.outcome);
    return;
  }
  EXPECT_EQ(Outcome::Ok, reply.outcome);
  EXPECT_EQ(reply.sent_at + ms(60), reply.finished_at);
}

TEST_P(OddGateway, mayAnswerABroadcast)
{
  good(READ_5, "03 04 00 00 00 00");
  const unsigned number = next();
  port_.answerNext({ { ms(60), frameOf(number, 0, "06 00 01 00 00") } });
  EXPECT_EQ(Outcome::Ok, line_.exchange(requestOf(withCrc("00 06 00 01 00 00")), milliseconds(20)).outcome);
  // The same write to one drive: the broadcast's answer, which comes first, is not its own.
  port_.answerNext({ { ms(80), frameOf(number + 1, 5, "06 00 01 00 00") } });
  const Reply reply = ask("05 06 00 01 00 00");
  EXPECT_TRUE(reply.outcome != Outcome::Ok || reply.finished_at == reply.sent_at + ms(80));
  EXPECT_EQ(0u, line_.counters().foreign_frames);
  EXPECT_EQ(0u, line_.counters().echoes);
  EXPECT_TRUE(line_.takeLateReplies().empty() || reply.outcome != Outcome::Ok);
}

TEST_P(OddGateway, repliesInPiecesArePutTogether)
{
  const Bytes frame = frameOf(next(), 5, "03 04 12 34 56 78");
  port_.answerNext({ { ms(30), Bytes(frame.begin(), frame.begin() + 7) },
                     { ms(45), Bytes(frame.begin() + 7, frame.begin() + 8) },
                     { ms(60), Bytes(frame.begin() + 8, frame.end()) } });
  EXPECT_EQ(hex("03 04 12 34 56 78"), ask(READ_5).pdu);
}

INSTANTIATE_TEST_SUITE_P(habits, OddGateway, testing::Combine(testing::Range(0, 4), testing::Values(-1, 0, 1, 255)));

class GatewayLine : public GatewayFixture
{
};

TEST_F(GatewayLine, trustNeedsThreeRepliesWithNothingElseOwed)
{
  ask(OTHER_READ);
  clock_.advance(seconds(1));
  EXPECT_EQ(Outcome::Ok, good(READ, "03 04 00 00 00 00").outcome);
  EXPECT_TRUE(line_.outstanding().empty()) << "the gateway has passed on to a later request";
  EXPECT_FALSE(line_.gatewayTrusted());
  good(READ, "03 04 00 00 00 00");
  good(READ, "03 04 00 00 00 00");
  EXPECT_FALSE(line_.gatewayTrusted());
  good(READ, "03 04 00 00 00 00");
  EXPECT_TRUE(line_.gatewayTrusted());
  reopen();
  EXPECT_FALSE(line_.gatewayTrusted());
}

TEST_F(GatewayLine, anAnswerThatTwoRequestsCouldHaveGotIsTakenByNone)
{
  ask(READ);
  EXPECT_FALSE(mayAsk(READ));
  EXPECT_TRUE(mayAsk(OTHER_READ));
  clock_.advance(milliseconds(1200));
  EXPECT_TRUE(mayAsk(READ)) << "nothing is known against the gateway";
  EXPECT_NE(Outcome::Ok, good(READ, "03 04 00 00 00 02").outcome) << "it may add 1 and answer the first one";
  EXPECT_NE("", line_.mustReopen());
  reopen();
  EXPECT_EQ(Outcome::Ok, good(READ, "03 04 00 00 00 02").outcome);
  EXPECT_EQ("", line_.mustReopen());
}

TEST_F(GatewayLine, aTrustedNumberTellsWhateverTheUnit)
{
  earnTrust();
  unit_ = 0;
  EXPECT_EQ(0x8302, good(READ, "83 02").error_id) << "only exceptions bear unit 0";
  EXPECT_NE(std::string::npos, line_.gatewayQuirk().find("unit 0"));
  EXPECT_TRUE(line_.gatewayTrusted());
}

TEST_F(GatewayLine, aTrustedConnectionTakesNoReplyUnderAnotherNumber)
{
  for (const Number number : { Number::Zero, Number::PlusOne, Number::Swapped })
  {
    reopen();
    number_ = Number::Kept;
    earnTrust();
    number_ = number;
    EXPECT_NE(Outcome::Ok, good(READ, "03 04 00 00 00 00").outcome) << static_cast<int>(number);
    EXPECT_TRUE(line_.gatewayTrusted());
    EXPECT_EQ("", line_.gatewayQuirk());
    number_ = Number::Kept;
    EXPECT_EQ(Outcome::Ok, good(READ, "03 04 00 00 00 01").outcome) << "the next one is taken as before";
  }
}

TEST_F(GatewayLine, whatIsOutstandingIsKnownUntilItIsAnswered)
{
  earnTrust();
  willAnswer(1, "03 04 00 00 00 00", 250);
  const Reply lost = ask(READ);
  willAnswer(2, "83 0B", 30);
  const Reply refused = ask("02 03 00 00 00 02");
  EXPECT_EQ(0x0B, refused.gateway_code);
  ASSERT_EQ(1u, line_.outstanding().size()) << "the gateway has done with the second one";
  EXPECT_EQ(lost.ticket, line_.outstanding()[0].ticket);
  EXPECT_EQ(1, line_.outstanding()[0].station);
  EXPECT_EQ(lost.sent_at, line_.outstanding()[0].sent_at);
  clock_.advance(milliseconds(200));
  line_.settle();
  EXPECT_TRUE(line_.outstanding().empty());
  const std::vector<LateReply> late = line_.takeLateReplies();
  ASSERT_EQ(1u, late.size());
  EXPECT_EQ(lost.ticket, late[0].ticket);
}

TEST_F(GatewayLine, exceptionsThatAreNotTheDrivesAreTimeoutsWithTheirCode)
{
  earnTrust();
  Request request = requestOf(withCrc(READ));
  request.own_exceptions = ExceptionCodes().set(1).set(2).set(3);
  for (const int code : { 0x04, 0x06, 0x0A, 0x0B, 0x43, 0xE0, 0xFF })
  {
    std::ostringstream pdu;
    pdu << "83 " << std::hex << code;
    willAnswer(1, pdu.str());
    ASSERT_TRUE(line_.settle());
    const Reply reply = line_.exchange(request);
    EXPECT_EQ(Outcome::Timeout, reply.outcome);
    EXPECT_EQ(ERROR_TIMEOUT, reply.error_id);
    EXPECT_EQ(code, reply.gateway_code);
    EXPECT_EQ(reply.sent_at + milliseconds(30), reply.finished_at) << "at once";
    EXPECT_TRUE(mayAsk(READ));
    EXPECT_TRUE(line_.outstanding().empty());
  }
  EXPECT_EQ(7u, line_.counters().timeouts);
  EXPECT_EQ(0u, line_.counters().exceptions);
  willAnswer(1, "83 02");
  const Reply own = line_.exchange(request);
  EXPECT_EQ(Outcome::Exception, own.outcome);
  EXPECT_EQ(0, own.gateway_code);
  EXPECT_EQ(0x8302, own.error_id);
}

TEST_F(GatewayLine, anExceptionWithALengthOffByOneIsToldAtOnceAndTheNextReplyIsWhole)
{
  for (const char* length : { "02", "04" })
  {
    Bytes frame = frameOf(next(), 1, "83 02");
    frame[5] = hex(length)[0];
    port_.answerNext({ { ms(30), frame } });
    const Reply reply = ask(READ);
    EXPECT_EQ(0x8302, reply.error_id) << length;
    EXPECT_EQ(reply.sent_at + milliseconds(30), reply.finished_at);
    EXPECT_EQ(Outcome::Ok, good(READ, "03 04 00 00 00 00").outcome);
  }
  EXPECT_EQ(0u, line_.counters().foreign_frames);
}

/// How long the next exchange has to wait behind what came with a reply.
class SurplusBytes : public GatewayFixture, public testing::WithParamInterface<const char*>
{
};

TEST_P(SurplusBytes, costNoPause)
{
  earnTrust();
  const Bytes reply = frameOf(next(), 1, "03 04 12 34 56 78");
  const Bytes surplus = GetParam()[0] == '=' ? reply : hex(GetParam());
  port_.answerNext({ { ms(30), reply + surplus } });
  EXPECT_EQ(Outcome::Ok, ask(READ).outcome);
  startWatch();
  EXPECT_TRUE(line_.settle());
  EXPECT_EQ(Duration(0), elapsed());
  EXPECT_EQ(Outcome::Ok, good(READ, "03 04 12 34 56 78").outcome);
  EXPECT_EQ(0u, line_.counters().foreign_frames);
}

INSTANTIATE_TEST_SUITE_P(kinds, SurplusBytes,
                         testing::Values("00", "00 00", "FF FF", "12 34", "A1 00", "00 00 00", "="));

TEST_F(GatewayLine, theRestOfALateReplyIsWaitedForWhileOneIsOwed)
{
  earnTrust();
  const Bytes late = frameOf(next(), 1, "03 04 12 34 56 78");
  port_.answerNext(
      { { ms(150), Bytes(late.begin(), late.begin() + 4) }, { ms(170), Bytes(late.begin() + 4, late.end()) } });
  EXPECT_EQ(Outcome::Timeout, ask(READ).outcome);
  clock_.advance(milliseconds(40));
  EXPECT_TRUE(line_.settle());
  EXPECT_EQ(1u, line_.counters().late_replies);
  EXPECT_EQ(0u, line_.counters().foreign_frames);
}

class SurplusOnTheWire : public LineFixture, public testing::WithParamInterface<const char*>
{
};

TEST_P(SurplusOnTheWire, costsOneGap)
{
  answerNextRaw(withCrc(REPLY) + hex(GetParam()));
  EXPECT_EQ(Outcome::Ok, ask(READ).outcome);
  startWatch();
  EXPECT_TRUE(line_.settle());
  EXPECT_LE(elapsed(), timing_.gap(3.5));
  answerNext(REPLY);
  EXPECT_EQ(Outcome::Ok, ask(READ).outcome);
}

INSTANTIATE_TEST_SUITE_P(kinds, SurplusOnTheWire,
                         testing::Values("00", "00 00", "01 03", "01 03 04 00", "00 00 00", "FF FF"));
}  // namespace
}  // namespace wire
}  // namespace inverter_bus
