// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

// Operating an MX2 or RX by hand: panel, safety terminals, load; and what its motor really does.

#include <cmath>

#include "simulation/drives/hitachi/hitachi_drive.h"
#include "simulation/drives/motor_watch.h"
#include "simulation/drives/panel_parameters.h"

namespace inverter_bus
{
namespace simulation
{
namespace
{
constexpr int E_SAFE_STOP = 37;  // PYMX2, from I570
constexpr std::uint32_t SOURCE_PANEL = 2;
}  // namespace

Refusal HitachiDrive::takeOverAtPanel(double hertz, TimePoint now)
{
  advance(now);
  if (std::abs(hertz) > maximumFrequency())
  {
    return "above the maximum frequency A004 = " + twoDecimals(maximumFrequency()) + " Hz";
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
  setHold(Hold::StopKey);
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

void HitachiDrive::takeLoad(double load)
{
  motor_.setLoad(load);
  change();
}

void HitachiDrive::takeBusy(TimePoint until)
{
  busy_until_ = until;
}

Refusal HitachiDrive::setParameter(const std::string& code, double value, TimePoint now)
{
  advance(now);
  Refusal refusal = setAtPanel(memory_, model_.name, code, value);
  control();
  return refusal;
}

Refusal HitachiDrive::parameter(const std::string& code, KeyValues& values) const
{
  return showAtPanel(memory_, model_.name, code, values);
}

bool HitachiDrive::runCommand() const
{
  return coils_[0x0001];
}

void HitachiDrive::describeMotor(KeyValues& values) const
{
  const auto add = [&values](const char* key, const std::string& value) { values.emplace_back(key, value); };
  const auto flag = [&add](const char* key, bool value) { add(key, value ? "1" : "0"); };
  add("model", model_.name);
  appendMotor(motor_, values);
  flag("run_coil", runCommand());
  flag("direction_coil", coils_[0x0002]);
  flag("run_effective", runCommanded() && !tripped_);
  add("reference", twoDecimals(reference_ / 100.0));
  flag("tripped", tripped_);
  add("trip", std::to_string(tripped_ ? trips_.front().code : 0));
  add("last_trip", std::to_string(trips_.front().code));
  add("status_b", std::to_string(tripped_ ? trip_state_ : 0));
  add("trips", std::to_string(trip_count_));
  add("command_source", std::to_string(memory_.ram(code_.a002)));
  flag("panel", panel_.has_value());
  flag("held", hold_ != Hold::None);
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
