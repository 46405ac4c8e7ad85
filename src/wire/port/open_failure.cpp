// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "wire/port/open_failure.h"

#include <dirent.h>
#include <grp.h>
#include <limits.h>
#include <pwd.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <memory>
#include <vector>

#include "util/text.h"

namespace inverter_bus
{
namespace wire
{
namespace
{
/// More would make a line too long to read.
constexpr std::size_t MOST_NAMES = 4;
const char* const DIGITS = "0123456789";
const char* const USB_NAMES[] = { "ttyUSB", "ttyACM" };

/// Without its number: "ttyUSB" of "ttyUSB0".
std::string kindOf(const std::string& name)
{
  return name.substr(0, name.find_last_not_of(DIGITS) + 1);
}

bool isUsb(const std::string& kind)
{
  return std::find(std::begin(USB_NAMES), std::end(USB_NAMES), kind) != std::end(USB_NAMES);
}

/// Names as udev gives them, one per adapter, all in a folder of their own.
bool isFixedName(const std::string& folder)
{
  return folder.find("/serial/by-") != std::string::npos;
}

bool isAlike(const std::string& name, const std::string& wanted, const std::string& folder)
{
  if (isFixedName(folder))
  {
    return name.front() != '.';
  }
  const std::string kind = kindOf(wanted);
  const bool numbered = kind.size() < wanted.size() && kind.size() < name.size() && !kind.empty();
  return numbered && (kindOf(name) == kind || (isUsb(kind) && isUsb(kindOf(name))));
}

/// Devices beside \p device that it may be called now.
std::vector<std::string> namesBeside(const std::string& device)
{
  const std::size_t slash = device.rfind('/');
  const std::string folder = slash == std::string::npos ? "./" : device.substr(0, slash + 1);
  const std::string wanted = slash == std::string::npos ? device : device.substr(slash + 1);
  const std::unique_ptr<DIR, int (*)(DIR*)> entries(::opendir(folder.c_str()), ::closedir);
  std::vector<std::string> names;
  while (const dirent* entry = entries ? ::readdir(entries.get()) : nullptr)
  {
    if (entry->d_name != wanted && isAlike(entry->d_name, wanted, folder))
    {
      names.push_back(folder + entry->d_name);
    }
  }
  std::sort(names.begin(), names.end());
  return names;
}

std::string beside(const std::string& device)
{
  const std::vector<std::string> names = namesBeside(device);
  const std::vector<std::string> first(names.begin(),
                                       names.begin() + static_cast<std::ptrdiff_t>(std::min(names.size(), MOST_NAMES)));
  const std::string more =
      names.size() > MOST_NAMES ? " and " + std::to_string(names.size() - MOST_NAMES) + " more" : "";
  if (names.empty())
  {
    return ": plug it in, or check its name";
  }
  return ": " + device + " is missing, " + util::joined(first) + more + (names.size() > 1 ? " are" : " is") +
         " there (a name from /dev/serial/by-id does not change)";
}

std::string whyMissing(const std::string& device)
{
  std::array<char, PATH_MAX> target{};
  const ssize_t length = ::readlink(device.c_str(), target.data(), target.size());
  if (length > 0)
  {
    return ": it is a link to " + std::string(target.data(), static_cast<std::size_t>(length)) + ", which is missing";
  }
  return beside(device);
}

std::string groupName(gid_t group)
{
  std::array<char, 4096> space{};
  struct group entry = {};
  struct group* found = nullptr;
  ::getgrgid_r(group, &entry, space.data(), space.size(), &found);
  return found != nullptr ? found->gr_name : std::to_string(group);
}

std::string userName(uid_t user)
{
  std::array<char, 4096> space{};
  struct passwd entry = {};
  struct passwd* found = nullptr;
  ::getpwuid_r(user, &entry, space.data(), space.size(), &found);
  return found != nullptr ? found->pw_name : std::to_string(user);
}

std::string whyDenied(const std::string& device)
{
  struct stat status = {};
  if (::stat(device.c_str(), &status) != 0)
  {
    return "";
  }
  const mode_t both = S_IRGRP | S_IWGRP;
  if ((status.st_mode & both) != both)
  {
    return ": only its owner " + userName(status.st_uid) + " may use it; give it a group by a udev rule";
  }
  const std::string group = groupName(status.st_gid);
  return ": only members of the group " + group + " may use it; add the user (sudo adduser " + userName(::geteuid()) +
         " " + group + ") and log in again";
}

std::string advice(const std::string& device, int error)
{
  switch (error)
  {
    case ENOENT:
      return whyMissing(device);
    case EACCES:
      return whyDenied(device);
    case EPERM:
      return ": a container must be given the device (docker run --device)";
    case EIO:
      return ": there is no UART behind it, or its adapter does not work (dmesg | grep tty)";
    case ENXIO:
    case ENODEV:
      return ": its driver has no device behind this name (dmesg | grep tty)";
    default:
      return "";
  }
}
}  // namespace

std::string openFailure(const std::string& device, int error)
{
  return "cannot open " + device + ": " + std::strerror(error) + advice(device, error);
}

std::string noSerialPort(const std::string& device, int error)
{
  const std::string reason =
      error == ENOTTY ? std::string("it is not a serial port") : std::strerror(error) + advice(device, error);
  return "cannot use " + device + ": " + reason;
}
}  // namespace wire
}  // namespace inverter_bus
