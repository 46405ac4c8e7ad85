// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_BUS_PROBE_ACCOUNT_H
#define INVERTER_BUS_BUS_PROBE_ACCOUNT_H

#include <cstddef>
#include <cstdint>
#include <vector>

#include "inverter_bus/util/clock.h"

namespace inverter_bus
{
namespace bus
{
/// Contract, rule 3.7: the share of the time that all probes of offline inverters take together.
constexpr double PROBE_SHARE = 0.05;
/// What is left of it for the probes' turns while a long wait is paid off.
constexpr double PROBE_TURNS_SHARE = 0.9 * PROBE_SHARE;

/// Contract, 8.8: [s], each offline inverter at most so often.
constexpr double PROBE_PERIOD_S = 0.5;

/// How long a probe waits at least for a drive whose slowest reply began after \p slowest (0: it was never heard), beyond the
/// drive's own \p reply_delay, which is waited out anyway.
Duration leastProbeTimeout(Duration slowest, Duration reply_delay);

/// What the probes of offline inverters have cost, and when the next one may go (contract, 3.7). Who waits for the whole
/// response_timeout, for a drive that has become slow, pays what that takes beyond a short wait with a tenth of the share,
/// so that it holds back nobody's next probe for long. Pure: time comes in as an argument. Not thread safe; the bus guards it.
class ProbeAccount
{
public:
  /// \p share of the bus time, above 0.
  ProbeAccount(std::size_t inverters, double share);

  /// From when on the next probe may go.
  TimePoint opensAt() const;
  /// From when on this inverter may be asked again.
  TimePoint opensAt(std::size_t inverter) const;
  /// A probe of \p inverter may wait for long: the last long wait is paid off, and none of \p wanting waits for its own for
  /// longer.
  bool mayWaitLong(TimePoint now, std::size_t inverter, const std::vector<std::size_t>& wanting) const;

  /// A probe of \p inverter has taken \p cost of everybody's time; what that is beyond \p in_turn was a long wait.
  void ended(TimePoint now, std::size_t inverter, Duration cost, Duration in_turn);
  /// It has cost so much after all: a gateway was kept busy by it, or a trial has led to nothing. Not added to what is paid
  /// for already.
  void charge(TimePoint now, Duration cost);
  /// What turns have cost before doesn't count.
  void restart(TimePoint now);

private:
  void chargeLongWait(TimePoint now, std::size_t inverter, Duration beyond);

  double share_;
  TimePoint opens_at_;
  TimePoint paid_off_at_;
  /// The end of each one's last probe.
  std::vector<TimePoint> last_probe_;
  /// Which long wait was each one's last; 0: it had none.
  std::vector<std::uint64_t> last_long_wait_;
  std::uint64_t long_waits_ = 0;
};
}  // namespace bus
}  // namespace inverter_bus

#endif  // INVERTER_BUS_BUS_PROBE_ACCOUNT_H
