// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "config/scalar.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <locale>
#include <regex>
#include <sstream>
#include <vector>

#include "config/angle.h"
#include "config/numerals.h"

namespace inverter_bus
{
namespace config
{
namespace
{
/// No number, word or date is that long, and std::regex recurses once per character.
constexpr std::size_t LONGEST_WORD = 200;

const std::string TAG_PREFIX = "tag:yaml.org,2002:";

bool matches(const std::string& text, const std::regex& form)
{
  return text.size() <= LONGEST_WORD && std::regex_match(text, form);
}

// The forms are those of PyYAML's resolver (yaml/resolver.py of version 5 and 6 alike), which are those of YAML 1.1
// but for the exponent, whose sign and decimal point must be there.

bool isTrue(const std::string& text)
{
  static const std::regex FORM("yes|Yes|YES|true|True|TRUE|on|On|ON");
  return matches(text, FORM);
}

bool isFalse(const std::string& text)
{
  static const std::regex FORM("no|No|NO|false|False|FALSE|off|Off|OFF");
  return matches(text, FORM);
}

bool isNull(const std::string& text)
{
  return text.empty() || text == "~" || text == "null" || text == "Null" || text == "NULL";
}

bool isInteger(const std::string& text)
{
  static const std::regex FORM(
      "[-+]?0b[01_]+|[-+]?0[0-7_]+|[-+]?(0|[1-9][0-9_]*)|[-+]?0x[0-9a-fA-F_]+|[-+]?[1-9][0-9_]*(:[0-5]?[0-9])+");
  return matches(text, FORM);
}

bool isNumber(const std::string& text)
{
  static const std::regex FORM(
      "[-+]?[0-9][0-9_]*\\.[0-9_]*([eE][-+][0-9]+)?|\\.[0-9][0-9_]*([eE][-+][0-9]+)?|"
      "[-+]?[0-9][0-9_]*(:[0-5]?[0-9])+\\.[0-9_]*|[-+]?\\.(inf|Inf|INF)|\\.(nan|NaN|NAN)");
  return matches(text, FORM);
}

bool isDate(const std::string& text)
{
  static const std::regex FORM(
      "[0-9]{4}-[0-9]{2}-[0-9]{2}|[0-9]{4}-[0-9]{1,2}-[0-9]{1,2}([Tt]|[ \t]+)[0-9]{1,2}:[0-9]{2}:[0-9]{2}(\\.[0-9]*)?"
      "([ \t]*(Z|[-+][0-9]{1,2}(:[0-9]{2})?))?");
  return matches(text, FORM);
}

/// "rad(2*pi)", "deg(90)": rosparam adds these to YAML.
bool isAngle(const std::string& text, const char* unit)
{
  return text.size() > 4 && text.compare(0, 4, std::string(unit) + "(") == 0 && text.find(')') == text.size() - 1 &&
         text.find('\n') == std::string::npos;
}

void setText(Scalar& scalar)
{
  scalar.type = Value::Type::Text;
}

void setBoolean(Scalar& scalar, bool value)
{
  scalar.type = Value::Type::Boolean;
  scalar.boolean = value;
}

void setNumber(Scalar& scalar, double value)
{
  scalar.type = Value::Type::Number;
  scalar.number = value;
}

void setInteger(Scalar& scalar)
{
  const WholeNumeral numeral = readWholeNumeral(scalar.text);
  scalar.type = numeral.fits ? Value::Type::Integer : Value::Type::Number;
  scalar.integer = numeral.integer;
  scalar.number = numeral.number;
  scalar.trap = numeral.trap;
}

void setSexagesimal(Scalar& scalar)
{
  setNumber(scalar, readSexagesimal(scalar.text));
  scalar.trap =
      "is " + numberInYaml(scalar.number) + " to YAML 1.1 (base 60); allowed: that number, or the text in quotes";
}

void setDecimal(Scalar& scalar)
{
  if (scalar.text.find(':') != std::string::npos)
  {
    setSexagesimal(scalar);
    return;
  }
  setNumber(scalar, readDecimal(scalar.text));
}

void setAngle(Scalar& scalar, const std::optional<double>& angle)
{
  setNumber(scalar, angle.value_or(0.0));
  if (!angle)
  {
    scalar.trap = "is not an angle; allowed: deg(NUMBER), or rad(...) of numbers, pi, + - * / and **";
  }
}

void setPlain(Scalar& scalar)
{
  const std::string& text = scalar.text;
  if (isNull(text))
  {
    scalar.type = Value::Type::None;
  }
  else if (isTrue(text) || isFalse(text))
  {
    setBoolean(scalar, isTrue(text));
  }
  else if (isNumber(text))
  {
    setDecimal(scalar);
  }
  else if (isInteger(text))
  {
    setInteger(scalar);
  }
  else if (isAngle(text, "rad") || isAngle(text, "deg"))
  {
    const std::string inner = text.substr(4, text.size() - 5);
    setAngle(scalar, text[0] == 'r' ? radians(inner) : degrees(inner));
  }
  else
  {
    setText(scalar);
    if (isDate(text))
    {
      scalar.trap = "is a date to YAML; allowed: a text in quotes";
    }
    else if (text == "=" || text == "<<")
    {
      scalar.trap = "has a meaning of its own in YAML; allowed: a text in quotes";
    }
  }
}

void setTaggedBoolean(Scalar& scalar)
{
  std::string lower = scalar.text;
  std::transform(lower.begin(), lower.end(), lower.begin(), [](unsigned char c) { return std::tolower(c); });
  setBoolean(scalar, isTrue(lower));
  if (!isTrue(lower) && !isFalse(lower))
  {
    scalar.trap = "is not a truth value; allowed: true or false";
  }
}

void setTaggedNumber(Scalar& scalar, bool whole)
{
  const std::optional<double> meant = meantNumber(scalar.text);
  if (isInteger(scalar.text))
  {
    setInteger(scalar);
    scalar.type = whole ? scalar.type : Value::Type::Number;
  }
  else if (!whole && (isNumber(scalar.text) || meant))
  {
    isNumber(scalar.text) ? setDecimal(scalar) : setNumber(scalar, *meant);
  }
  else
  {
    setText(scalar);
    scalar.trap = whole ? "is not a whole number; allowed: a whole number" : "is not a number; allowed: a number";
  }
}

void setTagged(Scalar& scalar, const std::string& tag)
{
  const std::string kind = tag.compare(0, TAG_PREFIX.size(), TAG_PREFIX) == 0 ? tag.substr(TAG_PREFIX.size()) : "";
  if (kind == "str")
  {
    scalar.quoted = true;
    setText(scalar);
  }
  else if (kind == "bool")
  {
    setTaggedBoolean(scalar);
  }
  else if (kind == "int" || kind == "float")
  {
    setTaggedNumber(scalar, kind == "int");
  }
  else if (kind == "null")
  {
    scalar.type = Value::Type::None;
  }
  else if (tag == "!radians" || tag == "!degrees")
  {
    const bool call = isAngle(scalar.text, tag == "!radians" ? "rad" : "deg");
    const std::string inner = call ? scalar.text.substr(4, scalar.text.size() - 5) : scalar.text;
    setAngle(scalar, tag == "!radians" ? radians(inner) : degrees(inner));
  }
  else
  {
    setText(scalar);
    scalar.trap =
        "has the tag " + tag + "; allowed: no tag, or one of !!str, !!int, !!float, !!bool, !!null, !radians, !degrees";
  }
}
}  // namespace

Scalar readScalar(const std::string& text, const std::string& tag)
{
  Scalar scalar;
  scalar.text = text;
  if (tag.empty() || tag == "?")
  {
    setPlain(scalar);
  }
  else if (tag == "!")
  {
    scalar.quoted = true;
    setText(scalar);
  }
  else
  {
    setTagged(scalar, tag);
  }
  return scalar;
}

std::optional<double> meantNumber(const std::string& text)
{
  static const std::regex EXPONENT("[-+]?(0|[1-9][0-9]*)(\\.[0-9]*)?[eE][-+]?[0-9]+|[-+]?\\.[0-9]+[eE][-+]?[0-9]+");
  static const std::regex SIGNED_FRACTION("[-+]\\.[0-9]+");
  if (!matches(text, EXPONENT) && !matches(text, SIGNED_FRACTION))
  {
    return std::nullopt;
  }
  return readDecimal(text);
}

std::string hintFor(const std::string& text)
{
  static const std::regex LEADING_ZEROS("([-+]?)0+([0-9]+(\\.[0-9]*)?)");
  static const std::regex DECIMAL_COMMA("([-+]?[0-9]+),([0-9]+)");
  static const std::regex NEW_OCTAL("0o[0-7]+");
  std::smatch match;
  if (const auto meant = meantNumber(text))
  {
    return "write " + numberInYaml(*meant);
  }
  const Scalar plain = readScalar(text);
  if (plain.type != Value::Type::Text && plain.type != Value::Type::None && plain.trap.empty())
  {
    return "write " + text + " without quotes";
  }
  if (text.size() > LONGEST_WORD)
  {
    return "";
  }
  if (std::regex_match(text, match, LEADING_ZEROS))
  {
    return "write " + (match[1] == "-" ? std::string("-") : std::string()) + match[2].str() + ", without leading zeros";
  }
  if (std::regex_match(text, match, DECIMAL_COMMA))
  {
    return "write " + match[1].str() + "." + match[2].str();
  }
  if (std::regex_match(text, NEW_OCTAL))
  {
    return "write " + std::to_string(std::stoull(text.substr(2, 20), nullptr, 8));
  }
  return "";
}

std::string numberInYaml(double number)
{
  if (!std::isfinite(number))
  {
    return std::isnan(number) ? ".nan" : number > 0.0 ? ".inf" : "-.inf";
  }
  std::string text;
  // The shortest that is read as the same number again.
  for (int digits = 6; digits <= std::numeric_limits<double>::max_digits10; ++digits)
  {
    std::ostringstream stream;
    stream.imbue(std::locale::classic());
    stream.precision(digits);
    stream << number;
    text = stream.str();
    if (readDecimal(text) == number)
    {
      break;
    }
  }
  if (text.find('.') == std::string::npos)
  {
    text.insert(std::min(text.find('e'), text.size()), ".0");
  }
  return text;
}
}  // namespace config
}  // namespace inverter_bus
