// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include <gtest/gtest.h>

#include <ostream>

#include "inverter_bus/wire/protocol.h"
#include "support/wire_frames.h"

namespace inverter_bus
{
namespace wire
{
namespace
{
using Kind = Parsed::Kind;

struct Golden
{
  const char* what;
  const char* request;
  /// Empty: the drive doesn't answer. "echo": the request once more.
  const char* reply;
};

std::ostream& operator<<(std::ostream& stream, const Golden& golden)
{
  return stream << golden.what;
}

Bytes replyFrame(const Golden& golden)
{
  return std::string(golden.reply) == "echo" ? hex(golden.request) : hex(golden.reply);
}

// Printed in manuals or recorded on real drives, or computed from the form printed there.
const Golden GOLDEN[] = {
  { "MX2 run, node 1", "01 05 00 00 FF 00 8C 3A", "echo" },
  { "MX2 run, node 8", "08 05 00 00 FF 00 8C A3", "echo" },
  { "MX2 stop, node 8", "08 05 00 00 00 00 CD 53", "echo" },
  { "MX2 reverse", "01 05 00 01 FF 00 DD FA", "echo" },
  { "MX2 reset on", "01 05 00 03 FF 00 7C 3A", "echo" },
  { "MX2 reset off", "01 05 00 03 00 00 3D CA", "echo" },
  { "MX2 status coils", "01 01 00 0E 00 0B 1C 0E", "" },
  { "MX2 terminals", "08 01 00 06 00 06 5C 90", "08 01 01 17 12 1A" },
  { "MX2 status registers", "01 03 00 00 00 05 85 C9", "" },
  { "MX2 last trip", "01 03 00 11 00 06 95 CD", "01 03 0C 00 0C 00 01 00 00 00 00 00 00 0D 02 24 E1" },
  { "MX2 trip block", "01 03 00 11 00 0A 95 C8", "" },
  { "MX2 F001", "01 10 00 00 00 02 04 00 00 13 88 FE F9", "01 10 00 00 00 02 41 C8" },
  { "MX2 F001 low word", "01 06 00 01 13 88 D5 5C", "echo" },
  { "MX2 write and read", "01 17 10 00 00 02 00 00 00 02 04 00 00 13 88 F4 86", "01 17 04 00 00 00 00 F9 27" },
  { "MX2 F002", "01 10 11 02 00 02 04 00 00 03 E8 B2 98", "" },
  { "MX2 A003", "08 06 12 02 01 F4 2D FC", "echo" },
  { "RX A003", "05 06 12 02 00 32 AD 23", "echo" },
  { "MX2 store, node 8", "08 06 08 FF 00 01 7A C3", "echo" },
  { "MX2 store, node 1", "01 06 08 FF 00 01 7A 5A", "echo" },
  { "MX2 busy bits", "01 01 00 48 00 06 3C 1E", "" },
  { "MX2 coil mirror", "01 03 1E 00 00 05 83 E1", "" },
  { "MX2 read only register", "01 10 10 13 00 02 04 00 04 93 E0 53 CF", "01 90 23 0D D9" },
  { "MX2 loop-back", "01 08 00 00 01 F4 E0 1C", "echo" },
  { "MX2 write coils", "01 0F 00 06 00 05 02 17 00 E9 BA", "01 0F 00 06 00 05 75 C9" },
  { "7200MA read", "01 03 00 00 00 01 84 0A", "01 03 02 00 00 B8 44" },
  { "7200MA loop test", "01 08 00 00 AA 55 5E 94", "echo" },
  { "7200MA loop test refused", "01 08 00 00 AA 55 5E 94", "01 88 01 87 C0" },
  { "7200MA run", "01 10 00 00 00 01 02 00 01 67 90", "01 10 00 00 00 01 01 C9" },
  { "7200MA stop", "01 10 00 00 00 01 02 00 00 A6 50", "01 10 00 00 00 01 01 C9" },
  { "7200MA fault reset", "01 10 00 00 00 01 02 00 08 A7 96", "01 10 00 00 00 01 01 C9" },
  { "7200MA frequency", "01 10 00 01 00 01 02 13 88 AA D7", "01 10 00 01 00 01 50 09" },
  { "7200MA run at 60 Hz", "01 10 00 00 00 02 04 00 01 17 70 AC 7B", "01 10 00 00 00 02 41 C8" },
  { "7200MA run at 50 Hz", "01 10 00 00 00 02 04 00 01 13 88 AF 39", "01 10 00 00 00 02 41 C8" },
  { "7200MA stop and 0 Hz", "01 10 00 00 00 02 04 00 00 00 00 F3 AF", "01 10 00 00 00 02 41 C8" },
  { "7200MA broadcast stop", "00 10 00 00 00 01 02 00 00 AB C0", "" },
  { "7200MA broadcast run", "00 10 00 00 00 02 04 00 01 17 70 A8 87", "" },
  { "7200MA broadcast frequency", "00 10 00 01 00 01 02 0B B8 AD 53", "" },
  { "7200MA longest read", "01 03 00 00 00 10 44 06",
    "01 03 20 00 00 00 01 00 02 00 03 00 04 00 05 00 06 00 07 00 08 00 09 00 0A 00 0B 00 0C 00 0D 00 0E 00 0F 88 4B" },
  { "7200MA write refused 01", "01 10 00 00 00 01 02 00 01 67 90", "01 90 01 8D C0" },
  { "7200MA write refused 02", "01 10 00 00 00 01 02 00 01 67 90", "01 90 02 CD C1" },
  { "7200MA write refused 03", "01 10 00 00 00 01 02 00 01 67 90", "01 90 03 0C 01" },
  { "7200MA write refused 21", "01 10 00 00 00 01 02 00 01 67 90", "01 90 21 8C 18" },
  { "7200MA write refused 22", "01 10 00 00 00 01 02 00 01 67 90", "01 90 22 CC 19" },
  { "7200MA too many registers", "01 03 00 00 00 11 85 C6", "01 83 03 01 31" },
  { "7200MA knows no 06", "01 06 00 01 17 70 D6 1E", "01 86 01 83 A0" },
  { "7200MA read refused 01", "01 03 00 00 00 01 84 0A", "01 83 01 80 F0" },
  { "7200MA read refused 02", "01 03 00 00 00 01 84 0A", "01 83 02 C0 F1" },
  { "7200MA read, node 31", "1F 03 00 00 00 01 87 B4", "1F 03 02 00 00 10 46" },
  { "7200MA run, node 31", "1F 10 00 00 00 01 02 00 01 E6 30", "1F 10 00 00 00 01 02 77" },
  { "VF-S15 read FD00", "01 03 FD 00 00 01 B5 A6", "01 03 02 17 70 B6 50" },
  { "VF-S15 block read 5", "01 03 18 75 00 05 92 B3", "01 03 0A E4 04 17 70 00 00 26 FF 00 80 58 00" },
  { "VF-S15 block read 2", "01 03 18 75 00 02 D3 71", "01 03 04 E4 04 17 70 83 16" },
  { "VF-S15 block read, slot 0", "01 03 18 75 00 02 D3 71", "01 03 04 00 00 17 70 F4 27" },
  { "VF-S15 too many words", "01 03 18 75 00 06 D2 B2", "01 83 03 01 31" },
  { "VF-S15 wrong block", "01 03 18 76 00 02 23 71", "01 83 03 01 31" },
  { "VF-S15 direct read", "01 03 01 30 00 05 84 3A", "01 03 0A 00 04 00 06 00 0A 80 00 80 00 A0 77" },
  { "VF-S15 write FA01", "01 06 FA 01 17 70 E6 C6", "echo" },
  { "VF-S15 no such number", "01 06 FF FF 00 00 89 EE", "01 86 02 C3 A1" },
  { "VF-S15 10H one word", "01 10 FA 01 00 01 02 17 70 F3 9A", "01 10 FA 01 00 01 60 D1" },
  { "VF-S15 block write", "01 10 18 70 00 02 04 C4 00 17 70 6D AF", "01 10 18 70 00 02 46 B3" },
  { "VF-S15 block write busy", "01 10 18 70 00 02 04 C4 00 17 70 6D AF", "01 90 04 4D C3" },
  { "VF-S15 block number 1871", "01 10 18 71 00 02 04 C4 00 17 70 AC 63", "01 90 03 0C 01" },
  { "VF-S15 count 3", "01 10 18 70 00 03 04 C4 00 17 70 6C 7E", "01 90 03 0C 01" },
  { "VF-S15 forward", "01 06 FA 00 C4 00 EB D2", "echo" },
  { "VF-S15 reverse", "01 06 FA 00 C6 00 EA B2", "echo" },
  { "VF-S15 stop", "01 06 FA 00 C0 00 E9 12", "echo" },
  { "VF-S15 coast", "01 06 FA 00 C8 00 EE D2", "echo" },
  { "VF-S15 emergency stop", "01 06 FA 00 D0 00 E4 D2", "echo" },
  { "VF-S15 reset", "01 06 FA 00 E0 00 F0 D2", "" },
  { "VF-S15 release", "01 06 FA 00 00 00 B9 12", "echo" },
  { "VF-S15 broadcast stop", "00 06 FA 00 C0 00 E8 C3", "" },
  { "VF-S15 write and read", "01 17 18 75 00 05 18 70 00 02 04 C4 00 17 70 84 31", "" },
};

class GoldenFrame : public testing::TestWithParam<Golden>
{
protected:
  const std::unique_ptr<Protocol> protocol_ = makeModbusRtu();
  const Request request_ = requestOf(hex(GetParam().request));
  const Bytes reply_ = replyFrame(GetParam());

