// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

#ifndef INVERTER_BUS_SIMULATION_COMPOWAY_FRAME_H
#define INVERTER_BUS_SIMULATION_COMPOWAY_FRAME_H

#include <cstdint>
#include <optional>
#include <string>

#include "inverter_bus/simulation/bytes.h"

namespace inverter_bus
{
namespace simulation
{
/// CompoWay/F frames (3G3JE manual I548, section 2): STX, body, ETX, BCC. The BCC is one raw byte, the XOR of the body
/// and ETX; it may have any value, STX and ETX too. Written here on purpose although the driver has it as well.

constexpr std::uint8_t COMPOWAY_STX = 0x02;
constexpr std::uint8_t COMPOWAY_ETX = 0x03;

/// Packs a body: STX before it, ETX and BCC behind it.
Bytes compowayFrame(const std::string& body);

/// How a receiver reads a stream of bytes: everything before an STX is ignored, a new STX starts afresh, the byte
/// after ETX is the BCC.
/// The first complete frame of \p stream, STX to BCC, right or wrong; nothing: there is none.
std::optional<Bytes> findCompowayFrame(const Bytes& stream);

/// What is between STX and ETX. \p frame as findCompowayFrame() returns it.
std::string compowayBody(const Bytes& frame);
bool compowayBccFits(const Bytes& frame);

/// \p digits upper-case hexadecimal digits, the last ones of the value.
std::string hexDigits(std::uint32_t value, int digits);

/// Nothing where a character is none of 0-9, A-F, or where there are none or more than eight.
std::optional<std::uint32_t> fromHexDigits(const std::string& text);
}  // namespace simulation
}  // namespace inverter_bus

#endif  // INVERTER_BUS_SIMULATION_COMPOWAY_FRAME_H
