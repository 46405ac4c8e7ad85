// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_SRC_DRIVE_CODEC_H
#define INVERTER_BUS_SRC_DRIVE_CODEC_H

#include <cstdint>
#include <optional>

#include "inverter_bus/drive/drive.h"

namespace inverter_bus
{
namespace drive
{
// Modbus function codes (Modbus application protocol V1.1b3, section 6).
constexpr std::uint8_t READ_COILS = 0x01;
constexpr std::uint8_t READ_REGISTERS = 0x03;
constexpr std::uint8_t WRITE_COIL = 0x05;
constexpr std::uint8_t WRITE_REGISTER = 0x06;
constexpr std::uint8_t DIAGNOSTICS = 0x08;
constexpr std::uint8_t WRITE_COILS = 0x0F;
constexpr std::uint8_t WRITE_REGISTERS = 0x10;

/// FC 01 or 03.
wire::Bytes encodeRead(Space space, std::uint16_t address, unsigned count);

/// FC 05 or 0F for a coil; FC 06 or 10 for a register: the shorter one that \p profile has.
wire::Bytes encodeWrite(const Item& item, std::uint32_t raw, const Profile& profile);

/// The raw value of \p item in the reply to a read that began at \p first; empty if the reply is too short, of another
/// function or doesn't hold the item.
std::optional<std::uint32_t> extractRaw(const Item& item, std::uint16_t first, const wire::Bytes& reply);

/// Raw value as a number with sign and unit.
double scaled(const Item& item, std::uint32_t raw);

/// Raw value through \ref Item::values; empty where the table doesn't have it.
std::optional<int> meaning(const Item& item, std::uint32_t raw);
}  // namespace drive
}  // namespace inverter_bus

#endif  // INVERTER_BUS_SRC_DRIVE_CODEC_H
