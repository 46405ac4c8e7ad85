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

Request command(std::uint8_t station, const std::string& text)
{
  Request request;
  request.station = station;
  request.pdu = ascii(text);
  return request;
}

struct Command
{
  const char* name;
  std::uint8_t station;
  bool broadcast;
  const char* text;
  const char* frame;

  Request request() const
  {
    Request request = command(station, text);
    request.broadcast = broadcast;
    return request;
  }
};

std::ostream& operator<<(std::ostream& stream, const Command& golden)
{
  return stream << golden.name;
}

// Commands as I548-E1 and the manuals of sister devices print them, or computed from the form printed there.
const Command COMMANDS[] = {
  { "Q1", 0, false, "0503", "02 30 30 30 30 30 30 35 30 33 03 35" },
  { "Q2", 1, false, "0503", "02 30 31 30 30 30 30 35 30 33 03 34" },
  { "Q3", 1, false, "0101C00001000001", "02 30 31 30 30 30 30 31 30 31 43 30 30 30 30 31 30 30 30 30 30 31 03 41" },
  { "Q4", 1, false, "0101C00001000002", "02 30 31 30 30 30 30 31 30 31 43 30 30 30 30 31 30 30 30 30 30 32 03 42" },
  { "Q5", 1, false, "0101C00000000000", "02 30 31 30 30 30 30 31 30 31 43 30 30 30 30 30 30 30 30 30 30 30 03 41" },
  { "Q6", 1, false, "0102C100000000010000012C",
    "02 30 31 30 30 30 30 31 30 32 43 31 30 30 30 30 30 30 30 30 30 31 30 30 30 30 30 31 32 43 03 32" },
  { "Q7", 1, false, "0102C10000000001000004B0",
    "02 30 31 30 30 30 30 31 30 32 43 31 30 30 30 30 30 30 30 30 30 31 30 30 30 30 30 34 42 30 03 34" },
  { "Q8", 1, false, "0102C300060000020000025800000000",
    "02 30 31 30 30 30 30 31 30 32 43 33 30 30 30 36 30 30 30 30 30 32 30 30 30 30 30 32 35 38 30 30 30 30 30 30 30 30 "
    "03 4A" },
  { "Q9", 1, false, "0601", "02 30 31 30 30 30 30 36 30 31 03 35" },
  { "Q10", 1, false, "0801123", "02 30 31 30 30 30 30 38 30 31 31 32 33 03 0B" },
  { "Q11", 1, false, "0801ABCDEFGHIJKLMNOPQRSTUVW",
    "02 30 31 30 30 30 30 38 30 31 41 42 43 44 45 46 47 48 49 4A 4B 4C 4D 4E 4F 50 51 52 53 54 55 56 57 03 7B" },
  { "Q12", 1, false, "30050100", "02 30 31 30 30 30 33 30 30 35 30 31 30 30 03 35" },
  { "Q13", 1, false, "30050101", "02 30 31 30 30 30 33 30 30 35 30 31 30 31 03 34" },
  { "Q14", 1, false, "30050401", "02 30 31 30 30 30 33 30 30 35 30 34 30 31 03 31" },
  { "B1", 0, true, "0102C1000000000100000000",
    "02 58 58 30 30 30 30 31 30 32 43 31 30 30 30 30 30 30 30 30 30 31 30 30 30 30 30 30 30 30 03 43" },
  { "B2", 0, true, "30050101", "02 58 58 30 30 30 33 30 30 35 30 31 30 31 03 35" },
  { "Q17", 99, false, "0101C3000B000001", "02 39 39 30 30 30 30 31 30 31 43 33 30 30 30 42 30 30 30 30 30 31 03 30" },
};

struct Response
{
  const char* name;
  /// Text of the command to station 1 that it answers.
  const char* command;
  const char* frame;
  Kind kind;
  const char* text;
  int error_id;
};

std::ostream& operator<<(std::ostream& stream, const Response& golden)
{
  return stream << golden.name;
}

