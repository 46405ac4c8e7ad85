// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_BUS_SLOW_SHARE_H
#define INVERTER_BUS_BUS_SLOW_SHARE_H

#include "inverter_bus/drive/drive.h"
#include "inverter_bus/util/clock.h"

namespace inverter_bus
{
namespace bus
{
/// Contract, 8.3: the share of the wire that slow values and repeated settings take together, over any SLOW_WINDOW_S.
constexpr double SLOW_SHARE = 0.075;
constexpr double SLOW_WINDOW_S = 10.0;

/// Silence of Modbus before a request, for the account; CompoWay/F needs none, and loses nothing by it.
constexpr double MODBUS_GAP_CHARACTERS = 3.5;

/// Whether a read that takes turns is slowed by the share: nothing in it is what safety depends on.
bool isSlowed(const drive::ReadBlock& block);

/// When the next exchange may go that takes from the share of the slow values (contract, 8.3). What was not used lately may
/// be used within one status cycle; the long-term rate is as much below the share as it takes that no window of
/// SLOW_WINDOW_S holds more. Pure. Not thread safe; the bus guards it.
class SlowShare
{
public:
  struct Settings
  {
    /// Shortest period of a slow value; 0: they are never read.
    Duration interval{ 0 };
    /// The longest exchange that counts.
    Duration longest{ 0 };
    /// A status cycle with its pause.
    Duration cycle{ 0 };
    /// Silence of the line before each exchange that counts.
    Duration gap{ 0 };
  };

  explicit SlowShare(const Settings& settings);

  /// Slow values are read at all.
  bool reads() const;
  /// An exchange that counts may begin.
  bool open(TimePoint now) const;
  /// One has taken the wire for \p cost until \p end.
  void spent(TimePoint end, Duration cost);
  /// How often each can be read where reading all of them once takes \p needs of the wire.
  Duration period(Duration needs) const;
  /// Of the time, in the long run.
  double rate() const;

private:
  Duration interval_;
  Duration longest_;
  /// What may be used at once after a while without any.
  Duration saved_;
  double rate_;
  /// By then all that was spent is earned.
  TimePoint earned_at_;
};
}  // namespace bus
}  // namespace inverter_bus

#endif  // INVERTER_BUS_BUS_SLOW_SHARE_H
