// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_BUS_STOPS_H
#define INVERTER_BUS_BUS_STOPS_H

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "bus/activities/gateway_traffic.h"

namespace inverter_bus
{
namespace bus
{
/// A stop from its request to its answer (contract, 3.1 to 3.3 and 4.3): every cause of one, a service, a silence, a
/// fault, a 0 that can't be confirmed, comes here. The scheduler decides in which order stops go, StopJob which frame is
/// next.
class Stops
{
public:
  Stops(BusState& bus, Turns& turns, GatewayTraffic& traffic);

  // --- requests -------------------------------------------------------------------------------------------------------
  /// Drops whatever was commanded. \p lock: the publishers must return to neutral (4.2), and no newer velocity replaces
  /// the stop; behind a gateway that may still set RUN also without it (8.8). \p reason is logged; empty: the caller knows.
  void request(TimePoint now, Inverter& inverter, StopMode mode, bool lock, const std::string& reason);
  /// The service, of one inverter or of all. \p mode as in Stop.srv; one that is unknown, or that the drive does not have,
  /// is carried out as DECELERATE, and the answer says so.
  void stop(TimePoint now, std::optional<std::size_t> index, std::uint8_t mode, AnswerCallback callback);
  void checkWatchdogs(TimePoint now);
  /// \p wake, or when the next inverter's commands have been silent for too long.
  TimePoint earliestWatchdog(TimePoint wake) const;
  /// Velocities of 0 that can't be confirmed now go the way of a stop, which keeps trying.
  void replaceZeros(TimePoint now);

  // --- exchanges ------------------------------------------------------------------------------------------------------
  std::optional<InFlight> composeBroadcast(TimePoint now);
  /// \p probe_timeout how long a probe of this inverter may wait.
  InFlight compose(const Pick& pick);
  void sent(TimePoint now, const InFlight& current);
  Ending ended(const InFlight& current, const wire::Reply& reply);
  /// Acceptance to the first byte, or behind a gateway to the answer.
  void noteLatency(Duration latency);

  // --- answers --------------------------------------------------------------------------------------------------------
  /// Answers the calls whose stops are confirmed, or whose time is up.
  void finishCalls(TimePoint now);
  /// Why it is not confirmed.
  std::string problem(const Inverter& inverter) const;
  /// The port is gone: no broadcast is due any more.
  void dropBroadcast();
  /// No exchange is asked for any more: callers that still wait get 0xB003.
  void refuseCalls();
  Duration latencyMax() const;

private:
  struct Call
  {
    std::vector<std::size_t> waiting;
    std::vector<std::string> problems;
    std::uint16_t error_id = 0;
    std::string note;
    TimePoint expires;
    AnswerCallback callback;
  };
  void confirmed(TimePoint now, Inverter& inverter);
  bool broadcastIsSafe() const;
  void noteGatewayLatency(const InFlight& current, const wire::Reply& reply);

  BusState& bus_;
  Turns& turns_;
  GatewayTraffic& traffic_;
  std::vector<Call> calls_;
  bool broadcast_due_ = false;
  /// The last exchange was one.
  bool broadcast_last_ = false;
  TimePoint broadcast_requested_;
  Duration latency_max_{ 0 };
};
}  // namespace bus
}  // namespace inverter_bus

#endif  // INVERTER_BUS_BUS_STOPS_H
