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

class LineEcho : public LineFixture
{
protected:
  void echoOn(std::size_t piece = 256)
  {
    port_.echo(timing_.characters(1), piece);
  }

  /// An answered read, from which the echo is learnt.
  void learn()
  {
    answerNext(REPLY);
    EXPECT_EQ(Outcome::Ok, ask(READ).outcome);
  }
};

TEST_F(LineEcho, isFoundOnAReadAndRemoved)
{
  echoOn();
  EXPECT_FALSE(line_.echoFound());
  learn();
  EXPECT_TRUE(line_.echoFound());
  EXPECT_EQ("RA", seen());
  EXPECT_EQ(1u, line_.counters().echoes);
  EXPECT_EQ(0u, line_.counters().foreign_frames);
}

TEST_F(LineEcho, isFoundThoughNoDriveAnswers)
{
  echoOn();
  EXPECT_EQ(Outcome::Timeout, ask(READ).outcome);
  EXPECT_TRUE(line_.echoFound());
  EXPECT_EQ(0u, line_.counters().corrupt_replies);
}

TEST_F(LineEcho, isFoundByteByByte)
{
  echoOn(1);
  learn();
  EXPECT_TRUE(line_.echoFound());
}

TEST_F(LineEcho, isFoundInPiecesOfAFunctionThatModbusRtuCannotParse)
{
  echoOn(1);
  EXPECT_EQ(Outcome::Timeout, ask("01 2B 0E 01 00").outcome);
  EXPECT_TRUE(line_.echoFound());
  EXPECT_EQ("R", seen());
}

TEST_F(LineEcho, isFoundInPiecesThatComeAfterTheTimeout)
{
  const Bytes frame = withCrc("01 2B 0E 01 00");
  port_.answerNext(
      { { ms(120), Bytes(frame.begin(), frame.begin() + 3) }, { ms(130), Bytes(frame.begin() + 3, frame.end()) } });
  ask("01 2B 0E 01 00");
  clock_.advance(milliseconds(17));
  EXPECT_TRUE(line_.settle());
  EXPECT_EQ("R", seen());
}

TEST_F(LineEcho, isFoundTogetherWithTheReply)
{
  answerNextRaw(withCrc(READ) + withCrc(REPLY), 12);
  EXPECT_EQ(Outcome::Ok, ask(READ).outcome);
  EXPECT_TRUE(line_.echoFound());
}

TEST_F(LineEcho, isFoundOnAWriteWhoseReplyIsDifferent)
{
  echoOn();
  answerNext("01 10 00 00 00 01", 15);
  EXPECT_EQ(Outcome::Ok, ask("01 10 00 00 00 01 02 00 01").outcome);
  EXPECT_TRUE(line_.echoFound());
}

TEST_F(LineEcho, mayComeInLatePieces)
{
  const Bytes echo = withCrc(OTHER_READ);
  port_.answerNext({ { ms(5), Bytes(echo.begin(), echo.begin() + 7) },
                     { ms(40), Bytes(echo.begin() + 7, echo.end()) },
                     { ms(60), withCrc(OTHER_REPLY) } });
  EXPECT_EQ(Outcome::Ok, ask(OTHER_READ).outcome);
}

TEST_F(LineEcho, isNotFoundWhereThereIsNone)
{
  learn();
  answerNext(WRITE);
  EXPECT_EQ(Outcome::Ok, ask(WRITE).outcome);
  EXPECT_FALSE(line_.echoFound());
  EXPECT_EQ(0u, line_.counters().echoes);
}

TEST_F(LineEcho, ofAWriteIsNotItsReply)
{
  echoOn();
  learn();
  const Reply reply = ask(WRITE);
  EXPECT_EQ(Outcome::Timeout, reply.outcome);
  EXPECT_EQ(ERROR_TIMEOUT, reply.error_id);
}

