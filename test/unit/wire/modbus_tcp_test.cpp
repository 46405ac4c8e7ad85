// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include <gtest/gtest.h>

#include <ostream>
#include <random>

#include "inverter_bus/wire/protocol.h"
#include "support/line_fixture.h"
#include "support/wire_frames.h"

namespace inverter_bus
{
namespace wire
{
namespace
{
using Kind = Parsed::Kind;
using std::chrono::milliseconds;

class ModbusTcpTest : public testing::Test
{
protected:
  Parsed parse(const Bytes& bytes, const Request* request = nullptr) const
  {
    return protocol_->parse(bytes.data(), bytes.size(), request);
  }

  const std::unique_ptr<Protocol> protocol_ = makeModbusTcp();
  const Request read_ = requestOf(withCrc("01 03 00 00 00 02"));
};

TEST_F(ModbusTcpTest, aRequestIsItsPduBehindAHeaderWithARunningNumber)
{
  EXPECT_EQ(hex("00 01 00 00 00 06 01 03 00 00 00 02"), protocol_->frame(read_));
  EXPECT_EQ(hex("00 02 00 00 00 06 1F 06 FA 01 17 70"), protocol_->frame(requestOf(withCrc("1F 06 FA 01 17 70"))));
  EXPECT_EQ(hex("00 03 00 00 00 0B 01 10 00 00 00 02 04 00 01 17 70"),
            protocol_->frame(requestOf(withCrc("01 10 00 00 00 02 04 00 01 17 70"))));
}

TEST_F(ModbusTcpTest, theNumberStartsAgainBehindItsLast)
{
  Bytes frame;
  for (int i = 0; i < 0x10000 + 0x1234; ++i)
  {
    frame = protocol_->frame(read_);
  }
  EXPECT_EQ(hex("12 35 00 00 00 06 01 03 00 00 00 02"), frame) << "0 is left out";
  EXPECT_EQ(Kind::Reply, parse(hex("12 35 00 00 00 07 01 03 04 00 00 00 00"), &read_).kind);
}

TEST_F(ModbusTcpTest, aBroadcastGoesToUnitZero)
{
  Request request = requestOf(withCrc("05 06 FA 00 C0 00"));
  request.broadcast = true;
  EXPECT_EQ(hex("00 01 00 00 00 06 00 06 FA 00 C0 00"), protocol_->frame(request));
  EXPECT_EQ(0u, protocol_->replyLength(request));
  EXPECT_EQ(Kind::Late, parse(hex("00 01 00 00 00 06 00 06 FA 00 C0 00"), &request).kind)
      << "a gateway that answers it all the same is no second master";
}

TEST_F(ModbusTcpTest, lengthsAreThoseOfTheSerialLineBehind)
{
  EXPECT_EQ(8u, protocol_->requestLength(read_));
  EXPECT_EQ(9u, protocol_->replyLength(read_));
  EXPECT_EQ(0.0, protocol_->gapCharacters());
  EXPECT_EQ(10.5, protocol_->gatewayGapCharacters());
  EXPECT_FALSE(protocol_->isLoopback(requestOf(withCrc("01 08 00 00 12 34")))) << "needless here";
}

struct Answer
{
  const char* what;
  /// With CRC left out, as for Modbus RTU.
  const char* request;
  const char* reply;
  Kind kind;
  int error_id;
};

std::ostream& operator<<(std::ostream& stream, const Answer& answer)
{
  return stream << answer.what;
}

const Answer ANSWERS[] = {
  { "read", "01 03 00 00 00 02", "00 01 00 00 00 07 01 03 04 12 34 56 78", Kind::Reply, 0 },
  { "read of coils", "01 01 00 0E 00 0B", "00 01 00 00 00 05 01 01 02 12 03", Kind::Reply, 0 },
  { "write", "01 06 FA 01 17 70", "00 01 00 00 00 06 01 06 FA 01 17 70", Kind::Reply, 0 },
  { "write of several", "01 10 00 00 00 02 04 00 01 17 70", "00 01 00 00 00 06 01 10 00 00 00 02", Kind::Reply, 0 },
  { "write and read", "01 17 10 00 00 02 00 00 00 02 04 00 00 13 88", "00 01 00 00 00 07 01 17 04 00 00 00 00",
    Kind::Reply, 0 },
  { "refusal", "01 03 00 00 00 02", "00 01 00 00 00 03 01 83 02", Kind::Exception, 0x8302 },
  { "gateway without path", "01 03 00 00 00 02", "00 01 00 00 00 03 01 83 0A", Kind::Exception, 0x0205 },
  { "gateway without answer", "01 03 00 00 00 02", "00 01 00 00 00 03 01 83 0B", Kind::Exception, 0x0205 },
  { "number of no request", "01 03 00 00 00 02", "00 09 00 00 00 07 01 03 04 12 34 56 78", Kind::Foreign, 0 },
  { "other unit", "01 03 00 00 00 02", "00 01 00 00 00 07 02 03 04 12 34 56 78", Kind::Foreign, 0 },
  { "other function", "01 03 00 00 00 02", "00 01 00 00 00 07 01 04 04 12 34 56 78", Kind::Foreign, 0 },
  { "fewer registers", "01 03 00 00 00 02", "00 01 00 00 00 05 01 03 02 12 34", Kind::Foreign, 0 },
  { "byte count against length", "01 03 00 00 00 02", "00 01 00 00 00 05 01 03 04 12 34", Kind::Foreign, 0 },
  { "longer than its byte count", "01 03 00 00 00 02", "00 01 00 00 00 08 01 03 04 12 34 56 78 9A", Kind::Foreign, 0 },
  { "other register", "01 06 FA 01 17 70", "00 01 00 00 00 06 01 06 FA 02 17 70", Kind::Foreign, 0 },
  { "other function's refusal", "01 03 00 00 00 02", "00 01 00 00 00 03 01 86 02", Kind::Foreign, 0x8602 },
};

class ModbusTcpAnswer : public ModbusTcpTest, public testing::WithParamInterface<Answer>
{
protected:
  ModbusTcpAnswer()
  {
    protocol_->frame(request_);
  }

