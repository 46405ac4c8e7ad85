// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_BUS_TRACE_NOTES_H
#define INVERTER_BUS_BUS_TRACE_NOTES_H

#include <cstdint>
#include <string>
#include <vector>

#include "bus/activities/bus_state.h"
#include "bus/exchange.h"

namespace inverter_bus
{
namespace bus
{
/// Records what no log line and no change of a status shows: commands, and exchanges that failed.
class TraceNotes
{
public:
  explicit TraceNotes(BusState& bus);

  /// A velocity was judged; \p error_id 0: accepted. A stream of equal ones is one event, and a count when it ends.
  void commanded(const VelocityCommand& command, std::uint16_t error_id);
  /// A malformed command.
  void refused(const std::string& text, std::uint16_t error_id);
  /// A service was called. \p index: an inverter, or nothing for all.
  void called(const std::string& service, std::optional<std::size_t> index);
  /// An exchange begins: a repeat of one that was lost is named.
  void sent(const InFlight& current);
  /// It has ended. Unanswered probes are left out: they would fill the record while an inverter is offline.
  void ended(const InFlight& current, const wire::Reply& reply);

private:
  struct Last
  {
    std::string text;
    std::uint64_t repeats = 0;
  };
  void note(Last& last, const std::string& words);
  std::string nameOf(std::size_t index) const;

  BusState& bus_;
  /// By the first inverter of a command.
  std::vector<Last> commands_;
  Last malformed_;
  /// By inverter: what was lost and may be repeated; empty: nothing.
  std::vector<wire::Bytes> lost_;
};
}  // namespace bus
}  // namespace inverter_bus

#endif  // INVERTER_BUS_BUS_TRACE_NOTES_H
