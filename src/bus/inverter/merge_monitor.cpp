// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "bus/inverter/merge_monitor.h"

#include <optional>
#include <tuple>

#include "drive/monitor_fields.h"

namespace inverter_bus
{
namespace bus
{
namespace
{
template <typename T>
void take(const std::optional<T>& from, std::optional<T>& to)
{
  if (from)
  {
    to = from;
  }
}

template <typename... Field>
void takeEach(const std::tuple<const Field&...>& from, const std::tuple<Field&...>& to)
{
  std::apply([&to](const auto&... value) { std::apply([&](auto&... kept) { (take(value, kept), ...); }, to); }, from);
}
}  // namespace

void mergeMonitor(const drive::Monitor& from, drive::Monitor& to)
{
  takeEach(drive::monitorFields(from), drive::monitorFields(to));
}
}  // namespace bus
}  // namespace inverter_bus
