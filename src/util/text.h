// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_UTIL_TEXT_H
#define INVERTER_BUS_UTIL_TEXT_H

#include <cstdint>
#include <string>

#include "inverter_bus/util/clock.h"

namespace inverter_bus
{
// Numbers, times and lists as people write them, whatever the locale. For what others have written see util/printable.h.
namespace util
{
/// \p value with at most \p digits significant ones (whole digits are never cut): "0.5", "1230", "0.00003". No exponent from
/// 1e-9 to 1e15; "nan", "inf" and "-inf" as they are.
std::string numberText(double value, int digits = 6);

/// \p value with so many digits (12) that it can be compared with what somebody has written in a file.
std::string exactText(double value);

/// \p value with \p decimals behind the point, zeros too: "0.50".
std::string fixedText(double value, int decimals);

/// \p number, and behind it \p unit if there is one: "0.5 Hz".
std::string withUnit(const std::string& number, const std::string& unit);

/// \p duration in the unit that people would use, three significant digits: "4.01 ms", "158 ms", "3.81 s", "120 s".
std::string durationText(Duration duration);

/// \p duration in milliseconds, whatever its size, with \p decimals behind the point: "1234.5 ms".
std::string millisecondsText(Duration duration, int decimals = 1);

/// \p value in capital hexadecimal digits, at least \p digits of them, without a prefix: "00AF".
std::string hexText(std::uint32_t value, int digits);

/// \p value as error ids and registers are written, at least four digits: "0x00AF".
std::string hexNumber(std::uint32_t value);

/// \p text itself, or a whole number in decimal: parts of joined().
inline const std::string& partText(const std::string& text)
{
  return text;
}
inline std::string partText(int number)
{
  return std::to_string(number);
}

/// "a, b, c": \p parts, which are texts or whole numbers, with \p separator between them.
template <typename Parts>
std::string joined(const Parts& parts, const std::string& separator = ", ")
{
  std::string text;
  for (const auto& part : parts)
  {
    text += (text.empty() ? "" : separator) + partText(part);
  }
  return text;
}
}  // namespace util
}  // namespace inverter_bus

#endif  // INVERTER_BUS_UTIL_TEXT_H
