// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_FUZZ_CHECKS_LOWEST_CLASS_H
#define INVERTER_BUS_FUZZ_CHECKS_LOWEST_CLASS_H

#include <set>
#include <vector>

#include "fuzz/bus/observed.h"

namespace inverter_bus
{
namespace fuzz
{
namespace checks
{
/// Rule 3.14, for the time until each drive's settings have been read once: the lowest class gets every eighth
/// exchange.
class LowestClass
{
public:
  explicit LowestClass(const Observed& observed);

  /// A request is about to go.
  void check(TimePoint now);
  void answered(std::size_t index);
  void wentOffline(std::size_t index);

private:
  struct Lane
  {
    std::set<unsigned> settings_read;
    bool first_time = true;  ///< it was never offline
  };

  bool hasUnreadSettings(std::size_t index) const;
  bool anyoneWaits(TimePoint now) const;
  bool clearsLineForSetting(TimePoint now) const;
  unsigned longestRow() const;

  const Observed& observed_;
  std::vector<Lane> lanes_;
  unsigned others_in_a_row_ = 0;
};
}  // namespace checks
}  // namespace fuzz
}  // namespace inverter_bus

#endif  // INVERTER_BUS_FUZZ_CHECKS_LOWEST_CLASS_H