// Values 0, 1 and 2 have the BCC 02 (STX), 03 (ETX) and 00.
const Response RESPONSES[] = {
  { "R2", "0503", "02 30 31 30 30 30 30 30 35 30 33 30 30 30 30 33 47 33 4A 45 32 30 32 42 46 30 30 32 38 03 72",
    Kind::Reply, "050300003G3JE202BF0028", 0 },
  { "R3", "0101C00001000001", "02 30 31 30 30 30 30 30 31 30 31 30 30 30 30 30 30 30 30 30 31 46 34 03 71", Kind::Reply,
    "01010000000001F4", 0 },
  { "R3z", "0101C00001000001", "02 30 31 30 30 30 30 30 31 30 31 30 30 30 30 30 30 30 30 30 30 30 30 03 02",
    Kind::Reply, "0101000000000000", 0 },
  { "R3o", "0101C00001000001", "02 30 31 30 30 30 30 30 31 30 31 30 30 30 30 30 30 30 30 30 30 30 31 03 03",
    Kind::Reply, "0101000000000001", 0 },
  { "R3t", "0101C00001000001", "02 30 31 30 30 30 30 30 31 30 31 30 30 30 30 30 30 30 30 30 30 30 32 03 00",
    Kind::Reply, "0101000000000002", 0 },
  { "R3n", "0101C00001000001", "02 30 31 30 30 30 30 30 31 30 31 30 30 30 30 46 46 46 46 46 46 46 46 03 02",
    Kind::Reply, "01010000FFFFFFFF", 0 },
  { "R4", "0101C00001000002",
    "02 30 31 30 30 30 30 30 31 30 31 30 30 30 30 30 30 30 30 30 31 32 43 30 30 30 30 30 30 30 41 03 03", Kind::Reply,
    "010100000000012C0000000A", 0 },
  { "R5", "0101C00000000000", "02 30 31 30 30 30 30 30 31 30 31 30 30 30 30 03 02", Kind::Reply, "01010000", 0 },
  { "R6", "0102C100000000010000012C", "02 30 31 30 30 30 30 30 31 30 32 30 30 30 30 03 01", Kind::Reply, "01020000",
    0 },
  { "R9", "0601", "02 30 31 30 30 30 30 30 36 30 31 30 30 30 30 30 30 30 30 03 05", Kind::Reply, "060100000000", 0 },
  { "R9b", "0601", "02 30 31 30 30 30 30 30 36 30 31 30 30 30 30 30 31 30 30 03 04", Kind::Reply, "060100000100", 0 },
  { "R10", "0801123", "02 30 31 30 30 30 30 30 38 30 31 30 30 30 30 31 32 33 03 3B", Kind::Reply, "08010000123", 0 },
  { "R11", "0801ABCDEFGHIJKLMNOPQRSTUVW",
    "02 30 31 30 30 30 30 30 38 30 31 30 30 30 30 41 42 43 44 45 46 47 48 49 4A 4B 4C 4D 4E 4F 50 51 52 53 54 55 56 57 "
    "03 4B",
    Kind::Reply, "08010000ABCDEFGHIJKLMNOPQRSTUVW", 0 },
  { "R12", "30050100", "02 30 31 30 30 30 30 33 30 30 35 30 30 30 30 03 04", Kind::Reply, "30050000", 0 },
  { "E1", "0101C00001000001", "02 30 31 30 30 30 46 30 31 30 31 31 31 30 33 03 77", Kind::Exception, "01011103",
    0x1103 },
  { "E2", "0101C00001000001", "02 30 31 30 30 30 46 30 31 30 31 31 31 30 42 03 06", Kind::Exception, "0101110B",
    0x110B },
  { "E3", "0102C100000000010000012C", "02 30 31 30 30 30 46 30 31 30 32 31 31 30 30 03 77", Kind::Exception, "01021100",
    0x1100 },
  { "E4", "0102C100000000010000012C", "02 30 31 30 30 30 46 30 31 30 32 33 30 30 33 03 77", Kind::Exception, "01023003",
    0x3003 },
  { "E5", "30050100", "02 30 31 30 30 30 46 33 30 30 35 32 32 30 33 03 71", Kind::Exception, "30052203", 0x2203 },
  { "E6", "0104C0000100C0000200", "02 30 31 30 30 30 46 30 31 30 34 30 34 30 31 03 74", Kind::Exception, "01040401",
    0x0401 },
  { "E7", "0101C00001000001", "02 30 31 30 30 31 33 03 00", Kind::NotUnderstood, "", 0x0013 },
  { "E8", "0101C00001000001", "02 30 31 30 30 31 30 03 03", Kind::NotUnderstood, "", 0x0010 },
  { "E9", "0101C00001000001", "02 30 31 30 30 31 38 03 0B", Kind::Exception, "", 0x0018 },
  { "E10", "0101C00001000001", "02 30 31 30 30 31 34 03 07", Kind::Exception, "", 0x0014 },
  { "E11", "0101C00001000001", "02 30 31 30 41 31 36 03 74", Kind::Exception, "", 0x0016 },
};

