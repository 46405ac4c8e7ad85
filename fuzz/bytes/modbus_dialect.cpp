// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
// Modbus application protocol V1.1b3, section 6; Modbus over serial line V1.02, sections 2.5.1 and 6.2 (appendix B).
#include <algorithm>

#include "dialect.h"

namespace inverter_bus
{
namespace fuzz
{
namespace
{
using wire::Bytes;
using wire::Parsed;
using wire::Request;

constexpr std::size_t CRC_SIZE = 2;
constexpr std::size_t HEADER_SIZE = 6;

/// Bit by bit, as the specification's flow chart has it.
Bytes crcOf(const std::uint8_t* data, std::size_t size)
{
  unsigned crc = 0xFFFF;
  for (std::size_t i = 0; i < size; ++i)
  {
    crc ^= data[i];
    for (int shift = 0; shift < 8; ++shift)
    {
      const bool carry = (crc & 1U) != 0;
      crc >>= 1;
      crc ^= carry ? 0xA001U : 0U;
    }
  }
  return { static_cast<std::uint8_t>(crc & 0xFF), static_cast<std::uint8_t>(crc >> 8) };
}

Request makeRequest(std::uint8_t station, Bytes pdu)
{
  Request request;
  request.station = station;
  request.pdu = std::move(pdu);
  request.broadcast = station == 0;
  request.expects_reply = station != 0;
  return request;
}

/// One of every function, most of them golden frames of the drives' manuals.
std::vector<Request> makeRequests()
{
  std::vector<Request> requests{
    makeRequest(1, { 0x03, 0x10, 0x00, 0x00, 0x0A }),
    makeRequest(1, { 0x01, 0x00, 0x06, 0x00, 0x0E }),
    makeRequest(1, { 0x05, 0x00, 0x00, 0xFF, 0x00 }),
    makeRequest(2, { 0x06, 0x00, 0x01, 0x13, 0x88 }),
    makeRequest(1, { 0x08, 0x00, 0x00, 0xAA, 0x55 }),
    makeRequest(5, { 0x0F, 0x00, 0x00, 0x00, 0x06, 0x01, 0x17 }),
    makeRequest(1, { 0x10, 0x00, 0x00, 0x00, 0x02, 0x04, 0x00, 0x01, 0x17, 0x70 }),
    makeRequest(1, { 0x17, 0x18, 0x75, 0x00, 0x05, 0x18, 0x70, 0x00, 0x02, 0x04, 0xC4, 0x00, 0x13, 0x88 }),
    makeRequest(247, { 0x03, 0x00, 0x00, 0x00, 0x7D }),
    makeRequest(1, { 0x03, 0xFE, 0x00, 0x00, 0x01 }),
    makeRequest(2, { 0x02, 0x00, 0x00, 0x00, 0x01 }),
    makeRequest(2, { 0x04, 0x00, 0x00, 0x00, 0x02 }),
    // To everybody.
    makeRequest(0, { 0x10, 0x00, 0x00, 0x00, 0x01, 0x02, 0x00, 0x00 }),
  };
  // Executed without a reply (VF-S15 fault reset).
  requests.push_back(makeRequest(1, { 0x06, 0xFA, 0x00, 0x20, 0x00 }));
  requests.back().expects_reply = false;
  requests.push_back(makeRequest(3, { 0x03, 0x00, 0x20, 0x00, 0x04 }));
  requests.back().quiet_before = seconds(0.01);
  return requests;
}

std::size_t wordAt(const Bytes& bytes, std::size_t place)
{
  return static_cast<std::size_t>(bytes[place] * 256 + bytes[place + 1]);
}

/// The normal reply's PDU with zeros for data; empty: the function is none of ours.
Bytes zeroReply(const Bytes& request)
{
  const std::uint8_t function = request[0];
  if (function == 0x05 || function == 0x06 || function == 0x08)
  {
    return request;
  }
  if (function == 0x0F || function == 0x10)
  {
    return Bytes(request.begin(), request.begin() + 5);
  }
  const std::size_t count = wordAt(request, 3);
  const std::size_t bytes = function <= 0x02 ? count / 8 + (count % 8 != 0 ? 1 : 0) : count * 2;
  Bytes reply(2 + bytes, 0);
  reply[0] = function;
  reply[1] = static_cast<std::uint8_t>(bytes);
  return reply;
}

bool isRead(const Bytes& request)
{
  return request[0] <= 0x04 || request[0] == 0x17;
}

/// Whether \p pdu of \p size bytes is a normal reply to \p request.
bool fits(const Bytes& request, const std::uint8_t* pdu, std::size_t size)
{
  const Bytes zeros = zeroReply(request);
  const std::size_t fixed = isRead(request) ? 2 : zeros.size();
  return size == zeros.size() && std::equal(pdu, pdu + fixed, zeros.begin());
}

std::uint16_t errorId(std::uint8_t function, std::uint8_t code)
{
  // A gateway that got no answer: for the driver a time-out.
  return code == 0x0A || code == 0x0B ? std::uint16_t{ 0x0205 } : static_cast<std::uint16_t>(function * 256 + code);
}

/// The answer in \p body (station and PDU), judged without its checksum.
Dialect::Answer judge(const Request& request, const std::uint8_t* body, std::size_t size)
{
  Dialect::Answer answer;
  if (size < 3 || request.broadcast || body[0] != request.station)
  {
    return answer;
  }
  if (size == 3 && body[1] == request.pdu[0] + 0x80)
  {
    answer.kind = Parsed::Kind::Exception;
    answer.error_id = errorId(body[1], body[2]);
  }
  else if (fits(request.pdu, body + 1, size - 1))
  {
    answer.kind = Parsed::Kind::Reply;
  }
  return answer;
}

class ModbusDialect : public Dialect
{
public:
  const std::vector<Request>& requests() const override
  {
    static const std::vector<Request> REQUESTS = makeRequests();
    return REQUESTS;
  }

