// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "bus/inverter/feeding.h"

namespace inverter_bus
{
namespace bus
{
namespace
{
/// Wire addresses that a Modbus request writes.
struct Written
{
  drive::Space space = drive::Space::Register;
  unsigned first = 0;
  unsigned last = 0;
};

unsigned word(const wire::Bytes& pdu, std::size_t at)
{
  return at + 1 < pdu.size() ? static_cast<unsigned>(pdu[at] << 8U | pdu[at + 1]) : 0U;
}

/// Empty: it only reads.
std::optional<Written> writtenBy(const wire::Bytes& pdu)
{
  constexpr std::uint8_t WRITE_COIL = 0x05;
  constexpr std::uint8_t WRITE_REGISTER = 0x06;
  constexpr std::uint8_t WRITE_COILS = 0x0F;
  constexpr std::uint8_t WRITE_REGISTERS = 0x10;
  constexpr std::uint8_t WRITE_AND_READ = 0x17;
  const std::uint8_t function = pdu.empty() ? std::uint8_t{ 0 } : pdu[0];
  const bool coils = function == WRITE_COIL || function == WRITE_COILS;
  const drive::Space space = coils ? drive::Space::Coil : drive::Space::Register;
  switch (function)
  {
    case WRITE_COIL:
    case WRITE_REGISTER:
      return Written{ space, word(pdu, 1), word(pdu, 1) };
    case WRITE_COILS:
    case WRITE_REGISTERS:
      return Written{ space, word(pdu, 1), word(pdu, 1) + word(pdu, 3) - 1 };
    case WRITE_AND_READ:
      return Written{ space, word(pdu, 5), word(pdu, 5) + word(pdu, 7) - 1 };
    default:
      return std::nullopt;
  }
}
}  // namespace

Feeding::Feeding(const drive::Drive& drive) : drive_(drive)
{
}

void Feeding::answered(const wire::Request& request, TimePoint at)
{
  // Its time-out counts from when it is heard of first.
  if (!fed_at_ || feeds(request.pdu))
  {
    fed_at_ = at;
  }
}

bool Feeding::needsWrites() const
{
  return drive_.profile().feeds != drive::Feeds::Everything;
}

const std::optional<TimePoint>& Feeding::fedAt() const
{
  return fed_at_;
}

bool Feeding::feeds(const wire::Bytes& pdu) const
{
  const drive::Profile& profile = drive_.profile();
  const auto written = writtenBy(pdu);
  if (profile.feeds != drive::Feeds::CommandWord || !written)
  {
    return profile.feeds == drive::Feeds::Everything || written;
  }
  // All command words in one frame have the command word among them.
  const bool block =
      profile.block && written->space == drive::Space::Register && written->first == profile.block->write.address;
  const drive::Sequence* stop = drive_.sequence("stop");
  const auto point = stop == nullptr ? profile.points.end() : profile.points.find(stop->steps.front().point);
  return block || (point != profile.points.end() && point->second.item.space == written->space &&
                   written->first <= point->second.item.address && point->second.item.address <= written->last);
}
}  // namespace bus
}  // namespace inverter_bus