class CompowayTest : public testing::Test
{
protected:
  Parsed parse(const Bytes& bytes, const Request* request = nullptr) const
  {
    return protocol_->parse(bytes.data(), bytes.size(), request);
  }

  const std::unique_ptr<Protocol> protocol_ = makeCompowayF();
};

class GoldenCommand : public CompowayTest, public testing::WithParamInterface<Command>
{
};

TEST_P(GoldenCommand, isBuiltAsPrinted)
{
  const Request request = GetParam().request();
  EXPECT_EQ(hex(GetParam().frame), protocol_->frame(request));
  EXPECT_EQ(hex(GetParam().frame).size(), protocol_->requestLength(request));
}

TEST_P(GoldenCommand, isNotItsOwnReply)
{
  const Request request = GetParam().request();
  const Bytes frame = hex(GetParam().frame);
  const Parsed parsed = parse(frame, &request);
  EXPECT_EQ(Kind::Foreign, parsed.kind);
  EXPECT_EQ(frame.size(), parsed.consumed);
  EXPECT_EQ(GetParam().station, parsed.station);
}

INSTANTIATE_TEST_SUITE_P(manuals, GoldenCommand, testing::ValuesIn(COMMANDS));

class GoldenResponse : public CompowayTest, public testing::WithParamInterface<Response>
{
protected:
  const Request request_ = command(1, GetParam().command);
  const Bytes frame_ = hex(GetParam().frame);
};

TEST_P(GoldenResponse, isUnderstoodAsPrinted)
{
  const Parsed parsed = parse(frame_, &request_);
  EXPECT_EQ(GetParam().kind, parsed.kind);
  EXPECT_EQ(frame_.size(), parsed.consumed);
  EXPECT_EQ(1, parsed.station);
  EXPECT_EQ(ascii(GetParam().text), parsed.pdu);
  EXPECT_EQ(GetParam().error_id, parsed.error_id);
  const bool normal = GetParam().kind == Kind::Reply;
  EXPECT_EQ(normal ? frame_.size() : protocol_->replyLength(request_), protocol_->replyLength(request_));
}

TEST_P(GoldenResponse, isWaitedForUntilItsBccIsThere)
{
  const bool has_text = frame_.size() > 9;
  for (std::size_t size = 0; size < frame_.size(); ++size)
  {
    const Parsed parsed = protocol_->parse(frame_.data(), size, &request_);
    EXPECT_EQ(Kind::Incomplete, parsed.kind) << size;
    EXPECT_EQ(0u, parsed.consumed) << size;
    EXPECT_EQ(has_text && size >= 11, parsed.own) << size;
  }
}

TEST_P(GoldenResponse, isRefusedWithAnyBitWrong)
{
  for (std::size_t bit = 0; bit < 8 * frame_.size(); ++bit)
  {
    Bytes wrong = frame_;
    wrong[bit / 8] = static_cast<std::uint8_t>(wrong[bit / 8] ^ (1u << (bit % 8)));
    const Kind kind = parse(wrong, &request_).kind;
    EXPECT_TRUE(kind == Kind::Garbage || kind == Kind::Incomplete) << bit;
  }
}

TEST_P(GoldenResponse, isForeignToEverybodyElse)
{
  const Request other_station = command(2, GetParam().command);
  const Request other_service = command(1, "0999");
  Request broadcast = request_;
  broadcast.broadcast = true;
  for (const Request* request : { static_cast<const Request*>(nullptr), &other_station, &other_service,
                                  static_cast<const Request*>(&broadcast) })
  {
    // A response without text tells no service.
    if (request != &other_service || *GetParam().text != 0)
    {
      const Parsed parsed = parse(frame_, request);
      EXPECT_EQ(Kind::Foreign, parsed.kind);
      EXPECT_EQ(frame_.size(), parsed.consumed);
    }
  }
}