  Bytes reply(const Request& request, std::size_t number, const Bytes& fill) const override
  {
    Bytes pdu = zeroReply(request.pdu);
    if (isRead(request.pdu))
    {
      std::copy_n(fill.begin(), std::min(fill.size(), pdu.size() - 2), pdu.begin() + 2);
    }
    return sealPdu(request, pdu, number);
  }

  Bytes refusal(const Request& request, std::size_t number, std::uint8_t code) const override
  {
    return sealPdu(request, { static_cast<std::uint8_t>(request.pdu[0] | 0x80), code }, number);
  }

private:
  Bytes sealPdu(const Request& request, Bytes pdu, std::size_t number) const
  {
    pdu.insert(pdu.begin(), request.station);
    return seal(pdu, number);
  }
};

class ModbusRtuDialect : public ModbusDialect
{
public:
  std::unique_ptr<wire::Protocol> makeProtocol() const override
  {
    return wire::makeModbusRtu();
  }

  bool isFrame(const std::uint8_t* data, std::size_t length) const override
  {
    if (length < 4 || length > 256)
    {
      return false;
    }
    const Bytes crc = crcOf(data, length - CRC_SIZE);
    return std::equal(crc.begin(), crc.end(), data + length - CRC_SIZE);
  }

  Answer answerAt(const Request& request, std::size_t /*number*/, const std::uint8_t* data,
                  std::size_t size) const override
  {
    if (size < 2 || request.broadcast || data[0] != request.station)
    {
      return Answer();
    }
    const bool refused = data[1] >= 0x80;
    const std::size_t length = refused ? 5 : 1 + zeroReply(request.pdu).size() + CRC_SIZE;
    Answer answer = length <= size ? judge(request, data, length - CRC_SIZE) : Answer();
    if (answer.kind != Parsed::Kind::Incomplete && isFrame(data, length))
    {
      answer.length = length;
      return answer;
    }
    return Answer();
  }

  Bytes contentOf(const Bytes& frame) const override
  {
    return Bytes(frame.begin() + 1, frame.end() - CRC_SIZE);
  }

