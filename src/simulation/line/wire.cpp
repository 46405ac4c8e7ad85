// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

#include "simulation/line/wire.h"

#include <algorithm>

namespace inverter_bus
{
namespace simulation
{
bool Transmission::isRequest() const
{
  return source == FrameRecord::Source::Master || source == FrameRecord::Source::ForeignMaster;
}

Bytes Transmission::values() const
{
  Bytes values;
  values.reserve(bytes.size());
  for (const WireByte& byte : bytes)
  {
    values.push_back(byte.value);
  }
  return values;
}

Wire::Wire(const LineSettings& settings, std::uint64_t seed, TimePoint silent_since)
  : settings_(settings), character_(settings.characterTime()), random_(seed), last_activity_(silent_since)
{
}

void Wire::set(const LineSettings& settings)
{
  settings_ = settings;
  character_ = settings.characterTime();
}

std::deque<Transmission>& Wire::live()
{
  return live_;
}

const std::deque<Transmission>& Wire::live() const
{
  return live_;
}

Transmission& Wire::open(FrameRecord::Source source)
{
  live_.emplace_back();
  live_.back().source = source;
  return live_.back();
}

Transmission* Wire::openRequest(FrameRecord::Source source)
{
  const auto found = std::find_if(live_.begin(), live_.end(),
                                  [source](const Transmission& one) { return one.source == source && !one.served; });
  return found == live_.end() ? nullptr : &*found;
}

void Wire::removeOver()
{
  live_.erase(std::remove_if(live_.begin(), live_.end(), [](const Transmission& one) { return one.over; }),
              live_.end());
}

TimePoint Wire::endOf(const Transmission& transmission) const
{
  return transmission.bytes.empty() ? TimePoint() : transmission.bytes.back().start + character_;
}

TimePoint Wire::lastActivity() const
{
  return last_activity_;
}

Duration Wire::characterTime() const
{
  return character_;
}

Bytes Wire::noise(std::size_t count)
{
  Bytes bytes(count);
  std::generate(bytes.begin(), bytes.end(), [this] { return random_.byte(); });
  return bytes;
}

std::size_t Wire::append(Transmission& transmission, const Bytes& bytes, TimePoint start)
{
  const std::size_t first = transmission.bytes.size();
  const unsigned int sent_bits = settings_.data_bits == 7 ? 0x7FU : 0xFFU;
  for (const std::uint8_t value : bytes)
  {
    transmission.bytes.push_back({ start, static_cast<std::uint8_t>(value & sent_bits), false });
    start += character_;
  }
  last_activity_ = std::max(last_activity_, start);
  return collide(transmission, first);
}

void Wire::breakOff(Transmission& transmission, TimePoint now)
{
  std::vector<WireByte>& bytes = transmission.bytes;
  bytes.erase(std::remove_if(bytes.begin(), bytes.end(), [now](const WireByte& byte) { return byte.start > now; }),
              bytes.end());
  last_activity_ = std::min(last_activity_, std::max(now, endOf(transmission)));
}

std::size_t Wire::collide(Transmission& added, std::size_t first)
{
  std::size_t collided = 0;
  for (Transmission& other : live_)
  {
    if (&other == &added || other.bytes.empty() || endOf(other) <= added.bytes[first].start ||
        other.bytes.front().start >= endOf(added))
    {
      continue;
    }
    for (std::size_t i = first; i < added.bytes.size(); ++i)
    {
      for (WireByte& byte : other.bytes)
      {
        const TimePoint start = added.bytes[i].start;
        if (byte.start < start + character_ && start < byte.start + character_)
        {
          collided += damage(added, added.bytes[i]);
          collided += damage(other, byte);
        }
      }
    }
  }
  return collided;
}

std::size_t Wire::damage(Transmission& transmission, WireByte& byte)
{
  if (!byte.damaged)
  {
    byte.damaged = true;
    byte.value = static_cast<std::uint8_t>(byte.value ^ random_.damage());
  }
  const std::size_t first_time = transmission.collided ? 0 : 1;
  transmission.collided = true;
  return first_time;
}
}  // namespace simulation
}  // namespace inverter_bus
