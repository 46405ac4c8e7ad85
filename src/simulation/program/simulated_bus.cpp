// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

#include "inverter_bus/simulation/simulated_bus.h"

#include <algorithm>
#include <cstdio>
#include <utility>

#include "simulation/program/bus_commands.h"

namespace inverter_bus
{
namespace simulation
{
namespace
{
constexpr std::size_t KEPT_FRAMES = 200;

LineOptions withSettings(LineOptions options, const LineSettings& settings)
{
  options.settings = settings;
  return options;
}

const char* senderOf(FrameRecord::Source source)
{
  switch (source)
  {
    case FrameRecord::Source::Master:
      return "master";
    case FrameRecord::Source::Drive:
      return "drive";
    case FrameRecord::Source::ForeignMaster:
      return "foreign";
    case FrameRecord::Source::Noise:
      return "noise";
  }
  return "";
}
}  // namespace

SimulatedBus::SimulatedBus(const BusConfig& config, LineOptions options, TimePoint start)
  : start_(start), line_(withSettings(options, config.line), start)
{
  for (DriveConfig drive : config.drives)
  {
    drive.options.start = start;
    drive.options.seed += options.seed * 1000003U;
    drives_.push_back(makeDrive(drive));
    line_.attach(*drives_.back());
  }
  line_.setObserver([this](const FrameRecord& frame) {
    frames_.push_back(frame);
    if (frames_.size() > KEPT_FRAMES)
    {
      frames_.pop_front();
    }
    if (observer_)
    {
      observer_(frame);
    }
  });
}

void SimulatedBus::send(const Bytes& bytes, TimePoint now)
{
  advance(now);
  line_.receive(bytes, now);
}

void SimulatedBus::setMaster(const LineSettings& settings, TimePoint now)
{
  advance(now);
  line_.setMaster(settings, now);
}

std::optional<TimePoint> SimulatedBus::nextEvent() const
{
  std::optional<TimePoint> next = line_.nextEvent();
  for (const std::optional<TimePoint>& time : { plug_in_at_, mend_at_ })
  {
    if (time)
    {
      next = next ? std::min(*next, *time) : *time;
    }
  }
  return next;
}

void SimulatedBus::advance(TimePoint now)
{
  changeDue(now);
  line_.advance(now);
}

void SimulatedBus::changeDue(TimePoint now)
{
  if (plug_in_at_ && *plug_in_at_ <= now)
  {
    const TimePoint time = *plug_in_at_;
    plugIn(time);
  }
  if (mend_at_ && *mend_at_ <= now)
  {
    const TimePoint time = *mend_at_;
    cutLine(false, std::nullopt, time);
  }
}

std::vector<Delivery> SimulatedBus::takeOutput(TimePoint now)
{
  return line_.takeOutput(now);
}

bool SimulatedBus::pluggedIn() const
{
  return plugged_in_;
}

void SimulatedBus::unplug(std::optional<TimePoint> until, TimePoint now)
{
  plugged_in_ = false;
  plug_in_at_ = until;
  line_.setConnected(false, now);
}

void SimulatedBus::plugIn(TimePoint now)
{
  plugged_in_ = true;
  plug_in_at_.reset();
  line_.setConnected(true, now);
}

void SimulatedBus::cutLine(bool cut, std::optional<TimePoint> until, TimePoint now)
{
  line_.advance(now);
  line_.setSilent(cut);
  mend_at_ = until;
}

std::string SimulatedBus::command(const std::string& line, TimePoint now)
{
  advance(now);
  return runCommand(*this, line, now);
}

SimulatedLine& SimulatedBus::line()
{
  return line_;
}

SimulatedDrive* SimulatedBus::drive(const std::string& name)
{
  const auto found =
      std::find_if(drives_.begin(), drives_.end(), [&name](const auto& drive) { return drive->name() == name; });
  return found == drives_.end() ? nullptr : found->get();
}

const std::vector<std::unique_ptr<SimulatedDrive>>& SimulatedBus::drives() const
{
  return drives_;
}

TimePoint SimulatedBus::start() const
{
  return start_;
}

void SimulatedBus::setObserver(std::function<void(const FrameRecord&)> observer)
{
  observer_ = std::move(observer);
}

const std::deque<FrameRecord>& SimulatedBus::frames() const
{
  return frames_;
}

std::string frameText(const FrameRecord& frame, TimePoint start)
{
  char head[96];
  const char* const station = frame.station.empty() ? "?" : frame.station.c_str();
  std::snprintf(head, sizeof(head), "%.6f %s %s ", toSeconds(frame.time - start), senderOf(frame.source), station);
  return head + toHex(frame.bytes) + (frame.remark.empty() ? "" : " # " + frame.remark);
}
}  // namespace simulation
}  // namespace inverter_bus
