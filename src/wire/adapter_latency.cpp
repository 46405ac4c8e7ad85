// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include <string>

#include "inverter_bus/wire/serial_port.h"
#include "tty_sysfs.h"

namespace inverter_bus
{
namespace wire
{
int adapterLatencyMs(const std::string& device)
{
  const std::string folder = ttyFolder(device);
  return folder.empty() ? -1 : static_cast<int>(readNumber(folder + "/device/latency_timer").value_or(-1));
}
}  // namespace wire
}  // namespace inverter_bus
