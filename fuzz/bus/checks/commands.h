// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_FUZZ_CHECKS_COMMANDS_H
#define INVERTER_BUS_FUZZ_CHECKS_COMMANDS_H

#include <cstdint>

#include "fuzz/bus/observed.h"

namespace inverter_bus
{
namespace fuzz
{
namespace checks
{
/// Rule 4.6 and contract, section 2: nonsense is refused, and 0 never is.
class Commands
{
public:
  explicit Commands(const Observed& observed);

  /// Before the record knows of the command.
  void check(TimePoint now, const bus::VelocityCommand& command, std::uint16_t result);
  std::uint64_t checked() const;

private:
  const Observed& observed_;
  std::uint64_t checked_ = 0;
};
}  // namespace checks
}  // namespace fuzz
}  // namespace inverter_bus

#endif  // INVERTER_BUS_FUZZ_CHECKS_COMMANDS_H
