// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_BENCHMARK_LIVE_BUS_H
#define INVERTER_BUS_BENCHMARK_LIVE_BUS_H

#include <atomic>
#include <cstddef>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "benchmark/scene.h"
#include "inverter_bus/bus/bus.h"
#include "inverter_bus/simulation/bus_runner.h"

namespace inverter_bus
{
namespace benchmark
{
/// Frames of the master, as the simulated line saw them.
class FrameLog
{
public:
  void add(const simulation::FrameRecord& frame);
  void clear();
  /// When the first frame since \p since that begins with \p head began.
  std::optional<TimePoint> first(const simulation::Bytes& head, TimePoint since) const;

private:
  mutable std::mutex mutex_;
  std::vector<simulation::FrameRecord> frames_;
};

/// What the wire asks of the host, to be punctual.
struct Host
{
  double spin = 0.0001;       ///< [s] see simulation::BusRunner::spin()
  int realtime_priority = 0;  ///< > 0: SCHED_FIFO, where that is permitted
};

/// Simulated drives on a pseudo-terminal in real time, played by a thread of this process.
class LiveWire
{
public:
  LiveWire(const Scene& scene, const Host& host);
  ~LiveWire();
  LiveWire(const LiveWire&) = delete;
  LiveWire& operator=(const LiveWire&) = delete;

  const std::string& path() const;
  void world(const std::string& command);
  /// Ends the thread, and says how late the wire was.
  simulation::Punctuality end();

  FrameLog frames;

private:
  std::string path_;
  std::unique_ptr<simulation::SimulatedBus> simulated_;
  std::unique_ptr<simulation::BusRunner> runner_;
  std::thread player_;
};

/// The same with the driver on it: real serial port, real threads.
class LiveBus
{
public:
  LiveBus(const Scene& scene, const std::string& profiles, const Host& host);
  ~LiveBus();

  LiveWire wire;
  std::unique_ptr<bus::Bus> driver;

private:
  std::unique_ptr<bus::Observer> observer_;
};

/// Keeps the queues full: a velocity of every inverter at 50 Hz, and parameter reads that always wait.
class Load
{
public:
  Load(LiveBus& bus, std::size_t inverters, int reads);
  ~Load();
  /// This inverter's velocities wait.
  void hold(std::size_t index);
  /// They go on.
  void resume(std::size_t index);
  /// They begin with a 0, which opens the lock of a stop.
  void restart(std::size_t index);

private:
  enum Phase
  {
    BEGINS,
    RUNS,
    WAITS
  };

  void run();
  void command(std::size_t index, double velocity);

  LiveBus& bus_;
  int reads_;
  std::vector<std::atomic<int>> phases_;  ///< Phase
  std::atomic<bool> stop_{ false };
  std::atomic<int> waiting_{ 0 };
  std::thread thread_;
};

/// How late a thread of this host wakes up that asks for every millisecond, while everything else runs.
class WakeUps
{
public:
  WakeUps();
  ~WakeUps();
  /// Ends it, and returns the lateness of each wake-up [s].
  std::vector<double> end();

private:
  std::atomic<bool> stop_{ false };
  std::vector<double> late_;
  std::thread thread_;
};
}  // namespace benchmark
}  // namespace inverter_bus

#endif  // INVERTER_BUS_BENCHMARK_LIVE_BUS_H
