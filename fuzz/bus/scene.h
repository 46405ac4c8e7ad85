// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_FUZZ_SCENE_H
#define INVERTER_BUS_FUZZ_SCENE_H

#include <cstddef>
#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "inverter_bus/util/clock.h"

namespace inverter_bus
{
namespace fuzz
{
enum class Brand
{
  HITACHI,  ///< MX2 and RX
  TOSHIBA,
  TECO,
  JE
};

/// The longest that any profile gives its drive besides the time-out.
constexpr double PROFILE_DELAY_S = 0.01;

/// What a player and a checker must know of one inverter, as the scan list below says it.
struct InverterFacts
{
  std::string name;
  std::string drive;
  Brand brand = Brand::HITACHI;
  unsigned node = 1;
  double hz_per_unit = 1.0;
  /// [Hz] each inverter has its own range of speeds, so that mixed-up replies show.
  double lowest_hz = 5.0;
  double highest_hz = 8.0;
  double command_timeout = 0.5;   ///< [s]
  double response_timeout = 0.1;  ///< [s]
  double own_delay = 0.0;         ///< [s] of the drive itself before a reply: C078, F805
  double drive_timeout = 0.0;     ///< [s] C077, F803, Cn-27; 0: none
  bool block = false;             ///< VF-S15 whose block read and write are selected
  bool fed_by_word = false;       ///< its profile says that only the command word feeds its own time-out
  bool map = false;               ///< MX2 whose register map is to be used
  double max_velocity = 0.0;      ///< [user's unit] 0: the profile's
  double min_velocity = 0.0;      ///< [user's unit]
  bool saturates = false;         ///< limit: saturate; has a max_velocity then
  /// Its profile is told of these trip codes only (0 among them): another one is a state that nobody knows.
  std::set<int> listed_trips;
  /// A parameter that nobody writes and that differs from drive to drive, and one that is written.
  std::string fixed_parameter;
  double fixed_value = 0.0;
  std::string free_parameter;

  /// The longest wait for a reply, from the request's last byte.
  Duration fullWait() const
  {
    return seconds(response_timeout + own_delay + PROFILE_DELAY_S);
  }
};

/// A bus and its drives: one scan list for the driver and for the simulation.
struct Scene
{
  std::string name;
  std::string yaml;
  int baud_rate = 19200;
  double character = 0.0;  ///< [s]
  bool compoway = false;
  bool one_brand = true;  ///< every inverter has the same profile
  double interval = 0.0;  ///< [s]
  unsigned idle_divisor = 1;
  double slow_interval = 1.0;  ///< [s] 0: no slow value is read
  int retries = 1;
  unsigned offline_after = 3;
  std::vector<InverterFacts> inverters;

  /// "a (omron_mx2)", for messages.
  std::string title(std::size_t index) const;
  /// The longest exchange that this bus can make, from its figures alone.
  Duration longestExchange() const;
  /// The longest time that a probe which nobody answers takes.
  Duration longestProbe() const;
  /// [s] that a request without an answer is waited for at the most.
  double longestSilence() const;
  /// [s] after which an inverter without a complete status is offline (contract, 8.15), with what a busy bus adds.
  double longestBlindness() const;
  /// A slow value is read at least so often on a bus without losses.
  Duration longestSlowPeriod() const;
  /// Silence before a request.
  Duration gap() const;
};

/// Kinds of buses: names for --scan-list.
const std::vector<std::string>& sceneNames();

/// The buses that are played on: number \p number of them, of kind \p name or (empty) of any kind.
Scene makeScene(std::uint64_t number, const std::string& name);
}  // namespace fuzz
}  // namespace inverter_bus

#endif  // INVERTER_BUS_FUZZ_SCENE_H
