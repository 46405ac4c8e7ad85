// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "ros/signals.h"

#include <poll.h>
#include <sys/eventfd.h>
#include <sys/signalfd.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <system_error>
#include <utility>

namespace inverter_bus
{
namespace ros_node
{
namespace
{
const char* nameOf(std::uint32_t signal)
{
  switch (signal)
  {
    case SIGINT:
      return "SIGINT";
    case SIGTERM:
      return "SIGTERM";
    default:
      return "SIGHUP";
  }
}
}  // namespace

Signals::Signals()
{
  sigemptyset(&signals_);
  sigaddset(&signals_, SIGINT);
  sigaddset(&signals_, SIGTERM);
  // Also where the parent had them ignored (nohup, background jobs of a shell): a blocked signal is kept for signalfd.
  sigaddset(&signals_, SIGHUP);
  pthread_sigmask(SIG_BLOCK, &signals_, nullptr);
  file_ = signalfd(-1, &signals_, SFD_CLOEXEC | SFD_NONBLOCK);
  wake_ = eventfd(0, EFD_CLOEXEC);
  if (file_ < 0 || wake_ < 0)
  {
    throw std::system_error(errno, std::generic_category(), "can't wait for signals");
  }
}

Signals::~Signals()
{
  if (thread_.joinable())
  {
    const std::uint64_t one = 1;
    // An eventfd takes 8 bytes or nothing, and its counter is far from full.
    static_cast<void>(::write(wake_, &one, sizeof one) == sizeof one);
    thread_.join();
  }
  close(file_);
  close(wake_);
}

void Signals::listen(std::function<void(const std::string&)> callback)
{
  callback_ = std::move(callback);
  thread_ = std::thread([this] { work(); });
}

void Signals::work()
{
  pollfd files[] = { { file_, POLLIN, 0 }, { wake_, POLLIN, 0 } };
  while (true)
  {
    if (poll(files, 2, -1) < 0)
    {
      continue;
    }
    if (files[1].revents != 0)
    {
      return;
    }
    signalfd_siginfo information{};
    if (read(file_, &information, sizeof information) == sizeof information)
    {
      callback_(nameOf(information.ssi_signo));
    }
  }
}
}  // namespace ros_node
}  // namespace inverter_bus
