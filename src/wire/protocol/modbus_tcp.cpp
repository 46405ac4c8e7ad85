// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include <algorithm>
#include <string>

#include "inverter_bus/wire/gateway_record.h"
#include "inverter_bus/wire/protocol.h"
#include "wire/protocol/modbus_awaited_reply.h"
#include "wire/protocol/modbus_frames.h"

namespace inverter_bus
{
namespace wire
{
namespace
{
using modbus::AwaitedReply;
using modbus::Match;

/// Transaction number, protocol number and length, two bytes each; the length counts what follows.
constexpr std::size_t HEADER_LENGTH = 6;
/// Unit and function.
constexpr std::size_t SHORTEST_BODY = 2;
/// Unit, function and code of an exception.
constexpr std::size_t EXCEPTION_BODY = 3;
/// Unit and the longest PDU.
constexpr std::size_t LONGEST_BODY = modbus::LONGEST_FRAME - modbus::CRC_LENGTH;
/// Numbers run from 1 to this: one that a gateway has put to 0 differs from all of them.
constexpr std::uint64_t HIGHEST_NUMBER = 0xFFFF;
/// Numbers that the last requests had: a frame with one of them is late, with any other it is foreign.
constexpr std::uint64_t REMEMBERED_NUMBERS = 1000;
/// Silences of 3.5 characters on the line behind: before the request, before the reply and after it.
constexpr double GATEWAY_GAP_CHARACTERS = 3 * 3.5;

std::uint16_t word(const std::uint8_t* data)
{
  return static_cast<std::uint16_t>(data[0] << 8 | data[1]);
}

Bytes header(std::uint16_t transaction, std::size_t body_length)
{
  return { static_cast<std::uint8_t>(transaction >> 8), static_cast<std::uint8_t>(transaction & 0xFF), 0, 0,
           static_cast<std::uint8_t>(body_length >> 8), static_cast<std::uint8_t>(body_length & 0xFF) };
}

/// False if \p size bytes at \p data cannot become a header.
bool mayBeHeader(const std::uint8_t* data, std::size_t size)
{
  const bool protocol_fits = std::all_of(data + std::min<std::size_t>(size, 2), data + std::min<std::size_t>(size, 4),
                                         [](std::uint8_t byte) { return byte == 0; });
  const std::size_t length = size < HEADER_LENGTH ? SHORTEST_BODY : word(data + 4);
  return protocol_fits && (size < 5 || data[4] == 0) && length >= SHORTEST_BODY && length <= LONGEST_BODY;
}

Parsed wholeFrame(const std::uint8_t* data, std::size_t length)
{
  Parsed parsed;
  parsed.kind = Parsed::Kind::Foreign;
  parsed.consumed = length;
  parsed.transaction = word(data);
  parsed.station = data[HEADER_LENGTH];
  parsed.pdu.assign(data + HEADER_LENGTH + 1, data + length);
  parsed.error_id = modbus::errorIdOf(parsed.pdu);
  return parsed;
}

/// Length of the body of the frame at \p data, the header at least. Some gateways count one byte too many or too few in
/// exceptions.
std::size_t bodyLength(const std::uint8_t* data, std::size_t size)
{
  const std::size_t stated = word(data + 4);
  const bool exception = size > HEADER_LENGTH + 1 && (data[HEADER_LENGTH + 1] & modbus::EXCEPTION_FLAG) != 0;
  if (!exception || stated + 1 < EXCEPTION_BODY || stated > EXCEPTION_BODY + 1)
  {
    return stated;
  }
  // Unless it really has no code: the next frame must not be swallowed.
  const std::size_t end = HEADER_LENGTH + stated;
  const bool ends_there = stated < EXCEPTION_BODY && size > end + HEADER_LENGTH &&
                          mayBeHeader(data + end, size - end) && !mayBeHeader(data + end + 1, size - end - 1);
  return ends_there ? stated : EXCEPTION_BODY;
}

/// How the bytes of a frame's body that have arrived compare with the awaited reply.
Match matchBody(const Request& request, const std::uint8_t* data, std::size_t size, std::size_t body_length)
{
  const std::uint8_t unit = data[HEADER_LENGTH];
  if (unitHabit(request.station, unit) == UnitHabit::None)
  {
    return Match::None;
  }
  const AwaitedReply awaited(request, unit, 0);
  const Match match = awaited.match(data + HEADER_LENGTH, std::min(size - HEADER_LENGTH, body_length));
  return modbus::isWhole(match) && awaited.length(match) != body_length ? Match::None : match;
}

class ModbusTcp : public Protocol
{
public:
  Bytes frame(const Request& request) override
  {
    ++framed_;
    const std::size_t body_length = 1 + request.pdu.size();
    Bytes frame = header(lastNumber(), body_length);
    frame.push_back(request.broadcast ? std::uint8_t{ 0 } : request.station);
    frame.insert(frame.end(), request.pdu.begin(), request.pdu.end());
    return frame;
  }

