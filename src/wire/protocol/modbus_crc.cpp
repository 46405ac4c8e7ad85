// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include <array>

#include "inverter_bus/wire/protocol.h"

namespace inverter_bus
{
namespace wire
{
namespace
{
constexpr std::uint16_t POLYNOMIAL = 0xA001;
constexpr std::uint16_t START = 0xFFFF;

constexpr std::array<std::uint16_t, 256> makeTable()
{
  std::array<std::uint16_t, 256> table{};
  for (unsigned byte = 0; byte < 256; ++byte)
  {
    unsigned crc = byte;
    for (int bit = 0; bit < 8; ++bit)
    {
      crc = (crc & 1u) != 0 ? (crc >> 1) ^ POLYNOMIAL : crc >> 1;
    }
    table[byte] = static_cast<std::uint16_t>(crc);
  }
  return table;
}

constexpr std::array<std::uint16_t, 256> TABLE = makeTable();
}  // namespace

std::uint16_t modbusCrc(const std::uint8_t* data, std::size_t size)
{
  std::uint16_t crc = START;
  for (std::size_t i = 0; i < size; ++i)
  {
    crc = static_cast<std::uint16_t>((crc >> 8) ^ TABLE[(crc ^ data[i]) & 0xFFu]);
  }
  return crc;
}
}  // namespace wire
}  // namespace inverter_bus
