// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_WIRE_MODBUS_FRAMES_H
#define INVERTER_BUS_WIRE_MODBUS_FRAMES_H

#include <array>
#include <cstddef>
#include <cstdint>

#include "inverter_bus/wire/request.h"

namespace inverter_bus
{
namespace wire
{
/// What the Modbus functions look like in bytes (Modbus application protocol V1.1b3, section 6): lengths and layouts.
namespace modbus
{
constexpr std::uint8_t LOOPBACK = 0x08;
constexpr std::uint8_t EXCEPTION_FLAG = 0x80;
constexpr std::uint8_t GATEWAY_PATH_UNAVAILABLE = 0x0A;
constexpr std::uint8_t GATEWAY_TARGET_FAILED = 0x0B;
constexpr std::size_t CRC_LENGTH = 2;
constexpr std::size_t EXCEPTION_LENGTH = 5;
constexpr std::size_t LONGEST_FRAME = 256;
constexpr std::uint8_t HIGHEST_STATION = 247;

/// True if the last two of \p size bytes are the CRC of those before.
bool crcFits(const std::uint8_t* frame, std::size_t size);

/// The bytes that every normal reply to \p request begins with: station, function, and the byte count or all that is
/// repeated of the request.
Bytes replyHead(const Request& request);

/// Length of the whole normal reply, CRC included; 0 where the function is unknown.
std::size_t replyLength(const Request& request);

/// The contract's error id of the exception \p pdu; 0 if it is none. A gateway's exceptions 0AH and 0BH mean that the
/// drive has not answered it: no reply in time, not a refusal.
std::uint16_t errorIdOf(const Bytes& pdu);

/// The shape (Protocol::shapeOfReply) that a reply from \p station answers to, as bytes; empty if it is not a reply.
Bytes replyShape(std::uint8_t station, const Bytes& pdu);

/// Lengths that a frame beginning like \p data (two bytes at least) can have as a reply or as a request, shorter one
/// first; 0: none. Where the byte count has not arrived yet, the least length that it can lead to.
std::array<std::size_t, 2> possibleLengths(const std::uint8_t* data, std::size_t size);
}  // namespace modbus
}  // namespace wire
}  // namespace inverter_bus

#endif  // INVERTER_BUS_WIRE_MODBUS_FRAMES_H
