// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "checks.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>

namespace inverter_bus
{
namespace fuzz
{
void require(bool condition, const char* what)
{
  if (!condition)
  {
    std::fprintf(stderr, "FINDING: %s\n", what);
    std::abort();
  }
}

void requireOneLine(const std::string& message)
{
  const bool one_line = !message.empty() && std::all_of(message.begin(), message.end(),
                                                        [](unsigned char c) { return c >= ' ' && c != 0x7F; });
  if (!one_line)
  {
    std::fprintf(stderr, "message: >>>%s<<<\n", message.c_str());
  }
  require(one_line, "a message is not one line of text");
}

ByteSource::ByteSource(const std::uint8_t* data, std::size_t size) : data_(data), size_(size)
{
}

bool ByteSource::empty() const
{
  return size_ == 0;
}

std::uint8_t ByteSource::byte()
{
  if (size_ == 0)
  {
    return 0;
  }
  --size_;
  return *data_++;
}

wire::Bytes ByteSource::bytes(std::size_t count)
{
  const std::size_t taken = std::min(count, size_);
  const wire::Bytes bytes(data_, data_ + taken);
  data_ += taken;
  size_ -= taken;
  return bytes;
}

wire::Bytes ByteSource::rest()
{
  return bytes(size_);
}
}  // namespace fuzz
}  // namespace inverter_bus
