// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

#ifndef INVERTER_BUS_SIMULATION_LINE_WIRE_H
#define INVERTER_BUS_SIMULATION_LINE_WIRE_H

#include <cstddef>
#include <cstdint>
#include <deque>
#include <vector>

#include "inverter_bus/simulation/bytes.h"
#include "inverter_bus/simulation/line_settings.h"
#include "inverter_bus/simulation/random.h"
#include "inverter_bus/simulation/simulated_line.h"
#include "inverter_bus/simulation/time.h"

namespace inverter_bus
{
namespace simulation
{
struct WireByte
{
  TimePoint start;
  std::uint8_t value;
  bool damaged;
};

/// What one participant sends without a pause.
struct Transmission
{
  FrameRecord::Source source = FrameRecord::Source::Master;
  SimulatedDrive* drive = nullptr;
  std::vector<WireByte> bytes;
  bool for_master = true;     ///< comes out at the master's end
  std::size_t delivered = 0;  ///< bytes of it that did
  bool early = false;         ///< came before the gap
  bool joined = false;        ///< began as one frame and went on as the next
  bool collided = false;
  bool served = false;  ///< a request: the drives have had it
  bool over = false;    ///< nothing more to do

  bool isRequest() const;
  Bytes values() const;
};

/// The two wires of the line: which bytes are on them when, and what two transmissions at once do to each other.
class Wire
{
public:
  /// \p seed of the damage; nothing has been on the wire since \p silent_since.
  Wire(const LineSettings& settings, std::uint64_t seed, TimePoint silent_since);

  /// What is sent from now on is sent with these.
  void set(const LineSettings& settings);

  /// What is being sent, or not quite finished. References stay valid while others begin; not after removeOver().
  std::deque<Transmission>& live();
  const std::deque<Transmission>& live() const;
  Transmission& open(FrameRecord::Source source);
  /// The request of \p source that the drives have not had yet, or null.
  Transmission* openRequest(FrameRecord::Source source);
  void removeOver();

  /// Sends \p bytes back to back from \p start on. Returns how many transmissions were damaged that had not been before.
  std::size_t append(Transmission& transmission, const Bytes& bytes, TimePoint start);
  /// The sender is cut off at \p now: bytes that had not begun don't come.
  void breakOff(Transmission& transmission, TimePoint now);

  /// The end of the last byte's stop bits; a time long ago for a transmission without a byte.
  TimePoint endOf(const Transmission& transmission) const;
  TimePoint lastActivity() const;  ///< end of the last byte of all
  Duration characterTime() const;  ///< of one byte on the wire
  /// \p count bytes by chance.
  Bytes noise(std::size_t count);

private:
  std::size_t collide(Transmission& added, std::size_t first);
  std::size_t damage(Transmission& transmission, WireByte& byte);

  LineSettings settings_;
  Duration character_;
  Random random_;
  std::deque<Transmission> live_;
  TimePoint last_activity_;
};
}  // namespace simulation
}  // namespace inverter_bus

#endif  // INVERTER_BUS_SIMULATION_LINE_WIRE_H
