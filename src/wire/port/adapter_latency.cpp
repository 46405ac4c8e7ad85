// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include <string>

#include "inverter_bus/wire/serial_port.h"
#include "wire/port/tty_sysfs.h"

namespace inverter_bus
{
namespace wire
{
std::optional<AdapterLatency> adapterLatency(const std::string& device, const std::string& sysfs)
{
  const std::string folder = ttyFolder(device, sysfs);
  const std::string file = folder + "/device/latency_timer";
  const auto milliseconds = folder.empty() ? std::nullopt : readNumber(file);
  if (!milliseconds || *milliseconds < 0)
  {
    return std::nullopt;
  }
  return AdapterLatency{ std::chrono::milliseconds(*milliseconds), file };
}
}  // namespace wire
}  // namespace inverter_bus
