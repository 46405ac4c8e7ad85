// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_FUZZ_CHECKS_TRIPS_H
#define INVERTER_BUS_FUZZ_CHECKS_TRIPS_H

#include <vector>

#include "fuzz/bus/observed.h"
#include "fuzz/bus/plant.h"

namespace inverter_bus
{
namespace fuzz
{
namespace checks
{
/// Rule 4.8 and contract, 8.6: a trip that no table lists is a trip.
class Trips
{
public:
  Trips(const Observed& observed, const Plant& plant);

  /// Something is about to happen to a drive, or has happened.
  void glance(std::size_t index);
  /// Before the record knows of the status.
  void check(TimePoint now, const bus::InverterStatus& status);

private:
  bool isUnlisted(std::size_t index) const;

  const Observed& observed_;
  const Plant& plant_;
  /// Complete statuses with stamps of their own since each drive has tripped.
  std::vector<unsigned> statuses_;
};
}  // namespace checks
}  // namespace fuzz
}  // namespace inverter_bus

#endif  // INVERTER_BUS_FUZZ_CHECKS_TRIPS_H
