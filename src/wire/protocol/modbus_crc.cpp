// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include <boost/crc.hpp>

#include "inverter_bus/wire/protocol.h"

namespace inverter_bus
{
namespace wire
{
std::uint16_t modbusCrc(const std::uint8_t* data, std::size_t size)
{
  // Boost reflects the polynomial itself: 8005 hex is A001 hex.
  boost::crc_optimal<16, 0x8005, 0xFFFF, 0, true, true> crc;
  crc.process_bytes(data, size);
  return crc.checksum();
}
}  // namespace wire
}  // namespace inverter_bus
