// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
// Sections constants and operation_codes: numbers with names, known or known to be unknown.

#include <algorithm>
#include <cstdlib>
#include <regex>

#include "config/numerals.h"
#include "drive/profile/profile_builder.h"
#include "util/text.h"

namespace inverter_bus
{
namespace drive
{
namespace
{
/// Command code and related information. Without quotes YAML reads 0100 as an octal number, which would be another code.
std::optional<double> readOperationCode(const Cursor& cursor)
{
  static const std::regex FORM("[0-9A-Fa-f]{4}");
  const Value& value = cursor.value();
  if (value.type != Value::Type::Text || !std::regex_match(value.text, FORM))
  {
    cursor.reject("four hexadecimal digits in quotes, such as \"0100\"");
    return std::nullopt;
  }
  return static_cast<double>(std::strtoul(value.text.c_str(), nullptr, 16));
}

Constant readConstant(const Cursor& cursor, bool operation_code)
{
  Constant constant;
  Section map(cursor);
  const auto value = map.require("value");
  constant.unconfirmed = map.name("unconfirmed");
  constant.where = map.text("where");
  map.text("source");
  map.finish();
  if (!value)
  {
    return constant;
  }
  if (value->value().text == UNKNOWN)
  {
    if (constant.unconfirmed.empty())
    {
      cursor.complain("is unknown: needs unconfirmed: NAME");
    }
    return constant;
  }
  constant.place = value->value().place;
  constant.key = value->path();
  constant.value = operation_code ? readOperationCode(*value) : value->number({ -4294967296.0, 4294967296.0 });
  return constant;
}

void readGroup(Section& root, const std::string& key, bool operation_codes, Numbering& numbering)
{
  const auto cursor = root.find(key);
  if (!cursor)
  {
    return;
  }
  for (const auto& [name, entry] : cursor->entries())
  {
    if (operation_codes &&
        std::find(operationCodeNames().begin(), operationCodeNames().end(), name) == operationCodeNames().end())
    {
      entry.complain("unknown key: allowed: " + util::joined(operationCodeNames()));
      continue;
    }
    if (config::parseInteger(name) || name == "setpoint" || name == UNKNOWN || numbering.constants.count(name) != 0)
    {
      entry.complain("can't be the name of a constant: allowed: any other name");
      continue;
    }
    numbering.constants[name] = readConstant(entry, operation_codes);
  }
}
}  // namespace

const std::vector<std::string>& operationCodeNames()
{
  static const std::vector<std::string> NAMES = { "run_forward",    "run_reverse",  "stop",        "fault_reset",
                                                  "ram_write_mode", "setup_area_0", "setup_area_1" };
  return NAMES;
}

void readConstants(Section& root, Numbering& numbering, Profile& profile)
{
  readGroup(root, "constants", false, numbering);
  if (numbering.variables)
  {
    readGroup(root, "operation_codes", true, numbering);
  }
  profile.constants = numbering.constants;
  for (const auto& entry : numbering.constants)
  {
    if (!entry.second.unconfirmed.empty())
    {
      profile.unconfirmed.insert(entry.second.unconfirmed);
    }
  }
}
}  // namespace drive
}  // namespace inverter_bus
