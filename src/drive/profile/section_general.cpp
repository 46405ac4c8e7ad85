// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
// Sections drive, title, manuals, protocol, numbering, stations, serial, limits, spans, frequency, timing, exceptions.

#include <set>
#include <type_traits>

#include "config/numerals.h"
#include "drive/profile/profile_builder.h"
#include "util/text.h"

namespace inverter_bus
{
namespace drive
{
namespace
{
constexpr std::int64_t MAX_MODBUS_STATION = 247;
constexpr std::int64_t MAX_COMPOWAY_STATION = 99;
constexpr double MAX_FREQUENCY = 10000.0;
constexpr double MAX_DELAY = 60.0;

/// The values that \p read reads from the elements of a list: at least one, and none twice.
template <typename Read>
auto readSet(const Cursor& cursor, Read read)
{
  std::set<typename std::invoke_result_t<Read, const Cursor&>::value_type> result;
  for (const Cursor& entry : cursor.list())
  {
    const auto value = read(entry);
    if (value && !result.insert(*value).second)
    {
      entry.complain("is in the list twice");
    }
  }
  if (cursor.isList() && cursor.value().list.empty())
  {
    cursor.complain("is an empty list: at least one value is needed");
  }
  return result;
}

std::set<unsigned> readUnsignedSet(const Cursor& cursor, std::int64_t lowest, std::int64_t highest)
{
  const auto values = readSet(cursor, [&](const Cursor& entry) { return entry.integer(lowest, highest); });
  return { values.begin(), values.end() };
}

std::set<std::string> readParities(const Cursor& cursor)
{
  return readSet(cursor, [](const Cursor& entry) { return entry.choice({ "none", "even", "odd" }); });
}

bool isCompoway(const Profile& profile)
{
  return profile.protocol == "compoway_f";
}

/// "8E1": data bits, parity, stop bits.
void readCharacters(const Cursor& cursor, Profile& profile)
{
  static const std::map<char, std::string> PARITIES = { { 'N', "none" }, { 'E', "even" }, { 'O', "odd" } };
  const unsigned least = isCompoway(profile) ? 7 : 8;
  for (const Cursor& entry : cursor.list())
  {
    const std::string text = entry.text().value_or("");
    const bool form = text.size() == 3 && PARITIES.count(text[1]) != 0 && (text[2] == '1' || text[2] == '2');
    const unsigned bits = form ? static_cast<unsigned>(text[0] - '0') : 0;
    if (!form || bits < least || bits > 8)
    {
      entry.reject("data bits, parity and stop bits, such as 8N2, 8E1 or 8O1" +
                   std::string(least == 7 ? ", 7E2" : " (Modbus RTU: 8 data bits)"));
      continue;
    }
    profile.characters.insert(text);
    profile.data_bits.insert(bits);
    profile.parities.insert(PARITIES.at(text[1]));
    profile.stop_bits.insert(static_cast<unsigned>(text[2] - '0'));
  }
  if (cursor.isList() && cursor.value().list.empty())
  {
    cursor.complain("is an empty list: at least one value is needed");
  }
}

void readServices(const Cursor& cursor, Profile& profile)
{
  const std::set<unsigned> known = { 0x0101, 0x0102, 0x0503, 0x0601, 0x0801, 0x3005 };
  profile.functions = readUnsignedSet(cursor, 1, 0xFFFF);
  for (const unsigned service : profile.functions)
  {
    if (known.count(service) == 0)
    {
      cursor.complain("service " + util::hexNumber(service) +
                      ": allowed: 0x0101, 0x0102, 0x0503, 0x0601, 0x0801, 0x3005");
    }
  }
}

void readFunctions(const Cursor& cursor, Profile& profile)
{
  const std::set<unsigned> known = { 0x01, 0x03, 0x05, 0x06, 0x08, 0x0F, 0x10, 0x17 };
  profile.functions = readUnsignedSet(cursor, 1, 0x7F);
  for (const unsigned function : profile.functions)
  {
    if (known.count(function) == 0)
    {
      cursor.complain("function " + util::hexNumber(function) +
                      ": allowed: 0x01, 0x03, 0x05, 0x06, 0x08, 0x0F, 0x10, 0x17");
    }
  }
}

void readSpansSection(Section& root, const Numbering& numbering, Profile& profile)
{
  const auto cursor = root.find("spans");
  if (!cursor)
  {
    return;
  }
  Section spans(*cursor);
  if (const auto registers = spans.find("registers"))
  {
    profile.register_spans = readSpans(*registers, numbering, Space::Register);
  }
  if (const auto coils = spans.find("coils"))
  {
    profile.coil_spans = readSpans(*coils, numbering, Space::Coil);
  }
  spans.finish();
}

void readExceptions(Section& root, Profile& profile)
{
  const auto cursor = root.find("exceptions");
  if (!cursor)
  {
    return;
  }
  for (const auto& [key, meaning] : cursor->entries())
  {
    const auto code = config::parseInteger(key);
    const auto text = meaning.text();
    const std::int64_t highest = isCompoway(profile) ? 0xFFFF : 0xFF;
    if (!code || *code < 1 || *code > highest)
    {
      meaning.complain("the exception code '" + key + "': allowed: an integer from 1 to " + std::to_string(highest));
    }
    else if (text)
    {
      profile.exceptions[static_cast<unsigned>(*code)] = *text;
    }
  }
}

void readBroadcast(Section& root, Profile& profile)
{
  const auto cursor = root.find("broadcast");
  if (!cursor)
  {
    return;
  }
  Section broadcast(*cursor);
  profile.broadcast_stop = broadcast.flag("stop", false);
  profile.broadcast_turnaround = broadcast.number("turnaround", { 0.0, MAX_DELAY }, profile.broadcast_turnaround);
  broadcast.text("source");
  broadcast.finish();
}
}  // namespace

namespace
{
void readStations(const Cursor& cursor, Profile& profile)
{
  Section stations(cursor);
  // Modbus keeps 0 for the broadcast; CompoWay/F has letters for that.
  const std::int64_t lowest = isCompoway(profile) ? 0 : 1;
  const std::int64_t highest = isCompoway(profile) ? MAX_COMPOWAY_STATION : MAX_MODBUS_STATION;
  const auto first = stations.require("first");
  const auto last = stations.require("last");
  profile.first_station = static_cast<unsigned>(first ? first->integer(lowest, highest).value_or(1) : 1);
  profile.last_station = static_cast<unsigned>(last ? last->integer(lowest, highest).value_or(highest) : highest);
  if (profile.last_station < profile.first_station)
  {
    cursor.complain("last is below first");
  }
  stations.finish();
}

void readSerial(const Cursor& cursor, Profile& profile)
{
  Section serial(cursor);
  const auto baud_rates = serial.require("baud_rates");
  profile.baud_rates = baud_rates ? readUnsignedSet(*baud_rates, 110, 4000000) : std::set<unsigned>();
  if (const auto characters = serial.find("characters"))
  {
    readCharacters(*characters, profile);
    serial.finish();
    return;
  }
  const auto data_bits = serial.require("data_bits");
  const auto parity = serial.require("parity");
  const auto stop_bits = serial.require("stop_bits");
  // A Modbus RTU character has 8 data bits, whatever the drive's other protocols use.
  const std::int64_t least = isCompoway(profile) ? 7 : 8;
  profile.data_bits = data_bits ? readUnsignedSet(*data_bits, least, 8) : std::set<unsigned>();
  profile.parities = parity ? readParities(*parity) : std::set<std::string>();
  profile.stop_bits = stop_bits ? readUnsignedSet(*stop_bits, 1, 2) : std::set<unsigned>();
  serial.finish();
}

void readModbusLimits(Section& limits, Profile& profile)
{
  if (const auto functions = limits.require("functions"))
  {
    readFunctions(*functions, profile);
  }
  // Upper ends: Modbus application protocol V1.1b3, sections 6.1, 6.3 and 6.12.
  profile.read_registers = static_cast<unsigned>(limits.integer("read_registers", 1, 125, 1));
  profile.write_registers = static_cast<unsigned>(limits.integer("write_registers", 1, 123, 1));
  profile.read_coils = static_cast<unsigned>(limits.integer("read_coils", 1, 2000, 1));
  if (limits.has("hole"))
  {
    profile.hole = static_cast<std::uint16_t>(limits.integer("hole", 0, 0xFFFF, 0));
  }
}

void readCompowayLimits(Section& limits, Profile& profile)
{
  if (const auto services = limits.require("services"))
  {
    readServices(*services, profile);
  }
  profile.frame = static_cast<unsigned>(limits.integer("frame", 32, 256, 40));
  // A reply has 17 characters and 8 for every element, the request of a write 24 and 8.
  profile.read_registers = static_cast<unsigned>(limits.integer("read_elements", 1, (profile.frame - 17) / 8, 1));
  profile.write_registers = static_cast<unsigned>(limits.integer("write_elements", 1, (profile.frame - 24) / 8, 1));
}
}  // namespace

Numbering readNumbering(Section& root)
{
  Numbering result;
  const auto protocol = root.find("protocol");
  result.variables = protocol && protocol->value().text == "compoway_f";
  const auto cursor = result.variables ? std::nullopt : root.require("numbering");
  if (!cursor)
  {
    return result;
  }
  Section numbering(*cursor);
  if (const auto offset = numbering.require("register_offset"))
  {
    result.register_offset = offset->integer(-0xFFFF, 0).value_or(0);
  }
  result.coil_offset = numbering.integer("coil_offset", -0xFFFF, 0, 0);
  result.decimal = numbering.flag("decimal", false);
  numbering.text("source");
  numbering.finish();
  return result;
}

void readIdentity(Section& root, Profile& profile)
{
  if (const auto cursor = root.require("drive"))
  {
    profile.name = cursor->name().value_or("");
  }
  if (const auto cursor = root.require("title"))
  {
    profile.title = cursor->text().value_or("");
  }
  if (const auto cursor = root.find("manuals"))
  {
    for (const auto& entry : cursor->entries())
    {
      entry.second.text();
    }
  }
}

void readLine(Section& root, Profile& profile)
{
  if (const auto cursor = root.require("protocol"))
  {
    profile.protocol = cursor->choice({ "modbus_rtu", "compoway_f" }).value_or("");
  }
  if (const auto cursor = root.require("stations"))
  {
    readStations(*cursor, profile);
  }
  if (const auto cursor = root.require("serial"))
  {
    readSerial(*cursor, profile);
  }
}

void readLimits(Section& root, const Numbering& numbering, Profile& profile)
{
  if (const auto cursor = root.require("limits"))
  {
    Section limits(*cursor);
    isCompoway(profile) ? readCompowayLimits(limits, profile) : readModbusLimits(limits, profile);
    limits.text("source");
    limits.finish();
  }
  readSpansSection(root, numbering, profile);
  readExceptions(root, profile);
  readBroadcast(root, profile);
}

void readTiming(Section& root, Profile& profile)
{
  if (const auto cursor = root.require("frequency"))
  {
    Section frequency(*cursor);
    if (const auto maximum = frequency.require("maximum"))
    {
      profile.maximum_frequency = maximum->number({ 0.01, MAX_FREQUENCY }).value_or(MAX_FREQUENCY);
    }
    frequency.text("source");
    frequency.finish();
  }
  if (const auto cursor = root.find("timing"))
  {
    Section timing(*cursor);
    profile.reply_delay = timing.number("reply_delay", { 0.0, MAX_DELAY }, 0.0);
    if (timing.has("response_timeout"))
    {
      profile.response_timeout = timing.number("response_timeout", { 0.001, MAX_DELAY }, 0.1);
    }
    profile.quiet_before = timing.number("quiet_before", { 0.0, 1.0 }, 0.0);
    profile.deaf_after_reset = timing.number("deaf_after_reset", { 0.0, MAX_DELAY }, 0.0);
    profile.reply_delay_parameter = timing.name("reply_delay_parameter");
    timing.text("source");
    timing.finish();
  }
}
}  // namespace drive
}  // namespace inverter_bus
