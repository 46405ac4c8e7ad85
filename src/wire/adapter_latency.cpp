// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include <climits>
#include <cstdlib>
#include <fstream>
#include <string>

#include "inverter_bus/wire/serial_port.h"

namespace inverter_bus
{
namespace wire
{
int adapterLatencyMs(const std::string& device)
{
  // /dev/serial/by-id/... and udev names are links to the ttyUSBn that sysfs knows.
  char path[PATH_MAX];
  if (::realpath(device.c_str(), path) == nullptr)
  {
    return -1;
  }
  const std::string real_path(path);
  const std::string name = real_path.substr(real_path.rfind('/') + 1);
  std::ifstream file("/sys/class/tty/" + name + "/device/latency_timer");
  int milliseconds = -1;
  return file >> milliseconds ? milliseconds : -1;
}
}  // namespace wire
}  // namespace inverter_bus
