// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_FUZZ_FRAMES_H
#define INVERTER_BUS_FUZZ_FRAMES_H

#include <optional>
#include <set>

#include "fuzz/bus/scene.h"
#include "inverter_bus/simulation/bytes.h"

namespace inverter_bus
{
namespace fuzz
{
/// What a request of the master asks of a drive, read from its bytes and the drives' manuals alone: no profile and no
/// line of the driver takes part.
struct RequestFacts
{
  /// Index of the inverter; nothing: a broadcast, or a station that is not on the bus.
  std::optional<std::size_t> inverter;
  bool broadcast = false;
  bool run = false;    ///< carries a RUN
  bool stop = false;   ///< takes RUN off
  bool reset = false;  ///< clears a trip
  bool reverse = false;
  /// Writes the direction alone.
  bool direction = false;
  /// Command words and a read in one frame (17H).
  bool with_read = false;
  bool loopback = false;
  bool expects_reply = true;
  std::optional<double> set_hertz;  ///< writes this frequency
  bool reads = false;
  bool reads_frequency = false;
  bool reads_run = false;        ///< the RUN command as the drive holds it from the bus
  bool reads_slow = false;       ///< nothing but voltages, torque, temperature, warnings
  bool reads_parameter = false;  ///< no status: settings, trip memory, parameters
  /// Sets once how the drive is to work, after it has come (VF-S15: FA87); in the lowest class, as settings are
  /// read.
  bool writes_setting = false;
  unsigned address = 0;

  /// Part of a velocity or a stop: what moves a motor or takes RUN off.
  bool commands() const
  {
    return run || stop || direction || set_hertz.has_value();
  }
};

/// The inverter with this station.
std::optional<std::size_t> inverterAt(const Scene& scene, unsigned station);

/// The inverter whose station a reply bears.
std::optional<std::size_t> bearerOf(const Scene& scene, const simulation::Bytes& reply);

RequestFacts readRequest(const Scene& scene, const simulation::Bytes& frame);

/// What each brand is asked for once after it has come, in the lowest class: wire addresses.
std::set<unsigned> settingsOf(const InverterFacts& facts);

/// Such a setting is the communication time-out of the drive.
bool tellsTimeout(const InverterFacts& facts, unsigned address);

enum class ReplyKind
{
  NORMAL,
  REFUSAL,  ///< the drive refuses the request
  OTHER     ///< damaged, another station's, another request's
};

/// What a drive's bytes are to the request that it was sent.
ReplyKind readReply(const Scene& scene, const simulation::Bytes& request, const simulation::Bytes& reply,
                    unsigned& refusal);
}  // namespace fuzz
}  // namespace inverter_bus

#endif  // INVERTER_BUS_FUZZ_FRAMES_H
