// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

// Operating an MX2 or RX by hand: STOP key, safety terminals; and what its `show` says.

#include "simulation/drives/hitachi/hitachi_drive.h"
#include "simulation/drives/motor_watch.h"

namespace inverter_bus
{
namespace simulation
{
namespace
{
constexpr int E_SAFE_STOP = 37;  // PYMX2, from I570
}  // namespace

Refusal HitachiDrive::stopByKey()
{
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

bool HitachiDrive::runCommand() const
{
  return coils_[0x0001];
}

void HitachiDrive::describeBrand(ShowList& list) const
{
  list.flag("run_coil", runCommand());
  list.flag("direction_coil", coils_[0x0002]);
  list.flag("run_effective", runCommanded() && !tripped_);
  list.text("reference", twoDecimals(reference_ / 100.0));
  list.number("status_b", tripped_ ? trip_state_ : 0U);
  list.number("command_source", memory_.ram(code_.a002));
  list.flag("panel", panel_.inCommand());
  list.flag("held", hold_ != Hold::None);
  list.flag("safe_stop", safe_stop_);
  list.flag("mapping", map_.on());
  list.number("stored_values", memory_.storedValues());
  list.number("ram_changes", memory_.ramChanges());
}
}  // namespace simulation
}  // namespace inverter_bus
