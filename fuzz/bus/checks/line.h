// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_FUZZ_CHECKS_LINE_H
#define INVERTER_BUS_FUZZ_CHECKS_LINE_H

#include "fuzz/bus/observed.h"

namespace inverter_bus
{
namespace fuzz
{
namespace checks
{
/// Rules 3.1, 3.3 and 3.8: one request at a time, silence before it, and broadcasts only where they are safe.
class Line
{
public:
  explicit Line(const Observed& observed);

  void opened(TimePoint now);
  void heard(TimePoint now);
  /// Before the record knows of the request.
  void begins(TimePoint now, const simulation::Bytes& request);
  /// Once it does.
  void checkStation(TimePoint now) const;
  void checkBroadcast(TimePoint now) const;

private:
  void checkGap(TimePoint now) const;

  const Observed& observed_;
  TimePoint request_end_;
  TimePoint heard_at_;
};
}  // namespace checks
}  // namespace fuzz
}  // namespace inverter_bus

#endif  // INVERTER_BUS_FUZZ_CHECKS_LINE_H
