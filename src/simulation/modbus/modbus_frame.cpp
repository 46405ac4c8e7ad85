// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

#include "simulation/modbus/modbus_frame.h"

namespace inverter_bus
{
namespace simulation
{
std::uint16_t modbusCrc(const Bytes& bytes, std::size_t count)
{
  unsigned int crc = 0xFFFFU;
  for (std::size_t i = 0; i < count; ++i)
  {
    crc ^= bytes[i];
    for (int bit = 0; bit < 8; ++bit)
    {
      crc = (crc & 1U) != 0U ? (crc >> 1U) ^ 0xA001U : crc >> 1U;
    }
  }
  return static_cast<std::uint16_t>(crc);
}

Bytes withModbusCrc(Bytes bytes)
{
  const std::uint16_t crc = modbusCrc(bytes, bytes.size());
  bytes.push_back(static_cast<std::uint8_t>(crc & 0xFFU));
  bytes.push_back(static_cast<std::uint8_t>(crc >> 8U));
  return bytes;
}

bool modbusCrcFits(const Bytes& frame)
{
  if (frame.size() < 4)
  {
    return false;
  }
  const std::uint16_t crc = modbusCrc(frame, frame.size() - 2);
  return frame[frame.size() - 2] == (crc & 0xFFU) && frame[frame.size() - 1] == (crc >> 8U);
}

std::uint16_t modbusWord(const Bytes& frame, std::size_t offset)
{
  return static_cast<std::uint16_t>(frame[offset] * 256U + frame[offset + 1]);
}

void appendModbusWord(Bytes& frame, std::uint16_t value)
{
  frame.push_back(static_cast<std::uint8_t>(value >> 8U));
  frame.push_back(static_cast<std::uint8_t>(value & 0xFFU));
}
}  // namespace simulation
}  // namespace inverter_bus
