// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "wire/protocol/compoway_frames.h"

#include <algorithm>
#include <functional>
#include <numeric>

namespace inverter_bus
{
namespace wire
{
namespace compoway
{
namespace
{
constexpr std::size_t NODE_LENGTH = 2;
constexpr std::size_t SUB_ADDRESS_LENGTH = 2;
constexpr std::size_t END_CODE_LENGTH = 2;
constexpr std::size_t HEAD_LENGTH = NODE_LENGTH + SUB_ADDRESS_LENGTH + END_CODE_LENGTH;
/// Hexadecimal digits of an element (double word).
constexpr std::size_t ELEMENT_LENGTH = 8;
/// Model (10) and buffer size (4).
constexpr std::size_t ATTRIBUTES_LENGTH = 14;
/// Type (2), address (4), bit position (2): the count comes behind them.
constexpr std::size_t COUNT_POSITION = 8;
constexpr std::size_t COUNT_LENGTH = 4;

bool isHexDigit(char character)
{
  return (character >= '0' && character <= '9') || (character >= 'A' && character <= 'F');
}

bool isHex(const std::string& text)
{
  return std::all_of(text.begin(), text.end(), isHexDigit);
}

unsigned valueOf(char digit)
{
  return static_cast<unsigned>(digit <= '9' ? digit - '0' : digit - 'A' + 10);
}

std::string textOf(const Request& request)
{
  return std::string(request.pdu.begin(), request.pdu.end());
}
}  // namespace

std::uint8_t bcc(const std::uint8_t* data, std::size_t size)
{
  return std::accumulate(data, data + size, std::uint8_t{ 0 }, std::bit_xor<std::uint8_t>());
}

std::string nodeOf(const Request& request)
{
  if (request.broadcast)
  {
    return "XX";
  }
  return { static_cast<char>('0' + request.station / 10 % 10), static_cast<char>('0' + request.station % 10) };
}

std::string serviceOf(const Request& request)
{
  return textOf(request).substr(0, SERVICE_LENGTH);
}

std::string dataOf(const Request& request)
{
  const std::string text = textOf(request);
  return text.substr(std::min(text.size(), SERVICE_LENGTH));
}

std::optional<Response> takeApart(const std::string& body)
{
  if (body.size() < HEAD_LENGTH)
  {
    return std::nullopt;
  }
  Response response;
  response.node = body.substr(0, NODE_LENGTH);
  response.sub_address = body.substr(NODE_LENGTH, SUB_ADDRESS_LENGTH);
  response.end_code = body.substr(NODE_LENGTH + SUB_ADDRESS_LENGTH, END_CODE_LENGTH);
  const std::string text = body.substr(HEAD_LENGTH);
  if (text.empty())
  {
    return response;
  }
  if (text.size() < SERVICE_LENGTH + RESPONSE_CODE_LENGTH)
  {
    return std::nullopt;
  }
  response.service = text.substr(0, SERVICE_LENGTH);
  response.response_code = text.substr(SERVICE_LENGTH, RESPONSE_CODE_LENGTH);
  response.data = text.substr(SERVICE_LENGTH + RESPONSE_CODE_LENGTH);
  return response;
}

std::optional<std::uint16_t> hexValue(const std::string& text)
{
  if (text.empty() || text.size() > 4 || !isHex(text))
  {
    return std::nullopt;
  }
  unsigned value = 0;
  for (const char digit : text)
  {
    value = 16 * value + valueOf(digit);
  }
  return static_cast<std::uint16_t>(value);
}

std::optional<std::size_t> dataLength(const Request& request)
{
  const std::string service = serviceOf(request);
  const std::string data = dataOf(request);
  if (service == READ_VARIABLES)
  {
    const bool whole = data.size() >= COUNT_POSITION + COUNT_LENGTH;
    const auto count = whole ? hexValue(data.substr(COUNT_POSITION, COUNT_LENGTH)) : std::nullopt;
    return ELEMENT_LENGTH * count.value_or(0);
  }
  if (service == WRITE_VARIABLES || service == OPERATION)
  {
    return 0;
  }
  if (service == READ_ATTRIBUTES)
  {
    return ATTRIBUTES_LENGTH;
  }
  return service == ECHOBACK ? std::optional<std::size_t>(data.size()) : std::nullopt;
}

bool dataFits(const Request& request, const std::string& data)
{
  const auto length = dataLength(request);
  if (length && *length != data.size())
  {
    return false;
  }
  const std::string service = serviceOf(request);
  if (service == ECHOBACK)
  {
    return data == dataOf(request);
  }
  return service != READ_VARIABLES || isHex(data);
}
}  // namespace compoway
}  // namespace wire
}  // namespace inverter_bus
