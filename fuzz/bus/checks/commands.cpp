// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "fuzz/bus/checks/commands.h"

#include <algorithm>
#include <cmath>

#include "fuzz/bus/limits.h"
#include "fuzz/bus/violation.h"

namespace inverter_bus
{
namespace fuzz
{
namespace checks
{
Commands::Commands(const Observed& observed) : observed_(observed)
{
}

void Commands::check(TimePoint now, const bus::VelocityCommand& command, std::uint16_t result)
{
  ++checked_;
  bool out_of_range = false;
  bool all_stop = true;
  const double factor = groupFactor(observed_.scene, command);
  for (const auto& target : command.targets)
  {
    const InverterFacts& facts = observed_.scene.inverters[target.first];
    const bool stops = target.second == 0.0 || isNearZero(facts, target.second);
    const bool refused = isBeyond(facts, target.second) && !facts.saturates;
    const bool reduced_too_far = !stops && !refused && isNearZero(facts, target.second * factor);
    out_of_range = out_of_range || !std::isfinite(target.second) || refused || reduced_too_far;
    all_stop = all_stop && stops;
  }
  // Contract, section 2: the end of the program is named before a value.
  const std::uint16_t refusal = observed_.shutting_down ? bus::ERROR_SHUTTING_DOWN : bus::ERROR_OUT_OF_RANGE;
  const bool repeat = std::any_of(command.targets.begin(), command.targets.end(), [&](const auto& target) {
    return std::isfinite(target.second) && observed_.isRepeat(target.first, command.publisher);
  });
  if (out_of_range && result != refusal && !(repeat && result == 0))
  {
    fail(now, "NaN, infinity and what is out of range are refused", "answer " + std::to_string(result));
  }
  if (all_stop && result != 0)
  {
    fail(now, "a command of 0, or near it, is never refused", "answer " + std::to_string(result));
  }
}

std::uint64_t Commands::checked() const
{
  return checked_;
}
}  // namespace checks
}  // namespace fuzz
}  // namespace inverter_bus
