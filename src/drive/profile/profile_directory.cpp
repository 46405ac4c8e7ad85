// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include <cstdlib>
#include <filesystem>
#include <system_error>

#include "inverter_bus/drive/profile.h"

namespace inverter_bus
{
namespace drive
{
std::string shippedProfileDirectory()
{
  namespace fs = std::filesystem;
  if (const char* directory = std::getenv("INVERTER_BUS_DRIVES"))
  {
    return directory;
  }
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  // <prefix>/lib/inverter_bus/<program>, wherever the prefix has been moved to.
  const fs::path installed = program.parent_path() / "../../share/inverter_bus/config/drives";
  for (const fs::path& directory : { installed, fs::path(INVERTER_BUS_SOURCE_SHARE) / "config/drives" })
  {
    if (fs::is_directory(directory, error))
    {
      return directory.lexically_normal().string();
    }
  }
  return (fs::path(INVERTER_BUS_INSTALL_SHARE) / "config/drives").string();
}
}  // namespace drive
}  // namespace inverter_bus
