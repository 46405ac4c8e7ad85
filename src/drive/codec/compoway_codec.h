// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_SRC_DRIVE_COMPOWAY_CODEC_H
#define INVERTER_BUS_SRC_DRIVE_COMPOWAY_CODEC_H

#include <cstdint>
#include <optional>
#include <string>

#include "inverter_bus/drive/drive.h"

namespace inverter_bus
{
namespace drive
{
// CompoWay/F services (MRC and SRC), OMRON I548-E1 section 2-6.
constexpr unsigned READ_VARIABLES = 0x0101;
constexpr unsigned WRITE_VARIABLES = 0x0102;
constexpr unsigned READ_ATTRIBUTES = 0x0503;
constexpr unsigned READ_STATUS = 0x0601;
constexpr unsigned ECHOBACK = 0x0801;
constexpr unsigned OPERATE = 0x3005;

/// Upper-case hexadecimal digits, as the drive wants them.
std::string hexDigits(std::uint32_t value, unsigned digits);

/// Command text of a read: 0101 type address 00 count, or 0601.
wire::Bytes encodeVariableRead(const ReadBlock& block);
/// Command text of a write: 0102 with one element, or 3005 with the four digits of \p raw.
wire::Bytes encodeVariableWrite(const Item& item, std::uint32_t raw);
/// Command text of one service with \p data.
wire::Bytes encodeService(unsigned service, const std::string& data = "");

/// Element \p index of the response text of a read; empty if it isn't there.
std::optional<std::uint32_t> extractElement(Space space, std::size_t index, const wire::Bytes& reply);
/// The data behind MRC SRC MRES SRES of a response to \p service; empty if it is another response.
std::optional<std::string> responseData(unsigned service, const wire::Bytes& reply);
}  // namespace drive
}  // namespace inverter_bus

#endif  // INVERTER_BUS_SRC_DRIVE_COMPOWAY_CODEC_H
