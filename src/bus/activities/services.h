// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_BUS_SERVICES_H
#define INVERTER_BUS_BUS_SERVICES_H

#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "bus/activities/jobs.h"
#include "bus/activities/stops.h"

namespace inverter_bus
{
namespace bus
{
/// Services that take several exchanges: reset, trip memory, parameters. One running job per call, its bound, and its
/// callers; each of its frames is queued again (contract, 3.14). The job decides what its frames are (jobs.h).
class Services
{
public:
  Services(BusState& bus, Turns& turns, Stops& stops);

  // --- calls ----------------------------------------------------------------------------------------------------------
  void reset(TimePoint now, std::size_t index, AnswerCallback callback);
  void readFaults(TimePoint now, std::size_t index, AnswerCallback callback);
  void readParameter(TimePoint now, std::size_t index, const std::string& name, AnswerCallback callback);
  void writeParameter(TimePoint now, std::size_t index, const std::string& name, double value, bool persist,
                      AnswerCallback callback);
  /// \p bound [s] from now on; \p callback may be empty.
  /// No caller waits for it: the parameters of the register map and their raw values, not empty, in the order of writing.
  void configureMap(TimePoint now, std::size_t index, const std::vector<std::pair<std::string, std::uint32_t>>& wanted);
  void start(TimePoint now, std::size_t index, std::unique_ptr<Job> job, double bound, AnswerCallback callback);

  // --- exchanges ------------------------------------------------------------------------------------------------------
  /// Nothing: it can't go now, or has just failed.
  std::optional<InFlight> compose(TimePoint now, const Pick& pick);
  void sent(const InFlight& current);
  Ending ended(const InFlight& current, const wire::Reply& reply);
  /// The frame reaches the drive's EEPROM.
  bool wears(const InFlight& current) const;

  // --- ends -----------------------------------------------------------------------------------------------------------
  /// All of one inverter.
  void fail(std::size_t index, std::uint16_t error_id, const std::string& message);
  /// Those whose bound has passed.
  void expire(TimePoint now);

private:
  struct Running
  {
    std::unique_ptr<Job> job;
    std::size_t inverter;
    TimePoint expires;
    /// One, or the callers of a reset that was asked for again while it was under way.
    std::vector<AnswerCallback> callbacks;
    Repeats repeats;
  };
  bool refuse(std::size_t index, const AnswerCallback& callback);
  bool refuseWrongDrive(const Inverter& inverter, const AnswerCallback& callback);
  bool joinReset(std::size_t index, const AnswerCallback& callback);
  void queue(CommandId id, TimePoint not_before);
  void doneStep(TimePoint now, const InFlight& current);
  void noteEnd(Inverter& inverter, const Job& job, const Answer& result);
  void advance(TimePoint now, CommandId id, Job::Progress progress);
  void end(CommandId id, const Answer& answer);

  BusState& bus_;
  Turns& turns_;
  Stops& stops_;
  std::map<CommandId, Running> jobs_;
  /// By inverter: names of the parameters written to RAM since the last store.
  std::vector<std::set<std::string>> ram_changes_;
};
}  // namespace bus
}  // namespace inverter_bus

#endif  // INVERTER_BUS_BUS_SERVICES_H
