// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_BUS_REFUSAL_LOG_H
#define INVERTER_BUS_BUS_REFUSAL_LOG_H

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "inverter_bus/bus/types.h"

namespace inverter_bus
{
namespace bus
{
/// What the log says of refused velocities: the first one of its kind at once, then one line in 5 s with a count of those
/// that it represents, so that a stream that is refused 100 times a second is reported and does not fill the log. A kind
/// is an inverter and an error id; what the users send can't make more of them. Not thread safe; the bus guards it.
class RefusalLog
{
public:
  explicit RefusalLog(std::size_t inverters);

  /// A velocity, or a group, was refused; \p text is the whole line. \p inverter: whose velocity was the reason; nothing: a
  /// group that was malformed.
  void refused(TimePoint now, std::optional<std::size_t> inverter, std::uint16_t error_id, const std::string& text);
  /// The lines that are due: also those of kinds that came no more.
  std::vector<std::string> takeLines(TimePoint now);

  /// This inverter was not commanded, because of \p reason.
  void notCommanded(std::size_t inverter, const std::string& reason);
  /// A command of this inverter was accepted.
  void accepted(std::size_t inverter);
  /// Why the command watchdog of \p inverter stops it after \p command_timeout [s]: no publisher has sent anything, or
  /// nothing that could be accepted.
  std::string watchdogReason(std::size_t inverter, double command_timeout) const;

private:
  struct Kind
  {
    TimePoint told_at;
    /// Refused since then, and the line of the last one.
    std::size_t held_back = 0;
    std::string last;
  };
  struct Refused
  {
    std::size_t count = 0;
    std::string last_reason;
  };
  std::map<std::pair<std::optional<std::size_t>, std::uint16_t>, Kind> kinds_;
  std::vector<std::string> lines_;
  /// By inverter, since its last accepted command.
  std::vector<Refused> since_accepted_;
};

/// `velocity 0.3: locked: ...`: \p reason with the value that it is about, unless the reason already names it (range).
std::string refusedVelocity(double velocity, std::uint16_t error_id, const std::string& reason);
}  // namespace bus
}  // namespace inverter_bus

#endif  // INVERTER_BUS_BUS_REFUSAL_LOG_H