TEST_P(GoldenResponse, answersTheShapeOfItsCommand)
{
  const std::string shape = protocol_->shape(request_);
  for (const Request* request : { static_cast<const Request*>(nullptr), &request_ })
  {
    const std::string answered = protocol_->shapeOfReply(parse(frame_, request));
    ASSERT_FALSE(answered.empty());
    EXPECT_EQ(GetParam().kind == Kind::Reply ? shape : shape.substr(0, answered.size()), answered);
  }
}

INSTANTIATE_TEST_SUITE_P(manuals, GoldenResponse, testing::ValuesIn(RESPONSES));

TEST_F(CompowayTest, malformedCommandsOfTheManualHaveAFittingBcc)
{
  for (const char* frame : { "02 30 31 30 30 30 03 32", "02 30 31 30 41 03 73" })
  {
    const Parsed parsed = parse(hex(frame));
    EXPECT_EQ(Kind::Foreign, parsed.kind);
    EXPECT_EQ(hex(frame).size(), parsed.consumed);
    EXPECT_EQ(1, parsed.station);
    EXPECT_EQ("", protocol_->shapeOfReply(parsed));
  }
}

struct Mismatch
{
  const char* what;
  const char* command;
  const char* reply;
};

std::ostream& operator<<(std::ostream& stream, const Mismatch& mismatch)
{
  return stream << mismatch.what;
}

/// The frame with \p body between STX and ETX.
Bytes withBcc(const std::string& body)
{
  std::uint8_t bcc = 0x03;
  for (const char character : body)
  {
    bcc = static_cast<std::uint8_t>(bcc ^ static_cast<std::uint8_t>(character));
  }
  return hex("02") + ascii(body) + Bytes{ 0x03, bcc };
}

const Mismatch MISMATCHES[] = {
  { "other node", "0101C00001000001", "02000001010000000001F4" },
  { "other sub-address", "0101C00001000001", "01010001010000000001F4" },
  { "other service", "0101C00001000001", "01000001020000" },
  { "other service with data", "0101C00001000001", "01000006010000000001F4" },
  { "fewer elements", "0101C00001000002", "01000001010000000001F4" },
  { "more elements", "0101C00001000001", "01000001010000000001F4000001F4" },
  { "no element", "0101C00001000001", "01000001010000" },
  { "an element that was not asked for", "0101C00001000000", "01000001010000000001F4" },
  { "half an element", "0101C00001000001", "010000010100000001" },
  { "lower case", "0101C00001000001", "01000001010000000001f4" },
  { "no hexadecimal digit", "0101C00001000001", "01000001010000000001G4" },
  { "data behind a write", "0102C10000000001000001F4", "01000001020000000001F4" },
  { "data behind an operation", "30050101", "0100003005000001" },
  { "other echoback data", "0801123", "01000008010000124" },
  { "shorter echoback data", "0801123", "0100000801000012" },
  { "attributes cut short", "0503", "010000050300003G3JE202BF002" },
  { "response code with a normal end", "0101C00001000001", "01000001011103" },
  { "command error without response code", "0101C00001000001", "01000F01010000" },
  { "command error with data", "0101C00001000001", "01000F01011103000001F4" },
  { "command error of another service", "0101C00001000001", "01000F01021100" },
  { "command error without text", "0101C00001000001", "01000F" },
  { "normal end without text", "0101C00001000001", "010000" },
  { "text behind another end code", "0101C00001000001", "01001301010000" },
  { "end code that is none", "0101C00001000001", "0100G1" },
  { "node cut short", "0101C00001000001", "01000" },
};

class MismatchedResponse : public CompowayTest, public testing::WithParamInterface<Mismatch>
{
};

TEST_P(MismatchedResponse, isForeign)
{
  const Request request = command(1, GetParam().command);
  const Bytes reply = withBcc(GetParam().reply);
  const Parsed parsed = parse(reply, &request);
  EXPECT_EQ(Kind::Foreign, parsed.kind);
  EXPECT_EQ(reply.size(), parsed.consumed);
}

INSTANTIATE_TEST_SUITE_P(fields, MismatchedResponse, testing::ValuesIn(MISMATCHES));

