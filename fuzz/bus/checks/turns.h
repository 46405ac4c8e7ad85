// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_FUZZ_CHECKS_TURNS_H
#define INVERTER_BUS_FUZZ_CHECKS_TURNS_H

#include <optional>
#include <vector>

#include "fuzz/bus/observed.h"
#include "fuzz/bus/recorder.h"

namespace inverter_bus
{
namespace fuzz
{
namespace checks
{
/// Contract, 8.1: but for stops, an inverter that did not answer gets no second exchange while another one waits or has
/// a deadline. (Answered frames that belong together are short; that they alternate is held by the scheduler's own
/// tests.)
class Turns
{
public:
  explicit Turns(const Observed& observed);

  /// A request is about to go.
  void check(TimePoint now);
  void answered(std::size_t index, const ReplyFacts& reply);
  void ended();

private:
  bool isOfStop() const;
  bool waits(TimePoint now, std::size_t index) const;
  bool hasUnsentCommand(std::size_t index) const;
  bool isNearItsTimeout(TimePoint now, std::size_t index) const;

  const Observed& observed_;
  /// The set-point that each drive has acknowledged last; a stop doesn't take it away [Hz].
  std::vector<std::optional<double>> held_;
  /// Whose the last exchange was, if it was none of a stop, and when it began.
  std::optional<std::size_t> turn_of_;
  TimePoint turn_began_;
  bool answered_ = false;
};
}  // namespace checks
}  // namespace fuzz
}  // namespace inverter_bus

#endif  // INVERTER_BUS_FUZZ_CHECKS_TURNS_H
