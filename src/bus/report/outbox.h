// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_BUS_OUTBOX_H
#define INVERTER_BUS_BUS_OUTBOX_H

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "inverter_bus/bus/types.h"

namespace inverter_bus
{
namespace bus
{
struct Outputs
{
  std::vector<InverterStatus> statuses;
  std::vector<BusStatus> bus_statuses;
  std::vector<Finding> log;
  /// For the flight recorder.
  std::vector<TraceEvent> events;
  /// Reasons to write the flight recorder.
  std::vector<std::string> traces;
};

using PendingAnswers = std::vector<std::pair<AnswerCallback, Answer>>;

class Inverter;

/// Subject of the lines that report the state of the port (see Finding); no inverter's name has a space.
constexpr const char* PORT_SUBJECT = "the port";

/// What goes out after a step, in its order: the bus thread delivers it with no lock held. Not thread safe; the bus
/// guards it.
class Outbox
{
public:
  /// \p inverters how many there are.
  explicit Outbox(std::size_t inverters);

  /// What happens from now on happens at \p now.
  void at(TimePoint now);
  /// For the flight recorder only.
  void event(const std::string& text);
  /// \p subject see Finding. The flight recorder gets the line too.
  void log(Level level, const std::string& text, const std::string& subject = "");
  /// The status of \p inverter as it is at \p now.
  void publish(TimePoint now, const Inverter& inverter);
  void busStatus(const BusStatus& status);
  /// The flight recorder is to be written, for this reason.
  void trace(const std::string& reason);
  /// \p callback may be empty: then no caller waits.
  void answer(const AnswerCallback& callback, const Answer& answer);
  /// The answer of a call that was refused.
  void refuse(const AnswerCallback& callback, std::uint16_t error_id, const std::string& message);

  /// When the status of this inverter was published last; the epoch: never.
  TimePoint lastPublished(std::size_t inverter) const;

  Outputs takeOutputs();
  PendingAnswers takeAnswers();

private:
  TimePoint now_;
  Outputs outputs_;
  PendingAnswers answers_;
  struct Published
  {
    TimePoint at;
    bool locked = true;
  };
  std::vector<Published> published_;
};
}  // namespace bus
}  // namespace inverter_bus

#endif  // INVERTER_BUS_BUS_OUTBOX_H
