// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "config/text_file.h"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <system_error>

#include "config/yaml.h"

namespace inverter_bus
{
namespace config
{
std::optional<std::string> readTextFile(const std::string& path, std::string& error)
{
  std::error_code code;
  const std::filesystem::file_status status = std::filesystem::status(path, code);
  if (status.type() != std::filesystem::file_type::regular)
  {
    error = std::filesystem::exists(status) ? "is not a regular file" : "cannot be read: " + code.message();
    return std::nullopt;
  }
  const std::uintmax_t size = std::filesystem::file_size(path, code);
  if (code || size > LARGEST_YAML)
  {
    error = code ? "cannot be read: " + code.message() : "is larger than 1 MiB";
    return std::nullopt;
  }
  errno = 0;
  std::ifstream stream(path, std::ios::binary);
  std::ostringstream text;
  if (!stream || (size > 0 && !(text << stream.rdbuf())))
  {
    error = std::string("cannot be read: ") + std::strerror(errno != 0 ? errno : EIO);
    return std::nullopt;
  }
  return text.str();
}
}  // namespace config
}  // namespace inverter_bus
