// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "drive/profile/numbers.h"

#include <cmath>
#include <cstddef>
#include <locale>
#include <sstream>

namespace inverter_bus
{
namespace drive
{
namespace
{
bool isDigit(char c)
{
  return c >= '0' && c <= '9';
}

int hexDigit(char c)
{
  if (isDigit(c))
  {
    return c - '0';
  }
  if (c >= 'a' && c <= 'f')
  {
    return c - 'a' + 10;
  }
  return c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
}

std::optional<std::int64_t> parseHex(const std::string& digits)
{
  if (digits.empty() || digits.size() > 8)
  {
    return std::nullopt;
  }
  std::int64_t value = 0;
  for (const char c : digits)
  {
    const int digit = hexDigit(c);
    if (digit < 0)
    {
      return std::nullopt;
    }
    value = value * 16 + digit;
  }
  return value;
}

/// Length of the run of digits at \p at.
std::size_t digitsAt(const std::string& text, std::size_t at)
{
  std::size_t count = 0;
  while (at + count < text.size() && isDigit(text[at + count]))
  {
    ++count;
  }
  return count;
}

/// -?(0|[1-9][0-9]*)(\.[0-9]+)?([eE][+-]?[0-9]+)?
bool isDecimal(const std::string& text)
{
  std::size_t at = !text.empty() && text[0] == '-' ? 1 : 0;
  const std::size_t whole = digitsAt(text, at);
  if (whole == 0 || (whole > 1 && text[at] == '0'))
  {
    return false;
  }
  at += whole;
  if (at < text.size() && text[at] == '.')
  {
    const std::size_t fraction = digitsAt(text, at + 1);
    if (fraction == 0)
    {
      return false;
    }
    at += 1 + fraction;
  }
  if (at < text.size() && (text[at] == 'e' || text[at] == 'E'))
  {
    ++at;
    at += at < text.size() && (text[at] == '+' || text[at] == '-') ? 1 : 0;
    const std::size_t exponent = digitsAt(text, at);
    if (exponent == 0)
    {
      return false;
    }
    at += exponent;
  }
  return at == text.size();
}

/// n where \p resolution is 1/n, else 0: dividing by n is exact where multiplying by 0.01 is not.
double wholeInverse(double resolution)
{
  const double inverse = std::round(1.0 / resolution);
  return inverse >= 1.0 && std::fabs(inverse * resolution - 1.0) < 1e-9 ? inverse : 0.0;
}
}  // namespace

std::optional<std::int64_t> parseInteger(const std::string& text)
{
  if (text.size() > 2 && text[0] == '0' && (text[1] == 'x' || text[1] == 'X'))
  {
    return parseHex(text.substr(2));
  }
  const std::size_t start = !text.empty() && text[0] == '-' ? 1 : 0;
  const std::size_t digits = digitsAt(text, start);
  if (digits == 0 || digits > 10 || start + digits != text.size() || (digits > 1 && text[start] == '0'))
  {
    return std::nullopt;
  }
  std::int64_t value = 0;
  for (std::size_t i = start; i < text.size(); ++i)
  {
    value = value * 10 + (text[i] - '0');
  }
  return start == 1 ? -value : value;
}

std::optional<double> parseNumber(const std::string& text)
{
  if (const auto integer = parseInteger(text))
  {
    return static_cast<double>(*integer);
  }
  if (!isDecimal(text))
  {
    return std::nullopt;
  }
  // A stream with the classic locale: strtod would read "0,01" in a process that calls setlocale().
  std::istringstream stream(text);
  stream.imbue(std::locale::classic());
  double value = 0.0;
  stream >> value;
  if (stream.fail() || !std::isfinite(value))
  {
    return std::nullopt;
  }
  return value;
}

double scaleCounts(double counts, double resolution)
{
  const double inverse = wholeInverse(resolution);
  return inverse > 0.0 ? counts / inverse : counts * resolution;
}

double toCounts(double value, double resolution)
{
  const double inverse = wholeInverse(resolution);
  return inverse > 0.0 ? value * inverse : value / resolution;
}
}  // namespace drive
}  // namespace inverter_bus