  Parsed parse(const std::uint8_t* data, std::size_t size, const Request* request) const override
  {
    Parsed parsed;
    if (!mayBeHeader(data, size))
    {
      // TCP damages nothing: the beginning of this frame was taken for lost before.
      parsed.kind = Parsed::Kind::Garbage;
      parsed.consumed = 1;
      return parsed;
    }
    if (size <= HEADER_LENGTH)
    {
      return parsed;
    }
    const std::size_t body_length = bodyLength(data, size);
    const bool waiting = request != nullptr && !request->broadcast;
    const bool awaited = waiting && numberHabit(lastNumber(), word(data)) != NumberHabit::None;
    const Match match = awaited ? matchBody(*request, data, size, body_length) : Match::None;
    if (size < HEADER_LENGTH + body_length)
    {
      parsed.own = match == Match::Begun;
      return parsed;
    }
    parsed = wholeFrame(data, HEADER_LENGTH + body_length);
    parsed.kind = modbus::isWhole(match) ? kindOfMatch(match) : kindOfUnasked(parsed.transaction, waiting);
    return parsed;
  }

  std::size_t requestLength(const Request& request) const override
  {
    return 1 + request.pdu.size() + modbus::CRC_LENGTH;
  }

  std::size_t replyLength(const Request& request) const override
  {
    return request.broadcast ? 0 : modbus::replyLength(request);
  }

  std::string shape(const Request& request) const override
  {
    const Bytes head = modbus::replyHead(request);
    return std::string(head.begin() + 1, head.end());
  }

  std::string shapeOfReply(const Parsed& reply) const override
  {
    const Bytes shape = modbus::replyShape(reply.station, reply.pdu);
    return shape.empty() ? std::string() : std::string(shape.begin() + 1, shape.end());
  }

  std::uint16_t lastNumber() const override
  {
    return framed_ == 0 ? std::uint16_t{ 0 } : static_cast<std::uint16_t>((framed_ - 1) % HIGHEST_NUMBER + 1);
  }

  double gapCharacters() const override
  {
    return 0.0;
  }

  double gatewayGapCharacters() const override
  {
    return GATEWAY_GAP_CHARACTERS;
  }

private:
  static Parsed::Kind kindOfMatch(Match match)
  {
    return match == Match::Reply ? Parsed::Kind::Reply : Parsed::Kind::Exception;
  }

  /// A frame that is not the awaited reply by its content. \p waiting a request waits for one.
  Parsed::Kind kindOfUnasked(std::uint16_t number, bool waiting) const
  {
    const std::uint64_t back = (lastNumber() + HIGHEST_NUMBER - number) % HIGHEST_NUMBER;
    const bool ours = number != 0 && back >= (waiting ? 1U : 0U) && back < std::min(framed_, REMEMBERED_NUMBERS);
    return ours ? Parsed::Kind::Late : Parsed::Kind::Foreign;
  }

  /// Requests so far.
  std::uint64_t framed_ = 0;
};
}  // namespace

std::unique_ptr<Protocol> makeModbusTcp()
{
  return std::make_unique<ModbusTcp>();
}
}  // namespace wire
}  // namespace inverter_bus
