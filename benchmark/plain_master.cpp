// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "benchmark/plain_master.h"

#include <algorithm>
#include <utility>

#include "simulation/modbus/modbus_frame.h"

namespace inverter_bus
{
namespace benchmark
{
using simulation::Bytes;
using simulation::withModbusCrc;

namespace
{
/// Bytes of the reply to a request: enough to know when it is whole.
std::size_t replyLength(const Bytes& request)
{
  switch (request[1])
  {
    case 0x01:
      return 5U + (request[5] + 7U) / 8U;
    case 0x03:
      return 5U + 2U * request[5];
    default:
      return 8U;
  }
}
}  // namespace

PlainMaster::PlainMaster(const Scene& scene, double time_out)
  : bus_(simulation::busConfigFromText(scanList(scene, "/dev/virtual")), simulation::LineOptions(),
         TimePoint() + std::chrono::hours(1))
  , gap_(silence(scene.baud))
  , time_out_(time_out)
  , now_(TimePoint() + std::chrono::hours(1))
{
  bus_.setObserver([this](const simulation::FrameRecord& frame) { frames.push_back(frame); });
}

void PlainMaster::once(const Bytes& request, std::function<void(TimePoint)> sent)
{
  queue_.push_back({ request, false, std::nullopt, std::move(sent) });
}

void PlainMaster::always(const Bytes& request)
{
  queue_.push_back({ request, true, std::nullopt, {} });
}

void PlainMaster::velocity(unsigned station)
{
  const bool waits = std::any_of(queue_.begin(), queue_.end(), [station](const Waiting& one) {
    return one.velocity_of && *one.velocity_of == station;
  });
  if (!waits)
  {
    const auto node = static_cast<std::uint8_t>(station);
    queue_.push_back({ withModbusCrc({ node, 0x10, 0, 0, 0, 2, 4, 0, 0, 0x0B, 0xB8 }), false, station, {} });
  }
}

void PlainMaster::at(TimePoint time, std::function<void()> action)
{
  const auto later = std::upper_bound(appointments_.begin(), appointments_.end(), time,
                                      [](TimePoint value, const auto& entry) { return value < entry.first; });
  appointments_.insert(later, { time, std::move(action) });
}

void PlainMaster::run(double duration)
{
  const TimePoint end = now_ + seconds(duration);
  while (now_ < end)
  {
    if (queue_.empty())
    {
      pass(end);
      continue;
    }
    const Waiting waiting = queue_.front();
    queue_.pop_front();
    exchange(waiting);
    if (waiting.again)
    {
      queue_.push_back(waiting);
    }
  }
}

TimePoint PlainMaster::now() const
{
  return now_;
}

void PlainMaster::world(const std::string& command)
{
  bus_.command(command, now_);
}

void PlainMaster::exchange(const Waiting& waiting)
{
  bus_.advance(now_);
  bus_.takeOutput(now_);
  if (waiting.sent)
  {
    waiting.sent(now_);
  }
  bus_.send(waiting.request, now_);
  const double character = 10.0 / bus_.line().options().settings.baud_rate;
  const TimePoint end = now_ + seconds(static_cast<double>(waiting.request.size()) * character);
  const TimePoint deadline = end + seconds(time_out_);
  std::size_t heard = 0;
  while (heard < replyLength(waiting.request) && now_ < deadline)
  {
    const auto next = bus_.nextEvent();
    pass(next ? std::min(std::max(*next, now_), deadline) : deadline);
    for (const simulation::Delivery& delivery : bus_.takeOutput(now_))
    {
      heard += delivery.bytes.size();
    }
  }
  pass(now_ + seconds(gap_));
}

/// Time passes; whoever has an appointment keeps it.
void PlainMaster::pass(TimePoint time)
{
  while (!appointments_.empty() && appointments_.front().first <= time)
  {
    const auto appointment = appointments_.front();
    appointments_.pop_front();
    now_ = std::max(now_, appointment.first);
    appointment.second();
  }
  now_ = std::max(now_, time);
  bus_.advance(now_);
}

std::vector<Bytes> refreshOf(const Scene& scene, unsigned station)
{
  const auto node = static_cast<std::uint8_t>(station);
  if (scene.drive == "toshiba_vfs15")
  {
    return { withModbusCrc({ node, 0x03, 0x18, 0x75, 0, 5 }) };
  }
  return { withModbusCrc({ node, 0x01, 0, 0, 0, 24 }), withModbusCrc({ node, 0x03, 0x10, 0, 0, 4 }) };
}

Bytes stopOf(unsigned station)
{
  return withModbusCrc({ static_cast<std::uint8_t>(station), 0x05, 0, 0, 0, 0 });
}
}  // namespace benchmark
}  // namespace inverter_bus
