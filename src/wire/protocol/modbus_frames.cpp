// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "wire/protocol/modbus_frames.h"

#include <algorithm>
#include <utility>

#include "inverter_bus/wire/protocol.h"

namespace inverter_bus
{
namespace wire
{
namespace modbus
{
namespace
{
/// How the frames of a function are built.
enum class Layout
{
  Unknown,
  /// Reads bits: the reply counts bytes.
  ReadBits,
  /// Reads registers (or writes and reads them): the reply counts bytes.
  ReadRegisters,
  WriteAndReadRegisters,
  /// The reply is the request once more.
  Echo,
  /// The reply repeats address and count.
  WriteSeveral
};

constexpr std::uint8_t READ_REGISTERS_WIDTH = 2;
/// Station, function, byte count, CRC.
constexpr std::size_t COUNTED_REPLY_OVERHEAD = 5;
/// Station, function, two words, CRC: a read request, and everything that is echoed.
constexpr std::size_t TWO_WORD_LENGTH = 8;
/// Function, address, count of a reply to 0F and 10 hex.
constexpr std::size_t ADDRESS_AND_COUNT_PDU = 5;

Layout layoutOf(std::uint8_t function)
{
  switch (function)
  {
    case 0x01:
    case 0x02:
      return Layout::ReadBits;
    case 0x03:
    case 0x04:
      return Layout::ReadRegisters;
    case 0x17:
      return Layout::WriteAndReadRegisters;
    case 0x05:
    case 0x06:
    case LOOPBACK:
      return Layout::Echo;
    case 0x0F:
    case 0x10:
      return Layout::WriteSeveral;
    default:
      return Layout::Unknown;
  }
}

Layout layoutOf(const Bytes& pdu)
{
  return pdu.empty() ? Layout::Unknown : layoutOf(pdu[0]);
}

/// Count of bits or registers that a read asks for.
std::size_t countAsked(const Bytes& pdu)
{
  return pdu.size() < ADDRESS_AND_COUNT_PDU ? 0 : static_cast<std::size_t>(pdu[3] << 8 | pdu[4]);
}

/// Data bytes of the reply to a read.
std::size_t bytesAsked(const Bytes& pdu)
{
  const std::size_t count = countAsked(pdu);
  return layoutOf(pdu) == Layout::ReadBits ? (count + 7) / 8 : READ_REGISTERS_WIDTH * count;
}

bool isException(const Bytes& pdu)
{
  return pdu.size() == 2 && (pdu[0] & EXCEPTION_FLAG) != 0;
}

/// \p overhead and the bytes counted at \p position, or the overhead alone as long as the count has not arrived.
std::size_t countedLength(const std::uint8_t* data, std::size_t size, std::size_t position, std::size_t overhead)
{
  return overhead + (size > position ? data[position] : 0);
}
}  // namespace

bool crcFits(const std::uint8_t* frame, std::size_t size)
{
  if (size <= CRC_LENGTH)
  {
    return false;
  }
  const std::uint16_t crc = modbusCrc(frame, size - CRC_LENGTH);
  return frame[size - 2] == (crc & 0xFF) && frame[size - 1] == crc >> 8;
}

Bytes replyHead(const Request& request)
{
  Bytes head{ request.station };
  const Bytes& pdu = request.pdu;
  const std::size_t repeated = std::min(ADDRESS_AND_COUNT_PDU, pdu.size());
  switch (layoutOf(pdu))
  {
    case Layout::ReadBits:
    case Layout::ReadRegisters:
    case Layout::WriteAndReadRegisters:
      head.push_back(pdu[0]);
      head.push_back(static_cast<std::uint8_t>(bytesAsked(pdu)));
      return head;
    case Layout::WriteSeveral:
      head.insert(head.end(), pdu.begin(), pdu.begin() + static_cast<std::ptrdiff_t>(repeated));
      return head;
    case Layout::Echo:
    case Layout::Unknown:
      head.insert(head.end(), pdu.begin(), pdu.end());
      return head;
  }
  return head;
}

std::size_t replyLength(const Request& request)
{
  switch (layoutOf(request.pdu))
  {
    case Layout::ReadBits:
    case Layout::ReadRegisters:
    case Layout::WriteAndReadRegisters:
      return COUNTED_REPLY_OVERHEAD + bytesAsked(request.pdu);
    case Layout::WriteSeveral:
      return TWO_WORD_LENGTH;
    case Layout::Echo:
      return 1 + request.pdu.size() + CRC_LENGTH;
    case Layout::Unknown:
      return 0;
  }
  return 0;
}

std::uint16_t errorIdOf(const Bytes& pdu)
{
  if (!isException(pdu))
  {
    return 0;
  }
  const bool gateway = pdu[1] == GATEWAY_PATH_UNAVAILABLE || pdu[1] == GATEWAY_TARGET_FAILED;
  return gateway ? ERROR_TIMEOUT : static_cast<std::uint16_t>(pdu[0] << 8 | pdu[1]);
}

Bytes replyShape(std::uint8_t station, const Bytes& pdu)
{
  Bytes shape{ station };
  if (isException(pdu))
  {
    shape.push_back(static_cast<std::uint8_t>(pdu[0] & ~EXCEPTION_FLAG));
    return shape;
  }
  const Layout layout = layoutOf(pdu);
  if (layout == Layout::Echo || (layout == Layout::WriteSeveral && pdu.size() == ADDRESS_AND_COUNT_PDU))
  {
    shape.insert(shape.end(), pdu.begin(), pdu.end());
    return shape;
  }
  const bool counted = layout != Layout::Unknown && layout != Layout::WriteSeveral;
  if (counted && pdu.size() >= 2 && pdu.size() == 2u + pdu[1])
  {
    shape.insert(shape.end(), pdu.begin(), pdu.begin() + 2);
    return shape;
  }
  return Bytes();
}

std::array<std::size_t, 2> possibleLengths(const std::uint8_t* data, std::size_t size)
{
  if ((data[1] & EXCEPTION_FLAG) != 0)
  {
    const auto function = static_cast<std::uint8_t>(data[1] & ~EXCEPTION_FLAG);
    return { layoutOf(function) == Layout::Unknown ? 0 : EXCEPTION_LENGTH, 0 };
  }
  std::array<std::size_t, 2> lengths{ 0, 0 };
  switch (layoutOf(data[1]))
  {
    case Layout::ReadBits:
    case Layout::ReadRegisters:
      lengths = { countedLength(data, size, 2, COUNTED_REPLY_OVERHEAD), TWO_WORD_LENGTH };
      break;
    case Layout::WriteAndReadRegisters:
      lengths = { countedLength(data, size, 2, COUNTED_REPLY_OVERHEAD), countedLength(data, size, 10, 13) };
      break;
    case Layout::WriteSeveral:
      lengths = { TWO_WORD_LENGTH, countedLength(data, size, 6, 9) };
      break;
    case Layout::Echo:
      lengths = { TWO_WORD_LENGTH, 0 };
      break;
    case Layout::Unknown:
      break;
  }
  if (lengths[1] != 0 && lengths[1] < lengths[0])
  {
    std::swap(lengths[0], lengths[1]);
  }
  return lengths;
}
}  // namespace modbus
}  // namespace wire
}  // namespace inverter_bus
