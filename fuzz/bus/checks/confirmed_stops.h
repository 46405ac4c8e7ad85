// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_FUZZ_CHECKS_CONFIRMED_STOPS_H
#define INVERTER_BUS_FUZZ_CHECKS_CONFIRMED_STOPS_H

#include <vector>

#include "fuzz/bus/observed.h"
#include "fuzz/bus/plant.h"
#include "fuzz/bus/recorder.h"

namespace inverter_bus
{
namespace fuzz
{
namespace checks
{
/// Rule 3.3: a stop that is answered with success was acknowledged, RUN was read as off where the drive can report it, and
/// it is off.
class ConfirmedStops
{
public:
  ConfirmedStops(const Observed& observed, const Plant& plant);

  void answered(TimePoint now, std::size_t index, const ReplyFacts& reply);
  /// A call of \p asked_at for one inverter is answered now.
  void check(TimePoint now, std::size_t index, TimePoint asked_at) const;

private:
  const Observed& observed_;
  const Plant& plant_;
  std::vector<TimePoint> run_read_;
};
}  // namespace checks
}  // namespace fuzz
}  // namespace inverter_bus

#endif  // INVERTER_BUS_FUZZ_CHECKS_CONFIRMED_STOPS_H
