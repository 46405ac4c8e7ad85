// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_FUZZ_CHECKS_VALUES_H
#define INVERTER_BUS_FUZZ_CHECKS_VALUES_H

#include <cstdint>
#include <deque>
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
/// Rule 3.9 and contract, section 2: what is published is the motor's. Each stamp is the end of a reply that was waited
/// for, the frequency is that of this exchange, slow values are not too old (8.3), and a motor that turns is not shown at rest.
class Values
{
public:
  Values(const Observed& observed, Plant& plant);

  /// A request goes: speeds of its drive count from here.
  void begins(TimePoint now);
  /// Something is about to happen to a drive, or has happened.
  void glance(TimePoint now, std::size_t index);
  /// The drive heard a request: what it answers is what it has now, not at the end of the exchange, when a new frequency that
  /// came with it has changed that.
  void heard(TimePoint now, std::size_t index);
  void sample(TimePoint now, std::size_t index);
  /// The drive's time has passed up to \p now.
  void answered(TimePoint now, std::size_t index, const ReplyFacts& reply);
  void ended(TimePoint now);
  void check(TimePoint now, const bus::InverterStatus& status);
  std::uint64_t compared() const;

private:
  /// An exchange in which a drive reported its frequency.
  struct FrequencyRead
  {
    TimePoint end;
    double least = 0.0;
    double most = 0.0;
  };
  struct Sample
  {
    TimePoint time;
    double torque = 0.0;
  };
  struct Lane
  {
    std::deque<TimePoint> ends;  ///< of its last replies
    std::deque<FrequencyRead> frequencies;
    std::deque<Sample> samples;
    /// Speeds since the exchange in flight began [Hz], and the sign of the last one.
    double least = 0.0;
    double most = 0.0;
    int sign = 0;
    /// Empty: it is at rest.
    std::optional<TimePoint> turning_since;
  };

  void widen(std::size_t index);
  void checkStamp(TimePoint now, const bus::InverterStatus& status) const;
  void checkFrequency(TimePoint now, const bus::InverterStatus& status);
  void checkRunning(TimePoint now, const bus::InverterStatus& status) const;
  void checkTorque(TimePoint now, const bus::InverterStatus& status) const;

  const Observed& observed_;
  Plant& plant_;
  std::vector<Lane> lanes_;
  std::uint64_t compared_ = 0;
};
}  // namespace checks
}  // namespace fuzz
}  // namespace inverter_bus

#endif  // INVERTER_BUS_FUZZ_CHECKS_VALUES_H
