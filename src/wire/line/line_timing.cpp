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

/// 16 ms of an FTDI adapter's latency timer, and some reserve.
constexpr std::chrono::milliseconds ADAPTER_PAUSE{ 25 };
/// The highest trigger level of a 16550A's FIFO, 14, and the 4 characters of silence after which it reports fewer.
constexpr double FIFO_CHARACTERS = 18.0;
/// Contract, 8.4.
constexpr std::chrono::milliseconds BRIEF_PAUSE{ 5 };
}  // namespace

LineTiming::LineTiming(unsigned baud_rate, unsigned bits_per_character)
  : LineTiming(baud_rate, bits_per_character, ADAPTER_PAUSE)
{
  pause_ = std::max(pause_, characters(FIFO_CHARACTERS));
}

LineTiming::LineTiming(unsigned baud_rate, unsigned bits_per_character, Duration pause)
  : character_s_(static_cast<double>(bits_per_character) / static_cast<double>(baud_rate))
  , fast_(baud_rate > FASTEST_COUNTED_BAUD_RATE)
  , pause_(pause)
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
  return std::max(gap(gap_characters), pause_);
}

Duration LineTiming::briefPause() const
{
  return std::max<Duration>(BRIEF_PAUSE, characters(FIFO_CHARACTERS));
}
}  // namespace wire
}  // namespace inverter_bus
