// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_FUZZ_CHECKS_SHUTDOWN_H
#define INVERTER_BUS_FUZZ_CHECKS_SHUTDOWN_H

#include <string>
#include <vector>

#include "fuzz/bus/observed.h"
#include "fuzz/bus/plant.h"

namespace inverter_bus
{
namespace fuzz
{
namespace checks
{
/// Rule 4.4: the end of the program comes within its bound, and what may still run is named.
class Shutdown
{
public:
  Shutdown(const Observed& observed, const Plant& plant);

  void checkDuration(TimePoint now, TimePoint begun) const;
  /// \p unconfirmed what the node names, each beginning with the inverter.
  void checkDrives(TimePoint now, TimePoint begun, const std::vector<std::string>& unconfirmed) const;

private:
  const Observed& observed_;
  const Plant& plant_;
};
}  // namespace checks
}  // namespace fuzz
}  // namespace inverter_bus

#endif  // INVERTER_BUS_FUZZ_CHECKS_SHUTDOWN_H
