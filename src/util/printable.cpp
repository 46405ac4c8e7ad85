// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "util/printable.h"

#include <cstdint>

#include "util/utf8.h"

namespace inverter_bus
{
namespace util
{
namespace
{
/// Control characters of Latin-1 (terminals obey them), and what breaks a line or turns its direction.
bool isHarmful(std::uint32_t character)
{
  return character < 0x20 || (character >= 0x7F && character < 0xA0) || (character >= 0x2028 && character <= 0x202E) ||
         (character >= 0x2066 && character <= 0x2069);
}

/// Bytes of the harmless character at \p place; 0: none stands there.
std::size_t harmlessAt(const std::string& text, std::size_t place)
{
  const Character character = characterAt(text, place);
  return isHarmful(character.code) ? 0 : character.length;
}
}  // namespace

std::string printable(const std::string& text, std::size_t longest)
{
  std::string line;
  std::size_t place = 0;
  while (place < text.size())
  {
    const std::size_t length = harmlessAt(text, place);
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
}  // namespace util
}  // namespace inverter_bus
