// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "bus/inverter/pauses.h"

#include <algorithm>

namespace inverter_bus
{
namespace bus
{
namespace
{
constexpr double CONNECT_PAUSE_S = 0.5;
}  // namespace

void Pauses::holdStatus(TimePoint until)
{
  status_not_before_ = until;
}

TimePoint Pauses::statusNotBefore() const
{
  return status_not_before_;
}

void Pauses::holdStop(TimePoint until)
{
  stop_not_before_ = until;
}

TimePoint Pauses::stopNotBefore() const
{
  return stop_not_before_;
}

void Pauses::holdSettings(TimePoint until)
{
  settings_not_before_ = until;
}

void Pauses::settingEnded(TimePoint now, bool failed, Duration refused_for)
{
  connect_not_before_ = failed ? now + seconds(CONNECT_PAUSE_S) : connect_not_before_;
  refused_not_before_ = now + refused_for;
}

void Pauses::forget()
{
  connect_not_before_ = TimePoint();
  settings_not_before_ = TimePoint();
}

bool Pauses::connectAllowed(TimePoint now) const
{
  return now >= std::max(connect_not_before_, settings_not_before_);
}

bool Pauses::settingsAllowed(TimePoint now, bool refused) const
{
  const bool rested = !refused || refused_not_before_ <= now;
  return status_not_before_ <= now && settings_not_before_ <= now && rested;
}
}  // namespace bus
}  // namespace inverter_bus
