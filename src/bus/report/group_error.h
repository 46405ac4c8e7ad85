// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_BUS_GROUP_ERROR_H
#define INVERTER_BUS_BUS_GROUP_ERROR_H

#include <cstdint>

#include "inverter_bus/util/clock.h"

namespace inverter_bus
{
namespace bus
{
/// The error id of the last grouped command that was refused, for the bus status. Pure; not thread safe.
class GroupError
{
public:
  void note(TimePoint now, std::uint16_t error_id);
  /// A command was accepted. The error stays until the next accepted group (\p by_group); other commands end it too, but not
  /// before it was seen.
  void clear(TimePoint now, bool by_group);
  /// 0: none.
  std::uint16_t id() const;

private:
  std::uint16_t error_id_ = 0;
  TimePoint noted_at_;
};
}  // namespace bus
}  // namespace inverter_bus

#endif  // INVERTER_BUS_BUS_GROUP_ERROR_H
