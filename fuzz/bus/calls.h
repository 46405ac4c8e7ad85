// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_FUZZ_CALLS_H
#define INVERTER_BUS_FUZZ_CALLS_H

#include <functional>
#include <optional>

#include "bus/coordinator.h"
#include "fuzz/bus/checker.h"
#include "fuzz/bus/story.h"
#include "inverter_bus/util/clock.h"

namespace inverter_bus
{
namespace fuzz
{
/// The services of one bus as users call them; \p answered may be empty.
class Calls
{
public:
  using Callback = std::function<void(const bus::Answer&)>;

  Calls(bus::Coordinator& coordinator, Checker& checker, Story& story, const util::Clock& clock);

  void stop(std::optional<std::size_t> index, std::uint8_t mode, const Callback& answered);
  void reset(std::size_t index, const Callback& answered);
  void readFaults(std::size_t index);
  void readFixedParameter(std::size_t index);
  void readUnknownParameter(std::size_t index);
  void writeFreeParameter(std::size_t index, double value, bool persist);

private:
  const InverterFacts& facts(std::size_t index) const;

  bus::Coordinator& coordinator_;
  Checker& checker_;
  Story& story_;
  const util::Clock& clock_;
  bus::ServiceBounds bounds_;
};
}  // namespace fuzz
}  // namespace inverter_bus

#endif  // INVERTER_BUS_FUZZ_CALLS_H
