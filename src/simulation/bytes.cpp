// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

#include "inverter_bus/simulation/bytes.h"

#include <cctype>
#include <cstddef>

namespace inverter_bus
{
namespace simulation
{
namespace
{
const char* const DIGITS = "0123456789ABCDEF";

int digitValue(char digit)
{
  const char upper = static_cast<char>(std::toupper(static_cast<unsigned char>(digit)));
  if (upper >= '0' && upper <= '9')
  {
    return upper - '0';
  }
  return upper >= 'A' && upper <= 'F' ? upper - 'A' + 10 : -1;
}
}  // namespace

std::string toHex(const Bytes& bytes)
{
  std::string text;
  text.reserve(bytes.size() * 3);
  for (const std::uint8_t byte : bytes)
  {
    if (!text.empty())
    {
      text += ' ';
    }
    text += DIGITS[byte >> 4U];
    text += DIGITS[byte & 0x0FU];
  }
  return text;
}

std::optional<Bytes> fromHex(const std::string& text)
{
  Bytes bytes;
  int high = -1;
  for (const char character : text)
  {
    if (std::isspace(static_cast<unsigned char>(character)) != 0 && high < 0)
    {
      continue;
    }
    const int value = digitValue(character);
    if (value < 0)
    {
      return std::nullopt;
    }
    if (high < 0)
    {
      high = value;
      continue;
    }
    bytes.push_back(static_cast<std::uint8_t>(high * 16 + value));
    high = -1;
  }
  return high < 0 ? std::optional<Bytes>(bytes) : std::nullopt;
}
}  // namespace simulation
}  // namespace inverter_bus
