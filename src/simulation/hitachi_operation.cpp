// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

// Operating an MX2 or RX by hand: panel, safety terminals, load; and what its motor really does.

#include <cmath>
#include <cstdio>

#include "inverter_bus/simulation/hitachi_drive.h"

namespace inverter_bus
{
namespace simulation
{
namespace
{
constexpr int E_SAFE_STOP = 37;  // PYMX2, from I570
constexpr std::uint32_t SOURCE_PANEL = 2;

std::string number(double value)
{
  char text[32];
  std::snprintf(text, sizeof(text), "%.2f", value);
  return text;
}
}  // namespace

Refusal HitachiDrive::takeOverAtPanel(double hertz, TimePoint now)
{
  advance(now);
  if (std::abs(hertz) > maximumFrequency())
  {
    return "above the maximum frequency A004 = " + number(maximumFrequency()) + " Hz";
  }
  if (!sources_before_panel_)
  {
    sources_before_panel_ = std::make_pair(memory_.ram(code_.a001), memory_.ram(code_.a002));
  }
  memory_.commission(code_.a001, SOURCE_PANEL);
  memory_.commission(code_.a002, SOURCE_PANEL);
  panel_ = hertz;
  control();
  return std::nullopt;
}

Refusal HitachiDrive::releasePanel(TimePoint now)
{
  advance(now);
  if (!sources_before_panel_)
  {
    return "the panel has not taken over";
  }
  memory_.commission(code_.a001, sources_before_panel_->first);
  memory_.commission(code_.a002, sources_before_panel_->second);
  sources_before_panel_.reset();
  panel_.reset();
  control();
  return std::nullopt;
}

Refusal HitachiDrive::pressStopKey(TimePoint now)
{
  advance(now);
  if (panel_)
  {
    panel_ = 0.0;
    control();
    return std::nullopt;
  }
  if (memory_.ram(code_.b087) == 1)
  {
    return "the STOP key is disabled by b087 = 1";
  }
  setHold(Hold::STOP_KEY);
  return std::nullopt;
}

Refusal HitachiDrive::setSafeStop(bool active, TimePoint now)
{
  advance(now);
  safe_stop_ = active;
  if (active && powered() && !tripped_)
  {
    doTrip(E_SAFE_STOP);
  }
  return std::nullopt;
}

Refusal HitachiDrive::setLoad(double load, TimePoint now)
{
  advance(now);
  if (!(load >= 0.0 && load <= 3.0))
  {
    return "load out of range (0-3; 1 = rated torque)";
  }
  motor_.setLoad(load);
  change();
  return std::nullopt;
}

Refusal HitachiDrive::setBusy(TimePoint until, TimePoint now)
{
  advance(now);
  busy_until_ = until;
  return std::nullopt;
}

Refusal HitachiDrive::setParameter(const std::string& code, double value, TimePoint now)
{
  advance(now);
  const Index index = memory_.find(code);
  if (index == ParameterMemory::NONE)
  {
    return model_.name + " has no parameter " + code;
  }
  const Parameter& info = memory_.info(index);
  const double raw = std::round(value * std::pow(10.0, info.decimals));
  if (!(raw >= 0.0 && raw <= 4294967295.0) || !memory_.accepts(index, static_cast<std::uint32_t>(raw)))
  {
    return "value out of range (" + panelText(info, info.minimum) + "-" + panelText(info, info.maximum) + ")";
  }
  memory_.writeBoth(index, static_cast<std::uint32_t>(raw));
  control();
  return std::nullopt;
}

Refusal HitachiDrive::parameter(const std::string& code, KeyValues& values) const
{
  const Index index = memory_.find(code);
  if (index == ParameterMemory::NONE)
  {
    return model_.name + " has no parameter " + code;
  }
  const Parameter& info = memory_.info(index);
  values.emplace_back("ram", panelText(info, memory_.ram(index)));
  values.emplace_back("eeprom", panelText(info, memory_.eeprom(index)));
  return std::nullopt;
}

void HitachiDrive::describeMotor(KeyValues& values) const
{
  const auto add = [&values](const char* key, const std::string& value) { values.emplace_back(key, value); };
  const auto flag = [&add](const char* key, bool value) { add(key, value ? "1" : "0"); };
  const double frequency = motor_.frequency();
  add("model", model_.name);
  add("frequency", number(std::abs(frequency)));
  add("direction", frequency == 0.0 ? "0" : (frequency > 0.0 ? "1" : "-1"));
  add("target", number(motor_.target()));
  flag("running", motor_.turning());
  add("ramp", motor_.accelerating() ? "accelerating" : (motor_.decelerating() ? "decelerating" : "none"));
  flag("run_coil", coils_[0x0001]);
  flag("direction_coil", coils_[0x0002]);
  flag("run_effective", runCommanded() && !tripped_);
  add("reference", number(reference_ / 100.0));
  flag("tripped", tripped_);
  add("trip", std::to_string(tripped_ ? trips_.front().code : 0));
  add("last_trip", std::to_string(trips_.front().code));
  add("trips", std::to_string(trip_count_));
  add("current", number(motor_.current()));
  add("load", number(motor_.load()));
  add("dc_voltage", number(motor_.dcVoltage()));
  add("temperature", number(motor_.temperature()));
  add("command_source", std::to_string(memory_.ram(code_.a002)));
  flag("panel", panel_.has_value());
  flag("held", hold_ != Hold::NONE);
  flag("safe_stop", safe_stop_);
  flag("busy", busy());
  const bool off = watchdogTimeout() == Duration::zero();
  add("watchdog", off ? "off" : (watchdog_.expired() ? "expired" : (watchdog_.started() ? "running" : "waiting")));
  add("eeprom_writes", std::to_string(memory_.eepromWrites()));
  add("stored_values", std::to_string(memory_.storedValues()));
  add("ram_changes", std::to_string(memory_.ramChanges()));
}
}  // namespace simulation
}  // namespace inverter_bus
