// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "util/text.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <locale>
#include <sstream>

namespace inverter_bus
{
namespace util
{
namespace
{
// Beyond these a row of zeros says less than an exponent.
constexpr double SMALLEST_WRITTEN_OUT = 1e-9;
constexpr double LARGEST_WRITTEN_OUT = 1e15;

std::string withoutTrailingZeros(std::string text)
{
  if (text.find('.') == std::string::npos)
  {
    return text;
  }
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.')
  {
    text.pop_back();
  }
  return text == "-0" ? "0" : text;
}
}  // namespace

std::string numberText(double value, int digits)
{
  if (std::isnan(value))
  {
    return "nan";
  }
  std::ostringstream text;
  text.imbue(std::locale::classic());
  const double magnitude = std::fabs(value);
  const bool written_out = value == 0.0 || (magnitude >= SMALLEST_WRITTEN_OUT && magnitude < LARGEST_WRITTEN_OUT);
  if (!written_out)
  {
    text.precision(digits);
    text << value;
    return text.str();
  }
  const int before_point = value == 0.0 ? 1 : static_cast<int>(std::floor(std::log10(magnitude))) + 1;
  text.precision(std::max(0, digits - before_point));
  text << std::fixed << value;
  return withoutTrailingZeros(text.str());
}

std::string exactText(double value)
{
  constexpr int DIGITS = 12;
  return numberText(value, DIGITS);
}

std::string fixedText(double value, int decimals)
{
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text.precision(decimals);
  text << std::fixed << value;
  return text.str();
}

std::string withUnit(const std::string& number, const std::string& unit)
{
  return unit.empty() ? number : number + " " + unit;
}

std::string durationText(Duration duration)
{
  constexpr int DIGITS = 3;
  constexpr double LONG_S = 0.9995;  // 1000 ms is 1 s
  const double time = toSeconds(duration);
  return std::fabs(time) < LONG_S ? numberText(time * 1e3, DIGITS) + " ms" : numberText(time, DIGITS) + " s";
}

std::string millisecondsText(Duration duration, int decimals)
{
  return fixedText(toSeconds(duration) * 1e3, decimals) + " ms";
}

std::string hexText(std::uint32_t value, int digits)
{
  char text[16];
  std::snprintf(text, sizeof text, "%0*X", digits, static_cast<unsigned>(value));
  return text;
}

std::string hexNumber(std::uint32_t value)
{
  return "0x" + hexText(value, 4);
}
}  // namespace util
}  // namespace inverter_bus
