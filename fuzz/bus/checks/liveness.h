// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_FUZZ_CHECKS_LIVENESS_H
#define INVERTER_BUS_FUZZ_CHECKS_LIVENESS_H

#include <vector>

#include "fuzz/bus/observed.h"
#include "fuzz/bus/recorder.h"

namespace inverter_bus
{
namespace fuzz
{
namespace checks
{
/// Contract, 8.15: alive means data. An inverter that has failed often and shown no complete status since is published
/// as offline, whatever else it answers; and none is offline because others are.
class Liveness
{
public:
  explicit Liveness(const Observed& observed);

  void answered(TimePoint now, std::size_t index, const ReplyFacts& reply);
  void ended();
  void checkAlive(TimePoint now) const;
  /// It is published as offline now.
  void checkWentOffline(TimePoint now, std::size_t index) const;
  /// Before the record knows of the status.
  void published(const bus::InverterStatus& status);

private:
  struct Lane
  {
    unsigned failed_reads = 0;  ///< of its status, since the last complete one
    TimePoint asked_at;         ///< the last of these reads
    /// The longest time without one since the last complete status, and before that.
    Duration pause{ 0 };
    Duration pause_before{ 0 };
    TimePoint refused_at;  ///< the last exchange that was answered by a refusal
  };

  Duration patience(std::size_t index) const;

  const Observed& observed_;
  std::vector<Lane> lanes_;
};
}  // namespace checks
}  // namespace fuzz
}  // namespace inverter_bus

#endif  // INVERTER_BUS_FUZZ_CHECKS_LIVENESS_H