  Parsed parse(const Bytes& bytes) const
  {
    return protocol_->parse(bytes.data(), bytes.size(), &request_);
  }
};

TEST_P(GoldenFrame, isBuiltAsPrinted)
{
  EXPECT_EQ(hex(GetParam().request), protocol_->frame(request_));
  EXPECT_EQ(hex(GetParam().request).size(), protocol_->requestLength(request_));
}

TEST_P(GoldenFrame, isUnderstoodAsPrinted)
{
  if (reply_.empty())
  {
    return;
  }
  const bool exception = (reply_[1] & 0x80) != 0;
  const Parsed parsed = parse(reply_);
  EXPECT_EQ(exception ? Kind::Exception : Kind::Reply, parsed.kind);
  EXPECT_EQ(reply_.size(), parsed.consumed);
  EXPECT_EQ(Bytes(reply_.begin() + 1, reply_.end() - 2), parsed.pdu);
  EXPECT_EQ(request_.station, parsed.station);
  EXPECT_EQ(exception ? reply_[1] << 8 | reply_[2] : 0, parsed.error_id);
  EXPECT_EQ(exception ? protocol_->replyLength(request_) : reply_.size(), protocol_->replyLength(request_));
}

TEST_P(GoldenFrame, isWaitedForUntilComplete)
{
  for (std::size_t size = 0; size < reply_.size(); ++size)
  {
    const Parsed parsed = protocol_->parse(reply_.data(), size, &request_);
    EXPECT_EQ(Kind::Incomplete, parsed.kind) << size;
    EXPECT_EQ(0u, parsed.consumed) << size;
    EXPECT_EQ(size >= 2, parsed.own) << size;
  }
}

TEST_P(GoldenFrame, isRefusedWithAnyBitWrong)
{
  for (std::size_t bit = 0; bit < 8 * reply_.size(); ++bit)
  {
    Bytes wrong = reply_;
    wrong[bit / 8] = static_cast<std::uint8_t>(wrong[bit / 8] ^ (1u << (bit % 8)));
    const Kind kind = parse(wrong).kind;
    EXPECT_TRUE(kind == Kind::Garbage || kind == Kind::Incomplete) << bit;
  }
}

TEST_P(GoldenFrame, isFoundBehindNoise)
{
  if (reply_.empty())
  {
    return;
  }
  // Noise as it comes from a switching transmitter, and noise that looks like the beginning of a frame.
  for (const Bytes& noise :
       { hex("00"), hex("FF"), hex("05"), hex("05 03"), hex("00 10 FF FF 00 7B F6"), hex("01 17 FF") })
  {
    const Parsed first = parse(noise + reply_);
    EXPECT_EQ(Kind::Garbage, first.kind);
    ASSERT_EQ(noise.size(), first.consumed);
  }
}

TEST_P(GoldenFrame, isForeignToEverybodyElse)
{
  const Request other = requestOf(withCrc("63 03 00 00 00 02"));
  for (const Bytes& frame : { hex(GetParam().request), reply_ })
  {
    if (frame.empty())
    {
      continue;
    }
    for (const Request* request : { static_cast<const Request*>(nullptr), &other })
    {
      const Parsed parsed = protocol_->parse(frame.data(), frame.size(), request);
      EXPECT_EQ(Kind::Foreign, parsed.kind);
      EXPECT_EQ(frame.size(), parsed.consumed);
      EXPECT_EQ(frame[0], parsed.station);
    }
  }
}

TEST_P(GoldenFrame, answersTheShapeOfItsRequest)
{
  if (reply_.empty())
  {
    return;
  }
  const std::string shape = protocol_->shape(request_);
  const std::string answered = protocol_->shapeOfReply(parse(reply_));
  ASSERT_FALSE(answered.empty());
  EXPECT_EQ((reply_[1] & 0x80) != 0 ? shape.substr(0, 2) : shape, answered);
}

INSTANTIATE_TEST_SUITE_P(manuals, GoldenFrame, testing::ValuesIn(GOLDEN));

struct Mismatch
{
  const char* what;
  const char* request;
  const char* reply;
};

std::ostream& operator<<(std::ostream& stream, const Mismatch& mismatch)
{
  return stream << mismatch.what;
}

const Mismatch MISMATCHES[] = {
  { "other station", "01 03 00 00 00 01", "02 03 02 00 00" },
  { "other function", "01 03 00 00 00 01", "01 04 02 00 00" },
  { "fewer registers", "01 03 00 00 00 02", "01 03 02 00 00" },
  { "more registers", "01 03 00 00 00 01", "01 03 04 00 00 00 00" },
  { "fewer coils", "01 01 00 00 00 09", "01 01 01 00" },
  { "other coil", "01 05 00 00 FF 00", "01 05 00 01 FF 00" },
  { "other coil value", "01 05 00 00 FF 00", "01 05 00 00 00 00" },
  { "other register", "01 06 00 01 13 88", "01 06 00 02 13 88" },
  { "other register value", "01 06 00 01 13 88", "01 06 00 01 13 89" },
  { "other test number", "01 08 00 00 AA 55", "01 08 00 00 AA 56" },
  { "other coils", "01 0F 00 06 00 05 01 17", "01 0F 00 07 00 05" },
  { "other coil count", "01 0F 00 06 00 05 01 17", "01 0F 00 06 00 04" },
  { "other address written", "01 10 00 00 00 02 04 00 01 13 88", "01 10 00 01 00 02" },
  { "other count written", "01 10 00 00 00 02 04 00 01 13 88", "01 10 00 00 00 01" },
  { "other count read and written", "01 17 10 00 00 02 00 00 00 01 02 00 00", "01 17 02 00 00" },
  { "other function's exception", "01 03 00 00 00 01", "01 86 02" },
  { "other station's exception", "01 03 00 00 00 01", "02 83 02" },
};

class MismatchedReply : public testing::TestWithParam<Mismatch>
{
};

TEST_P(MismatchedReply, isForeign)
{
  const std::unique_ptr<Protocol> protocol = makeModbusRtu();
  const Request request = requestOf(withCrc(GetParam().request));
  const Bytes reply = withCrc(GetParam().reply);
  const Parsed parsed = protocol->parse(reply.data(), reply.size(), &request);
  EXPECT_EQ(Kind::Foreign, parsed.kind);
  EXPECT_EQ(reply.size(), parsed.consumed);
}

TEST_P(MismatchedReply, hasAnotherShape)
{
  const std::unique_ptr<Protocol> protocol = makeModbusRtu();
  const Request request = requestOf(withCrc(GetParam().request));
  const Bytes reply = withCrc(GetParam().reply);
  const std::string answered = protocol->shapeOfReply(protocol->parse(reply.data(), reply.size(), &request));
  const std::string shape = protocol->shape(request);
  EXPECT_NE(shape, answered);
  EXPECT_NE(shape.substr(0, answered.size()), answered);
}

INSTANTIATE_TEST_SUITE_P(fields, MismatchedReply, testing::ValuesIn(MISMATCHES));

TEST(ModbusCrc, hasTheCheckValueOfItsCatalogue)
{
  const std::string text = "123456789";
  const Bytes bytes(text.begin(), text.end());
  EXPECT_EQ(0x4B37, modbusCrc(bytes.data(), bytes.size()));
  EXPECT_EQ(0xFFFF, modbusCrc(bytes.data(), 0));
}

class ModbusRtuTest : public testing::Test
{
protected:
  Parsed parse(const Bytes& bytes, const Request* request = nullptr) const
  {
    return protocol_->parse(bytes.data(), bytes.size(), request);
  }

