// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_BUS_ADAPTER_WATCH_H
#define INVERTER_BUS_BUS_ADAPTER_WATCH_H

#include <optional>
#include <string>

#include "inverter_bus/bus/types.h"
#include "inverter_bus/wire/port.h"

namespace inverter_bus
{
namespace bus
{
/// What the adapter of a serial port adds to every exchange, as its driver reports it. Pure.
class AdapterWatch
{
public:
  /// Nothing: the driver does not say, or the port is a network connection.
  void note(const std::optional<wire::AdapterLatency>& latency);

  /// How long a reply may stay in the adapter; 0 where that is unknown.
  Duration latency() const;
  /// WARN above 2 ms, with the command that fixes it: the bytes of every reply wait so long, unless 62 of them fill a
  /// packet of the adapter's.
  std::optional<Finding> finding() const;
  /// For /diagnostics.
  std::string text() const;

private:
  std::optional<wire::AdapterLatency> latency_;
};
}  // namespace bus
}  // namespace inverter_bus

#endif  // INVERTER_BUS_BUS_ADAPTER_WATCH_H