TEST_F(CompowayTest, stationZeroIsAUnitLikeAnyOther)
{
  const Request request = command(0, "0503");
  EXPECT_EQ(hex("02 30 30 30 30 30 30 35 30 33 03 35"), protocol_->frame(request));
  const Bytes reply = withBcc("000000050300003G3JE202BF0028");
  EXPECT_EQ(Kind::Reply, parse(reply, &request).kind);
}

TEST_F(CompowayTest, everyEndCodeIsARefusalOrADamage)
{
  const Request request = command(1, "0101C00001000001");
  for (const char* damage : { "10", "11", "12", "13" })
  {
    EXPECT_EQ(Kind::NotUnderstood, parse(withBcc("0100" + std::string(damage)), &request).kind);
  }
  for (const char* refusal : { "0E", "14", "15", "16", "18", "22", "FF" })
  {
    const Parsed parsed = parse(withBcc("0100" + std::string(refusal)), &request);
    EXPECT_EQ(Kind::Exception, parsed.kind);
    EXPECT_EQ(std::stoi(refusal, nullptr, 16), parsed.error_id);
    EXPECT_TRUE(parsed.pdu.empty());
  }
}

TEST_F(CompowayTest, lengthsOfRepliesAreThoseOfTheManual)
{
  EXPECT_EQ(25u, protocol_->replyLength(command(1, "0101C00001000001")));
  EXPECT_EQ(33u, protocol_->replyLength(command(1, "0101C00001000002")));
  EXPECT_EQ(17u, protocol_->replyLength(command(1, "0102C10000000001000001F4")));
  EXPECT_EQ(31u, protocol_->replyLength(command(1, "0503")));
  EXPECT_EQ(21u, protocol_->replyLength(command(1, "0601")));
  EXPECT_EQ(20u, protocol_->replyLength(command(1, "0801123")));
  EXPECT_EQ(17u, protocol_->replyLength(command(1, "30050101")));
  EXPECT_EQ(40u, protocol_->replyLength(command(1, "0999"))) << "unknown: the drive's buffer";
  Request broadcast = command(0, "0101C00001000001");
  broadcast.broadcast = true;
  EXPECT_EQ(0u, protocol_->replyLength(broadcast));
}

TEST_F(CompowayTest, malformedCommandsHarmNothing)
{
  for (const char* text : { "", "0", "0101", "0101C0", "0101C0000100ZZZZ" })
  {
    const Request request = command(1, text);
    EXPECT_EQ(protocol_->requestLength(request), protocol_->frame(request).size());
    EXPECT_LE(protocol_->replyLength(request), 40u);
    EXPECT_NE(Kind::Reply, parse(withBcc("01000001010000000001F4"), &request).kind);
    EXPECT_FALSE(protocol_->isLoopback(request));
  }
}

TEST_F(CompowayTest, requestsOfOneServiceHaveEqualShapes)
{
  const auto shape = [this](std::uint8_t station, const char* text) {
    return protocol_->shape(command(station, text));
  };
  EXPECT_EQ(shape(1, "0101C00001000001"), shape(1, "0101C30006000002")) << "a reply tells neither address nor type";
  EXPECT_NE(shape(1, "0101C00001000001"), shape(2, "0101C00001000001"));
  EXPECT_NE(shape(1, "0101C00001000001"), shape(1, "0102C10000000001000001F4"));
  EXPECT_EQ(shape(1, "30050100"), shape(1, "30050101"));
  EXPECT_NE(shape(1, "08010001"), shape(1, "08010002"));
}

TEST_F(CompowayTest, onlyAnEchobackWithDataIsALoopback)
{
  EXPECT_TRUE(protocol_->isLoopback(command(1, "0801123")));
  EXPECT_FALSE(protocol_->isLoopback(command(1, "0801"))) << "its reply carries nothing of its own";
  EXPECT_FALSE(protocol_->isLoopback(command(1, "0503")));
  Request broadcast = command(0, "0801123");
  broadcast.broadcast = true;
  EXPECT_FALSE(protocol_->isLoopback(broadcast));
}

