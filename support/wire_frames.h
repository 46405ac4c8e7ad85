// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_TEST_WIRE_FRAMES_H
#define INVERTER_BUS_TEST_WIRE_FRAMES_H

#include <sstream>
#include <string>

#include "inverter_bus/wire/protocol.h"

namespace inverter_bus
{
namespace wire
{
/// Bytes as manuals print them: "01 03 00 00".
inline Bytes hex(const std::string& text)
{
  std::istringstream stream(text);
  stream >> std::hex;
  Bytes bytes;
  for (unsigned value = 0; stream >> value;)
  {
    bytes.push_back(static_cast<std::uint8_t>(value));
  }
  return bytes;
}

/// The characters of \p text.
inline Bytes ascii(const std::string& text)
{
  return Bytes(text.begin(), text.end());
}

inline Bytes operator+(Bytes left, const Bytes& right)
{
  left.insert(left.end(), right.begin(), right.end());
  return left;
}

/// The frame of these bytes: with its CRC.
inline Bytes withCrc(const std::string& text)
{
  const Bytes bytes = hex(text);
  const std::uint16_t crc = modbusCrc(bytes.data(), bytes.size());
  return bytes + Bytes{ static_cast<std::uint8_t>(crc & 0xFF), static_cast<std::uint8_t>(crc >> 8) };
}

/// The request whose frame is \p frame.
inline Request requestOf(const Bytes& frame)
{
  Request request;
  request.station = frame.at(0);
  request.broadcast = frame.at(0) == 0;
  request.pdu.assign(frame.begin() + 1, frame.end() - 2);
  return request;
}
}  // namespace wire
}  // namespace inverter_bus

#endif  // INVERTER_BUS_TEST_WIRE_FRAMES_H
