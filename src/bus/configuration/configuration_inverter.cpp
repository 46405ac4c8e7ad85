// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "bus/configuration/configuration_inverter.h"

#include <algorithm>
#include <cmath>
#include <regex>
#include <utility>

#include "bus/configuration/configuration_yaml.h"
#include "util/printable.h"
#include "util/text.h"

namespace inverter_bus
{
namespace bus
{
namespace
{
/// Names that the node itself uses beside those of the inverters.
const std::vector<std::string> RESERVED_NAMES{ "bus", "command", "stop", "bus_status", "dump_trace" };

/// Stations that a request can address at all: Modbus 1 to 247, CompoWay/F 0 to 99.
constexpr int LAST_STATION = InverterConfig::LAST_SERIAL_STATION;
/// Unit identifiers of Modbus TCP.
constexpr int LAST_UNIT = 255;

/// A velocity that the profile's maximum allows by arithmetic may miss it by rounding.
constexpr double ROUNDING = 1e-9;

std::string readName(const Section& entry)
{
  static const std::regex GRAPH_NAME("[A-Za-z][A-Za-z0-9_]*");
  const std::string allowed = "a letter, then letters, digits and _; not " + util::joined(RESERVED_NAMES);
  entry.require("name", allowed);
  std::string name = entry.text("name", "");
  constexpr std::size_t LONGEST_NAME = 255;
  if (name.size() > LONGEST_NAME || !std::regex_match(name, GRAPH_NAME))
  {
    entry.fail("name", "is no legal ROS name", allowed);
  }
  if (std::find(RESERVED_NAMES.begin(), RESERVED_NAMES.end(), name) != RESERVED_NAMES.end())
  {
    entry.fail("name", "is reserved for the node itself", allowed);
  }
  return name;
}

std::vector<std::string> readConfirm(const Section& entry)
{
  const char* const allowed = "a list of names of unconfirmed items, or all";
  const Value* value = entry.find("confirm");
  if (value == nullptr || value->type == Value::Type::None)
  {
    return {};
  }
  if (value->type == Value::Type::Text)
  {
    return { value->text };
  }
  if (value->type != Value::Type::List)
  {
    entry.fail("confirm", "is no list of names", allowed);
  }
  std::vector<std::string> names;
  for (const Value& name : value->list)
  {
    if (name.type != Value::Type::Text)
    {
      entry.fail("confirm", "holds something else than names", allowed);
    }
    names.push_back(name.text);
  }
  return names;
}

/// What can't be left out, and what does not exist, is a mistake: a safety word that somebody believes skipped, or a field
/// that he believes read, is neither.
void checkSkipped(const Section& entry, const std::string& field)
{
  const std::string allowed = "fields of the status that nothing depends on: " + util::joined(drive::skippableFields());
  if (drive::protectedFields().count(field) != 0)
  {
    entry.fail("skip", "holds '" + field + "', which the driver can't do without", allowed);
  }
  if (drive::skippableFields().count(field) == 0)
  {
    entry.fail("skip", "holds '" + util::printable(field) + "', which is no field of the status", allowed);
  }
}

std::vector<std::string> readSkip(const Section& entry)
{
  const char* const allowed = "a list of status fields";
  const Value* value = entry.find("skip");
  if (value == nullptr || value->type == Value::Type::None)
  {
    return {};
  }
  if (value->type != Value::Type::List)
  {
    entry.fail("skip", "is no list", allowed);
  }
  std::vector<std::string> fields;
  for (const Value& field : value->list)
  {
    if (field.type != Value::Type::Text)
    {
      entry.fail("skip", "holds something else than names", allowed);
    }
    checkSkipped(entry, field.text);
    fields.push_back(field.text);
  }
  return fields;
}

drive::ProfileChanges readChanges(const Section& entry)
{
  drive::ProfileChanges changes;
  changes.skip = readSkip(entry);
  changes.place = entry.placeOf("drive");
  changes.confirm = readConfirm(entry);
  changes.confirm_place = entry.placeOf("confirm");
  const Value* overrides = entry.find("overrides");
  if (overrides == nullptr || overrides->type == Value::Type::None)
  {
    return changes;
  }
  if (overrides->type != Value::Type::Map)
  {
    entry.fail("overrides", "is no map", "a map of profile keys");
  }
  if (!overrides->map.empty())
  {
    changes.overrides_yaml = toYaml(*overrides);
    changes.place = entry.placeOf("overrides");
  }
  return changes;
}

bool begins(const std::string& text, const std::string& start)
{
  return text.compare(0, start.size(), start) == 0;
}

/// The profile reader names file and line; this adds the entry that asked for the profile. What is wrong with the entry's own
/// overrides and confirm it names itself.
drive::Profile loadProfileOf(const Section& entry, const InverterConfig& config, const std::string& profile_directory)
{
  try
  {
    return drive::loadProfile(config.drive, profile_directory, config.changes);
  }
  catch (const drive::ConfigurationError& error)
  {
    const std::string what = error.what();
    const bool in_overrides = !config.changes.overrides_yaml.empty() && begins(what, config.changes.place + ": ");
    if (in_overrides || begins(what, config.changes.confirm_place + ": key 'confirm'"))
    {
      throw;
    }
    const std::string place = entry.placeOf("drive") + ": key 'drive' = '" + util::printable(config.drive) + "': ";
    throw drive::ConfigurationError(drive::oneLine(place + error.what()));
  }
}

void checkProtocol(const Section& entry, const drive::Profile& profile, const BusConfig& bus)
{
  if (profile.protocol != bus.protocol)
  {
    entry.fail("drive", "speaks " + profile.protocol + ", the bus " + bus.protocol,
               "a drive that speaks " + bus.protocol);
  }
}

/// A drive that can be started must be one that can be stopped.
void checkArming(const Section& entry, const drive::Drive& drive)
{
  if (!drive.runsWithoutStop())
  {
    return;
  }
  const std::string missing = drive.missingFor("stop");
  const std::string key = entry.has("confirm") ? "confirm" : entry.has("overrides") ? "overrides" : "drive";
  entry.fail(key, "arms run without stop" + (missing.empty() ? std::string() : " (" + missing + " is unconfirmed)"),
             "run only together with stop" + (missing.empty() ? std::string() : ": confirm or supply " + missing));
}

double readHzPerUnit(const Section& entry)
{
  constexpr double SMALLEST = 1e-6;
  constexpr double LARGEST = 1e6;
  const double hz_per_unit = entry.number("hz_per_unit", 1.0, Range{ -LARGEST, LARGEST, false, "Hz per unit" });
  if (std::abs(hz_per_unit) < SMALLEST)
  {
    entry.fail("hz_per_unit", hz_per_unit == 0.0 ? "is 0" : "is too small",
               "a number from 0.000001 to 1000000 Hz per unit, negative where the drive is mounted mirrored, never 0");
  }
  return hz_per_unit;
}

void readVelocities(const Section& entry, const drive::Profile& profile, InverterConfig& config)
{
  config.hz_per_unit = readHzPerUnit(entry);
  const double largest = profile.maximum_frequency / std::abs(config.hz_per_unit);
  const Range range{ 0.0, largest * (1.0 + ROUNDING), true, "(the drive's maximum / |hz_per_unit|)" };
  config.max_velocity = std::min(entry.number("max_velocity", largest, range), largest);
  config.min_velocity = entry.number("min_velocity", 0.0, Range{ 0.0, config.max_velocity, false, "(max_velocity)" });
}

void readTimes(const Section& entry, const drive::Profile& profile, const BusConfig& bus, InverterConfig& config)
{
  config.command_timeout = entry.number("command_timeout", config.command_timeout, Range{ 0.0, 3600.0, false, "s" });
  const double inherited = profile.response_timeout.value_or(bus.response_timeout);
  config.response_timeout = entry.number("response_timeout", inherited, Range{ 0.0, 10.0, true, "s" });
}

std::vector<int> readBlock(const Section& entry, const std::vector<int>& fallback)
{
  const char* const allowed = "five codes from 0 to 14, as for F875 to F879";
  const Value* value = entry.find("block_read");
  if (value == nullptr)
  {
    return fallback;
  }
  if (value->type != Value::Type::List || value->list.size() != 5)
  {
    entry.fail("block_read", "is no list of five", allowed);
  }
  std::vector<int> codes;
  for (const Value& code : value->list)
  {
    if (code.type != Value::Type::Integer || code.integer < 0 || code.integer > 14)
    {
      entry.fail("block_read", "holds a code that the drive does not have", allowed);
    }
    codes.push_back(static_cast<int>(code.integer));
  }
  return codes;
}

void readOptions(const Section& entry, const BusConfig& bus, InverterConfig& config)
{
  config.limit = readLimit(entry, bus.limit);
  config.rated_current = entry.number("rated_current", Range{ 0.0, 10000.0, true, "A" });
  config.rated_voltage = entry.number("rated_voltage", Range{ 0.0, 10000.0, true, "V" });
  config.configure_block = entry.boolean("configure_block", config.configure_block);
  config.block_read = readBlock(entry, config.block_read);
  config.configure_map = entry.boolean("configure_map", config.configure_map);
  config.stop_unexpected_motion = entry.boolean("stop_unexpected_motion", config.stop_unexpected_motion);
  config.release_on_exit = entry.boolean("release_on_exit", config.release_on_exit);
}

/// Keys that mean something to one protocol only, or contradict others.
void checkProtocolKeys(const Section& entry, const drive::Profile& profile, const BusConfig& bus)
{
  for (const char* key : { "configure_block", "configure_map" })
  {
    if (bus.parameters_read_only && entry.boolean(key, false))
    {
      entry.fail(key, "writes parameters, and parameter_access is read_only", "false, or parameter_access: read_write");
    }
  }
  if (!profile.map && entry.boolean("configure_map", false))
  {
    entry.fail("configure_map", "needs a drive with a register map, and the profile " + profile.name + " has none",
               "no configure_map here");
  }
  for (const char* key : { "configure_block", "block_read" })
  {
    if (profile.protocol == "compoway_f" && entry.has(key))
    {
      entry.fail(key, "is a key for Modbus drives, and " + profile.name + " speaks " + profile.protocol,
                 "no " + std::string(key) + " here");
    }
  }
}

std::uint8_t readNode(const Section& entry, const drive::Profile& profile, const BusConfig& bus)
{
  if (bus.modbus_tcp)
  {
    // Beyond the serial stations: a drive with a port of its own.
    const std::int64_t unit = entry.integer("node", 0, 0, LAST_UNIT);
    if (unit == 0 || unit > LAST_STATION)
    {
      return static_cast<std::uint8_t>(unit);
    }
  }
  const auto last = std::min<unsigned>(profile.last_station, LAST_STATION);
  return static_cast<std::uint8_t>(entry.integer("node", 0, profile.first_station, last));
}
}  // namespace

ConfiguredInverter readInverter(const Section& entry, const BusConfig& bus, const std::string& profile_directory)
{
  InverterConfig config;
  config.name = readName(entry);
  // Before the profile is read, so that nonsense is named as such; its own range comes with the profile.
  entry.require("node", "a station number");
  const bool from_zero = bus.modbus_tcp || bus.protocol == "compoway_f";
  entry.integer("node", 0, from_zero ? 0 : 1, bus.modbus_tcp ? LAST_UNIT : LAST_STATION);
  entry.require("drive", "the name of a profile or an absolute path to one");
  config.drive = entry.text("drive", "");
  config.changes = readChanges(entry);
  config.skip = config.changes.skip;
  drive::Drive drive(loadProfileOf(entry, config, profile_directory));
  const drive::Profile& profile = drive.profile();
  checkProtocol(entry, profile, bus);
  config.modbus_tcp = bus.modbus_tcp;
  config.node = readNode(entry, profile, bus);
  checkArming(entry, drive);
  checkProtocolKeys(entry, profile, bus);
  readVelocities(entry, profile, config);
  readTimes(entry, profile, bus, config);
  readOptions(entry, bus, config);
  return ConfiguredInverter{ std::move(config), std::move(drive) };
}
}  // namespace bus
}  // namespace inverter_bus