TEST_F(CompowayTest, whatLeavesNoRoomForEtxAndBccIsNoFrame)
{
  EXPECT_EQ(Kind::Incomplete, parse(hex("02") + Bytes(37, '0')).kind);
  const Parsed parsed = parse(hex("02") + Bytes(38, '0'));
  EXPECT_EQ(Kind::Garbage, parsed.kind);
  EXPECT_EQ(39u, parsed.consumed);
  // The longest frame, and one that is a character longer though its BCC fits.
  EXPECT_EQ(Kind::Foreign, parse(withBcc("01" + std::string(35, '0'))).kind);
  EXPECT_EQ(Kind::Garbage, parse(withBcc("01" + std::string(36, '0'))).kind);
}

TEST_F(CompowayTest, randomBytesAreConsumedAndNeverAccepted)
{
  std::mt19937 random(1);
  // Characters of frames, so that some come near to one.
  const Bytes alphabet = ascii("0123456789ABCDEF0101") + hex("02 02 03 03 00 FF 7F");
  std::uniform_int_distribution<std::size_t> pick(0, alphabet.size() - 1);
  std::uniform_int_distribution<int> any(0, 255);
  const Request request = command(1, "0101C00001000001");
  for (int round = 0; round < 200; ++round)
  {
    Bytes bytes(1000);
    for (std::uint8_t& byte : bytes)
    {
      byte = round % 2 == 0 ? alphabet[pick(random)] : static_cast<std::uint8_t>(any(random));
    }
    while (bytes.size() >= 40)
    {
      const Parsed parsed = parse(bytes, round % 3 == 0 ? nullptr : &request);
      ASSERT_NE(Kind::Incomplete, parsed.kind) << "no frame is longer than 40 bytes";
      ASSERT_GE(parsed.consumed, 1u);
      ASSERT_LE(parsed.consumed, bytes.size());
      if (parsed.kind != Kind::Garbage)
      {
        // STX, body, ETX and the XOR of body and ETX, in 40 bytes at most.
        ASSERT_LE(parsed.consumed, 40u);
        ASSERT_EQ(0x02, bytes[0]);
        ASSERT_EQ(0x03, bytes[parsed.consumed - 2]);
        const std::string body(bytes.begin() + 1, bytes.begin() + static_cast<std::ptrdiff_t>(parsed.consumed) - 2);
        ASSERT_EQ(withBcc(body).back(), bytes[parsed.consumed - 1]);
      }
      bytes.erase(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(parsed.consumed));
    }
  }
}

/// The stream cases, on a whole line at 9600 7E2: a character takes 1.15 ms, a read 27.5 ms.
class CompowayLine : public LineFixture
{
protected:
  CompowayLine() : LineFixture(makeCompowayF(), { 9600, 11 })
  {
    read_.response_timeout = milliseconds(150);
  }

  Reply exchange(const Request& request)
  {
    EXPECT_TRUE(line_.settle());
    return line_.exchange(request);
  }

  Reply answeredBy(const Bytes& bytes)
  {
    answerNextRaw(bytes, 80);
    return exchange(read_);
  }

  std::string valueOf(const Reply& reply) const
  {
    return reply.outcome == Outcome::Ok ? std::string(reply.pdu.begin() + 8, reply.pdu.end()) : "none";
  }

  const Bytes R3 = hex("02 30 31 30 30 30 30 30 31 30 31 30 30 30 30 30 30 30 30 30 31 46 34 03 71");
  const Bytes R3Z = hex("02 30 31 30 30 30 30 30 31 30 31 30 30 30 30 30 30 30 30 30 30 30 30 03 02");
  const Bytes R3O = hex("02 30 31 30 30 30 30 30 31 30 31 30 30 30 30 30 30 30 30 30 30 30 31 03 03");
  const Bytes R6 = hex("02 30 31 30 30 30 30 30 31 30 32 30 30 30 30 03 01");
  const Bytes R9 = hex("02 30 31 30 30 30 30 30 36 30 31 30 30 30 30 30 30 30 30 03 05");
  const Bytes E7 = hex("02 30 31 30 30 31 33 03 00");
  const Bytes Q3 = hex("02 30 31 30 30 30 30 31 30 31 43 30 30 30 30 31 30 30 30 30 30 31 03 41");
  Request read_ = command(1, "0101C00001000001");
};

