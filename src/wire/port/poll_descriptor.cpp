// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "wire/port/poll_descriptor.h"

#include <poll.h>

#include <algorithm>
#include <cerrno>
#include <ctime>

namespace inverter_bus
{
namespace wire
{
namespace
{
timespec timeLeft(TimePoint deadline)
{
  const Duration left = std::max(Duration(deadline - std::chrono::steady_clock::now()), Duration{ 0 });
  const auto whole_seconds = std::chrono::duration_cast<std::chrono::seconds>(left);
  timespec time{};
  time.tv_sec = static_cast<std::time_t>(whole_seconds.count());
  time.tv_nsec = static_cast<long>((left - whole_seconds).count());
  return time;
}
}  // namespace

DescriptorState pollDescriptor(int descriptor, short events, TimePoint deadline)
{
  pollfd polled{ descriptor, events, 0 };
  int count = -1;
  do
  {
    // ppoll and not poll: a gap is a few milliseconds, and a whole one too long would cost a tenth of the bus time.
    const timespec time = timeLeft(deadline);
    count = ::ppoll(&polled, 1, &time, nullptr);
  } while (count < 0 && errno == EINTR);

  if (count == 0)
  {
    return DescriptorState::Silent;
  }
  const bool hung_up = count < 0 || (polled.revents & (POLLHUP | POLLERR | POLLNVAL)) != 0;
  return hung_up ? DescriptorState::HungUp : DescriptorState::Ready;
}

bool waitUntilWritable(int descriptor, TimePoint deadline)
{
  return pollDescriptor(descriptor, POLLOUT, deadline) == DescriptorState::Ready;
}
}  // namespace wire
}  // namespace inverter_bus
