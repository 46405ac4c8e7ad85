// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "drive/codec/compoway_codec.h"

#include <algorithm>
#include <cstdlib>

namespace inverter_bus
{
namespace drive
{
namespace
{
constexpr std::size_t HEADER = 8;  // MRC, SRC, MRES, SRES: two digits each
constexpr std::size_t ELEMENT = 8;
constexpr std::size_t STATUS_WORD = 4;

bool isHexDigit(char c)
{
  return (c >= '0' && c <= '9') || (c >= 'A' && c <= 'F');
}

std::optional<std::uint32_t> parseHex(const std::string& digits)
{
  if (digits.empty() || !std::all_of(digits.begin(), digits.end(), isHexDigit))
  {
    return std::nullopt;
  }
  return static_cast<std::uint32_t>(std::strtoul(digits.c_str(), nullptr, 16));
}
}  // namespace

std::string hexDigits(std::uint32_t value, unsigned digits)
{
  std::string text(digits, '0');
  for (unsigned i = digits; i-- > 0; value >>= 4)
  {
    text[i] = "0123456789ABCDEF"[value & 0xFU];
  }
  return text;
}

wire::Bytes encodeService(unsigned service, const std::string& data)
{
  const std::string text = hexDigits(service, 4) + data;
  return wire::Bytes(text.begin(), text.end());
}

wire::Bytes encodeVariableRead(const ReadBlock& block)
{
  if (block.space == Space::ControllerStatus)
  {
    return encodeService(READ_STATUS);
  }
  return encodeService(READ_VARIABLES,
                       hexDigits(block.area, 2) + hexDigits(block.address, 4) + "00" + hexDigits(block.count, 4));
}

wire::Bytes encodeVariableWrite(const Item& item, std::uint32_t raw)
{
  if (item.space == Space::Operation)
  {
    return encodeService(OPERATE, hexDigits(raw, 4));
  }
  return encodeService(WRITE_VARIABLES,
                       hexDigits(item.area, 2) + hexDigits(item.address, 4) + "000001" + hexDigits(raw, 8));
}

std::optional<std::string> responseData(unsigned service, const wire::Bytes& reply)
{
  const std::string text(reply.begin(), reply.end());
  if (text.size() < HEADER || text.compare(0, 4, hexDigits(service, 4)) != 0)
  {
    return std::nullopt;
  }
  return text.substr(HEADER);
}

std::optional<std::uint32_t> extractElement(Space space, std::size_t index, const wire::Bytes& reply)
{
  const bool status = space == Space::ControllerStatus;
  const auto data = responseData(status ? READ_STATUS : READ_VARIABLES, reply);
  const std::size_t size = status ? STATUS_WORD : ELEMENT;
  if (!data || data->size() < (index + 1) * size)
  {
    return std::nullopt;
  }
  return parseHex(data->substr(index * size, size));
}
}  // namespace drive
}  // namespace inverter_bus