TEST_F(CompowayLine, readsAValue)
{
  const Reply reply = answeredBy(R3);
  EXPECT_EQ("000001F4", valueOf(reply));
  EXPECT_EQ(ascii("01010000000001F4"), reply.pdu);
  EXPECT_EQ(Q3, port_.sent().at(0));
  EXPECT_EQ("RA", seen());
}

TEST_F(CompowayLine, anStxRestarts)
{
  answerNextRaw(hex("02 30 31 30") + R9, 60);
  const Reply reply = exchange(command(1, "0601"));
  EXPECT_EQ(Outcome::Ok, reply.outcome);
  EXPECT_EQ(ascii("060100000000"), reply.pdu);
  EXPECT_EQ("RDA", seen());
}

TEST_F(CompowayLine, noiseIsSkipped)
{
  EXPECT_EQ("000001F4", valueOf(answeredBy(hex("FF 00 7F") + R3)));
  EXPECT_EQ("000001F4", valueOf(answeredBy(hex("03") + R3)));
  EXPECT_EQ("000001F4", valueOf(answeredBy(hex("02 55 03") + R3))) << "its STX stands where a BCC could";
  EXPECT_EQ("000001F4", valueOf(answeredBy(hex("02 01 03") + R3))) << "where it even fits";
  EXPECT_EQ("RDARDARDARDA", seen());
}

TEST_F(CompowayLine, aBccThatLooksLikeStxEndsItsFrame)
{
  EXPECT_EQ("00000000", valueOf(answeredBy(R3Z + R3)));
  EXPECT_TRUE(line_.settle());
  ASSERT_EQ("RAF", seen()) << "two frames; nobody has asked for the second";
  EXPECT_EQ(R3Z, events_.at(1).bytes);
  EXPECT_EQ(R3, events_.at(2).bytes);
}

TEST_F(CompowayLine, aBccThatLooksLikeEtxEndsItsFrame)
{
  EXPECT_EQ("00000001", valueOf(answeredBy(R3O)));
  EXPECT_TRUE(line_.settle());
  EXPECT_EQ("RA", seen());
}

TEST_F(CompowayLine, aMissingBccMakesNoFrame)
{
  const Reply reply = answeredBy(Bytes(R3.begin(), R3.end() - 1));
  EXPECT_EQ(Outcome::Damaged, reply.outcome);
  EXPECT_EQ(milliseconds(105), reply.finished_at - reply.sent_at) << "the reply had begun: soon given up";
  EXPECT_EQ(1u, line_.counters().corrupt_replies);
}

TEST_F(CompowayLine, aWrongBccMakesNoFrame)
{
  Bytes wrong = R3;
  wrong.back() = 0x70;
  EXPECT_EQ(Outcome::Damaged, answeredBy(wrong).outcome);
  EXPECT_EQ("RD", seen());
}

TEST_F(CompowayLine, aWrongBccDoesNotHideTheNextFrame)
{
  Bytes wrong = R3;
  wrong.pop_back();
  EXPECT_EQ("000001F4", valueOf(answeredBy(wrong + R3)));
}

TEST_F(CompowayLine, anotherNodeIsIgnored)
{
  const Bytes other = hex("02 30 32 30 30 30 30 30 31 30 31 30 30 30 30 30 30 30 30 30 31 46 34 03 72");
  port_.answerNext({ { milliseconds(60), other }, { milliseconds(120), R3O } });
  EXPECT_EQ("00000001", valueOf(exchange(read_)));
  EXPECT_EQ("RFA", seen());
}

TEST_F(CompowayLine, anotherServiceIsWaitedOut)
{
  const Reply reply = answeredBy(R6);
  EXPECT_EQ(Outcome::Damaged, reply.outcome);
  EXPECT_EQ(timing_.characters(24) + timing_.gap(3.5) + milliseconds(150), reply.finished_at - reply.sent_at);
  EXPECT_EQ("RF", seen());
}

TEST_F(CompowayLine, theLocalEchoIsRemoved)
{
  for (const std::size_t piece : { std::size_t{ 256 }, std::size_t{ 7 }, std::size_t{ 1 } })
  {
    port_.echo(timing_.characters(1), piece);
    EXPECT_EQ("000001F4", valueOf(answeredBy(R3)));
  }
  EXPECT_TRUE(line_.echoFound());
  EXPECT_EQ("RARARA", seen());
  EXPECT_EQ(3u, line_.counters().echoes);
}

