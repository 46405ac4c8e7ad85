// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_BUS_LINE_WATCH_H
#define INVERTER_BUS_BUS_LINE_WATCH_H

#include <optional>
#include <string>

#include "inverter_bus/bus/types.h"
#include "inverter_bus/wire/line.h"

namespace inverter_bus
{
namespace bus
{
/// What the line has counted and found, as a copy: others ask for it while the bus thread uses the line. Pure; not thread
/// safe, the bus guards it.
class LineWatch
{
public:
  /// \p quirk what the gateway does to numbers and units (Line::gatewayQuirk()); empty: nothing.
  void note(TimePoint now, const wire::LineCounters& counters, bool echo_found, const std::string& quirk);

  const wire::LineCounters& counters() const;
  /// A local echo is removed.
  bool echoFound() const;
  const std::string& gatewayQuirk() const;
  /// Somebody else polls on this line, or behind this gateway: seen within the last minute.
  std::optional<Finding> foreignFinding(TimePoint now, bool gateway) const;

private:
  wire::LineCounters counters_;
  bool echo_found_ = false;
  std::string gateway_quirk_;
  TimePoint foreign_at_;
};
}  // namespace bus
}  // namespace inverter_bus

#endif  // INVERTER_BUS_BUS_LINE_WATCH_H
