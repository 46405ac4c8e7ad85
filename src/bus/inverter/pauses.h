// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_BUS_PAUSES_H
#define INVERTER_BUS_BUS_PAUSES_H

#include "inverter_bus/util/clock.h"

namespace inverter_bus
{
namespace bus
{
/// Until when one inverter is not asked for its status, or for its settings. Pure: time comes in as an argument. Not thread
/// safe; the bus guards it.
class Pauses
{
public:
  /// Its status is not asked for before \p until.
  void holdStatus(TimePoint until);
  TimePoint statusNotBefore() const;

  /// No frame of its stop goes before \p until; a time in the past: it may go.
  void holdStop(TimePoint until);
  TimePoint stopNotBefore() const;

  /// Its settings are not asked for before \p until.
  void holdSettings(TimePoint until);
  /// An exchange for its settings has ended. \p failed: not at once again, since the status is worth more. \p refused_for:
  /// all that is left was refused for the moment (see DriveSettings::pauseBeforeNext()).
  void settingEnded(TimePoint now, bool failed, Duration refused_for);
  /// Another drive may be there: what is settled at connect does not wait.
  void forget();

  /// What is settled at connect may be asked.
  bool connectAllowed(TimePoint now) const;
  /// Settings of the lowest class may be asked. \p refused: all that is left was refused for the moment.
  bool settingsAllowed(TimePoint now, bool refused) const;

private:
  TimePoint status_not_before_;
  TimePoint stop_not_before_;
  TimePoint settings_not_before_;
  TimePoint connect_not_before_;
  TimePoint refused_not_before_;
};
}  // namespace bus
}  // namespace inverter_bus

#endif  // INVERTER_BUS_BUS_PAUSES_H
