// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "config/angle.h"

#include <cctype>
#include <cmath>
#include <cstddef>

#include "config/numerals.h"

namespace inverter_bus
{
namespace config
{
namespace
{
constexpr double PI = 3.14159265358979323846;
/// More than any angle has; each parenthesis and sign is a call.
constexpr std::size_t LONGEST_EXPRESSION = 200;

/// Recursive descent over one line. After a mistake everything is NaN and failed() is true.
class Expression
{
public:
  explicit Expression(const std::string& text) : text_(text)
  {
  }

  std::optional<double> value()
  {
    const double result = sum();
    skipBlanks();
    if (failed_ || at_ != text_.size())
    {
      return std::nullopt;
    }
    return result;
  }

private:
  double sum()
  {
    double result = product();
    for (;;)
    {
      if (take("+"))
      {
        result += product();
      }
      else if (take("-"))
      {
        result -= product();
      }
      else
      {
        return result;
      }
    }
  }

  double product()
  {
    double result = factor();
    for (;;)
    {
      if (startsWith("**"))
      {
        return result;
      }
      if (take("*"))
      {
        result *= factor();
      }
      else if (take("/"))
      {
        const double divisor = factor();
        failed_ = failed_ || divisor == 0.0;
        result /= divisor;
      }
      else
      {
        return result;
      }
    }
  }

  /// A sign binds weaker than ** on its right: -2**2 is -4.
  double factor()
  {
    if (take("-"))
    {
      return -factor();
    }
    if (take("+"))
    {
      return factor();
    }
    const double base = atom();
    return take("**") ? std::pow(base, factor()) : base;
  }

  double atom()
  {
    if (take("("))
    {
      const double result = sum();
      failed_ = failed_ || !take(")");
      return result;
    }
    if (take("pi"))
    {
      return PI;
    }
    return number();
  }

  double number()
  {
    skipBlanks();
    const std::size_t start = at_;
    const auto skip_digits = [this] {
      const std::size_t first = at_;
      while (at_ < text_.size() && std::isdigit(static_cast<unsigned char>(text_[at_])) != 0)
      {
        ++at_;
      }
      return at_ - first;
    };
    const std::size_t whole = skip_digits();
    const bool leading_zero = whole > 1 && text_[start] == '0';
    const bool point = at_ < text_.size() && text_[at_] == '.';
    at_ += point ? 1 : 0;
    const std::size_t fraction = point ? skip_digits() : 0;
    if (at_ < text_.size() && (text_[at_] == 'e' || text_[at_] == 'E'))
    {
      ++at_;
      at_ += at_ < text_.size() && (text_[at_] == '+' || text_[at_] == '-') ? 1 : 0;
      failed_ = skip_digits() == 0 || failed_;
    }
    failed_ = failed_ || whole + fraction == 0 || (leading_zero && !point);
    return failed_ ? 0.0 : readDecimal(text_.substr(start, at_ - start));
  }

  void skipBlanks()
  {
    while (at_ < text_.size() && text_[at_] == ' ')
    {
      ++at_;
    }
  }

  bool startsWith(const std::string& word)
  {
    skipBlanks();
    return text_.compare(at_, word.size(), word) == 0;
  }

  bool take(const std::string& word)
  {
    const bool there = startsWith(word);
    at_ += there ? word.size() : 0;
    return there;
  }

  const std::string text_;
  std::size_t at_ = 0;
  bool failed_ = false;
};
}  // namespace

std::optional<double> radians(const std::string& expression)
{
  if (expression.size() > LONGEST_EXPRESSION)
  {
    return std::nullopt;
  }
  const std::optional<double> value = Expression(expression).value();
  return value && std::isfinite(*value) ? value : std::nullopt;
}

std::optional<double> degrees(const std::string& number)
{
  const std::optional<double> value =
      number.find_first_of("pi*/()") == std::string::npos ? radians(number) : std::nullopt;
  const std::size_t sign = number.find_last_of("+-");
  const std::size_t first = number.find_first_not_of(' ');
  // "90" and "-90" and "1e-3" are numbers, "90-1" is a sum.
  const bool sum = sign != std::string::npos && sign != first && number[sign - 1] != 'e' && number[sign - 1] != 'E';
  if (!value || sum)
  {
    return std::nullopt;
  }
  return *value * PI / 180.0;
}
}  // namespace config
}  // namespace inverter_bus
