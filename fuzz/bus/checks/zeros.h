// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_FUZZ_CHECKS_ZEROS_H
#define INVERTER_BUS_FUZZ_CHECKS_ZEROS_H

#include <optional>
#include <vector>

#include "fuzz/bus/observed.h"

namespace inverter_bus
{
namespace fuzz
{
namespace checks
{
/// A command of 0, or near it, takes RUN off.
class Zeros
{
public:
  explicit Zeros(const Observed& observed);

  /// 0, or near it, was commanded.
  void commanded(TimePoint now, std::size_t index);
  /// A stop or a newer command takes its place, or the drive or the port is gone.
  void drop(std::size_t index);
  void dropAll();
  /// The request that goes may be its stop.
  void sent();
  void checkOverdue(TimePoint now, std::size_t index) const;

private:
  const Observed& observed_;
  std::vector<std::optional<TimePoint>> due_;
};
}  // namespace checks
}  // namespace fuzz
}  // namespace inverter_bus

#endif  // INVERTER_BUS_FUZZ_CHECKS_ZEROS_H
