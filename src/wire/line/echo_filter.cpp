// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "inverter_bus/wire/echo_filter.h"

#include <algorithm>

namespace inverter_bus
{
namespace wire
{
void EchoFilter::forget()
{
  expected_.clear();
  found_ = false;
}

void EchoFilter::expect(const Bytes& frame, bool reply_may_equal)
{
  // Without an echo (or as long as it is unknown), bytes that equal such a request are its reply.
  expected_ = found_ || !reply_may_equal ? frame : Bytes();
}

bool EchoFilter::strip(Bytes& buffer, Bytes& damaged)
{
  if (expected_.empty())
  {
    return false;
  }
  const auto echo = std::search(buffer.begin(), buffer.end(), expected_.begin(), expected_.end());
  if (echo == buffer.end())
  {
    return false;
  }
  damaged.insert(damaged.end(), buffer.begin(), echo);
  buffer.erase(buffer.begin(), echo + static_cast<std::ptrdiff_t>(expected_.size()));
  expected_.clear();
  found_ = true;
  return true;
}

bool EchoFilter::holds(const Bytes& buffer) const
{
  return buffer.size() < expected_.size() && std::equal(buffer.begin(), buffer.end(), expected_.begin());
}

void EchoFilter::answered(bool clean)
{
  if (!expected_.empty() && clean)
  {
    found_ = false;
  }
  expected_.clear();
}

bool EchoFilter::found() const
{
  return found_;
}
}  // namespace wire
}  // namespace inverter_bus
