// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_FUZZ_CHECKS_SET_POINTS_H
#define INVERTER_BUS_FUZZ_CHECKS_SET_POINTS_H

#include "fuzz/bus/observed.h"

namespace inverter_bus
{
namespace fuzz
{
namespace checks
{
/// Rules 3.2 and 3.5: only the newest velocity is sent, each one once, and none that was cancelled.
class SetPoints
{
public:
  explicit SetPoints(const Observed& observed);

  /// A request is about to go.
  void check(TimePoint now) const;

private:
  void checkNewest(TimePoint now, std::size_t index) const;
  void checkOnce(TimePoint now, std::size_t index) const;

  const Observed& observed_;
};
}  // namespace checks
}  // namespace fuzz
}  // namespace inverter_bus

#endif  // INVERTER_BUS_FUZZ_CHECKS_SET_POINTS_H
