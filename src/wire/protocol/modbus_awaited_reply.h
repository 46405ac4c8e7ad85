// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_WIRE_MODBUS_AWAITED_REPLY_H
#define INVERTER_BUS_WIRE_MODBUS_AWAITED_REPLY_H

#include <cstddef>
#include <cstdint>

#include "inverter_bus/wire/request.h"

namespace inverter_bus
{
namespace wire
{
namespace modbus
{
/// How the bytes at some place compare with the awaited reply.
enum class Match
{
  None,
  /// The station's number only: no more than a hint.
  Perhaps,
  /// Station, function and all other bytes that are known beforehand fit so far.
  Begun,
  Reply,
  Exception
};

/// True if \p match is a complete answer.
bool isWhole(Match match);

/// The reply that a request waits for: station, PDU and the checksum behind it.
class AwaitedReply
{
public:
  /// \p checksum_length CRC_LENGTH, or 0 where something else protects the frame. \p station the one that the reply bears, if it is not that of the request.
  AwaitedReply(const Request& request, std::size_t checksum_length);
  AwaitedReply(const Request& request, std::uint8_t station, std::size_t checksum_length);

  /// \p size at least 1.
  Match match(const std::uint8_t* data, std::size_t size) const;
  /// Bytes of a whole match, checksum included.
  std::size_t length(Match match) const;

private:
  Match matchNormal(const std::uint8_t* data, std::size_t size) const;
  Match complete(const std::uint8_t* data, std::size_t size, Match kind) const;

  Bytes head_;
  std::size_t checksum_length_;
  /// 0 where the function is unknown.
  std::size_t length_;
  std::size_t exception_length_;
};
}  // namespace modbus
}  // namespace wire
}  // namespace inverter_bus

#endif  // INVERTER_BUS_WIRE_MODBUS_AWAITED_REPLY_H
