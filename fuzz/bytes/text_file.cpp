// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "text_file.h"

#include <sys/mman.h>
#include <unistd.h>

#include "checks.h"

namespace inverter_bus
{
namespace fuzz
{
TextFile::TextFile()
  : descriptor_(::memfd_create("fuzz", MFD_CLOEXEC)), path_("/proc/self/fd/" + std::to_string(descriptor_))
{
  require(descriptor_ >= 0, "no file in memory");
}

TextFile::~TextFile()
{
  ::close(descriptor_);
}

void TextFile::write(const std::uint8_t* data, std::size_t size)
{
  const bool written =
      ::ftruncate(descriptor_, 0) == 0 && ::pwrite(descriptor_, data, size, 0) == static_cast<ssize_t>(size);
  require(written, "no room for the file in memory");
}

const std::string& TextFile::path() const
{
  return path_;
}
}  // namespace fuzz
}  // namespace inverter_bus
