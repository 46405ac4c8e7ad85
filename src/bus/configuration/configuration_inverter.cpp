// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "bus/configuration/configuration_inverter.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <regex>
#include <utility>

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
  std::string name = entry.filledText("name", "");
  constexpr std::size_t LONGEST_NAME = 255;
  if (name.size() > LONGEST_NAME || !std::regex_match(name, GRAPH_NAME))
  {
    fail(entry, "name", "is not a legal ROS name", allowed);
  }
  if (std::find(RESERVED_NAMES.begin(), RESERVED_NAMES.end(), name) != RESERVED_NAMES.end())
  {
    fail(entry, "name", "is reserved for the node itself", allowed);
  }
  return name;
}

/// The value of \p key; nothing also where it is empty.
std::optional<config::Cursor> findFilled(const Section& entry, const std::string& key)
{
  const auto found = entry.find(key);
  return found && found->value().type != Value::Type::None ? found : std::nullopt;
}

std::vector<std::string> readConfirm(const Section& entry)
{
  const auto confirm = findFilled(entry, "confirm");
  if (confirm && confirm->value().type == Value::Type::Text)
  {
    return { confirm->value().text };
  }
  return confirm ? confirm->texts("a list of names of unconfirmed items, or all").value_or(std::vector<std::string>())
                 : std::vector<std::string>();
}

/// A field that can't be left out, or does not exist, is a mistake: the user would believe that a safety word is skipped,
/// or that a field is read, when neither is so.
void checkSkipped(const Section& entry, const std::string& field)
{
  const std::string allowed = "status fields that nothing depends on: " + util::joined(drive::skippableFields());
  if (drive::protectedFields().count(field) != 0)
  {
    fail(entry, "skip", "holds '" + field + "', which the driver needs", allowed);
  }
  if (drive::skippableFields().count(field) == 0)
  {
    fail(entry, "skip", "holds '" + util::printable(field) + "', which is not a status field", allowed);
  }
}

std::vector<std::string> readSkip(const Section& entry)
{
  const auto skip = findFilled(entry, "skip");
  const auto fields = skip ? skip->texts("a list of status fields") : std::nullopt;
  for (const std::string& field : fields.value_or(std::vector<std::string>()))
  {
    checkSkipped(entry, field);
  }
  return fields.value_or(std::vector<std::string>());
}

drive::ProfileChanges readChanges(const Section& entry)
{
  drive::ProfileChanges changes;
  changes.skip = readSkip(entry);
  changes.place = entry.spot("drive").place;
  changes.confirm = readConfirm(entry);
  changes.confirm_place = entry.spot("confirm").place;
  if (const auto overrides = findFilled(entry, "overrides"))
  {
    if (!overrides->isMap())
    {
      fail(entry, "overrides", "is not a map", "a map of profile keys");
    }
    changes.overrides = overrides->value();
  }
  return changes;
}

bool begins(const std::string& text, const std::string& start)
{
  return text.compare(0, start.size(), start) == 0;
}

/// The profile reader names file and line; this adds the entry that asked for the profile. A mistake in the entry itself,
/// its overrides or its confirm is passed on unchanged.
drive::Profile loadProfileOf(const InverterConfig& config, const std::string& profile_directory)
{
  const drive::ProfileChanges& changes = config.changes;
  try
  {
    return drive::loadProfile(config.drive, profile_directory, changes);
  }
  catch (const drive::ConfigurationError& error)
  {
    const std::string what = error.what();
    const bool in_overrides = !changes.overrides.map.empty() && begins(what, changes.overrides.place + ": ");
    if (in_overrides || begins(what, changes.confirm_place + ": key 'confirm'") ||
        begins(what, changes.place + ": key 'drive'"))
    {
      throw;
    }
    const std::string place = changes.place + ": key 'drive' = '" + util::printable(config.drive) + "': ";
    throw drive::ConfigurationError(drive::oneLine(place + what));
  }
}

