// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_FUZZ_CHECKS_BOUNDED_VELOCITIES_H
#define INVERTER_BUS_FUZZ_CHECKS_BOUNDED_VELOCITIES_H

#include <vector>

#include "fuzz/bus/observed.h"

namespace inverter_bus
{
namespace fuzz
{
namespace checks
{
/// Contract, 8.1: a velocity is bounded whatever follows it. After 1 + retries lost frames of an inverter that may run
/// a stop is next. SetPoints and RunFrames count the copies of one velocity; here newer ones may have come meanwhile.
class BoundedVelocities
{
public:
  explicit BoundedVelocities(const Observed& observed);

  /// A request is about to go.
  void check(TimePoint now);
  void answered(std::size_t index);
  /// Something wants RUN off: it may cut the exchange in flight.
  void wantedOff();
  void ended(TimePoint now);
  /// The order is void.
  void forbidden(std::size_t index);

private:
  const Observed& observed_;
  /// Frames of velocities in a row that were not answered.
  std::vector<int> lost_;
  bool wanted_off_ = false;
};
}  // namespace checks
}  // namespace fuzz
}  // namespace inverter_bus

#endif  // INVERTER_BUS_FUZZ_CHECKS_BOUNDED_VELOCITIES_H
