// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include <algorithm>
#include <string>

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

Parsed incomplete(bool own)
{
  Parsed parsed;
  parsed.own = own;
  return parsed;
}

Parsed garbage(std::size_t count)
{
  Parsed parsed;
  parsed.kind = Parsed::Kind::Garbage;
  parsed.consumed = count;
  return parsed;
}

Parsed wholeFrame(Parsed::Kind kind, const std::uint8_t* data, std::size_t length)
{
  Parsed parsed;
  parsed.kind = kind;
  parsed.consumed = length;
  parsed.station = data[0];
  parsed.pdu.assign(data + 1, data + length - modbus::CRC_LENGTH);
  parsed.error_id = modbus::errorIdOf(parsed.pdu);
  return parsed;
}

Parsed ownFrame(Match match, const std::uint8_t* data, std::size_t length)
{
  const bool exception = match == Match::Exception;
  return wholeFrame(exception ? Parsed::Kind::Exception : Parsed::Kind::Reply, data, length);
}

/// First place behind the head where the awaited reply is complete; \p size if nowhere. It is looked for although
/// the bytes in front of it may become a frame yet, so that noise which looks like the beginning of one cannot hide it.
std::size_t findBehindHead(const AwaitedReply& awaited, const std::uint8_t* data, std::size_t size)
{
  std::size_t place = 1;
  while (place < size && !isWhole(awaited.match(data + place, size - place)))
  {
    ++place;
  }
  return place;
}

/// Any frame of a station on this bus, in either direction.
Parsed parseForeign(const std::uint8_t* data, std::size_t size)
{
  if (data[0] > modbus::HIGHEST_STATION)
  {
    return garbage(1);
  }
  if (size == 1)
  {
    return incomplete(false);
  }
  bool more_to_come = false;
  for (const std::size_t length : modbus::possibleLengths(data, size))
  {
    if (length > size && length <= modbus::LONGEST_FRAME)
    {
      more_to_come = true;
    }
    else if (length != 0 && length <= size && modbus::crcFits(data, length))
    {
      return wholeFrame(Parsed::Kind::Foreign, data, length);
    }
  }
  return more_to_come ? incomplete(false) : garbage(1);
}

Parsed parseAwaiting(const AwaitedReply& awaited, const std::uint8_t* data, std::size_t size)
{
  const Match head = awaited.match(data, size);
  if (isWhole(head))
  {
    return ownFrame(head, data, awaited.length(head));
  }
  // Not looked at otherwise before it is complete: the beginning of a long reply passes for a shorter frame with a
  // fitting CRC once in 65536 times.
  if (head == Match::Begun)
  {
    return incomplete(true);
  }
  Parsed other = parseForeign(data, size);
  if (other.kind == Parsed::Kind::Foreign)
  {
    return other;
  }
  const std::size_t place = findBehindHead(awaited, data, size);
  return place < size ? garbage(place) : other;
}

std::string toShape(const Bytes& bytes)
{
  return std::string(bytes.begin(), bytes.end());
}

class ModbusRtu : public Protocol
{
public:
  Bytes frame(const Request& request) override
  {
    Bytes frame(1 + request.pdu.size());
    frame[0] = request.broadcast ? std::uint8_t{ 0 } : request.station;
    std::copy(request.pdu.begin(), request.pdu.end(), frame.begin() + 1);
    const std::uint16_t crc = modbusCrc(frame.data(), frame.size());
    frame.push_back(static_cast<std::uint8_t>(crc & 0xFF));
    frame.push_back(static_cast<std::uint8_t>(crc >> 8));
    return frame;
  }

  Parsed parse(const std::uint8_t* data, std::size_t size, const Request* request) const override
  {
    if (size == 0)
    {
      return incomplete(false);
    }
    const bool awaiting = request != nullptr && !request->broadcast;
    return awaiting ? parseAwaiting(AwaitedReply(*request, modbus::CRC_LENGTH), data, size) : parseForeign(data, size);
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
    return toShape(modbus::replyHead(request));
  }

  std::string shapeOfReply(const Parsed& reply) const override
  {
    return toShape(modbus::replyShape(reply.station, reply.pdu));
  }

  bool isLoopback(const Request& request) const override
  {
    return !request.broadcast && !request.pdu.empty() && request.pdu[0] == modbus::LOOPBACK;
  }

  double gapCharacters() const override
  {
    return 3.5;
  }
};
}  // namespace

std::unique_ptr<Protocol> makeModbusRtu()
{
  return std::make_unique<ModbusRtu>();
}
}  // namespace wire
}  // namespace inverter_bus
