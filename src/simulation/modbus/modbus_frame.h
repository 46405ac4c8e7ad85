// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

#ifndef INVERTER_BUS_SIMULATION_MODBUS_FRAME_H
#define INVERTER_BUS_SIMULATION_MODBUS_FRAME_H

#include <cstdint>

#include "inverter_bus/simulation/bytes.h"

namespace inverter_bus
{
namespace simulation
{
/// CRC-16 of Modbus RTU (initial value FFFFh, reflected polynomial A001h), written here once more on purpose: the
/// simulated drives share no code with the driver.
/// Of the first \p count bytes, at most bytes.size().
std::uint16_t modbusCrc(const Bytes& bytes, std::size_t count);

/// Appends the CRC, low byte first.
Bytes withModbusCrc(Bytes bytes);

/// There are at least four bytes (station, function, CRC), and the CRC fits.
bool modbusCrcFits(const Bytes& frame);

/// 16 bit, high byte first. The caller makes sure that offset + 1 < frame.size().
std::uint16_t modbusWord(const Bytes& frame, std::size_t offset);

void appendModbusWord(Bytes& frame, std::uint16_t value);
}  // namespace simulation
}  // namespace inverter_bus

#endif  // INVERTER_BUS_SIMULATION_MODBUS_FRAME_H