TEST_F(CompowayLine, theLocalEchoOfAnEchobackTestIsNotItsReply)
{
  port_.echo(timing_.characters(1));
  answeredBy(R3);
  EXPECT_EQ(Outcome::Timeout, exchange(command(1, "0801123")).outcome);
  answerNextRaw(hex("02 30 31 30 30 30 30 30 38 30 31 30 30 30 30 31 32 33 03 3B"), 60);
  EXPECT_EQ(Outcome::Ok, exchange(command(1, "0801123")).outcome);
}

TEST_F(CompowayLine, anOversizeFrameIsDiscarded)
{
  const Bytes endless = hex("02") + Bytes(40, '0');
  EXPECT_EQ("000001F4", valueOf(answeredBy(endless + R3)));
  EXPECT_EQ(endless, events_.at(1).bytes);
  EXPECT_EQ(Outcome::Damaged, answeredBy(endless).outcome);
}

TEST_F(CompowayLine, aCommandThatReachedTheDriveDamagedMayBeRepeatedAtOnce)
{
  const Reply reply = answeredBy(E7);
  EXPECT_EQ(Outcome::Damaged, reply.outcome);
  EXPECT_EQ(0x0013, reply.error_id);
  EXPECT_EQ(reply.sent_at + milliseconds(80), reply.finished_at) << "nothing else is waited for";
  EXPECT_TRUE(line_.mayAsk(read_)) << "the drive has answered: no reply is owed";
  EXPECT_EQ("RE", seen());
  EXPECT_EQ(1u, line_.counters().corrupt_replies);
  EXPECT_EQ(0u, line_.counters().replies);
  EXPECT_EQ(0u, line_.counters().exceptions);
}

TEST_F(CompowayLine, aRefusalIsAnException)
{
  const Reply reply = answeredBy(hex("02 30 31 30 30 30 46 30 31 30 31 31 31 30 33 03 77"));
  EXPECT_EQ(Outcome::Exception, reply.outcome);
  EXPECT_EQ(0x1103, reply.error_id);
  EXPECT_EQ(1u, line_.counters().exceptions);
}

TEST_F(CompowayLine, anEndCodeOfUnclearOriginIsNotTaken)
{
  EXPECT_EQ(Outcome::Timeout, exchange(read_).outcome);
  answerNextRaw(E7, 60);
  EXPECT_EQ(Outcome::Timeout, exchange(command(1, "0601")).outcome) << "it may belong to the lost read";
  EXPECT_EQ("RRL", seen());
}

TEST_F(CompowayLine, aLateReplyIsTakenByNoOtherRequest)
{
  answerNextRaw(R3, 260);
  EXPECT_EQ(Outcome::Timeout, exchange(read_).outcome);
  EXPECT_FALSE(line_.mayAsk(read_));
  EXPECT_FALSE(line_.mayAsk(command(1, "0101C30006000002"))) << "every read of this station looks the same";
  answerNextRaw(R9, 100);
  EXPECT_EQ(ascii("060100000000"), exchange(command(1, "0601")).pdu);
  EXPECT_EQ("RRLA", seen());
  EXPECT_TRUE(line_.mayAsk(read_));
}

TEST_F(CompowayLine, anEchobackTestWithFreshDataLiftsTheBar)
{
  exchange(read_);
  EXPECT_FALSE(line_.mayAsk(read_));
  answerNextRaw(hex("02 30 31 30 30 30 30 30 38 30 31 30 30 30 30 31 32 33 03 3B"), 60);
  EXPECT_EQ(Outcome::Ok, exchange(command(1, "0801123")).outcome);
  EXPECT_TRUE(line_.mayAsk(read_));
}

TEST_F(CompowayLine, aBroadcastGoesToXxAndWaitsForNothing)
{
  Request stop = command(0, "30050101");
  stop.broadcast = true;
  EXPECT_EQ(Outcome::Ok, exchange(stop).outcome);
  EXPECT_EQ(hex("02 58 58 30 30 30 33 30 30 35 30 31 30 31 03 35"), port_.sent().at(0));
  EXPECT_EQ("R", seen());
}
}  // namespace
}  // namespace wire
}  // namespace inverter_bus
