// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "inverter_bus/wire/shown.h"

#include <cstdint>

namespace inverter_bus
{
namespace wire
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

/// Control characters of Latin-1 (terminals obey them), surrogates, and what breaks a line or turns its direction.
bool isHarmful(std::uint32_t character)
{
  return character < 0x20 || (character >= 0x7F && character < 0xA0) || (character >= 0xD800 && character < 0xE000) ||
         (character >= 0x2028 && character <= 0x202E) || (character >= 0x2066 && character <= 0x2069) ||
         character > 0x10FFFF;
}

/// Bytes of the harmless character at \p place; 0: none stands there.
std::size_t characterAt(const std::string& text, std::size_t place)
{
  const auto byte = [&text](std::size_t at) { return static_cast<unsigned char>(text[at]); };
  constexpr std::uint32_t LEAST[] = { 0, 0, 0x80, 0x800, 0x10000 };
  constexpr std::uint32_t LEAD_BITS[] = { 0, 0x7F, 0x1F, 0x0F, 0x07 };
  const std::size_t length = lengthFrom(byte(place));
  if (length == 0 || length > text.size() - place)
  {
    return 0;
  }
  std::uint32_t character = byte(place) & LEAD_BITS[length];
  for (std::size_t i = 1; i < length; ++i)
  {
    if ((byte(place + i) & 0xC0U) != 0x80U)
    {
      return 0;
    }
    character = character << 6 | (byte(place + i) & 0x3FU);
  }
  return character < LEAST[length] || isHarmful(character) ? 0 : length;
}
}  // namespace

std::string shown(const std::string& text, std::size_t longest)
{
  std::string line;
  std::size_t place = 0;
  while (place < text.size())
  {
    const std::size_t length = characterAt(text, place);
    if (line.size() + (length == 0 ? 1 : length) > longest)
    {
      return line + "... (" + std::to_string(text.size()) + " bytes)";
    }
    // Tabs and line breaks are no accident worth a mark.
    const bool blank = static_cast<unsigned char>(text[place]) < 0x20 || text[place] == 0x7F;
    line += length > 0 ? text.substr(place, length) : std::string(blank ? " " : "?");
    place += length == 0 ? 1 : length;
  }
  return line;
}
}  // namespace wire
}  // namespace inverter_bus
