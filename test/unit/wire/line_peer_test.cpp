// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
// Who is at the other end of a network connection that passes bytes on: telnet servers, banners, last words.
#include "inverter_bus/wire/telnet_filter.h"
#include "support/line_fixture.h"

namespace inverter_bus
{
namespace wire
{
namespace
{
using std::chrono::milliseconds;

class NetworkPort : public FakePort
{
public:
  using FakePort::FakePort;

  bool isNetwork() const override
  {
    return true;
  }

  Loss lastLoss() const override
  {
    return Loss::ClosedByPeer;
  }
};

class LinePeer : public testing::Test
{
protected:
  LinePeer()
  {
    open();
  }

  void open()
  {
    std::string error;
    ASSERT_EQ(OpenResult::Opened, line_.open(error));
  }

  Reply ask(const std::string& request, const Bytes& answer)
  {
    EXPECT_TRUE(line_.settle());
    port_.answerNext({ { milliseconds(10), answer } });
    return line_.exchange(requestOf(withCrc(request)));
  }

  void say(const Bytes& bytes)
  {
    port_.deliver(Duration{ 0 }, bytes);
    line_.settle();
  }

  const std::string READ = "01 03 00 00 00 02";
  const std::string REPLY = "01 03 04 12 FF 56 FF";
  /// What ser2net sends first.
  const Bytes TELNET = hex("FF FB 03 FF FD 03 FF FB 01 FF FE 01 FF FD 00 FF FB 00");

