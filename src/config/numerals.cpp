// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "config/numerals.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <limits>
#include <locale>
#include <sstream>
#include <string_view>
#include <system_error>

namespace inverter_bus
{
namespace config
{
namespace
{
struct Digits
{
  bool fits = true;
  std::uint64_t magnitude = 0;
  double number = 0.0;

  void append(unsigned base, std::uint64_t digit)
  {
    fits = fits && magnitude <= (std::numeric_limits<std::uint64_t>::max() - digit) / base;
    magnitude = magnitude * base + digit;
    number = number * base + static_cast<double>(digit);
  }
};

unsigned digitOf(char c)
{
  return c <= '9' ? static_cast<unsigned>(c - '0')
                  : static_cast<unsigned>(std::tolower(static_cast<unsigned char>(c)) - 'a') + 10U;
}

Digits digitsOf(const std::string& text, unsigned base)
{
  Digits digits;
  for (const char c : text)
  {
    digits.append(base, digitOf(c));
  }
  return digits;
}

/// 1:30 is 1 x 60 + 30.
Digits sexagesimalDigits(const std::string& text)
{
  Digits digits;
  std::istringstream parts(text);
  for (std::string part; std::getline(parts, part, ':');)
  {
    const Digits one = digitsOf(part, 10);
    digits.fits = digits.fits && one.fits;
    digits.append(60, one.magnitude);
  }
  return digits;
}

std::string withoutUnderscores(std::string text)
{
  text.erase(std::remove(text.begin(), text.end(), '_'), text.end());
  return text;
}

std::string withoutLeadingZeros(const std::string& digits)
{
  const std::size_t first = digits.find_first_not_of('0');
  return first == std::string::npos ? "0" : digits.substr(first);
}

std::string octalTrap(const std::string& sign, const Digits& digits, const std::string& text)
{
  const std::string decimal = withoutLeadingZeros(text);
  const std::string octal = std::to_string(digits.magnitude);
  if (decimal == octal)
  {
    return "has leading zeros; allowed: " + sign + decimal + " without leading zeros, or the text in quotes";
  }
  return "has a leading zero and is " + sign + octal + " to YAML 1.1 (octal); allowed: " + sign + octal + " or " +
         sign + decimal + " without leading zeros, whichever is meant, or the text in quotes";
}

bool begins(const std::string& text, const char* prefix)
{
  return text.compare(0, 2, prefix) == 0;
}
}  // namespace

WholeNumeral readWholeNumeral(const std::string& text)
{
  WholeNumeral numeral;
  std::string rest = withoutUnderscores(text);
  const bool negative = rest[0] == '-';
  const std::string sign = negative ? "-" : "";
  const bool signed_text = text[0] == '-' || text[0] == '+';
  rest.erase(0, signed_text ? 1 : 0);
  Digits digits;
  if (begins(rest, "0b") || begins(rest, "0x"))
  {
    digits = digitsOf(rest.substr(2), rest[1] == 'b' ? 2 : 16);
    numeral.trap = rest.size() == 2 ? "is not a number; allowed: a whole number" : "";
  }
  else if (rest.find(':') != std::string::npos)
  {
    digits = sexagesimalDigits(rest);
    numeral.trap = "is " + sign + std::to_string(digits.magnitude) +
                   " to YAML 1.1 (base 60); allowed: that number, or the text in quotes";
  }
  else if (text.size() > (signed_text ? 2U : 1U) && rest[0] == '0')
  {
    digits = digitsOf(rest, 8);
    numeral.trap = octalTrap(sign, digits, rest);
  }
  else
  {
    digits = digitsOf(rest, 10);
  }
  constexpr std::uint64_t LARGEST = std::numeric_limits<std::int64_t>::max();
  numeral.fits = digits.fits && digits.magnitude <= LARGEST;
  if (!numeral.fits)
  {
    numeral.trap = "has more than 64 bits; allowed: a smaller number, or the text in quotes";
  }
  const std::int64_t magnitude = numeral.fits ? static_cast<std::int64_t>(digits.magnitude) : 0;
  numeral.integer = negative ? -magnitude : magnitude;
  numeral.number = negative ? -digits.number : digits.number;
  return numeral;
}

std::optional<std::int64_t> parseInteger(const std::string& text)
{
  const bool hexadecimal = text.size() > 2 && text[0] == '0' && (text[1] == 'x' || text[1] == 'X');
  const bool negative = text.size() > 1 && text[0] == '-';
  const std::string_view digits = std::string_view(text).substr(hexadecimal ? 2 : negative ? 1 : 0);
  const bool leading_zero = !hexadecimal && digits.size() > 1 && digits[0] == '0';
  if (digits.empty() || digits[0] == '-' || leading_zero || digits.size() > (hexadecimal ? 8U : 10U))
  {
    return std::nullopt;
  }
  std::int64_t value = 0;
  const char* const end = digits.data() + digits.size();
  const auto parsed = std::from_chars(digits.data(), end, value, hexadecimal ? 16 : 10);
  if (parsed.ec != std::errc() || parsed.ptr != end)
  {
    return std::nullopt;
  }
  return negative ? -value : value;
}

double readDecimal(const std::string& text)
{
  std::string rest = withoutUnderscores(text);
  const bool negative = !rest.empty() && rest[0] == '-';
  rest.erase(0, !rest.empty() && (rest[0] == '-' || rest[0] == '+') ? 1 : 0);
  std::transform(rest.begin(), rest.end(), rest.begin(), [](unsigned char c) { return std::tolower(c); });
  double magnitude = 0.0;
  if (rest == ".inf")
  {
    magnitude = std::numeric_limits<double>::infinity();
  }
  else if (rest == ".nan")
  {
    return std::numeric_limits<double>::quiet_NaN();
  }
  else
  {
    // A stream with the classic locale: strtod would read "0,01" in a process that calls setlocale().
    std::istringstream stream(rest);
    stream.imbue(std::locale::classic());
    stream >> magnitude;
    // A number that is too large leaves the largest one and the mark of a failure.
    magnitude = stream.fail() && magnitude > 1.0 ? std::numeric_limits<double>::infinity() : magnitude;
  }
  return negative ? -magnitude : magnitude;
}

double readSexagesimal(const std::string& text)
{
  const bool negative = text[0] == '-';
  double value = 0.0;
  std::istringstream parts(text.substr(text[0] == '-' || text[0] == '+' ? 1 : 0));
  for (std::string part; std::getline(parts, part, ':');)
  {
    value = value * 60.0 + readDecimal(part);
  }
  return negative ? -value : value;
}
}  // namespace config
}  // namespace inverter_bus
