// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

#ifndef INVERTER_BUS_SIMULATION_PANEL_CONTROL_H
#define INVERTER_BUS_SIMULATION_PANEL_CONTROL_H

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "simulation/drives/parameter_memory.h"

namespace inverter_bus
{
namespace simulation
{
/// The parameters that say what commands a drive.
struct CommandSources
{
  std::vector<ParameterMemory::Index> parameters;
  std::uint32_t panel = 0;                                 ///< their value for the panel
  ParameterMemory::Index highest = ParameterMemory::NONE;  ///< the maximum frequency
};

/// A user at the panel: sets the drive's command sources to the panel, runs the motor, and gives it back.
class PanelControl
{
public:
  void setSources(CommandSources sources)
  {
    sources_ = std::move(sources);
  }

  const CommandSources& sources() const
  {
    return sources_;
  }

  /// \p hertz: sign = direction, 0 = stopped.
  void takeOver(ParameterMemory& memory, double hertz)
  {
    if (!hertz_)
    {
      before_.clear();
      for (const ParameterMemory::Index index : sources_.parameters)
      {
        before_.push_back(memory.ram(index));
      }
    }
    for (const ParameterMemory::Index index : sources_.parameters)
    {
      memory.commission(index, sources_.panel);
    }
    hertz_ = hertz;
  }

  /// The command sources are again what they were. False: the panel had not taken over.
  bool release(ParameterMemory& memory)
  {
    if (!hertz_)
    {
      return false;
    }
    for (std::size_t i = 0; i < before_.size(); ++i)
    {
      memory.commission(sources_.parameters[i], before_[i]);
    }
    hertz_.reset();
    return true;
  }

  bool inCommand() const
  {
    return hertz_.has_value();
  }

  /// [Hz] what the panel wants, signed; 0 while it is not in command.
  double hertz() const
  {
    return hertz_.value_or(0.0);
  }

  /// The motor of a panel in command stops; the panel stays in command.
  void stop()
  {
    hertz_ = hertz_ ? std::optional<double>(0.0) : std::nullopt;
  }

private:
  CommandSources sources_;
  std::vector<std::uint32_t> before_;
  std::optional<double> hertz_;
};
}  // namespace simulation
}  // namespace inverter_bus

#endif  // INVERTER_BUS_SIMULATION_PANEL_CONTROL_H
