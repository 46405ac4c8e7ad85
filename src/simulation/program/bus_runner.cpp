// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

#include "inverter_bus/simulation/bus_runner.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <ctime>
#include <stdexcept>
#include <utility>

#include <poll.h>
#include <pthread.h>
#include <sys/eventfd.h>
#include <sys/prctl.h>
#include <unistd.h>

#include "simulation/line/terminal_settings.h"

namespace inverter_bus
{
namespace simulation
{
BusRunner::BusRunner(SimulatedBus& bus, const std::string& link)
  : bus_(bus), terminal_(link, bus.line().options().settings), wake_(eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC))
{
  if (wake_ < 0)
  {
    throw std::runtime_error(std::string("eventfd: ") + std::strerror(errno));
  }
}

BusRunner::~BusRunner()
{
  ::close(wake_);
}

void BusRunner::readCommands(int descriptor, std::function<void(const std::string&)> answer)
{
  command_descriptor_ = descriptor;
  answer_ = std::move(answer);
}

void BusRunner::assumeParity(Parity parity)
{
  assumed_parity_ = parity;
}

const PseudoTerminal& BusRunner::terminal() const
{
  return terminal_;
}

void BusRunner::stop() noexcept
{
  stop_ = true;
  const std::uint64_t one = 1;
  const ssize_t ignored = ::write(wake_, &one, sizeof(one));
  static_cast<void>(ignored);
}

std::string BusRunner::command(const std::string& line)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  std::string answer = bus_.command(line, Clock::now());
  try
  {
    matchPort();
  }
  catch (const std::runtime_error& error)
  {
    answer = std::string("error: ") + error.what() + " (allowed: a link that can be made)";
  }
  const std::uint64_t one = 1;
  const ssize_t ignored = ::write(wake_, &one, sizeof(one));
  static_cast<void>(ignored);
  return answer;
}

void BusRunner::matchPort()
{
  if (bus_.pluggedIn() == terminal_.isOpen())
  {
    return;
  }
  if (bus_.pluggedIn())
  {
    terminal_.open();
  }
  else
  {
    terminal_.close();
  }
}

void BusRunner::spin(double lead)
{
  lead_ = seconds(lead);
}

const Punctuality& BusRunner::punctuality() const
{
  return punctuality_;
}

timespec BusRunner::waitTime() const
{
  // At least every second, so that the drives' clocks never lag far behind.
  Duration wait = std::chrono::seconds(1);
  const std::optional<TimePoint> next = bus_.nextEvent();
  if (next)
  {
    wait = std::min(wait, std::max(Duration::zero(), *next - lead_ - Clock::now()));
  }
  timespec time{};
  time.tv_sec = static_cast<time_t>(std::chrono::duration_cast<std::chrono::seconds>(wait).count());
  time.tv_nsec = static_cast<long>(std::chrono::duration_cast<std::chrono::nanoseconds>(wait).count() % 1000000000);
  return time;
}

/// Until one of them has something to read, or the next instant of the bus has come.
void BusRunner::wait(pollfd* watched, std::size_t count)
{
  timespec timeout{};
  std::optional<TimePoint> next;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    watched[1].fd = terminal_.descriptor();
    timeout = waitTime();
    next = bus_.nextEvent();
  }
  int ready = ::ppoll(watched, count, &timeout, nullptr);
  timeout = timespec{};
  while (ready == 0 && lead_ > Duration::zero() && next && Clock::now() < *next && Clock::now() + lead_ >= *next)
  {
    ready = ::ppoll(watched, count, &timeout, nullptr);
  }
  if (ready < 0)
  {
    for (std::size_t index = 0; index < count; ++index)
    {
      watched[index].revents = 0;  // a signal came: none of them was looked at
    }
  }
}

void BusRunner::run(int realtime_priority)
{
  if (realtime_priority > 0)
  {
    sched_param parameters{};
    parameters.sched_priority = realtime_priority;
    pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters);  // without the right to it: goes on as it is
  }
  prctl(PR_SET_TIMERSLACK, 1UL, 0UL, 0UL, 0UL);  // of this thread: wake up when asked, not 50 us later
  while (!stop_)
  {
    pollfd watched[3] = { { wake_, POLLIN, 0 }, { -1, POLLIN, 0 }, { command_descriptor_, POLLIN, 0 } };
    wait(watched, 3);
    if ((watched[0].revents & POLLIN) != 0)
    {
      std::uint64_t count = 0;
      const ssize_t ignored = ::read(wake_, &count, sizeof(count));
      static_cast<void>(ignored);
    }
    step((watched[1].revents & POLLIN) != 0);
    if (watched[2].revents != 0)
    {
      readCommandBytes();
    }
  }
}

void BusRunner::step(bool readable)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  const TimePoint now = Clock::now();
  const std::optional<TimePoint> planned = bus_.nextEvent();
  if (planned && *planned <= now)
  {
    punctuality_.add(*planned, now);
  }
  if (readable)
  {
    matchSettings(now);
  }
  const Bytes received = readable ? terminal_.read() : Bytes();
  bus_.send(received, now);  // nothing received: moves the time only
  matchPort();
  handOver();
}

/// A client sets its port before it sends, so it is enough to look when bytes come.
void BusRunner::matchSettings(TimePoint now)
{
  std::optional<LineSettings> seen = settingsOf(terminal_.descriptor(), bus_.line().options().settings);
  if (!seen)
  {
    return;
  }
  seen->parity = assumed_parity_.value_or(seen->parity);
  if (!master_ || master_->text() != seen->text())
  {
    bus_.setMaster(*seen, now);
    master_ = seen;
  }
}

void BusRunner::handOver()
{
  // The stamp is taken before the bytes are written: the master can't have seen them earlier (see SimulatedLine).
  const std::vector<Delivery> output = bus_.takeOutput(Clock::now());
  Bytes bytes;
  for (const Delivery& delivery : output)
  {
    bytes.insert(bytes.end(), delivery.bytes.begin(), delivery.bytes.end());
  }
  terminal_.write(bytes);
}

void BusRunner::readCommandBytes()
{
  char buffer[1024];
  const ssize_t size = ::read(command_descriptor_, buffer, sizeof(buffer));
  if (size < 0 && (errno == EINTR || errno == EAGAIN))
  {
    return;
  }
  if (size <= 0)
  {
    command_descriptor_ = -1;  // the end of the commands is not the end of the bus
    return;
  }
  command_text_.append(buffer, static_cast<std::size_t>(size));
  for (std::size_t end = command_text_.find('\n'); end != std::string::npos; end = command_text_.find('\n'))
  {
    const std::string answer = command(command_text_.substr(0, end));
    command_text_.erase(0, end + 1);
    if (!answer.empty() && answer_)
    {
      answer_(answer);
    }
  }
}
}  // namespace simulation
}  // namespace inverter_bus
