// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "wire/protocol/modbus_awaited_reply.h"

#include <algorithm>

#include "wire/protocol/modbus_frames.h"

namespace inverter_bus
{
namespace wire
{
namespace modbus
{
namespace
{
/// \p length of a whole frame, its CRC replaced by another checksum; 0 stays 0.
std::size_t withChecksum(std::size_t length, std::size_t checksum_length)
{
  return length == 0 ? 0 : length - CRC_LENGTH + checksum_length;
}
}  // namespace

bool isWhole(Match match)
{
  return match == Match::Reply || match == Match::Exception;
}

AwaitedReply::AwaitedReply(const Request& request, std::size_t checksum_length)
  : head_(replyHead(request))
  , checksum_length_(checksum_length)
  , length_(withChecksum(replyLength(request), checksum_length))
  , exception_length_(withChecksum(EXCEPTION_LENGTH, checksum_length))
{
}

AwaitedReply::AwaitedReply(const Request& request, std::uint8_t station, std::size_t checksum_length)
  : AwaitedReply(request, checksum_length)
{
  head_[0] = station;
}

Match AwaitedReply::match(const std::uint8_t* data, std::size_t size) const
{
  if (data[0] != head_[0] || head_.size() < 2)
  {
    return Match::None;
  }
  if (size == 1)
  {
    return Match::Perhaps;
  }
  const bool exception = data[1] == (head_[1] | EXCEPTION_FLAG);
  return exception ? complete(data, size, Match::Exception) : matchNormal(data, size);
}

std::size_t AwaitedReply::length(Match match) const
{
  return match == Match::Exception ? exception_length_ : length_;
}

Match AwaitedReply::matchNormal(const std::uint8_t* data, std::size_t size) const
{
  const std::size_t known = std::min(size, head_.size());
  const bool fits = length_ != 0 && std::equal(data, data + known, head_.begin());
  return fits ? complete(data, size, Match::Reply) : Match::None;
}

Match AwaitedReply::complete(const std::uint8_t* data, std::size_t size, Match kind) const
{
  if (size < length(kind))
  {
    return Match::Begun;
  }
  return checksum_length_ == 0 || crcFits(data, length(kind)) ? kind : Match::None;
}
}  // namespace modbus
}  // namespace wire
}  // namespace inverter_bus
