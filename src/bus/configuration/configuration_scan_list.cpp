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
    fail(bus, SCAN_LIST, "has more than 32 bits", MASK_FORMS);
  }
  return static_cast<std::uint32_t>(number);
}

std::uint32_t maskFromText(const Section& bus, const std::string& text)
{
  static const std::regex HEXADECIMAL("(0[xX]|#)([0-9a-fA-F]{1,8})");
  std::smatch match;
  if (!std::regex_match(text, match, HEXADECIMAL))
  {
    fail(bus, SCAN_LIST, "is not a bit mask", MASK_FORMS);
  }
  return static_cast<std::uint32_t>(std::strtoul(match[2].str().c_str(), nullptr, 16));
}

std::vector<Value> entriesFromMask(const Section& bus, std::uint32_t mask, const Value& defaults)
{
  std::vector<Value> entries;
  for (int node = 1; node <= 31; ++node)
  {
    if ((mask >> node & 1U) == 0)
    {
      continue;
    }
    const std::string station = std::to_string(node);
    entries.push_back(
        Value::ofMap({ { "name", Value::ofText("inverter_" + station) }, { "node", Value::ofInteger(node) } }));
    entries.back().moveTo(bus.spot(SCAN_LIST).place + " station " + station + " of scan_list");
    entries.back().inherit(defaults);
  }
  if (entries.empty())
  {
    fail(bus, SCAN_LIST, "names no station (bit 0 does not count)", MASK_FORMS);
  }
  return entries;
}

/// "~scan_list[2] (belt_outfeed)".
std::string entryPlace(const std::string& place, std::size_t index, const Value& entry)
{
  const Value* name = entry.find("name");
  const bool named = name != nullptr && name->type == Value::Type::Text;
  return place + "scan_list[" + std::to_string(index) + "]" + (named ? " (" + util::printable(name->text) + ")" : "");
}

std::vector<Value> entriesFromList(const Section& bus, std::vector<Value> entries, const Value& defaults,
                                   const std::string& place)
{
  if (entries.empty())
  {
    fail(bus, SCAN_LIST, "is empty", MASK_FORMS);
  }
  for (std::size_t i = 0; i < entries.size(); ++i)
  {
    entries[i].moveTo(entryPlace(place, i, entries[i]));
    sectionOf(entries[i], bus.cursor().complaints()).allowOnly(entryKeys());
    entries[i].inherit(defaults);
  }
  return entries;
}

Value readDefaults(const Section& bus, const std::string& place)
{
  const auto given = bus.find("defaults");
  Value defaults = given && given->value().type != Value::Type::None ? given->value() : Value::ofMap({});
  defaults.moveTo(place + "defaults");
  sectionOf(defaults, bus.cursor().complaints()).allowOnly(sharedKeys());
  return defaults;
}
}  // namespace

std::vector<Value> readScanList(const Section& bus, const std::string& place)
{
  bus.require(SCAN_LIST, MASK_FORMS);
  const Value defaults = readDefaults(bus, place);
  const Value& value = bus.find(SCAN_LIST)->value();
  switch (value.type)
  {
    case Value::Type::List:
      return entriesFromList(bus, value.list, defaults, place);
    case Value::Type::Integer:
      return entriesFromMask(bus, maskFromInteger(bus, value.integer), defaults);
    case Value::Type::Text:
      return entriesFromMask(bus, maskFromText(bus, value.text), defaults);
    default:
      fail(bus, SCAN_LIST, "is neither a list nor a bit mask", MASK_FORMS);
  }
}
}  // namespace bus
}  // namespace inverter_bus
