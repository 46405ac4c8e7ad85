// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_BUS_COORDINATOR_H
#define INVERTER_BUS_BUS_COORDINATOR_H

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "bus/activities/activities.h"
#include "bus/line_view.h"
#include "bus/link/freeze_watch.h"
#include "inverter_bus/bus/bus.h"

namespace inverter_bus
{
namespace bus
{
/// Hands each turn of the bus to one activity (src/bus/activities) and its end back to it: the scheduler decides whose
/// turn it is. Time comes in as an argument; there is no thread, no clock and no I/O in it, so that the whole behaviour
/// of a bus can be run in virtual time. Not thread safe: the bus guards it with one mutex.
class Coordinator
{
public:
  /// \p configuration must outlive the coordinator. \p line is asked for its timing, once, and not kept.
  Coordinator(const Configuration& configuration, const wire::Line& line);
  ~Coordinator();

  // --- requests of users --------------------------------------------------------------------------------------------
  std::uint16_t command(TimePoint now, const VelocityCommand& command);
  /// \p velocity takes the RUN of this inverter off: 0, or near it. Depends on the configuration alone; any thread.
  bool stops(std::size_t index, double velocity) const;
  /// A malformed command: shows in the status of \p indices and, for a group, in the bus status.
  void refuse(TimePoint now, const std::vector<std::size_t>& indices, std::uint16_t error_id, const std::string& text,
              bool group);
  void stop(TimePoint now, std::optional<std::size_t> index, std::uint8_t mode, AnswerCallback callback);
  void reset(TimePoint now, std::size_t index, AnswerCallback callback);
  void readFaults(TimePoint now, std::size_t index, AnswerCallback callback);
  void readParameter(TimePoint now, std::size_t index, const std::string& name, AnswerCallback callback);
  void writeParameter(TimePoint now, std::size_t index, const std::string& name, double value, bool persist,
                      AnswerCallback callback);

  // --- the bus loop -------------------------------------------------------------------------------------------------
  struct Exchange
  {
    wire::Request request;
    /// Silence to keep after a broadcast.
    Duration turnaround{ 0 };
    /// Silence after which a stop ends the wait (stopWaits()); nothing: that takes its full time.
    std::optional<Duration> cut_after;
  };
  /// The next exchange to make right now; nothing: ask again at \p wake or when something was requested.
  /// \p line is not kept either.
  std::optional<Exchange> next(TimePoint now, const LineView& line, TimePoint& wake);
  /// What time alone brings: command watchdogs, bounds, slow publications. Also while the port is closed. True: an
  /// inverter has just gone offline, because its status has not come for too long.
  bool tick(TimePoint now);
  /// The first byte of that exchange is leaving now.
  void sent(TimePoint now);
  /// A stop waits that ends the wait for that exchange; between two of them, that is to go next.
  bool stopWaits(TimePoint now);
  /// Its end.
  void done(const wire::Reply& reply);

  /// A reply that came after its time-out: its station is alive.
  void lateReply(TimePoint now, const wire::LateReply& late);
  /// What the line has counted and found so far: before anything else that the line or the port has brought.
  void noteLine(TimePoint now, const LineFacts& facts);
  /// What the open port reports of its adapter; nothing: its driver does not say.
  void noteAdapter(const std::optional<wire::AdapterLatency>& latency);

  void portOpened(TimePoint now);
  /// \p in_use: another process holds it.
  void portMissing(TimePoint now, const std::string& error, bool in_use);
  /// It is being opened, which takes a while.
  void portPending(TimePoint now);
  /// settle() found it gone: closed by its other end, or lost.
  void portClosed(TimePoint now);
  /// The next connection is not to be tried before this time.
  TimePoint openNotBefore() const;
  /// A connection that its other end closed is being opened again at once; motors run on.
  bool resuming() const;
  /// The link is mute and is to be reopened (renewing(), then abandon and open).
  bool renewalDue(TimePoint now);
  void renewing(TimePoint now);
  /// It is reopened for any other reason of this node's: motors run on.
  void reopening(TimePoint now);
  /// It leads to a telnet server, and everything that may be sent to one was: close it (closedForTelnet()).
  bool telnetOver(TimePoint now);
  void closedForTelnet(TimePoint now);

  void beginShutdown(TimePoint now);
  /// All motors confirmed, or the time is up.
  bool shutdownDone(TimePoint now);
  /// Answers callers that still wait with 0xB003; names what could not be confirmed.
  std::vector<std::string> endShutdown();

  // --- what it reports ---------------------------------------------------------------------------------------------
  Outputs takeOutputs();
  PendingAnswers takeAnswers();
  Report report(TimePoint now) const;
  ServiceBounds bounds() const;
  std::vector<Finding> budget() const;

private:
  void noteRunning(TimePoint now);
  Pick pick(TimePoint now);
  std::optional<InFlight> compose(TimePoint now, const Pick& pick, const LineView& line);
  std::optional<InFlight> chosen(TimePoint now, const LineView& line, TimePoint& wake);
  void ended(const InFlight& current, const wire::Reply& reply);
  void noteReply(const InFlight& current, const wire::Reply& reply);
  void endedBy(const InFlight& current, const wire::Reply& reply);
  void cut(const InFlight& current, const wire::Reply& reply);

  BusState bus_;
  Activities activities_;
  FreezeWatch freeze_;
  std::optional<InFlight> in_flight_;
};
}  // namespace bus
}  // namespace inverter_bus

#endif  // INVERTER_BUS_BUS_COORDINATOR_H
