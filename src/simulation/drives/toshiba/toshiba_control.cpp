// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

// Who commands a VF-S15 and what its motor does then (E6581913 p. 34, 52-54).

#include <algorithm>
#include <cmath>

#include "simulation/drives/toshiba/toshiba_numbers.h"
#include "simulation/drives/toshiba/toshiba_vfs15.h"

namespace inverter_bus
{
namespace simulation
{
using namespace toshiba;  // NOLINT: the numbers of this drive

namespace
{
// Bits of FA00.
constexpr unsigned int PRESETS = 0x000F;
constexpr unsigned int ACCELERATION_2 = 6;
constexpr unsigned int DC_BRAKE = 7;
constexpr unsigned int JOG = 8;
constexpr unsigned int REVERSE = 9;
constexpr unsigned int RUN = 10;
constexpr unsigned int COAST = 11;
constexpr unsigned int FREQUENCY_PRIORITY = 14;
constexpr unsigned int COMMAND_PRIORITY = 15;

constexpr int SOURCE_PANEL = 1;
constexpr int SOURCE_BUS = 2;             // CMOD, FD45
constexpr int FREQUENCY_FROM_BUS = 4;     // FMOD, FD46
constexpr int FREQUENCY_DIAL_2 = 3;       // FMOD
constexpr int FREQUENCY_PRESET = 255;     // FD46
constexpr double SHORTEST_RAMP = 0.01;    // [s]
constexpr double FORCED_STOP_RAMP = 0.5;  // [s] FA20 bit 7: from FH; "maximum deceleration", figure invented
}  // namespace

bool ToshibaVfs15::command(unsigned int bit) const
{
  return ((ram_.at(FA00) >> bit) & 1U) != 0;
}

bool ToshibaVfs15::local() const
{
  return raw(FA08) == 1;
}

bool ToshibaVfs15::busCommands() const
{
  return commandSource() == SOURCE_BUS;
}

int ToshibaVfs15::commandSource() const
{
  if (local())
  {
    return SOURCE_PANEL;
  }
  return command(COMMAND_PRIORITY) ? SOURCE_BUS : static_cast<int>(raw(CMOD));
}

int ToshibaVfs15::frequencySource() const
{
  if (local())
  {
    return 0;
  }
  if (preset() != 0)
  {
    return FREQUENCY_PRESET;
  }
  return command(FREQUENCY_PRIORITY) ? FREQUENCY_FROM_BUS : static_cast<int>(raw(FMOD));
}

unsigned int ToshibaVfs15::preset() const
{
  return busCommands() ? ram_.at(FA00) & PRESETS : 0U;
}

bool ToshibaVfs15::jogging() const
{
  return busCommands() && command(JOG);
}

bool ToshibaVfs15::forcedStop() const
{
  return command(COMMAND_PRIORITY) && !local() && (ram_.at(FA20) & 0x0080U) != 0;
}

bool ToshibaVfs15::coasting() const
{
  return safe_stop_ || (busCommands() && command(COAST));
}

bool ToshibaVfs15::dcBraking() const
{
  return !tripped_ && !coasting() && busCommands() && command(DC_BRAKE);
}

bool ToshibaVfs15::reverse() const
{
  return commandSource() == SOURCE_PANEL ? panel_run_ < 0 : busCommands() && command(REVERSE);
}

bool ToshibaVfs15::runs() const
{
  const std::uint32_t prohibited = raw(F311);  // 1: no reverse, 2: no forward
  const bool direction_allowed = prohibited == 0 || (prohibited == 1) != reverse();
  if (!powered() || tripped_ || coasting() || dcBraking() || forcedStop() || trip_after_stop_ != 0 ||
      !direction_allowed)
  {
    return false;
  }
  if (commandSource() == SOURCE_PANEL)
  {
    return panel_run_ != 0;
  }
  return busCommands() && !held_by_key_ && (command(RUN) || command(JOG));
}

bool ToshibaVfs15::running() const
{
  return motor_.turning() || runs();
}

double ToshibaVfs15::busFrequency() const
{
  const double pole_pairs = raw(F856);
  return speed_by_rpm_ ? ram_.at(FA13) * pole_pairs / 60.0 : ram_.at(FA01) / 100.0;
}

double ToshibaVfs15::wantedFrequency() const
{
  if (jogging())
  {
    return hertz(F260);
  }
  switch (frequencySource())
  {
    case FREQUENCY_PRESET:
    {
      // Presets 1-7 and 8-15 lie in two rows of decimal numbers.
      std::uint32_t number = preset() <= 7 ? SR1 : F287;
      for (unsigned int step = preset() <= 7 ? 1 : 8; step < preset(); ++step)
      {
        number = next(number);
      }
      return limited(hertz(static_cast<Number>(number)));
    }
    case FREQUENCY_FROM_BUS:
      return limited(busFrequency());
    case 0:
    case FREQUENCY_DIAL_2:
      return limited(hertz(FA03));
    default:
      return limited(0.0);  // nothing is connected to the analog inputs
  }
}

double ToshibaVfs15::limited(double hertz) const
{
  return std::max(std::min({ hertz, this->hertz(UL), this->hertz(FH) }), this->hertz(LL));
}

int ToshibaVfs15::accelerationPattern() const
{
  const int pattern = 1 + ((ram_.at(FA20) >> 8U) & 3);
  return command(COMMAND_PRIORITY) && pattern > 1 ? pattern : (busCommands() && command(ACCELERATION_2) ? 2 : 1);
}

Ramps ToshibaVfs15::ramps() const
{
  const double unit = raw(TIME_UNIT) == 1 ? 0.01 : 0.1;
  const int pattern = accelerationPattern();
  const Number up = pattern == 1 ? ACC : (pattern == 2 ? F500 : F510);
  const Number down = pattern == 1 ? DEC : (pattern == 2 ? F501 : F511);
  const double deceleration = forcedStop() ? FORCED_STOP_RAMP : raw(down) * unit;
  return { hertz(FH), std::max(SHORTEST_RAMP, raw(up) * unit), std::max(SHORTEST_RAMP, deceleration), hertz(F240) };
}

void ToshibaVfs15::control()
{
  motor_.setRating({ raw(FE70) / 10.0, raw(FE71) / 10.0, hertz(VL) });
  motor_.setRamps(ramps());
  if (!powered() || tripped_ || coasting() || dcBraking())
  {
    motor_.cut();
    return;
  }
  const bool was_at_rest = !motor_.turning() && motor_.target() == 0.0;
  motor_.rampTo(runs() ? (reverse() ? -wantedFrequency() : wantedFrequency()) : 0.0);
  if (was_at_rest && motor_.target() != 0.0)
  {
    starts_[reverse() ? 1 : 0] += 1.0;
  }
}

double ToshibaVfs15::outputCurrent() const
{
  return dcBraking() ? raw(F251) / 100.0 * raw(FE70) / 10.0 : motor_.current();
}

double ToshibaVfs15::overloadLevel() const
{
  return raw(FE70) / 10.0 * raw(THR) / 100.0;
}
}  // namespace simulation
}  // namespace inverter_bus