  const std::unique_ptr<Protocol> protocol_ = makeModbusRtu();
};

TEST_F(ModbusRtuTest, gatewayExceptionsMeanNoReplyInTime)
{
  const Request request = requestOf(withCrc("01 03 00 00 00 01"));
  EXPECT_EQ(ERROR_TIMEOUT, parse(withCrc("01 83 0A"), &request).error_id);
  EXPECT_EQ(ERROR_TIMEOUT, parse(withCrc("01 83 0B"), &request).error_id);
  EXPECT_EQ(0x8304, parse(withCrc("01 83 04"), &request).error_id);
}

TEST_F(ModbusRtuTest, aBroadcastIsSentToStationZeroAndHasNoReply)
{
  Request request = requestOf(withCrc("05 06 FA 00 C0 00"));
  request.broadcast = true;
  EXPECT_EQ(hex("00 06 FA 00 C0 00 E8 C3"), protocol_->frame(request));
  EXPECT_EQ(0u, protocol_->replyLength(request));
  EXPECT_EQ(Kind::Foreign, parse(withCrc("05 06 FA 00 C0 00"), &request).kind);
}

TEST_F(ModbusRtuTest, aForeignFrameBeforeTheReplyIsSeenAsOne)
{
  const Request request = requestOf(withCrc("01 03 00 00 00 01"));
  const Bytes foreign = withCrc("02 03 02 12 34");
  const Parsed parsed = parse(foreign + withCrc("01 03 02 00 00"), &request);
  EXPECT_EQ(Kind::Foreign, parsed.kind);
  EXPECT_EQ(foreign.size(), parsed.consumed);
}

TEST_F(ModbusRtuTest, aForeignFrameThatContainsTheReplyIsForeign)
{
  const Request request = requestOf(withCrc("01 03 00 00 00 01"));
  const Bytes foreign = withCrc("02 10 00 00 00 04 08 01 03 02 00 00 B8 44 00");
  const Parsed parsed = parse(foreign, &request);
  EXPECT_EQ(Kind::Foreign, parsed.kind);
  EXPECT_EQ(foreign.size(), parsed.consumed);
}

TEST_F(ModbusRtuTest, theBeginningOfALongReplyIsNoShorterFrame)
{
  // Its first eight bytes are by chance a valid read request.
  const Bytes beginning = withCrc("01 03 20 00 00 01");
  Bytes reply = beginning;
  reply.resize(35);
  const std::uint16_t crc = modbusCrc(reply.data(), reply.size());
  reply = reply + Bytes{ static_cast<std::uint8_t>(crc & 0xFF), static_cast<std::uint8_t>(crc >> 8) };
  const Request request = requestOf(withCrc("01 03 00 00 00 10"));
  EXPECT_EQ(Kind::Incomplete, parse(beginning, &request).kind);
  EXPECT_EQ(Kind::Reply, parse(reply, &request).kind);
}

TEST_F(ModbusRtuTest, noiseThatNoStationCouldSendIsSkippedAtOnce)
{
  EXPECT_EQ(Kind::Garbage, parse(hex("FF")).kind);
  EXPECT_EQ(Kind::Garbage, parse(hex("01 55")).kind);
  EXPECT_EQ(Kind::Garbage, parse(hex("01 D5 02")).kind);
  EXPECT_EQ(Kind::Garbage, parse(hex("01 10 00 00 00 01 FF 00 00 00")).kind);
  EXPECT_EQ(Kind::Incomplete, parse(hex("01")).kind);
  EXPECT_EQ(Kind::Incomplete, parse(Bytes()).kind);
}

TEST_F(ModbusRtuTest, garbageIsNeverIncompleteForever)
{
  for (unsigned function = 0; function <= 0xFF; ++function)
  {
    Bytes bytes(300, 0xFF);
    bytes[0] = 1;
    bytes[1] = static_cast<std::uint8_t>(function);
    EXPECT_EQ(Kind::Garbage, parse(bytes).kind) << function;
  }
}

TEST_F(ModbusRtuTest, unknownAndMalformedRequestsHaveNoReply)
{
  for (const char* pdu : { "2B 0E 01 00", "03", "17 00", "10 00", "0F" })
  {
    Request request;
    request.station = 1;
    request.pdu = hex(pdu);
    EXPECT_FALSE(protocol_->frame(request).empty());
    EXPECT_LE(protocol_->replyLength(request), 8u);
    EXPECT_NE(Kind::Reply, parse(withCrc("01 03 02 00 00"), &request).kind);
  }
  const Request empty;
  EXPECT_EQ(3u, protocol_->frame(empty).size());
  EXPECT_EQ(0u, protocol_->replyLength(empty));
  EXPECT_EQ(Kind::Incomplete, parse(hex("00"), &empty).kind);
}

TEST_F(ModbusRtuTest, aRequestOnTheWireIsNoAnswerToAShape)
{
  for (const char* pdu : { "03 0A 00 00 05", "10 00 00 00 01 02 00 01", "2B 0E", "" })
  {
    Parsed frame;
    frame.kind = Kind::Foreign;
    frame.station = 1;
    frame.pdu = hex(pdu);
    EXPECT_EQ("", protocol_->shapeOfReply(frame)) << pdu;
  }
}

TEST_F(ModbusRtuTest, requestsThatReadEquallyMuchHaveEqualShapes)
{
  const auto shape = [this](const char* frame) { return protocol_->shape(requestOf(withCrc(frame))); };
  EXPECT_EQ(shape("01 03 00 00 00 02"), shape("01 03 10 00 00 02"));
  EXPECT_NE(shape("01 03 00 00 00 02"), shape("01 03 00 00 00 03"));
  EXPECT_NE(shape("01 03 00 00 00 02"), shape("02 03 00 00 00 02"));
  EXPECT_EQ(shape("01 10 00 00 00 01 02 00 01"), shape("01 10 00 00 00 01 02 00 00"));
  EXPECT_NE(shape("01 06 00 00 00 01"), shape("01 06 00 00 00 00"));
  EXPECT_NE(shape("01 08 00 00 00 01"), shape("01 08 00 00 00 02"));
}

TEST_F(ModbusRtuTest, onlyALoopBackIsALoopBack)
{
  EXPECT_TRUE(protocol_->isLoopback(requestOf(withCrc("01 08 00 00 00 01"))));
  EXPECT_FALSE(protocol_->isLoopback(requestOf(withCrc("01 03 00 00 00 01"))));
  EXPECT_FALSE(protocol_->isLoopback(Request()));
}
}  // namespace
}  // namespace wire
}  // namespace inverter_bus
