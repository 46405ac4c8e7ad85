// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_BUS_BUDGET_H
#define INVERTER_BUS_BUS_BUDGET_H

#include <optional>
#include <string>
#include <vector>

#include "bus/rules/slow_share.h"
#include "inverter_bus/bus/configuration.h"
#include "inverter_bus/bus/types.h"

namespace inverter_bus
{
namespace bus
{
/// What the bus can do, computed before anything is sent (contract, rule 3.11): every exchange has a cost on the wire.
/// The drives' own processing time is not known before they answer; the figures are the wire's limit. Pure.
class Budget
{
public:
  /// Everything that the running bus needs of it, computed once.
  struct Figures
  {
    Duration cycle{ 0 };
    Duration worst_stop{ 0 };
    /// Behind an exchange that no stop cuts.
    Duration worst_stop_uncut{ 0 };
    Duration longest_exchange{ 0 };
    Duration deadline_margin{ 0 };
    /// Longest pause inside a reply that is waited out.
    Duration longest_pause{ 0 };
    /// How much longer than that exchange a stop may take to the wire before it is worth a trace: gaps and a short frame.
    Duration stop_slack{ 0 };
    SlowShare::Settings slow;
    std::vector<Finding> findings;
  };

  Budget(const Configuration& configuration, const wire::Line& line);

  /// One status cycle of all inverters without commands, slow values included in proportion. They have their share of the
  /// wire, and what is never slowed comes once a second.
  Duration cycle() const;
  /// Acceptance of a stop to the last bit of its frame: the exchange in flight, unanswered until the stop cuts it
  /// (contract, 8.4), then the frame. Drives that take longer than 5 ms to begin a reply are waited for longer: Waits has
  /// that.
  Duration worstStop() const;
  /// The same behind one that no stop cuts: another stop, a reset, a write to the EEPROM, and whatever a gateway
  /// has (contract, 8.8).
  Duration worstStopUncut() const;
  /// Longest time between two frames to the same inverter: every read of the cycle alternates with a velocity of one
  /// inverter, and one exchange is lost.
  Duration longestGap() const;
  /// How long a drive whose own time-out is close may still have to wait for its turn: an exchange in flight, a
  /// velocity for all inverters under way, and every other drive's turn before it.
  Duration deadlineMargin() const;
  /// The longest exchange in use: its reply begins when its time is almost up, and has a pause in it.
  Duration longestExchange() const;
  /// How often each slow value can be read within the share of the wire that all have (contract, 8.3), while all motors
  /// run.
  Duration slowPeriod() const;
  /// The longest one that a stop cuts as soon as it may: its reply begins at the last moment, and has a pause in it.
  Duration longestCutExchange() const;
  /// How long an inverter that answers again may stay offline on a serial line while \p offline of the slowest to probe are
  /// (itself included): their probes take turns. What the wire allows, once they were heard.
  Duration returnTime(std::size_t offline) const;
  Figures figures() const;

  /// Lines for the log: the figures, and WARN where a time-out can't be met.
  std::vector<Finding> findings() const;
  /// WARN if a drive's own \p timeout can't be met.
  std::optional<Finding> judgeDriveTimeout(const std::string& name, Duration timeout) const;
  /// The same with deadlineMargin() at hand.
  static std::optional<Finding> judgeDriveTimeout(const std::string& name, Duration timeout, Duration margin);

  /// How long an inverter that answers again may stay offline behind a gateway that each silent station blocks for \p
  /// block: the probes of \p offline inverters (itself included, at least 1) take turns. With a short block what rule 3.7
  /// says.
  static Duration longestReturn(Duration block, std::size_t offline);

private:
  Duration stopFrame() const;
  Duration readCost(std::size_t index, const drive::ReadBlock& block) const;
  Duration refreshCost(std::size_t index) const;
  Duration slowNeeds() const;
  SlowShare::Settings slowSettings() const;
  std::optional<Finding> slowFinding() const;
  Duration velocityUnit(std::size_t index) const;
  std::vector<wire::Request> requests(std::size_t index) const;
  std::string behindOthers() const;
  std::string returnText() const;
  std::optional<Finding> returnBehindGateway() const;

  const Configuration& configuration_;
  const wire::Line& line_;
};
}  // namespace bus
}  // namespace inverter_bus

#endif  // INVERTER_BUS_BUS_BUDGET_H
