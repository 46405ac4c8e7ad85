// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_DRIVE_MONITOR_FIELDS_H
#define INVERTER_BUS_DRIVE_MONITOR_FIELDS_H

#include <cstddef>
#include <optional>
#include <tuple>
#include <utility>

#include "inverter_bus/drive/drive.h"

namespace inverter_bus
{
namespace drive
{
namespace monitor_fields
{
template <typename Struct, std::size_t... Index>
constexpr auto takes(std::index_sequence<Index...> /*count*/)
    -> decltype(Struct{ (static_cast<void>(Index), std::nullopt)... }, bool())
{
  return true;
}

template <typename Struct>
constexpr bool takes(...)
{
  return false;
}

/// Whether \p Struct has at least \p count members that may be empty.
template <typename Struct, std::size_t count>
constexpr bool HAS = takes<Struct>(std::make_index_sequence<count>());
}  // namespace monitor_fields

/// Every field of a Monitor, as references in the order of the struct. Whoever does the same to all fields goes through this,
/// so that a new one can't be forgotten: it doesn't compile before it is named here.
/// \tparam M Monitor or const Monitor
template <typename M>
auto monitorFields(M& monitor)
{
  // Two lists, since a binding can't be unpacked. The first must name all members; the assertion holds the second to it.
  auto& [run_seen, operation, running, ready, at_speed, at_set_frequency, overload_warning, pid_deviation, faulted,
         restarted, direction, unknown_trip, raw_status, fault_code, warning_code, output_frequency, output_current,
         output_voltage, dc_voltage, torque, temperature] = monitor;
  auto fields =
      std::tie(run_seen, operation, running, ready, at_speed, at_set_frequency, overload_warning, pid_deviation,
               faulted, restarted, direction, unknown_trip, raw_status, fault_code, warning_code, output_frequency,
               output_current, output_voltage, dc_voltage, torque, temperature);
  static_assert(!monitor_fields::HAS<Monitor, std::tuple_size<decltype(fields)>::value + 1>, "a field is missing");
  return fields;
}
}  // namespace drive
}  // namespace inverter_bus

#endif  // INVERTER_BUS_DRIVE_MONITOR_FIELDS_H
