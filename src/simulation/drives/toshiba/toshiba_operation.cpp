// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

// Operating a VF-S15 by hand: panel, terminal ST, load; and what its motor really does.

#include <algorithm>
#include <cmath>
#include <set>

#include "simulation/drives/motor_watch.h"
#include "simulation/drives/toshiba/toshiba_numbers.h"
#include "simulation/drives/toshiba/toshiba_vfs15.h"
#include "util/text.h"

namespace inverter_bus
{
namespace simulation
{
using namespace toshiba;  // NOLINT: the numbers of this drive

namespace
{
const std::set<int> TRIP_CODES = { 1,  2,  3,  4,  5,  8,  9,  10, 11, 12, 13, 14, 15, 16, 17, 18, 19, 20,
                                   21, 22, 23, 24, 26, 27, 28, 29, 30, 32, 34, 40, 41, 45, 46, 47, 50, 51,
                                   52, 53, 55, 58, 62, 63, 64, 65, 69, 71, 72, 73, 84, 85, 86, 87 };  // p. 63
}  // namespace

Refusal ToshibaVfs15::noSuchTrip(int code) const
{
  if (TRIP_CODES.count(code) == 0)
  {
    return "no trip code " + std::to_string(code) + " (those of E6581913 p. 63: 1-5, 8-24, 26-30, 32, ... 87)";
  }
  return std::nullopt;
}

Refusal ToshibaVfs15::takeOverAtPanel(double hertz, TimePoint now)
{
  advance(now);
  const double size = std::abs(hertz);
  if (size > this->hertz(FH))
  {
    return "above the maximum frequency FH = " + twoDecimals(this->hertz(FH)) + " Hz";
  }
  memory_.commission(memory_.at(FA08), 1);
  if (hertz != 0.0)
  {
    memory_.commission(memory_.at(FA03), static_cast<std::uint32_t>(std::lround(size * 100.0)));
  }
  panel_run_ = hertz == 0.0 ? 0 : (hertz > 0.0 ? 1 : -1);
  control();
  return std::nullopt;
}

Refusal ToshibaVfs15::releasePanel(TimePoint now)
{
  advance(now);
  if (!local())
  {
    return "the panel has not taken over";
  }
  memory_.commission(memory_.at(FA08), 0);
  panel_run_ = 0;
  control();
  return std::nullopt;
}

Refusal ToshibaVfs15::pressStopKey(TimePoint now)
{
  advance(now);
  panel_run_ = 0;
  // Without a RUN there is nothing to hold back: the next one starts the motor.
  held_by_key_ = busCommands() && runs();
  control();
  return std::nullopt;
}

Refusal ToshibaVfs15::setSafeStop(bool active, TimePoint now)
{
  advance(now);
  safe_stop_ = active;
  clearRunWhenCoasting();
  control();
  return std::nullopt;
}

Refusal ToshibaVfs15::setParameter(const std::string& code, double value, TimePoint now)
{
  advance(now);
  const std::optional<Bytes> bytes = fromHex(code);
  const Number monitor = bytes && bytes->size() == 2 ? static_cast<Number>((*bytes)[0] * 256U + (*bytes)[1]) : Number{};
  if (memory_.find(code) != ParameterMemory::NONE || monitors_.count(monitor) == 0)
  {
    return BrandDrive::setParameter(code, value, now);
  }
  if (!(value >= 0.0 && value <= 65535.0))
  {
    return "value out of range (0-65535)";
  }
  pinned_[monitor] = static_cast<std::uint16_t>(value);
  return std::nullopt;
}

bool ToshibaVfs15::runCommand() const
{
  return (ram_.at(FA00) & 0x0400U) != 0;
}

void ToshibaVfs15::describeBrand(ShowList& list) const
{
  list.text("command", util::hexText(ram_.at(FA00), 4));
  list.flag("run_command", runCommand());
  list.flag("run_effective", runs());
  list.text("reference", twoDecimals(busFrequency()));
  list.text("alarms", util::hexText(alarms(), 4));
  list.number("command_source", commandSource());
  list.number("frequency_source", frequencySource());
  list.flag("panel", local());
  list.flag("held", held_by_key_);
  list.flag("safe_stop", safe_stop_);
  list.flag("reset_marker", ram_.at(FA87) != 0);
  list.number("stored_values", memory_.storedValues());
}
}  // namespace simulation
}  // namespace inverter_bus
