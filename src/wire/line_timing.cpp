// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include <algorithm>

#include "inverter_bus/wire/line.h"

namespace inverter_bus
{
namespace wire
{
namespace
{
/// Up to here silences are counted in characters, above it in fixed times: at high rates a few characters are too short
/// for a timer to tell them from a pause inside a frame.
constexpr unsigned FASTEST_COUNTED_BAUD_RATE = 19200;
constexpr double FAST_CHARACTER_S = 0.0005;
}  // namespace

LineTiming::LineTiming(unsigned baud_rate, unsigned bits_per_character, Duration delivery)
  : character_s_(static_cast<double>(bits_per_character) / static_cast<double>(baud_rate))
  , fast_(baud_rate > FASTEST_COUNTED_BAUD_RATE)
  , delivery_(delivery)
{
}

Duration LineTiming::characters(double count) const
{
  return seconds(count * character_s_);
}

Duration LineTiming::gap(double gap_characters) const
{
  return fast_ ? seconds(gap_characters * FAST_CHARACTER_S) : characters(gap_characters);
}

Duration LineTiming::patience(double gap_characters) const
{
  return std::max(gap(gap_characters), delivery_);
}
}  // namespace wire
}  // namespace inverter_bus
