// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "bus/report/group_error.h"

namespace inverter_bus
{
namespace bus
{
namespace
{
constexpr double SHOWN_S = 1.0;
}  // namespace

void GroupError::note(TimePoint now, std::uint16_t error_id)
{
  error_id_ = error_id;
  noted_at_ = now;
}

void GroupError::clear(TimePoint now, bool by_group)
{
  if (by_group || now - noted_at_ > seconds(SHOWN_S))
  {
    error_id_ = 0;
  }
}

std::uint16_t GroupError::id() const
{
  return error_id_;
}
}  // namespace bus
}  // namespace inverter_bus