TEST_F(LineEcho, ofAWriteIsFollowedByItsReply)
{
  echoOn(3);
  learn();
  answerNext(WRITE, 12);
  const Reply reply = ask(WRITE);
  EXPECT_EQ(Outcome::Ok, reply.outcome);
  EXPECT_EQ(reply.sent_at + ms(12), reply.finished_at);
  EXPECT_EQ(2u, line_.counters().echoes);
}

TEST_F(LineEcho, ofALoopBackIsNotItsReply)
{
  echoOn();
  learn();
  EXPECT_EQ(Outcome::Timeout, ask(LOOP_BACK).outcome);
}

TEST_F(LineEcho, behindNoiseIsNotTheReplyToAWrite)
{
  echoOn();
  learn();
  port_.noEcho();
  answerNextRaw(hex("00") + withCrc(WRITE), 5);
  EXPECT_EQ(Outcome::Damaged, ask(WRITE).outcome);
}

TEST_F(LineEcho, thatIsDamagedLeavesAReadReadable)
{
  echoOn();
  learn();
  port_.noEcho();
  Bytes collision = withCrc(READ);
  collision[5] ^= 4;
  answerNextRaw(collision + withCrc(REPLY));
  EXPECT_EQ(Outcome::Ok, ask(READ).outcome);
  EXPECT_TRUE(line_.echoFound()) << "bytes came before the reply: no proof that the echo is gone";
}

TEST_F(LineEcho, thatIsDamagedMakesAWriteFail)
{
  echoOn();
  learn();
  port_.noEcho();
  Bytes collision = withCrc(WRITE);
  collision[5] ^= 4;
  answerNextRaw(collision + withCrc(WRITE));
  EXPECT_EQ(Outcome::Damaged, ask(WRITE).outcome);
}

TEST_F(LineEcho, ofABroadcastIsNotForeign)
{
  echoOn();
  learn();
  EXPECT_EQ(Outcome::Ok, line_.exchange(requestOf(withCrc("00 06 FA 00 C0 00")), milliseconds(20)).outcome);
  EXPECT_TRUE(line_.settle());
  EXPECT_EQ(0u, line_.counters().foreign_frames);
  EXPECT_EQ("RAR", seen());
}

TEST_F(LineEcho, thatComesAfterABroadcastIsNotForeign)
{
  learn();
  answerNext("00 06 FA 00 C0 00", 16);
  line_.settle();
  line_.exchange(requestOf(withCrc("00 06 FA 00 C0 00")), milliseconds(20));
  EXPECT_TRUE(line_.settle());
  EXPECT_EQ(0u, line_.counters().foreign_frames);
}

TEST_F(LineEcho, ofASilentRequestIsNotItsReply)
{
  echoOn();
  learn();
  Request reset = requestOf(withCrc("01 06 FA 00 E0 00"));
  reset.expects_reply = false;
  line_.settle();
  const Reply reply = line_.exchange(reset);
  EXPECT_EQ(Outcome::Ok, reply.outcome);
  EXPECT_TRUE(reply.pdu.empty());
  EXPECT_EQ(1u, line_.counters().replies);
}

TEST_F(LineEcho, thatIsGoneIsNoticedOnTheNextRead)
{
  echoOn();
  learn();
  port_.noEcho();
  learn();
  EXPECT_FALSE(line_.echoFound());
  answerNext(WRITE);
  EXPECT_EQ(Outcome::Ok, ask(WRITE).outcome);
}

TEST_F(LineEcho, isForgottenWithThePort)
{
  echoOn();
  learn();
  std::string error;
  line_.open(error);
  EXPECT_FALSE(line_.echoFound());
}

TEST_F(LineEcho, aLateReplyToAWriteIsNotTheEcho)
{
  learn();
  answerNext(WRITE, 120);
  ask(WRITE);
  clock_.advance(milliseconds(30));
  line_.settle();
  EXPECT_EQ("RARL", seen());
  EXPECT_FALSE(line_.echoFound());
}
}  // namespace
}  // namespace wire
}  // namespace inverter_bus
