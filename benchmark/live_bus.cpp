// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "benchmark/live_bus.h"

#include <sys/prctl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <utility>

namespace inverter_bus
{
namespace benchmark
{
namespace
{
class Silent : public bus::Observer
{
public:
  void inverterStatus(const bus::InverterStatus& /*status*/) override
  {
  }
  void busStatus(const bus::BusStatus& /*status*/) override
  {
  }
  void log(const bus::Finding& finding) override
  {
    if (finding.level == bus::Level::Error)
    {
      std::cerr << finding.text << std::endl;
    }
  }
  void trace(bus::TraceDump /*dump*/) override
  {
  }
};

bus::Configuration readScene(const Scene& scene, const std::string& port, const std::string& profiles)
{
  const std::string path = port + ".yaml";
  std::ofstream(path) << scanList(scene, port);
  const bus::Value value = bus::readYamlFile(path);
  std::remove(path.c_str());
  return bus::readConfiguration(value, "scan list", profiles);
}
}  // namespace

void FrameLog::add(const simulation::FrameRecord& frame)
{
  if (frame.source == simulation::FrameRecord::Source::Master)
  {
    const std::lock_guard<std::mutex> guard(mutex_);
    frames_.push_back(frame);
  }
}

void FrameLog::clear()
{
  const std::lock_guard<std::mutex> guard(mutex_);
  frames_.clear();
}

std::optional<TimePoint> FrameLog::first(const simulation::Bytes& head, TimePoint since) const
{
  const std::lock_guard<std::mutex> guard(mutex_);
  for (const simulation::FrameRecord& frame : frames_)
  {
    if (frame.time >= since && frame.bytes.size() >= head.size() &&
        std::equal(head.begin(), head.end(), frame.bytes.begin()))
    {
      return frame.time;
    }
  }
  return std::nullopt;
}

LiveWire::LiveWire(const Scene& scene, const Host& host)
  : path_("/tmp/inverter_bus_benchmark_" + std::to_string(::getpid()))
{
  simulation::LineOptions line;
  line.delivery_step = std::chrono::microseconds(500);
  simulated_ = std::make_unique<simulation::SimulatedBus>(simulation::busConfigFromText(scanList(scene, path_)), line,
                                                          std::chrono::steady_clock::now());
  simulated_->setObserver([this](const simulation::FrameRecord& frame) { frames.add(frame); });
  runner_ = std::make_unique<simulation::BusRunner>(*simulated_, path_);
  runner_->spin(host.spin);
  player_ = std::thread([this, priority = host.realtime_priority] { runner_->run(priority); });
}

LiveWire::~LiveWire()
{
  end();
}

const std::string& LiveWire::path() const
{
  return path_;
}

void LiveWire::world(const std::string& command)
{
  runner_->command(command);
}

simulation::Punctuality LiveWire::end()
{
  runner_->stop();
  if (player_.joinable())
  {
    player_.join();
  }
  return runner_->punctuality();
}

LiveBus::LiveBus(const Scene& scene, const std::string& profiles, const Host& host)
  : wire(scene, host), observer_(std::make_unique<Silent>())
{
  bus::Configuration configuration = readScene(scene, wire.path(), profiles);
  auto port = bus::makePort(configuration.bus);
  driver = std::make_unique<bus::Bus>(std::move(configuration), std::move(port), *observer_);
  driver->start();
}

LiveBus::~LiveBus()
{
  driver->shutdown();
}

Load::Load(LiveBus& bus, std::size_t inverters, int reads) : bus_(bus), reads_(reads), phases_(inverters)
{
  thread_ = std::thread([this] { run(); });
}

Load::~Load()
{
  stop_ = true;
  thread_.join();
}

void Load::hold(std::size_t index)
{
  phases_[index] = WAITS;
}

void Load::resume(std::size_t index)
{
  phases_[index] = RUNS;
}

void Load::restart(std::size_t index)
{
  phases_[index] = BEGINS;
}

void Load::command(std::size_t index, double velocity)
{
  bus::VelocityCommand command;
  command.targets = { { index, velocity } };
  command.publisher.name = "/benchmark";
  bus_.driver->command(command);
}

void Load::run()
{
  for (unsigned round = 0; !stop_; ++round)
  {
    for (std::size_t index = 0; index < phases_.size(); ++index)
    {
      if (waiting_ < reads_)
      {
        ++waiting_;
        bus_.driver->readParameter(index, "F002", [this](const bus::Answer&) { --waiting_; });
      }
      const int phase = phases_[index];
      if (phase != WAITS)
      {
        command(index, phase == BEGINS ? 0.0 : 10.0 + (round % 100) * 0.1);
        int begins = BEGINS;
        phases_[index].compare_exchange_strong(begins, RUNS);
      }
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
}

WakeUps::WakeUps()
{
  thread_ = std::thread([this] {
    prctl(PR_SET_TIMERSLACK, 1UL, 0UL, 0UL, 0UL);
    TimePoint next = std::chrono::steady_clock::now();
    while (!stop_)
    {
      next += std::chrono::milliseconds(1);
      std::this_thread::sleep_until(next);
      const TimePoint now = std::chrono::steady_clock::now();
      late_.push_back(toSeconds(now - next));
      next = std::max(next, now - std::chrono::milliseconds(1));
    }
  });
}

WakeUps::~WakeUps()
{
  end();
}

std::vector<double> WakeUps::end()
{
  stop_ = true;
  if (thread_.joinable())
  {
    thread_.join();
  }
  return late_;
}
}  // namespace benchmark
}  // namespace inverter_bus
