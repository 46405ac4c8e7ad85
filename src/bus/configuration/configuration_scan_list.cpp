// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "bus/configuration/configuration_scan_list.h"

#include <cstdlib>
#include <limits>
#include <regex>

#include "bus/configuration/configuration_keys.h"
#include "util/printable.h"

namespace inverter_bus
{
namespace bus
{
namespace
{
const char* const SCAN_LIST = "scan_list";
const char* const MASK_FORMS =
    "a list of inverters, or a bit mask of stations 1 to 31: an integer, '0x80000002' or "
    "'#80000002' (in quotes)";

/// ROS parameters are int32: bit 31 makes a mask negative.
std::uint32_t maskFromInteger(const Section& bus, std::int64_t number)
{
  if (number < std::numeric_limits<std::int32_t>::min() || number > std::numeric_limits<std::uint32_t>::max())
  {
    bus.fail(SCAN_LIST, "has more than 32 bits", MASK_FORMS);
  }
  return static_cast<std::uint32_t>(number);
}

std::uint32_t maskFromText(const Section& bus, const std::string& text)
{
  static const std::regex HEXADECIMAL("(0[xX]|#)([0-9a-fA-F]{1,8})");
  std::smatch match;
  if (!std::regex_match(text, match, HEXADECIMAL))
  {
    bus.fail(SCAN_LIST, "is no bit mask", MASK_FORMS);
  }
  return static_cast<std::uint32_t>(std::strtoul(match[2].str().c_str(), nullptr, 16));
}

Value integerValue(std::int64_t number)
{
  Value value;
  value.type = Value::Type::Integer;
  value.integer = number;
  return value;
}

Value textValue(const std::string& text)
{
  Value value;
  value.type = Value::Type::Text;
  value.text = text;
  return value;
}

std::vector<Section> entriesFromMask(const Section& bus, std::uint32_t mask, const Section& defaults)
{
  std::vector<Section> entries;
  for (int node = 1; node <= 31; ++node)
  {
    if ((mask >> node & 1U) == 0)
    {
      continue;
    }
    Value entry;
    entry.type = Value::Type::Map;
    entry.map["name"] = textValue("inverter_" + std::to_string(node));
    entry.map["node"] = integerValue(node);
    entries.emplace_back(entry, bus.placeOf(SCAN_LIST) + " station " + std::to_string(node) + " of scan_list",
                         bus.remarks());
    entries.back().inherit(defaults);
  }
  if (entries.empty())
  {
    bus.fail(SCAN_LIST, "names no station (bit 0 does not count)", MASK_FORMS);
  }
  return entries;
}

/// "~scan_list[2] (belt_outfeed)".
std::string entryPlace(const std::string& place, std::size_t index, const Value& entry)
{
  std::string text = place + "scan_list[" + std::to_string(index) + "]";
  const auto name = entry.map.find("name");
  if (name != entry.map.end() && name->second.type == Value::Type::Text)
  {
    text += " (" + util::printable(name->second.text) + ")";
  }
  return text;
}

std::vector<Section> entriesFromList(const Section& bus, const std::vector<Value>& list, const Section& defaults,
                                     const std::string& place)
{
  if (list.empty())
  {
    bus.fail(SCAN_LIST, "is empty", MASK_FORMS);
  }
  std::vector<Section> entries;
  for (std::size_t i = 0; i < list.size(); ++i)
  {
    entries.emplace_back(list[i], entryPlace(place, i, list[i]), bus.remarks());
    entries.back().refuseUnknownKeys(entryKeys());
    entries.back().inherit(defaults);
  }
  return entries;
}

Section readDefaults(const Section& bus, const std::string& place)
{
  Value none;
  none.type = Value::Type::Map;
  const Value* value = bus.find("defaults");
  const bool given = value != nullptr && value->type != Value::Type::None;
  Section defaults(given ? *value : none, place + "defaults", bus.remarks());
  defaults.refuseUnknownKeys(sharedKeys());
  return defaults;
}
}  // namespace

std::vector<Section> readScanList(const Section& bus, const std::string& place)
{
  bus.require(SCAN_LIST, MASK_FORMS);
  const Section defaults = readDefaults(bus, place);
  const Value& value = *bus.find(SCAN_LIST);
  switch (value.type)
  {
    case Value::Type::List:
      return entriesFromList(bus, value.list, defaults, place);
    case Value::Type::Integer:
      return entriesFromMask(bus, maskFromInteger(bus, value.integer), defaults);
    case Value::Type::Text:
      return entriesFromMask(bus, maskFromText(bus, value.text), defaults);
    default:
      bus.fail(SCAN_LIST, "is neither a list nor a bit mask", MASK_FORMS);
  }
}
}  // namespace bus
}  // namespace inverter_bus
