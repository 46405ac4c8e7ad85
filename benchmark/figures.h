// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_BENCHMARK_FIGURES_H
#define INVERTER_BUS_BENCHMARK_FIGURES_H

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

#include "inverter_bus/simulation/simulated_line.h"

// What the programs of this folder hand to the scripts: raw samples as one JSON object on standard output. Medians and the like are
// worked out in one place, benchmark/figures.py.

namespace inverter_bus
{
namespace benchmark
{
/// A flat or nested JSON object that is written once. Keys and texts are plain words of ours: nothing is escaped.
class Json
{
public:
  Json& number(const std::string& key, double value)
  {
    return raw(key, text(value));
  }

  Json& word(const std::string& key, const std::string& value)
  {
    return raw(key, "\"" + value + "\"");
  }

  Json& numbers(const std::string& key, const std::vector<double>& values)
  {
    std::string list;
    for (const double value : values)
    {
      list += (list.empty() ? "" : ",") + text(value);
    }
    return raw(key, "[" + list + "]");
  }

  Json& object(const std::string& key, const Json& value)
  {
    return raw(key, value.str());
  }

  std::string str() const
  {
    return "{" + text_ + "}";
  }

private:
  Json& raw(const std::string& key, const std::string& value)
  {
    text_ += (text_.empty() ? "\"" : ",\"") + key + "\":" + value;
    return *this;
  }

  static std::string text(double value)
  {
    char buffer[32];
    std::snprintf(buffer, sizeof buffer, std::isfinite(value) ? "%.7g" : "null", value);
    return buffer;
  }

  std::string text_;
};

/// Does this request of a master read that register (its address in the frame)? 03H, 04H and the read of a 17H.
inline bool reads(const simulation::Bytes& frame, unsigned address)
{
  if (frame.size() < 8 || (frame[1] != 0x03 && frame[1] != 0x04 && frame[1] != 0x17))
  {
    return false;
  }
  const unsigned first = frame[2] * 256U + frame[3];
  const unsigned count = frame[4] * 256U + frame[5];
  return first <= address && address < first + count;
}

/// What every refresh of a drive reads in one way or another: its output frequency.
constexpr unsigned MX2_FREQUENCY = 0x1000;
constexpr unsigned VFS15_FREQUENCY = 0xFD00;
constexpr unsigned VFS15_BLOCK = 0x1875;

inline bool isRefresh(const simulation::FrameRecord& frame)
{
  return frame.source == simulation::FrameRecord::Source::Master &&
         (reads(frame.bytes, MX2_FREQUENCY) || reads(frame.bytes, VFS15_FREQUENCY) || reads(frame.bytes, VFS15_BLOCK));
}

/// [s] between two refreshes of the same station, for each of \p stations, in the order in which they came.
inline std::vector<double> refreshPeriods(const std::vector<simulation::FrameRecord>& frames, unsigned stations)
{
  std::vector<simulation::TimePoint> last(stations + 1);
  std::vector<double> periods;
  for (const simulation::FrameRecord& frame : frames)
  {
    if (!isRefresh(frame) || frame.bytes[0] > stations)
    {
      continue;
    }
    simulation::TimePoint& before = last[frame.bytes[0]];
    if (before != simulation::TimePoint())
    {
      periods.push_back(simulation::toSeconds(frame.time - before));
    }
    before = frame.time;
  }
  return periods;
}
}  // namespace benchmark
}  // namespace inverter_bus

#endif  // INVERTER_BUS_BENCHMARK_FIGURES_H
