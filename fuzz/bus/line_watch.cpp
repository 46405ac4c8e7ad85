// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "fuzz/bus/line_watch.h"

namespace inverter_bus
{
namespace fuzz
{
namespace
{
using Source = simulation::FrameRecord::Source;
}  // namespace

LineWatch::LineWatch(Checks& checks) : checks_(checks)
{
}

void LineWatch::opened(TimePoint now)
{
  checks_.recorder.opened(now);
  checks_.line.opened(now);
  checks_.probes.opened();
}

void LineWatch::lost(TimePoint now)
{
  checks_.recorder.lost(now);
  checks_.stops.dropAll();
  checks_.cut_waits.dropAll();
  checks_.zeros.dropAll();
  checks_.probes.lost();
}

void LineWatch::heard(TimePoint now)
{
  checks_.recorder.heard(now);
  checks_.line.heard(now);
}

void LineWatch::sending(TimePoint now, const simulation::Bytes& frame)
{
  checks_.line.begins(now, frame);
  checks_.recorder.begins(now, frame);
  checks_.line.checkStation(now);
  expireWatchdogs(now);
  checks_.stops.checkNextFrame(now);
  checks_.cut_waits.begins(now);
  checks_.turns.check(now);
  checks_.bounded_velocities.check(now);
  checkCommandWords(now);
  checks_.lowest_class.check(now);
  checks_.slow_reads.begins(now);
  checks_.values.begins(now);
}

/// The node looks at its command watchdogs before each exchange.
void LineWatch::expireWatchdogs(TimePoint now)
{
  const Observed& observed = checks_.observed;
  for (std::size_t index = 0; index < observed.inverters.size(); ++index)
  {
    const std::optional<TimePoint> since = checks_.watchdog.expired(now, index);
    if (!since)
    {
      continue;
    }
    checks_.recorder.starved(index);
    const InverterRecord& inverter = observed.inverters[index];
    if (!inverter.words.run_sent)
    {
      continue;
    }
    const bool runs = inverter.words.run_answered && !inverter.stop.active && observed.online(index);
    checks_.lockUp(*since, index, true);
    if (runs)
    {
      checks_.stops.watchdogExpired(*since, index);
      checks_.recorder.stopRequested(index);
    }
  }
}

void LineWatch::checkCommandWords(TimePoint now)
{
  checks_.line.checkBroadcast(now);
  checks_.resets.check(now);
  checks_.run_frames.check(now);
  checks_.set_points.check(now);
  checks_.stops.sent(now);
  checks_.zeros.sent();
  checks_.run_frames.sent();
  checks_.recorder.sent(now);
}

void LineWatch::stepped(TimePoint now)
{
  if (checks_.observed.exchange.in_flight)
  {
    endExchange(now);
  }
  for (std::size_t index = 0; index < checks_.observed.inverters.size(); ++index)
  {
    checks_.stops.checkOverdue(now, index);
    checks_.watchdog.checkOverdue(now, index);
    checks_.zeros.checkOverdue(now, index);
  }
  checks_.liveness.checkAlive(now);
  checks_.services.check(now);
}

void LineWatch::endExchange(TimePoint now)
{
  checks_.recorder.ended(now);
  checks_.cut_waits.ended(now);
  checks_.liveness.ended();
  checks_.turns.ended();
  checks_.stops.ended();
  checks_.bounded_velocities.ended(now);
  checks_.supervision.ended(now);
  checks_.probes.ended(now);
  checks_.slow_reads.ended(now);
  checks_.values.ended(now);
}

void LineWatch::frame(TimePoint now, const simulation::FrameRecord& frame)
{
  const Scene& scene = checks_.observed.scene;
  if (frame.source == Source::Master || frame.source == Source::ForeignMaster)
  {
    const std::optional<std::size_t> index = readRequest(scene, frame.bytes).inverter;
    if (frame.remark.empty() && index)
    {
      checks_.supervision.check(now, *index);
      checks_.recorder.reached(now, *index, frame.bytes, frame.source == Source::Master);
      checks_.values.heard(now, *index);
    }
    return;
  }
  for (std::size_t index = 0; frame.source == Source::Drive && index < scene.inverters.size(); ++index)
  {
    if (scene.inverters[index].name == frame.drive)
    {
      takeReply(now, frame, index);
    }
  }
}

void LineWatch::takeReply(TimePoint now, const simulation::FrameRecord& frame, std::size_t index)
{
  const ReplyFacts reply = checks_.recorder.replied(now, frame, index);
  checks_.probes.replied(index);
  if (reply.kind == ReplyFacts::Kind::Answer)
  {
    checks_.plant.advance(now, index);
    checks_.recorder.answered(now, index, reply);
    checks_.cut_waits.answered(frame.time, reply.good);
    takeAnswer(now, index, reply);
  }
  else if (reply.kind == ReplyFacts::Kind::LateStop)
  {
    checks_.recorder.answered(now, index, reply);
    checks_.locks.answered(now, index, reply);
  }
}

void LineWatch::takeAnswer(TimePoint now, std::size_t index, const ReplyFacts& reply)
{
  checks_.bounded_velocities.answered(index);
  checks_.values.answered(now, index, reply);
  checks_.slow_reads.answered(now, index, reply);
  checks_.liveness.answered(now, index, reply);
  checks_.lowest_class.answered(index);
  checks_.confirmed_stops.answered(now, index, reply);
  checks_.locks.answered(now, index, reply);
  checks_.turns.answered(index, reply);
}
}  // namespace fuzz
}  // namespace inverter_bus