  const Request request_ = requestOf(withCrc(GetParam().request));
  const Bytes reply_ = hex(GetParam().reply);
};

TEST_P(ModbusTcpAnswer, isToldByItsNumberAndItsContent)
{
  const Parsed parsed = parse(reply_, &request_);
  EXPECT_EQ(GetParam().kind, parsed.kind);
  EXPECT_EQ(reply_.size(), parsed.consumed);
  EXPECT_EQ(reply_[6], parsed.station);
  EXPECT_EQ(Bytes(reply_.begin() + 7, reply_.end()), parsed.pdu);
  EXPECT_EQ(GetParam().error_id, parsed.error_id);
}

TEST_P(ModbusTcpAnswer, isWaitedForUntilComplete)
{
  const bool own = GetParam().kind == Kind::Reply || GetParam().kind == Kind::Exception;
  for (std::size_t size = 0; size < reply_.size(); ++size)
  {
    const Parsed parsed = protocol_->parse(reply_.data(), size, &request_);
    EXPECT_EQ(Kind::Incomplete, parsed.kind) << size;
    EXPECT_EQ(0u, parsed.consumed) << size;
    EXPECT_TRUE(!own || parsed.own == (size >= 8)) << size;
  }
}

TEST_P(ModbusTcpAnswer, isLateToEveryLaterRequest)
{
  for (int i = 0; i < 9; ++i)
  {
    protocol_->frame(request_);
  }
  EXPECT_EQ(Kind::Late, parse(reply_, &request_).kind);
  EXPECT_EQ(Kind::Late, parse(reply_).kind);
}

INSTANTIATE_TEST_SUITE_P(fields, ModbusTcpAnswer, testing::ValuesIn(ANSWERS));

TEST_F(ModbusTcpTest, whatGatewaysMakeOfNumbersAndUnitsIsSeen)
{
  const Request request = requestOf(withCrc("05 03 00 00 00 02"));
  for (int i = 0; i < 0x0203; ++i)
  {
    protocol_->frame(request);
  }
  for (const char* number : { "02 03", "02 04", "00 00", "03 02" })
  {
    for (const char* unit : { "05", "00", "01", "FF" })
    {
      const std::string begin = number + std::string(" 00 00 00 07 ") + unit;
      const Parsed parsed = parse(hex(begin + " 03 04 12 34 56 78"), &request);
      EXPECT_EQ(Kind::Reply, parsed.kind) << begin;
      EXPECT_EQ(hex("03 04 12 34 56 78"), parsed.pdu);
      EXPECT_EQ(hex(unit)[0], parsed.station);
      EXPECT_NE(Kind::Reply, parse(hex(begin + " 04 04 12 34 56 78"), &request).kind) << "another function";
      EXPECT_EQ(Kind::Exception, parse(hex(number + std::string(" 00 00 00 03 ") + unit + " 83 02"), &request).kind);
    }
    EXPECT_NE(Kind::Reply, parse(hex(number + std::string(" 00 00 00 07 06 03 04 12 34 56 78")), &request).kind);
  }
  EXPECT_EQ(Kind::Foreign, parse(hex("02 05 00 00 00 07 05 03 04 12 34 56 78"), &request).kind);
  EXPECT_EQ(Kind::Late, parse(hex("02 02 00 00 00 07 05 03 04 12 34 56 78"), &request).kind);
}

TEST_F(ModbusTcpTest, theLengthOfAnExceptionMayBeOneOff)
{
  protocol_->frame(read_);
  for (const char* length : { "02", "03", "04" })
  {
    const std::string frame = std::string("00 01 00 00 00 ") + length + " 01 83 02";
    for (const char* behind : { "", " 00", " 00 02 00 00 00 07 01" })
    {
      const Parsed parsed = parse(hex(frame + behind), &read_);
      EXPECT_EQ(Kind::Exception, parsed.kind) << frame << behind;
      EXPECT_EQ(9u, parsed.consumed) << "nothing of the next frame";
      EXPECT_EQ(0x8302, parsed.error_id);
    }
    EXPECT_EQ(Kind::Incomplete, parse(hex(frame.substr(0, 23)), &read_).kind);
  }
  EXPECT_EQ(Kind::Foreign, parse(hex("00 01 00 00 00 05 01 83 02 00 00"), &read_).kind) << "two are too many";
  const Parsed bare = parse(hex("00 01 00 00 00 02 01 83 00 02 00 00 00 07 01 03"), &read_);
  EXPECT_EQ(Kind::Foreign, bare.kind) << "really without a code";
  EXPECT_EQ(8u, bare.consumed);
}

TEST_F(ModbusTcpTest, aNumberThatNoRecentRequestHadIsForeign)
{
  for (int i = 0; i < 2000; ++i)
  {
    protocol_->frame(read_);
  }
  EXPECT_EQ(Kind::Late, parse(hex("07 CF 00 00 00 03 01 83 0B"), &read_).kind) << "the request before";
  EXPECT_EQ(Kind::Foreign, parse(hex("07 D2 00 00 00 03 01 83 0B"), &read_).kind) << "one that is still to come";
  EXPECT_EQ(Kind::Foreign, parse(hex("00 01 00 00 00 03 01 83 0B"), &read_).kind) << "one of long ago";
}

TEST_F(ModbusTcpTest, whatIsNoHeaderIsSkipped)
{
  for (const char* bytes : { "00 01 01", "00 01 00 01", "00 01 00 00 01", "00 01 00 00 00 01", "00 01 00 00 00 FF" })
  {
    const Parsed parsed = parse(hex(bytes));
    EXPECT_EQ(Kind::Garbage, parsed.kind) << bytes;
    EXPECT_EQ(1u, parsed.consumed) << bytes;
  }
  EXPECT_EQ(Kind::Incomplete, parse(hex("00 01 00 00 00 FE")).kind) << "the longest PDU";
  EXPECT_EQ(Kind::Incomplete, parse(Bytes()).kind);
}

TEST_F(ModbusTcpTest, randomBytesAreConsumed)
{
  std::mt19937 random(1);
  std::uniform_int_distribution<int> any(0, 255);
  for (int round = 0; round < 200; ++round)
  {
    Bytes bytes(1500);
    for (std::uint8_t& byte : bytes)
    {
      byte = any(random) < 128 ? std::uint8_t{ 0 } : static_cast<std::uint8_t>(any(random));
    }
    while (bytes.size() >= 260)
    {
      const Parsed parsed = parse(bytes, &read_);
      ASSERT_NE(Kind::Incomplete, parsed.kind) << "no frame is longer than 260 bytes";
      ASSERT_GE(parsed.consumed, 1u);
      ASSERT_LE(parsed.consumed, 260u);
      bytes.erase(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(parsed.consumed));
    }
  }
}

/// A gateway with a line at 19200 8N1 behind it: a character takes 521 us there.
class ModbusTcpLine : public LineFixture
{
protected:
  ModbusTcpLine() : LineFixture(makeModbusTcp())
  {
  }

