// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "bench/scan_list.h"

#include <algorithm>
#include <filesystem>
#include <memory>

#include "bench/profile_drive.h"
#include "inverter_bus/bus/configuration.h"
#include "util/printable.h"

namespace inverter_bus
{
namespace bench
{
namespace
{
/// What roslaunch puts in place of $(find inverter_bus), wherever the program runs.
void findPackage(config::Value& value, const std::string& share)
{
  static const std::string CALL = "$(find inverter_bus)";
  for (std::size_t at = value.text.find(CALL); at != std::string::npos; at = value.text.find(CALL, at + share.size()))
  {
    value.text.replace(at, CALL.size(), share);
  }
  for (config::Value& element : value.list)
  {
    findPackage(element, share);
  }
  for (config::Entry& entry : value.map)
  {
    findPackage(entry.value, share);
  }
}

void giveProfile(simulation::DriveConfig& drive, const bus::Configuration& judged)
{
  const auto& inverters = judged.bus.inverters;
  const auto known = std::find_if(inverters.begin(), inverters.end(),
                                  [&drive](const bus::InverterConfig& one) { return one.name == drive.options.name; });
  if (known == inverters.end())
  {
    throw simulation::ConfigError(
        "simulation." + util::printable(drive.options.name) +
        ".model: profile, and no scan list entry names its drive (allowed: a simulated model)");
  }
  const drive::Profile& profile = judged.drives[static_cast<std::size_t>(known - inverters.begin())].profile();
  if (profile.protocol != "modbus_rtu")
  {
    throw simulation::ConfigError("drive: " + util::printable(known->drive) + " of " + known->name + " speaks " +
                                  profile.protocol + " (allowed: a profile for modbus_rtu, or a simulated model)");
  }
  const auto shared = std::make_shared<const drive::Profile>(profile);
  drive.make = [shared](const simulation::DriveOptions& options) {
    return std::make_unique<ProfileDrive>(shared, options);
  };
}
}  // namespace

SimulatedScanList readScanList(config::Value parameters, const std::string& place, const std::string& profile_directory,
                               const simulation::SerialOptions& drives_serial)
{
  const std::filesystem::path share = std::filesystem::path(profile_directory).parent_path().parent_path();
  findPackage(parameters, share.string());
  const bus::Configuration judged = bus::readConfiguration(parameters, place, profile_directory);
  SimulatedScanList result;
  result.config = simulation::busConfigFromParameters(parameters, drives_serial);
  result.warnings = judged.warnings;
  for (simulation::DriveConfig& drive : result.config.drives)
  {
    if (drive.model == "profile")
    {
      giveProfile(drive, judged);
    }
  }
  return result;
}
}  // namespace bench
}  // namespace inverter_bus
