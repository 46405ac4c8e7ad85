// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_BUS_PORT_WATCH_H
#define INVERTER_BUS_BUS_PORT_WATCH_H

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "bus/activities/telnet_stops.h"

namespace inverter_bus
{
namespace bus
{
/// Is the port there, and does it work? Said once, in words that fit it; what a loss means for the inverters; which
/// connections are opened again as if nothing had happened (contract, 8.9, 8.10 and 8.13).
class PortWatch
{
public:
  PortWatch(BusState& bus, Stops& stops, Absences& absences, TelnetStops& telnet);

  void opened(TimePoint now);
  /// Something was read from it, or it has been open for long.
  void works();
  /// \p in_use: another process holds it.
  void missing(TimePoint now, const std::string& error, bool in_use);
  /// It is being opened, which takes a while.
  void pending(TimePoint now);
  /// It was found gone: closed by its other end, or lost.
  void closed(TimePoint now);
  void lost(TimePoint now);
  void closedForTelnet(TimePoint now);
  /// The link is mute and is reopened.
  void renewing(TimePoint now);
  /// It is reopened for any other reason of this node's: motors run on.
  void reopening(TimePoint now);
  /// The other end has closed the connection, in place of the answer of \p index or between two exchanges. True: it is
  /// opened again at once, and nothing else happens.
  bool resumes(TimePoint now, std::optional<std::size_t> index);
  /// After each exchange: which inverters answer over this connection.
  void noteConnection(TimePoint now, const InFlight& current, const wire::Reply& reply);

  /// It is open, and did not fail as soon as it was used.
  bool usable() const;
  std::uint64_t reconnects() const;
  /// What is wrong with it; empty: nothing.
  const std::string& error() const;

private:
  void fails(TimePoint now, const std::string& error);
  std::vector<std::size_t> onlineInverters() const;
  struct Resumed
  {
    std::size_t times = 0;
    std::optional<TimePoint> logged_at;
  };

  BusState& bus_;
  Stops& stops_;
  Absences& absences_;
  TelnetStops& telnet_;
  /// Since it was opened.
  bool works_ = false;
  /// It can be opened, and then fails before anything was read from it.
  bool failing_ = false;
  bool complained_ = false;
  std::string error_;
  std::uint64_t opens_ = 0;
  /// It is being reopened because it was mute.
  bool renewing_ = false;
  /// To whom the last request went, if it was not answered.
  std::optional<std::size_t> last_unanswered_;
  Resumed resumed_;
};
}  // namespace bus
}  // namespace inverter_bus

#endif  // INVERTER_BUS_BUS_PORT_WATCH_H