  Bytes seal(const Bytes& bytes, std::size_t /*number*/) const override
  {
    Bytes frame = bytes;
    const Bytes crc = crcOf(frame.data(), frame.size());
    frame.insert(frame.end(), crc.begin(), crc.end());
    return frame;
  }
};

class ModbusTcpDialect : public ModbusDialect
{
public:
  std::unique_ptr<wire::Protocol> makeProtocol() const override
  {
    return wire::makeModbusTcp();
  }

  bool isFrame(const std::uint8_t* data, std::size_t length) const override
  {
    const std::size_t body = length - std::min(length, HEADER_SIZE);
    const bool off_by_one = body == 3 && data[7] >= 0x80 && data[5] + 1 >= 3 && data[5] <= 4;
    return body >= 2 && body <= 254 && data[2] == 0 && data[3] == 0 && data[4] == 0 && (data[5] == body || off_by_one);
  }

  Answer answerAt(const Request& request, std::size_t number, const std::uint8_t* data, std::size_t size) const override
  {
    const std::size_t length = frameAt(data, size);
    if (length < HEADER_SIZE + 2 || !mayNumber(number, data[0] * 256U + data[1]) ||
        !mayName(request, data[HEADER_SIZE]))
    {
      return Answer();
    }
    Bytes body(data + HEADER_SIZE, data + length);
    body[0] = request.station;
    Answer answer = judge(request, body.data(), body.size());
    answer.length = answer.kind == Parsed::Kind::Incomplete ? 0 : length;
    return answer;
  }

  Bytes contentOf(const Bytes& frame) const override
  {
    return Bytes(frame.begin() + HEADER_SIZE + 1, frame.end());
  }

  Bytes seal(const Bytes& bytes, std::size_t number) const override
  {
    Bytes frame{ static_cast<std::uint8_t>(number / 256 % 256), static_cast<std::uint8_t>(number % 256),      0, 0,
                 static_cast<std::uint8_t>(bytes.size() / 256), static_cast<std::uint8_t>(bytes.size() % 256) };
    frame.insert(frame.end(), bytes.begin(), bytes.end());
    return frame;
  }

private:
  /// What gateways were seen to make of the number: itself, 0, one more, its bytes exchanged.
  static bool mayNumber(std::size_t asked, std::size_t replied)
  {
    const std::size_t number = asked % 65536;
    return replied == number || replied == 0 || replied == (number + 1) % 65536 ||
           replied == number % 256 * 256 + number / 256;
  }

  static bool mayName(const Request& request, std::uint8_t unit)
  {
    return unit == request.station || unit == 0 || unit == 1 || unit == 255;
  }

  static bool isHeader(const std::uint8_t* data, std::size_t size)
  {
    const auto zero = [&](std::size_t place) { return place >= size || data[place] == 0; };
    return zero(2) && zero(3) && zero(4) && (size < HEADER_SIZE || (data[5] >= 2 && data[5] <= 254));
  }

  /// Length of the complete frame at the head, 0: none. The stated length of an exception may be one off.
  static std::size_t frameAt(const std::uint8_t* data, std::size_t size)
  {
    if (size < HEADER_SIZE + 2 || !isHeader(data, size))
    {
      return 0;
    }
    std::size_t body = data[5];
    if (data[7] >= 0x80 && body >= 2 && body <= 4)
    {
      const bool another_behind =
          body == 2 && size > 14 && isHeader(data + 8, size - 8) && !isHeader(data + 9, size - 9);
      body = another_behind ? 2 : 3;
    }
    return HEADER_SIZE + body <= size ? HEADER_SIZE + body : 0;
  }
};
}  // namespace

std::unique_ptr<Dialect> makeModbusRtuDialect()
{
  return std::make_unique<ModbusRtuDialect>();
}

std::unique_ptr<Dialect> makeModbusTcpDialect()
{
  return std::make_unique<ModbusTcpDialect>();
}
}  // namespace fuzz
}  // namespace inverter_bus
