// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "util/utf8.h"

namespace inverter_bus
{
namespace util
{
namespace
{
/// Bytes that the UTF-8 character with this first byte has; 0: no character begins so.
std::size_t lengthFrom(unsigned char first)
{
  if (first < 0x80)
  {
    return 1;
  }
  if (first < 0xC2 || first > 0xF4)
  {
    return 0;
  }
  return first < 0xE0 ? 2 : first < 0xF0 ? 3 : 4;
}
}  // namespace

Character characterAt(const std::string& text, std::size_t place)
{
  const auto byte = [&text](std::size_t at) { return static_cast<unsigned char>(text[at]); };
  constexpr std::uint32_t LEAST[] = { 0, 0, 0x80, 0x800, 0x10000 };
  constexpr std::uint32_t LEAD_BITS[] = { 0, 0x7F, 0x1F, 0x0F, 0x07 };
  const std::size_t length = lengthFrom(byte(place));
  if (length == 0 || length > text.size() - place)
  {
    return Character();
  }
  std::uint32_t code = byte(place) & LEAD_BITS[length];
  for (std::size_t i = 1; i < length; ++i)
  {
    if ((byte(place + i) & 0xC0U) != 0x80U)
    {
      return Character();
    }
    code = code << 6 | (byte(place + i) & 0x3FU);
  }
  const bool surrogate = code >= 0xD800 && code < 0xE000;
  return code < LEAST[length] || surrogate || code > 0x10FFFF ? Character() : Character{ length, code };
}
}  // namespace util
}  // namespace inverter_bus
