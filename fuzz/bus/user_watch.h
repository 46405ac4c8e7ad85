// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_FUZZ_USER_WATCH_H
#define INVERTER_BUS_FUZZ_USER_WATCH_H

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "fuzz/bus/checks.h"

namespace inverter_bus
{
namespace fuzz
{
/// Reports to the checks what users do, and how they are answered.
class UserWatch
{
public:
  explicit UserWatch(Checks& checks);

  /// \p locked what the status of each of its inverters has said of the lock just before.
  void commanded(TimePoint now, const bus::VelocityCommand& command, const std::vector<bool>& locked,
                 std::uint16_t result);
  /// A stop is about to be called for, of one or of all, and must be answered within \p bound [s]; what this returns is
  /// to be given the answer.
  checks::Services::Callback stopCalled(TimePoint now, std::optional<std::size_t> index, double bound);
  /// The node knows of it.
  void stopRequested(TimePoint now, std::optional<std::size_t> index);
  void shutdownBegun(TimePoint now);
  /// \p unconfirmed what the node names, each beginning with the inverter.
  void shutdownEnded(TimePoint now, TimePoint begun, const std::vector<std::string>& unconfirmed) const;

private:
  void checkTold(TimePoint now, const bus::VelocityCommand& command, const std::vector<bool>& locked,
                 std::uint16_t result);
  void accept(TimePoint now, std::size_t index, double velocity, const bus::Publisher& publisher);
  void refuse(TimePoint now, std::size_t index, const bus::Publisher& publisher);
  void takeZero(TimePoint now, std::size_t index, const bus::Publisher& publisher);
  void takeRunOff(TimePoint now, std::size_t index);

  Checks& checks_;
};
}  // namespace fuzz
}  // namespace inverter_bus

#endif  // INVERTER_BUS_FUZZ_USER_WATCH_H
