// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_FUZZ_CHECKS_TOLD_LOCKS_H
#define INVERTER_BUS_FUZZ_CHECKS_TOLD_LOCKS_H

#include <cstdint>
#include <string>
#include <vector>

#include "fuzz/bus/observed.h"

namespace inverter_bus
{
namespace fuzz
{
namespace checks
{
/// Rule 4.2: what the status says of the lock is what becomes of velocities. While it is reported as free, no publisher is
/// refused as locked that has returned to neutral since it was reported as locked; while it is reported as locked, its only
/// publisher does not get through. (Several: a lock is reported until all have returned, or one got through.)
class ToldLocks
{
public:
  explicit ToldLocks(const Observed& observed);

  /// A status says \p locked.
  void told(TimePoint now, std::size_t index, bool locked);
  /// A velocity that \p publisher sent to this inverter alone was answered with \p result. Before the record knows of it, and
  /// after told() of the moment before it.
  void check(TimePoint now, std::size_t index, const bus::Publisher& publisher, std::uint16_t result) const;

private:
  struct Lane
  {
    bool locked = true;
    TimePoint locked_at;  ///< when it was last reported as locked
  };
  bool hasReturned(TimePoint now, std::size_t index, const std::string& publisher) const;
  bool isAlone(std::size_t index, const std::string& publisher) const;
  Duration longestSilence(std::size_t index) const;

  const Observed& observed_;
  std::vector<Lane> lanes_;
};
}  // namespace checks
}  // namespace fuzz
}  // namespace inverter_bus

#endif  // INVERTER_BUS_FUZZ_CHECKS_TOLD_LOCKS_H
