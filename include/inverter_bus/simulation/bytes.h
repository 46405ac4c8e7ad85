// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

#ifndef INVERTER_BUS_SIMULATION_BYTES_H
#define INVERTER_BUS_SIMULATION_BYTES_H

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace inverter_bus
{
namespace simulation
{
using Bytes = std::vector<std::uint8_t>;

/// Upper-case hexadecimal, separated by blanks ("01 05 00 00 FF 00 8C 3A")
std::string toHex(const Bytes& bytes);

/// Reads hexadecimal with or without blanks between the bytes. Nothing where a character is no hexadecimal digit or a byte
/// is only half there.
std::optional<Bytes> fromHex(const std::string& text);
}  // namespace simulation
}  // namespace inverter_bus

#endif  // INVERTER_BUS_SIMULATION_BYTES_H
