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
/// What the line has counted and found so far. Each is explained where wire::Line is asked for it.
struct LineFacts
{
  wire::LineCounters counters;
  /// A local echo is removed.
  bool echo_found = false;
  /// What the gateway does to numbers and units; empty: nothing.
  std::string gateway_quirk;
  bool telnet_found = false;
  /// A valid reply came since the port was opened.
  bool proven_since_open = false;
  wire::Loss last_loss = wire::Loss::None;
  /// What the other end of a connection has said; empty: nothing.
  std::string peer_words;
};

/// A copy of that: others ask for it while the bus thread uses the line. Pure; not thread safe, the bus guards it.
class LineWatch
{
public:
  void note(TimePoint now, const LineFacts& facts);

  const LineFacts& facts() const;
  /// Another master polls on this line, or behind this gateway: seen within the last minute.
  std::optional<Finding> foreignFinding(TimePoint now, bool gateway) const;

private:
  LineFacts facts_;
  TimePoint foreign_at_;
};
}  // namespace bus
}  // namespace inverter_bus

#endif  // INVERTER_BUS_BUS_LINE_WATCH_H
