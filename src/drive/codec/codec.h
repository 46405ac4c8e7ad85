// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_SRC_DRIVE_CODEC_H
#define INVERTER_BUS_SRC_DRIVE_CODEC_H

#include <cstdint>
#include <optional>
#include <vector>

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
constexpr std::uint8_t READ_WRITE_REGISTERS = 0x17;

/// FC 01 or 03; CompoWay/F service 0101 or 0601.
wire::Bytes encodeRead(const ReadBlock& block);

/// The read of one item alone.
ReadBlock blockAround(const Item& item);

/// FC 05 or 0F for a coil; FC 06 or 10 for a register: the shorter one that \p profile has. CompoWay/F: 0102 or 3005.
wire::Bytes encodeWrite(const Item& item, std::uint32_t raw, const Profile& profile);

/// FC 10: \p words from \p address on.
wire::Bytes encodeWriteRegisters(std::uint16_t address, const std::vector<std::uint16_t>& words);

/// FC 17: writes \p words from \p write_address on and reads what \p block says.
wire::Bytes encodeReadWrite(const ReadBlock& block, std::uint16_t write_address,
                            const std::vector<std::uint16_t>& words);

/// The raw value of \p item in the reply to the read of \p block; empty if the reply is too short, of another function,
/// doesn't hold the item, or says that nothing is there.
std::optional<std::uint32_t> extractRaw(const Item& item, const ReadBlock& block, const wire::Bytes& reply,
                                        const Profile& profile);

/// Raw value as a number with sign and unit.
double scaled(const Item& item, std::uint32_t raw);

/// Raw value through \ref Item::values; empty where the table doesn't have it.
std::optional<int> meaning(const Item& item, std::uint32_t raw);
}  // namespace drive
}  // namespace inverter_bus

#endif  // INVERTER_BUS_SRC_DRIVE_CODEC_H