void checkProtocol(const Section& entry, const drive::Profile& profile, const BusConfig& bus)
{
  if (profile.protocol != bus.protocol)
  {
    fail(entry, "drive", "speaks " + profile.protocol + ", but the bus speaks " + bus.protocol,
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
  fail(entry, key, "arms run without stop" + (missing.empty() ? std::string() : " (" + missing + " is unconfirmed)"),
       "run only together with stop" + (missing.empty() ? std::string() : ": confirm or supply " + missing));
}

double readHzPerUnit(const Section& entry)
{
  constexpr double SMALLEST = 1e-6;
  constexpr double LARGEST = 1e6;
  const double hz_per_unit = entry.number("hz_per_unit", { -LARGEST, LARGEST, false, "Hz per unit" }, 1.0);
  if (std::abs(hz_per_unit) < SMALLEST)
  {
    fail(entry, "hz_per_unit", hz_per_unit == 0.0 ? "is 0" : "is too small",
         "a number from 0.000001 to 1000000 Hz per unit, negative where the drive is mounted mirrored, never 0");
  }
  return hz_per_unit;
}

void readVelocities(const Section& entry, const drive::Profile& profile, InverterConfig& config)
{
  config.hz_per_unit = readHzPerUnit(entry);
  const double largest = profile.maximum_frequency / std::abs(config.hz_per_unit);
  const Range range{ 0.0, largest * (1.0 + ROUNDING), true, "(the drive's maximum / |hz_per_unit|)" };
  config.max_velocity = std::min(entry.number("max_velocity", range, largest), largest);
  config.min_velocity = entry.number("min_velocity", { 0.0, config.max_velocity, false, "(max_velocity)" }, 0.0);
}

void readTimes(const Section& entry, const drive::Profile& profile, const BusConfig& bus, InverterConfig& config)
{
  config.command_timeout = entry.number("command_timeout", { 0.0, 3600.0, false, "s" }, config.command_timeout);
  const double inherited = profile.response_timeout.value_or(bus.response_timeout);
  config.response_timeout = entry.number("response_timeout", { 0.0, 10.0, true, "s" }, inherited);
}

std::vector<int> readBlock(const Section& entry, const std::vector<int>& fallback)
{
  const char* const allowed = "five codes from 0 to 14, as for F875 to F879";
  const auto block = entry.find("block_read");
  if (!block)
  {
    return fallback;
  }
  if (!block->isList() || block->value().list.size() != 5)
  {
    fail(entry, "block_read", "is not a list of five", allowed);
  }
  std::vector<int> codes;
  for (const Value& code : block->value().list)
  {
    if (code.type != Value::Type::Integer || code.integer < 0 || code.integer > 14)
    {
      fail(entry, "block_read", "holds a code that the drive does not have", allowed);
    }
    codes.push_back(static_cast<int>(code.integer));
  }
  return codes;
}

std::optional<double> readRating(const Section& entry, const std::string& key, const Range& range)
{
  const auto found = entry.find(key);
  return found ? found->number(range) : std::nullopt;
}

void readOptions(const Section& entry, const BusConfig& bus, InverterConfig& config)
{
  config.limit = readLimit(entry, bus.limit);
  config.rated_current = readRating(entry, "rated_current", { 0.0, 10000.0, true, "A" });
  config.rated_voltage = readRating(entry, "rated_voltage", { 0.0, 10000.0, true, "V" });
  config.configure_block = entry.flag("configure_block", config.configure_block);
  config.block_read = readBlock(entry, config.block_read);
  config.configure_map = entry.flag("configure_map", config.configure_map);
  config.stop_unexpected_motion = entry.flag("stop_unexpected_motion", config.stop_unexpected_motion);
  config.release_on_exit = entry.flag("release_on_exit", config.release_on_exit);
}

/// Keys that only one protocol uses, or that contradict others.
void checkProtocolKeys(const Section& entry, const drive::Profile& profile, const BusConfig& bus)
{
  for (const char* key : { "configure_block", "configure_map" })
  {
    if (bus.parameters_read_only && entry.flag(key, false))
    {
      fail(entry, key, "writes parameters, and parameter_access is read_only",
           "false, or parameter_access: read_write");
    }
  }
  if (!profile.map && entry.flag("configure_map", false))
  {
    fail(entry, "configure_map", "needs a drive with a register map, and the profile " + profile.name + " has none",
         "no configure_map here");
  }
  for (const char* key : { "configure_block", "block_read" })
  {
    if (profile.protocol == "compoway_f" && entry.has(key))
    {
      fail(entry, key, "is a key for Modbus drives, and " + profile.name + " speaks " + profile.protocol,
           "no " + std::string(key) + " here");
    }
  }
}

std::uint8_t readNode(const Section& entry, const drive::Profile& profile, const BusConfig& bus)
{
  if (bus.modbus_tcp)
  {
    // Beyond the serial stations: a drive with a port of its own.
    const std::int64_t unit = entry.integer("node", 0, LAST_UNIT, 0);
    if (unit == 0 || unit > LAST_STATION)
    {
      return static_cast<std::uint8_t>(unit);
    }
  }
  const auto last = std::min<unsigned>(profile.last_station, LAST_STATION);
  return static_cast<std::uint8_t>(entry.integer("node", profile.first_station, last, 0));
}
}  // namespace

ConfiguredInverter readInverter(const Section& entry, const BusConfig& bus, const std::string& profile_directory)
{
  InverterConfig config;
  config.name = readName(entry);
  // Before the profile is read, so that an absurd value gets its own message; the drive's own range comes with the profile.
  entry.require("node", "a station number");
  const bool from_zero = bus.modbus_tcp || bus.protocol == "compoway_f";
  entry.integer("node", from_zero ? 0 : 1, bus.modbus_tcp ? LAST_UNIT : LAST_STATION, 0);
  entry.require("drive", "the name of a profile or an absolute path to one");
  config.drive = entry.filledText("drive", "");
  config.changes = readChanges(entry);
  config.skip = config.changes.skip;
  drive::Drive drive(loadProfileOf(config, profile_directory));
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
