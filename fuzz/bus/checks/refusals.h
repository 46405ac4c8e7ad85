// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_FUZZ_CHECKS_REFUSALS_H
#define INVERTER_BUS_FUZZ_CHECKS_REFUSALS_H

#include <optional>
#include <string>
#include <vector>

#include "fuzz/bus/observed.h"

namespace inverter_bus
{
namespace fuzz
{
namespace checks
{
/// Refusals are reported: the log must not say that no command came while commands were refused.
class Refusals
{
public:
  explicit Refusals(const Observed& observed);

  void refused(TimePoint now, std::size_t index);
  /// A command was accepted, or takes RUN off.
  void forget(std::size_t index);
  void check(TimePoint now, const std::string& line) const;

private:
  const Observed& observed_;
  /// The first command that was refused since the last accepted one.
  std::vector<std::optional<TimePoint>> refused_at_;
};
}  // namespace checks
}  // namespace fuzz
}  // namespace inverter_bus

#endif  // INVERTER_BUS_FUZZ_CHECKS_REFUSALS_H