  /// Three good replies: from the fourth request on the gateway's numbers are trusted.
  void earnTrust()
  {
    for (const char* number : { "00 01", "00 02", "00 03" })
    {
      answerNextRaw(hex(number + std::string(" 00 00 00 07 01 03 04 00 00 00 00")), 30);
      ASSERT_EQ(Outcome::Ok, ask(READ).outcome);
    }
    ASSERT_TRUE(line_.gatewayTrusted());
    events_.clear();
  }

  const std::string REPLY_1 = "00 01 00 00 00 07 01 03 04 12 34 56 78";
  const std::string REPLY_2 = "00 02 00 00 00 07 01 03 04 00 00 00 02";
};

TEST_F(ModbusTcpLine, asksAndIsAnswered)
{
  answerNextRaw(hex(REPLY_1), 30);
  const Reply reply = ask(READ);
  EXPECT_EQ(Outcome::Ok, reply.outcome);
  EXPECT_EQ(hex("03 04 12 34 56 78"), reply.pdu);
  EXPECT_EQ(hex("00 01 00 00 00 06 01 03 00 00 00 02"), port_.sent().at(0));
  EXPECT_EQ("RA", seen());
  EXPECT_EQ(clock_.now(), line_.readyAt()) << "the gateway keeps the gaps";
}

TEST_F(ModbusTcpLine, aWriteWhoseReplyIsTheRequestIsAnswered)
{
  answerNextRaw(hex("00 01 00 00 00 06 01 06 00 01 13 88"), 30);
  EXPECT_EQ(Outcome::Ok, ask(WRITE).outcome);
  EXPECT_EQ(0u, line_.counters().echoes);
}

TEST_F(ModbusTcpLine, segmentsArePutTogether)
{
  const Bytes reply = hex(REPLY_1);
  port_.answerNext({ { ms(30), Bytes(reply.begin(), reply.begin() + 3) },
                     { ms(40), Bytes(reply.begin() + 3, reply.begin() + 9) },
                     { ms(60), Bytes(reply.begin() + 9, reply.end()) } });
  EXPECT_EQ(Outcome::Ok, ask(READ).outcome);
}

TEST_F(ModbusTcpLine, theTimeoutGrowsByTheTimeOnTheLineBehind)
{
  const Reply reply = ask(READ);
  EXPECT_EQ(Outcome::Timeout, reply.outcome);
  // Request, reply and three silences of 3.5 characters before the gateway can pass anything on.
  const double characters = 8 + 9 + 3 * 3.5;
  EXPECT_NEAR(toSeconds(timing_.characters(characters) + milliseconds(100)),
              toSeconds(reply.finished_at - reply.sent_at), 1e-6);
  EXPECT_NEAR(toSeconds(reply.finished_at - reply.sent_at), toSeconds(line_.costUnanswered(requestOf(withCrc(READ)))),
              1e-6);
}

TEST_F(ModbusTcpLine, turnaroundIsThatOfTheDrive)
{
  // 28.5 characters on the line and 20 ms of the drive; the frame is four bytes longer here than on the line.
  port_.answerNext({ { timing_.characters(28.5) + milliseconds(20), hex(REPLY_1) } });
  EXPECT_NEAR(0.020, toSeconds(ask(READ).turnaround), toSeconds(timing_.characters(4.1)));
}

TEST_F(ModbusTcpLine, anExchangeCostsTheTimeOnTheLineBehind)
{
  EXPECT_NEAR(toSeconds(timing_.characters(8 + 9 + 3 * 3.5) + milliseconds(5)),
              toSeconds(line_.cost(requestOf(withCrc(READ)), milliseconds(5))), 1e-6);
}

TEST_F(ModbusTcpLine, aLostRequestMayBeRepeatedAtOnce)
{
  earnTrust();
  EXPECT_EQ(Outcome::Timeout, ask(READ).outcome);
  EXPECT_TRUE(mayAsk(READ));
  EXPECT_EQ(clock_.now(), line_.mayAskAt(requestOf(withCrc(READ))));
}

TEST_F(ModbusTcpLine, aLateReplyIsNeverTheNextAnswer)
{
  answerNextRaw(hex(REPLY_1), 150);
  EXPECT_EQ(Outcome::Timeout, ask(READ).outcome);
  answerNextRaw(hex(REPLY_2), 80);
  const Reply reply = ask(READ);
  EXPECT_EQ(Outcome::Ok, reply.outcome);
  EXPECT_EQ(hex("03 04 00 00 00 02"), reply.pdu);
  EXPECT_EQ("RRLA", seen());
  EXPECT_EQ(1u, line_.counters().late_replies);
  EXPECT_EQ(0u, line_.counters().foreign_frames);
}

TEST_F(ModbusTcpLine, aLateReplyAloneIsATimeoutAndMeasured)
{
  answerNextRaw(hex(REPLY_1), 150);
  ask(READ);
  EXPECT_EQ(Outcome::Timeout, ask(READ).outcome);
  EXPECT_EQ(2u, line_.counters().timeouts);
  const std::vector<LateReply> late = line_.takeLateReplies();
  ASSERT_EQ(1u, late.size());
  EXPECT_EQ(1, late[0].station);
  EXPECT_NEAR(toSeconds(ms(150) - timing_.characters(8 + 3 * 3.5)), toSeconds(late[0].delay.value()), 1e-6);
  EXPECT_EQ(1u, late[0].ticket);
}

TEST_F(ModbusTcpLine, eachOfSeveralLostRequestsIsKnownByItsReply)
{
  earnTrust();
  answerNextRaw(hex("00 04 00 00 00 07 01 03 04 00 00 00 04"), 280);
  ask(READ);
  answerNextRaw(hex("00 05 00 00 00 07 01 03 04 00 00 00 05"), 170);
  ask(READ);
  answerNextRaw(hex("00 06 00 00 00 07 01 03 04 00 00 00 06"), 90);
  EXPECT_EQ(hex("03 04 00 00 00 06"), ask(READ).pdu);
  EXPECT_EQ("RRRLLA", seen());
  EXPECT_EQ(2u, line_.takeLateReplies().size());
}

TEST_F(ModbusTcpLine, aLateRefusalIsNotTheNextAnswer)
{
  answerNextRaw(hex("00 01 00 00 00 03 01 83 02"), 150);
  ask(READ);
  EXPECT_EQ(Outcome::Timeout, ask(READ).outcome);
  EXPECT_EQ(0u, line_.counters().exceptions);
  EXPECT_EQ(1u, line_.counters().late_replies);
}

TEST_F(ModbusTcpLine, aRefusalIsTakenThoughAnotherRequestWasLost)
{
  earnTrust();
  ask(READ);
  answerNextRaw(hex("00 05 00 00 00 03 01 83 02"), 50);
  EXPECT_EQ(0x8302, ask(OTHER_READ).error_id);
}

TEST_F(ModbusTcpLine, aGatewaysExceptionIsATimeoutAtOnce)
{
  answerNextRaw(hex("00 01 00 00 00 03 01 83 0B"), 50);
  const Reply reply = ask(READ);
  EXPECT_EQ(Outcome::Timeout, reply.outcome);
  EXPECT_EQ(ERROR_TIMEOUT, reply.error_id);
  EXPECT_EQ(reply.sent_at + milliseconds(50), reply.finished_at);
  EXPECT_EQ(1u, line_.counters().timeouts);
}

TEST_F(ModbusTcpLine, aGatewaysLateExceptionIsNotMeasured)
{
  answerNextRaw(hex("00 01 00 00 00 03 01 83 0B"), 150);
  ask(READ);
  EXPECT_EQ(Outcome::Timeout, ask(READ).outcome);
  EXPECT_EQ(1u, line_.counters().late_replies);
  const std::vector<LateReply> late = line_.takeLateReplies();
  ASSERT_EQ(1u, late.size());
  EXPECT_FALSE(late[0].delay) << "no longer time-out would have made the drive answer";
  EXPECT_EQ(0x0B, late[0].gateway_code);
  EXPECT_EQ(1u, late[0].ticket);
}

TEST_F(ModbusTcpLine, anAnswerToABroadcastIsNotForeign)
{
  answerNextRaw(hex("00 01 00 00 00 03 00 86 0B"), 30);
  EXPECT_EQ(Outcome::Ok, line_.exchange(requestOf(withCrc("00 06 FA 00 C0 00")), milliseconds(20)).outcome);
  answerNextRaw(hex(REPLY_2), 60);
  EXPECT_EQ(Outcome::Ok, ask(READ).outcome);
  EXPECT_EQ(0u, line_.counters().foreign_frames);
}

TEST_F(ModbusTcpLine, aSilentRequestMayBeAnswered)
{
  Request reset = requestOf(withCrc("01 06 FA 00 E0 00"));
  reset.expects_reply = false;
  answerNextRaw(hex("00 01 00 00 00 06 01 06 FA 00 E0 00"), 60);
  EXPECT_EQ(Outcome::Ok, line_.exchange(reset).outcome);
  clock_.advance(milliseconds(80));
  EXPECT_TRUE(line_.settle());
  EXPECT_EQ("RA", seen());
}

TEST_F(ModbusTcpLine, numbersGoOnBehindAReconnection)
{
  ask(READ);
  std::string error;
  line_.open(error);
  ask(READ);
  EXPECT_EQ(hex("00 02 00 00 00 06 01 03 00 00 00 02"), port_.sent().at(1));
}
}  // namespace
}  // namespace wire
}  // namespace inverter_bus
