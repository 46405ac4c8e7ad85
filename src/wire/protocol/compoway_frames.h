// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_WIRE_COMPOWAY_FRAMES_H
#define INVERTER_BUS_WIRE_COMPOWAY_FRAMES_H

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "inverter_bus/wire/request.h"

namespace inverter_bus
{
namespace wire
{
/// What CompoWay/F frames and their services look like (OMRON I548-E1, sections 2-1 to 2-4).
namespace compoway
{
constexpr std::uint8_t STX = 0x02;
constexpr std::uint8_t ETX = 0x03;
/// From STX through BCC: the drive's buffer.
constexpr std::size_t LONGEST_FRAME = 40;
/// STX, node (2), sub-address (2), SID, ETX, BCC.
constexpr std::size_t COMMAND_OVERHEAD = 8;
/// Characters of a response frame without data: STX, node (2), sub-address (2), end code (2), MRC SRC (4), response
/// code (4), ETX, BCC.
constexpr std::size_t RESPONSE_OVERHEAD = 17;

constexpr std::size_t SERVICE_LENGTH = 4;
constexpr std::size_t RESPONSE_CODE_LENGTH = 4;

/// MRC and SRC of the services.
constexpr const char* READ_VARIABLES = "0101";
constexpr const char* WRITE_VARIABLES = "0102";
constexpr const char* READ_ATTRIBUTES = "0503";
constexpr const char* READ_STATUS = "0601";
constexpr const char* ECHOBACK = "0801";
constexpr const char* OPERATION = "3005";

/// A response frame, taken apart.
struct Response
{
  std::string node;
  std::string sub_address;
  std::string end_code;
  /// MRC and SRC; empty in a response without text, as are the next two.
  std::string service;
  std::string response_code;
  std::string data;
};

/// XOR of \p size bytes: those from the node number through ETX.
std::uint8_t bcc(const std::uint8_t* data, std::size_t size);

/// Station number in two decimal digits, or XX.
std::string nodeOf(const Request& request);

/// MRC and SRC; shorter where the command text is.
std::string serviceOf(const Request& request);

/// What follows MRC and SRC.
std::string dataOf(const Request& request);

/// The response between STX and ETX; empty if it cannot be one.
std::optional<Response> takeApart(const std::string& body);

/// The value of \p text in hexadecimal digits as the protocol writes them (0-9, A-F); empty if it holds anything else.
std::optional<std::uint16_t> hexValue(const std::string& text);

/// Data characters of the normal response to \p request; empty where any number may come.
std::optional<std::size_t> dataLength(const Request& request);

/// True if \p data may be in the normal response to \p request.
bool dataFits(const Request& request, const std::string& data);
}  // namespace compoway
}  // namespace wire
}  // namespace inverter_bus

#endif  // INVERTER_BUS_WIRE_COMPOWAY_FRAMES_H
