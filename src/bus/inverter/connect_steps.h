// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_BUS_CONNECT_STEPS_H
#define INVERTER_BUS_BUS_CONNECT_STEPS_H

#include <cstddef>
#include <cstdint>

#include "bus/inverter/setting_list.h"

namespace inverter_bus
{
namespace bus
{
/// What is sent to the drive once at every connect: the profile's sequence `connect`, step by step. Pure. Not thread
/// safe; the bus guards it.
class ConnectSteps
{
public:
  /// \p drive must outlive it.
  explicit ConnectSteps(const drive::Drive& drive);

  /// All of it again: the drive has come back, or has forgotten what it was sent.
  void restart();
  /// The step that is due; null: none.
  const drive::Step* next() const;
  /// The answer to it.
  void done(const wire::Reply& reply);
  /// All steps were sent, or there are none.
  bool complete() const;
  /// With which error id the drive has refused a step; 0: it has not.
  std::uint16_t refusedWith() const;

private:
  const drive::Drive& drive_;
  std::size_t step_ = 0;
  Told told_ = Told::NotYet;
  std::uint16_t error_id_ = 0;
};
}  // namespace bus
}  // namespace inverter_bus

#endif  // INVERTER_BUS_BUS_CONNECT_STEPS_H
