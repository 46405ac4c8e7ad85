// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_HEAP_STORY_H
#define INVERTER_BUS_HEAP_STORY_H

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "bus/bus_loop.h"
#include "bus/coordinator.h"
#include "bus/report/flight_recorder.h"
#include "inverter_bus/simulation/random.h"
#include "support/heap_count.h"
#include "support/virtual_world.h"

namespace inverter_bus
{
namespace heap
{
/// A kind of bus that a story is played on: one scan list for the driver and for the simulated drives.
struct Stage
{
  std::string name;
  std::string yaml;
  /// In the words of the simulated bus: how a drive refuses a request, and what a second master says.
  std::string refusal;
  std::string foreign;
  /// A parameter of each inverter that may be written; empty: none.
  std::vector<std::string> parameters;
};

/// Every brand that speaks Modbus RTU on one line, and CompoWay/F.
const std::vector<Stage>& stages();

/// What happened in a story: proof that it was one.
struct Events
{
  unsigned long commands = 0;
  unsigned long refused = 0;
  unsigned long stops = 0;
  unsigned long services = 0;
  unsigned long answers = 0;
  unsigned long faults = 0;
  unsigned long publishers = 0;
  unsigned long statuses = 0;
  unsigned long log_lines = 0;
  unsigned long dumps = 0;
};

/// The whole core in virtual time, with users and faults by chance. What it reports is not kept, only counted.
class Story
{
public:
  /// \p profiles: directory of the drive profiles.
  Story(const Stage& stage, const std::string& profiles, std::uint64_t seed);
  ~Story();

  /// Users and faults for so long; then everything is repaired and stopped, and the bus is left alone for a minute: so all
  /// stories end in the same state.
  void play(double duration);

  const Events& events() const;
  wire::LineCounters counters() const;
  std::uint64_t reconnects() const;
  /// Bus time since the beginning [s].
  double time() const;
  /// No caller waits for an answer, every inverter is online, and none is running.
  bool calm() const;

private:
  class Port;
  struct Stream
  {
    double velocity = 0.0;
    std::string publisher;
    bool latched = false;
  };

  void run(double duration);
  void deliver();
  void tickStreams();
  void scheduleStreams();
  void act();
  void use();
  void changeStream(Stream& stream);
  void command(const bus::VelocityCommand& command);
  void send(std::size_t index, const Stream& stream, bool first);
  void sendGroup();
  void stop();
  void callService();
  bus::AnswerCallback answered();
  void ask();
  void harm();
  void harmDrive(const std::string& name);
  void provoke(const std::string& command);
  void mend();
  double chance();
  double between(double least, double most);
  template <typename T>
  const T& any(const std::vector<T>& values);

  const Stage& stage_;
  bus::Configuration configuration_;
  AppointedClock clock_;
  TimePoint start_;
  std::unique_ptr<simulation::SimulatedBus> simulated_;
  std::unique_ptr<Port> port_;
  std::unique_ptr<wire::Protocol> protocol_;
  std::unique_ptr<wire::Line> line_;
  bus::FlightRecorder recorder_;
  std::mutex mutex_;
  std::unique_ptr<bus::Coordinator> coordinator_;
  std::unique_ptr<bus::BusLoop> loop_;
  simulation::Random random_;
  std::vector<Stream> streams_;
  bool acting_ = false;
  Events events_;
};
}  // namespace heap
}  // namespace inverter_bus

#endif  // INVERTER_BUS_HEAP_STORY_H