  VirtualClock clock_;
  NetworkPort port_{ clock_ };
  const std::unique_ptr<Protocol> protocol_ = makeModbusRtu();
  Line line_{ port_, *protocol_, clock_, LineTiming(19200, 10) };
};

/// As telnet sends it.
Bytes doubled(const Bytes& bytes)
{
  Bytes result;
  for (const std::uint8_t byte : bytes)
  {
    result.insert(result.end(), byte == 0xFF ? 2 : 1, byte);
  }
  return result;
}

TEST_F(LinePeer, aTelnetServerIsNoticedAndSpokenTo)
{
  EXPECT_FALSE(line_.telnetFound());
  say(TELNET);
  EXPECT_TRUE(line_.telnetFound());
  EXPECT_FALSE(line_.provenSinceOpen());
  const Reply reply = ask("01 05 00 00 FF 00", doubled(withCrc("01 05 00 00 FF 00")));
  EXPECT_EQ(Outcome::Ok, reply.outcome);
  EXPECT_EQ(doubled(withCrc("01 05 00 00 FF 00")), port_.sent().back());
  EXPECT_TRUE(line_.provenSinceOpen());
  EXPECT_EQ(hex("03 04 12 FF 56 FF"), ask(READ, hex("FF FB 01") + doubled(withCrc(REPLY))).pdu);
  EXPECT_TRUE(line_.telnetFound());
}

TEST_F(LinePeer, telnetIsNoticedInAnyPieces)
{
  for (const std::uint8_t byte : TELNET)
  {
    say({ byte });
  }
  EXPECT_TRUE(line_.telnetFound());
}

TEST_F(LinePeer, telnetIsNoticedBesideTheFirstRequest)
{
  EXPECT_EQ(Outcome::Ok, ask(READ, TELNET + doubled(withCrc(REPLY))).outcome);
  EXPECT_TRUE(line_.telnetFound());
}

TEST_F(LinePeer, oneNegotiationIsNoise)
{
  say(hex("FF FB 03"));
  EXPECT_FALSE(line_.telnetFound());
  EXPECT_EQ(hex("03 04 12 FF 56 FF"), ask(READ, withCrc(REPLY)).pdu);
}

TEST_F(LinePeer, behindAValidReplyNothingIsTelnet)
{
  ask(READ, withCrc(REPLY));
  say(TELNET);
  EXPECT_FALSE(line_.telnetFound());
  EXPECT_EQ(Outcome::Ok, ask("01 05 00 00 FF 00", withCrc("01 05 00 00 FF 00")).outcome);
  EXPECT_EQ(withCrc("01 05 00 00 FF 00"), port_.sent().back());
}

TEST_F(LinePeer, aNewConnectionStartsAfresh)
{
  say(TELNET);
  ask(READ, doubled(withCrc(REPLY)));
  line_.close();
  open();
  EXPECT_FALSE(line_.telnetFound());
  EXPECT_FALSE(line_.provenSinceOpen());
  EXPECT_EQ("", line_.peerWords());
}

TEST_F(LinePeer, lastWordsAreKeptBehindTheClose)
{
  say(ascii("Port already in use\r\n"));
  port_.unplug();
  EXPECT_FALSE(line_.settle());
  EXPECT_EQ("Port already in use", line_.peerWords());
  EXPECT_EQ(Loss::ClosedByPeer, line_.lastLoss());
}

TEST_F(LinePeer, lastWordsOfATelnetServerAreText)
{
  say(TELNET + ascii("Port already in use\r\n"));
  EXPECT_EQ("Port already in use", line_.peerWords());
}

TEST_F(LinePeer, lastWordsInPlaceOfAReplyAreKept)
{
  EXPECT_EQ(Outcome::Damaged, ask(READ, ascii("Device open failure: Value or file not found\r\n")).outcome);
  EXPECT_EQ("Device open failure: Value or file not found", line_.peerWords());
}

TEST_F(LinePeer, aBannerIsHarmlessAndForgotten)
{
  say(ascii("ser2net port 4001 device /dev/ttyS0 [9600N81] (Debian GNU/Linux)\r\n\r\n"));
  EXPECT_FALSE(line_.telnetFound());
  EXPECT_NE("", line_.peerWords());
  EXPECT_EQ(Outcome::Ok, ask(READ, withCrc(REPLY)).outcome);
  EXPECT_EQ("", line_.peerWords());
  EXPECT_EQ(0u, line_.counters().corrupt_replies);
}

TEST_F(LinePeer, noiseIsNoText)
{
  say(hex("48 61 6C 6C 6F 00 1B 5B 32 4A FF"));
  EXPECT_EQ("", line_.peerWords());
}

TEST_F(LinePeer, aSecondMastersRequestIsNoText)
{
  say(hex("05 03 10 00 00 04"));
  EXPECT_EQ("", line_.peerWords());
}

TEST_F(LinePeer, wordsWithoutEndAreCut)
{
  for (int i = 0; i < 50; ++i)
  {
    say(ascii("please go away, please go away\r\n"));
  }
  EXPECT_LE(line_.peerWords().size(), 130u);
}

TEST_F(LinePeer, nothingIsAnEchoOverANetwork)
{
  // A serial server that answers a broadcast by its own frame.
  port_.answerNext({ { milliseconds(5), withCrc("00 05 00 00 00 00") } });
  line_.exchange(requestOf(withCrc("00 05 00 00 00 00")), milliseconds(20));
  EXPECT_FALSE(line_.echoFound());
  EXPECT_EQ(Outcome::Ok, ask("01 05 00 00 00 00", withCrc("01 05 00 00 00 00")).outcome);
  EXPECT_EQ(0u, line_.counters().echoes);
}

TEST_F(LinePeer, nothingIsKnownOfALossThatWasNone)
{
  EXPECT_EQ(Loss::None, line_.lastLoss());
  line_.abandon();
  EXPECT_EQ(Loss::None, line_.lastLoss());
  EXPECT_FALSE(line_.isOpen());
}

TEST(TelnetFilterTest, aSubnegotiationIsTakenOutWhole)
{
  TelnetFilter filter;
  Bytes bytes = hex("FF FB 03 FF FB 01 FF FA 2C FF FF 01 FF F0 41 FF FF 42");
  filter.receive(bytes, 0);
  EXPECT_TRUE(filter.found());
  EXPECT_EQ(hex("41 FF 42"), bytes);
  bytes = hex("41");
  for (const std::uint8_t byte : hex("FF FD 01 FF FF 43"))
  {
    bytes.push_back(byte);
    filter.receive(bytes, bytes.size() - 1);
  }
  EXPECT_EQ(hex("41 FF 43"), bytes);
}
}  // namespace
}  // namespace wire
}  // namespace inverter_bus
