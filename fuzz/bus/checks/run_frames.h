// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_FUZZ_CHECKS_RUN_FRAMES_H
#define INVERTER_BUS_FUZZ_CHECKS_RUN_FRAMES_H

#include <cstdint>
#include <optional>
#include <vector>

#include "fuzz/bus/observed.h"
#include "fuzz/bus/plant.h"

namespace inverter_bus
{
namespace fuzz
{
namespace checks
{
/// Rules 4.1 and 4.2: every RUN has a fresh, allowed command, and nothing but a command makes one.
class RunFrames
{
public:
  RunFrames(const Observed& observed, const Plant& plant);

  void lostPower(TimePoint now, std::size_t index);
  /// A request is about to go.
  void check(TimePoint now);
  /// It goes.
  void sent();
  std::uint64_t checked() const;

private:
  void checkRepeat(TimePoint now, std::size_t index) const;
  void checkPowerCycle(TimePoint now, std::size_t index) const;

  const Observed& observed_;
  const Plant& plant_;
  /// When a drive lost the RUN that it had acknowledged, if no stop was sent to it since.
  std::vector<std::optional<TimePoint>> power_lost_;
  std::uint64_t checked_ = 0;
};
}  // namespace checks
}  // namespace fuzz
}  // namespace inverter_bus

#endif  // INVERTER_BUS_FUZZ_CHECKS_RUN_FRAMES_H
