// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_FUZZ_CHECKS_PROBES_H
#define INVERTER_BUS_FUZZ_CHECKS_PROBES_H

#include <vector>

#include "fuzz/bus/observed.h"

namespace inverter_bus
{
namespace fuzz
{
namespace checks
{
/// Rule 3.7: probes of dead drives take at most 5 % of the time. A bucket that fills at that rate; what the first
/// probes of each inverter cost is allowed for when it goes offline.
class Probes
{
public:
  explicit Probes(const Observed& observed);

  void opened();
  void lost();
  /// An inverter is or was offline: \p exchanges more with it are allowed for.
  void allow(double exchanges);
  /// The drive has sent something, however late.
  void replied(std::size_t index);
  void ended(TimePoint now);

private:
  void pay(TimePoint now, Duration cost);

  const Observed& observed_;
  std::vector<unsigned> silences_;  ///< exchanges in a row that each drive has not answered
  double debt_ = 0.0;               ///< [s]
  double allowance_ = 0.0;          ///< [s]
  TimePoint paid_at_;
};
}  // namespace checks
}  // namespace fuzz
}  // namespace inverter_bus

#endif  // INVERTER_BUS_FUZZ_CHECKS_PROBES_H
