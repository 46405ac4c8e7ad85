// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "wire/port/tty_sysfs.h"

#include <limits.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>

#include <cstdlib>
#include <fstream>

namespace inverter_bus
{
namespace wire
{
namespace
{
/// "188:0"; empty if \p device is not a device file.
std::string numberOf(const std::string& device)
{
  struct stat status = {};
  if (::stat(device.c_str(), &status) != 0 || !S_ISCHR(status.st_mode))
  {
    return "";
  }
  return std::to_string(major(status.st_rdev)) + ":" + std::to_string(minor(status.st_rdev));
}

bool isFolder(const std::string& path)
{
  struct stat status = {};
  return ::stat(path.c_str(), &status) == 0 && S_ISDIR(status.st_mode);
}
}  // namespace

std::string ttyFolder(const std::string& device, const std::string& sysfs)
{
  // /dev/serial/by-id/... and udev names are links to the ttyUSBn that sysfs knows.
  char path[PATH_MAX];
  if (::realpath(device.c_str(), path) == nullptr)
  {
    return "";
  }
  const std::string real_path(path);
  const std::string number = numberOf(device);
  std::string by_name = sysfs + "/class/tty/" + real_path.substr(real_path.rfind('/') + 1);
  std::string number_there;
  std::ifstream(by_name + "/dev") >> number_there;
  if (isFolder(by_name) && (number_there.empty() || number_there == number))
  {
    return by_name;
  }
  const std::string by_number = sysfs + "/dev/char/" + number;
  return !number.empty() && isFolder(by_number) ? by_number : "";
}

std::optional<long> readNumber(const std::string& file)
{
  std::ifstream stream(file);
  long number = 0;
  return stream >> number ? std::optional<long>(number) : std::nullopt;
}
}  // namespace wire
}  // namespace inverter_bus
