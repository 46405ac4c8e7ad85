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

Refusal ToshibaVfs15::trip(int code, TimePoint now)
{
  advance(now);
  if (!powered())
  {
    return "the drive has no power";
  }
  if (TRIP_CODES.count(code) == 0)
  {
    return "no trip code " + std::to_string(code) + " (those of E6581913 p. 63: 1-5, 8-24, 26-30, 32, ... 87)";
  }
  doTrip(code);
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

void ToshibaVfs15::takeLoad(double load)
{
  motor_.setLoad(load);
  change();
}

void ToshibaVfs15::takeBusy(TimePoint until)
{
  busy_until_ = until;
}

Refusal ToshibaVfs15::setParameter(const std::string& code, double value, TimePoint now)
{
  advance(now);
  const Index index = memory_.find(code);
  const std::optional<Bytes> bytes = fromHex(code);
  const Number monitor = bytes && bytes->size() == 2 ? static_cast<Number>((*bytes)[0] * 256U + (*bytes)[1]) : Number{};
  if (index == ParameterMemory::NONE && monitors_.count(monitor) == 0)
  {
    return model_.name + " has no parameter " + code;
  }
  if (index == ParameterMemory::NONE)
  {
    if (!(value >= 0.0 && value <= 65535.0))
    {
      return "value out of range (0-65535)";
    }
    pinned_[monitor] = static_cast<std::uint16_t>(value);
    return std::nullopt;
  }
  const Parameter info = asShown(index);
  const double raw = std::round(value * std::pow(10.0, info.decimals));
  if (!(raw >= 0.0 && raw <= 65535.0) || !memory_.accepts(index, static_cast<std::uint32_t>(raw)))
  {
    return "value out of range (" + panelText(info, info.minimum) + "-" + panelText(info, info.maximum) + ")";
  }
  store(index, static_cast<std::uint32_t>(raw));
  control();
  return std::nullopt;
}

Refusal ToshibaVfs15::parameter(const std::string& code, KeyValues& values) const
{
  const Index index = memory_.find(code);
  if (index == ParameterMemory::NONE)
  {
    return model_.name + " has no parameter " + code;
  }
  const Parameter info = asShown(index);
  values.emplace_back("ram", panelText(info, memory_.ram(index)));
  values.emplace_back("eeprom", panelText(info, memory_.eeprom(index)));
  return std::nullopt;
}

bool ToshibaVfs15::runCommand() const
{
  return (ram_.at(FA00) & 0x0400U) != 0;
}

void ToshibaVfs15::describeMotor(KeyValues& values) const
{
  const auto add = [&values](const char* key, const std::string& value) { values.emplace_back(key, value); };
  const auto flag = [&add](const char* key, bool value) { add(key, value ? "1" : "0"); };
  const double frequency = motor_.frequency();
  add("model", model_.name);
  add("frequency", twoDecimals(std::abs(frequency)));
  add("direction", frequency == 0.0 ? "0" : (frequency > 0.0 ? "1" : "-1"));
  add("target", twoDecimals(motor_.target()));
  flag("running", motor_.turning());
  add("ramp", motor_.accelerating() ? "accelerating" : (motor_.decelerating() ? "decelerating" : "none"));
  add("command", util::hexText(ram_.at(FA00), 4));
  flag("run_command", runCommand());
  flag("run_effective", runs());
  add("reference", twoDecimals(busFrequency()));
  flag("tripped", tripped_);
  add("trip", std::to_string(tripped_ ? trips_.front() : 0));
  add("last_trip", std::to_string(trips_.front()));
  add("trips", std::to_string(trip_count_));
  add("alarms", util::hexText(alarms(), 4));
  add("current", twoDecimals(current()));
  add("load", twoDecimals(motor_.load()));
  add("dc_voltage", twoDecimals(motor_.dcVoltage()));
  add("temperature", twoDecimals(motor_.temperature()));
  add("command_source", std::to_string(commandSource()));
  add("frequency_source", std::to_string(frequencySource()));
  flag("panel", local());
  flag("held", held_by_key_);
  flag("safe_stop", safe_stop_);
  flag("busy", busy());
  flag("reset_marker", ram_.at(FA87) != 0);
  const bool off = watchdogTimeout() == Duration::zero();
  add("watchdog", off ? "off" : (watchdog_.expired() ? "expired" : (watchdog_.started() ? "running" : "waiting")));
  add("eeprom_writes", std::to_string(memory_.eepromWrites()));
  add("stored_values", std::to_string(memory_.storedValues()));
}
}  // namespace simulation
}  // namespace inverter_bus
