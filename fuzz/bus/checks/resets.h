// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_FUZZ_CHECKS_RESETS_H
#define INVERTER_BUS_FUZZ_CHECKS_RESETS_H

#include "fuzz/bus/observed.h"
#include "fuzz/bus/plant.h"

namespace inverter_bus
{
namespace fuzz
{
namespace checks
{
/// Rule 4.8: a reset sends nothing unless RUN is off.
class Resets
{
public:
  Resets(const Observed& observed, const Plant& plant);

  /// A request is about to go.
  void check(TimePoint now) const;

private:
  const Observed& observed_;
  const Plant& plant_;
};
}  // namespace checks
}  // namespace fuzz
}  // namespace inverter_bus

#endif  // INVERTER_BUS_FUZZ_CHECKS_RESETS_H
