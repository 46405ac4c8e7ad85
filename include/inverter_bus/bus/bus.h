// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_BUS_BUS_H
#define INVERTER_BUS_BUS_BUS_H

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "inverter_bus/bus/configuration.h"
#include "inverter_bus/bus/types.h"

namespace inverter_bus
{
namespace bus
{
/// One serial bus: the thread that owns the port, and the way in for all other threads.
///
/// Every public function may be called from any thread, returns at once (shutdown() excepted) and never throws.
class Bus
{
public:
  /// Nothing is opened or sent before start().
  Bus(Configuration configuration, std::unique_ptr<wire::Port> port, Observer& observer);
  ~Bus();

  Bus(const Bus&) = delete;
  Bus& operator=(const Bus&) = delete;

  /// Starts the bus thread. Opens the port; goes on trying while it is missing.
  void start();

  /// True when the port was in use by another process for 30 s after start(): end with status 1.
  bool portInUse() const;

  /// Stops every motor that may run, waits for the confirmations within the contract's bound (at most 10 s), closes the
  /// port and ends the thread. Waiting services are answered with 0xB003. Returns one line per inverter that could not be
  /// confirmed; empty: all stopped. A second call does nothing.
  std::vector<std::string> shutdown();

  /// A velocity command for one or several inverters: all accepted or none (what stops(), always). The verdict shows in
  /// the status and in the log.
  /// Returns the error id of a refused command, else 0.
  std::uint16_t command(const VelocityCommand& command);

  /// \p velocity takes the RUN of inverter \p index off and is never refused: 0, or near it. Any thread, no lock.
  bool stops(std::size_t index, double velocity) const;

  /// A velocity command that could not even be turned into targets (unequal lengths, unknown or repeated names): shows
  /// \p error_id and \p text in the status of \p indices (may be empty) and, with \p group, in that of the bus. It feeds
  /// no command watchdog, unlocks nothing and changes nothing that runs.
  void refuse(const std::vector<std::size_t>& indices, std::uint16_t error_id, const std::string& text, bool group);

  /// \p index: an inverter, or nothing for all of them. \p callback gets the answer when every stop is confirmed, or
  /// with the error after the bound.
  void stop(std::optional<std::size_t> index, std::uint8_t mode, AnswerCallback callback);
  void reset(std::size_t index, AnswerCallback callback);
  void readFaults(std::size_t index, AnswerCallback callback);
  void readParameter(std::size_t index, const std::string& name, AnswerCallback callback);
  void writeParameter(std::size_t index, const std::string& name, double value, bool persist, AnswerCallback callback);

  /// The flight recorder's content for `~dump_trace`.
  TraceDump dumpTrace();

  /// Everything for /diagnostics, at any time, also when the bus is dead.
  Report report() const;

  /// Lines to print at start-up: cycle time, worst stop latency, longest gap between two frames to each inverter, and
  /// WARN where a command_timeout or a drive's own time-out can't be met.
  std::vector<Finding> budget() const;

  ServiceBounds bounds() const;

private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};
}  // namespace bus
}  // namespace inverter_bus

#endif  // INVERTER_BUS_BUS_BUS_H
