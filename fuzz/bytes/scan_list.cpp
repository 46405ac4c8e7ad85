// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
// A scan list file as a user writes it, with overrides of the profiles in it. INVERTER_BUS_FUZZ_PROFILES names another
// directory of profiles (smaller ones are read faster).
#include <cstdlib>
#include <string>

#include "checks.h"
#include "inverter_bus/bus/configuration.h"
#include "text_file.h"

namespace
{
std::string profileDirectory()
{
  const char* const other = std::getenv("INVERTER_BUS_FUZZ_PROFILES");
  return other != nullptr ? other : INVERTER_BUS_ROOT "/config/drives";
}

void checkConfiguration(const inverter_bus::bus::Configuration& configuration)
{
  using inverter_bus::fuzz::require;
  require(!configuration.drives.empty() && configuration.drives.size() == configuration.bus.inverters.size(),
          "no drives, or not as many as inverters");
  require(configuration.bus.response_timeout > 0.0 && configuration.bus.response_timeout <= 10.0, "no time-out");
  for (const auto& inverter : configuration.bus.inverters)
  {
    require(inverter.max_velocity > 0.0 && inverter.max_velocity <= 1e9, "no maximum");
    require(inverter.min_velocity >= 0.0 && inverter.min_velocity <= inverter.max_velocity, "no minimum");
    require(inverter.response_timeout > 0.0 && inverter.response_timeout <= 10.0, "no time-out of an inverter");
    require(inverter.command_timeout >= 0.0, "a command time-out below 0");
  }
  inverter_bus::bus::makeProtocol(configuration.bus);
  inverter_bus::bus::makeTiming(configuration.bus);
}
}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  static inverter_bus::fuzz::TextFile file;
  static const std::string PROFILES = profileDirectory();
  file.write(data, size);
  try
  {
    const inverter_bus::bus::Value parameters = inverter_bus::bus::readYamlFile(file.path());
    checkConfiguration(inverter_bus::bus::readConfiguration(parameters, file.path(), PROFILES));
  }
  catch (const inverter_bus::drive::ConfigurationError& error)
  {
    inverter_bus::fuzz::requireOneLine(error.what());
  }
  return 0;
}
