// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_BUS_BUS_LOOP_H
#define INVERTER_BUS_BUS_BUS_LOOP_H

#include <mutex>
#include <optional>

#include "bus/coordinator.h"

namespace inverter_bus
{
namespace bus
{
/// Joins the coordinator to a line: opens the port, asks for the next exchange, makes it, reports its end. The thread
/// around it lives in Bus; in virtual time a test calls step() itself.
class BusLoop
{
public:
  /// \p mutex guards \p coordinator; it is never held while the line is used.
  BusLoop(Coordinator& coordinator, wire::Line& line, util::Clock& clock, std::mutex& mutex);

  /// One round, at most one exchange. Returns the time of the next round at the latest; in the past: at once.
  TimePoint step();
  /// The port was in use by another process from the start, for 30 s.
  bool portInUse() const;
  void close();

private:
  TimePoint openPort();
  TimePoint noteOpening(wire::OpenResult result, const std::string& error);
  bool reopen();
  void judgePatience(TimePoint now, bool in_use);
  void lookAtAdapter();

  Coordinator& coordinator_;
  wire::Line& line_;
  util::Clock& clock_;
  std::mutex& mutex_;
  wire::GiveWay give_way_;
  TimePoint next_open_;
  TimePoint next_look_;
  /// An attempt to open the port is under way.
  bool opening_ = false;
  std::optional<TimePoint> in_use_since_;
  bool ever_opened_ = false;
  bool given_up_ = false;
};
}  // namespace bus
}  // namespace inverter_bus

#endif  // INVERTER_BUS_BUS_BUS_LOOP_H
