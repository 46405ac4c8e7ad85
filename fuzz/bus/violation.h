// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_FUZZ_VIOLATION_H
#define INVERTER_BUS_FUZZ_VIOLATION_H

#include <cstdio>
#include <stdexcept>
#include <string>

#include "inverter_bus/util/clock.h"

namespace inverter_bus
{
namespace fuzz
{
/// A rule of the contract was broken.
class Violation : public std::runtime_error
{
public:
  Violation(TimePoint time, const std::string& rule, const std::string& text)
    : std::runtime_error(rule + ": " + text), time(time)
  {
  }
  TimePoint time;
};

/// Ends the story. \p rule is quoted by docs/fuzzing.md and docs/safety_rules.md.
/// \throws Violation always
[[noreturn]] inline void fail(TimePoint now, const std::string& rule, const std::string& text)
{
  throw Violation(now, rule, text);
}

/// With three decimals, for messages.
inline std::string decimal(double value)
{
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.3f", value);
  return buffer;
}
}  // namespace fuzz
}  // namespace inverter_bus

#endif  // INVERTER_BUS_FUZZ_VIOLATION_H
