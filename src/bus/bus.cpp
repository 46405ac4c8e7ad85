// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "inverter_bus/bus/bus.h"

#include <pthread.h>

#include <atomic>
#include <cstring>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#include "bus/bus_loop.h"
#include "bus/coordinator.h"
#include "bus/report/flight_recorder.h"
#include "util/steady_condition.h"

namespace inverter_bus
{
namespace bus
{
struct Bus::Implementation
{
  Implementation(Configuration given, std::unique_ptr<wire::Port> given_port, Observer& given_observer)
    : configuration(std::move(given))
    , port(std::move(given_port))
    , observer(given_observer)
    , protocol(makeProtocol(configuration.bus))
    , line(*port, *protocol, clock, makeTiming(configuration.bus))
    , coordinator(configuration, line)
    , loop(coordinator, line, clock, mutex)
  {
    line.setGatewayTimeout(seconds(configuration.bus.gateway_timeout));
    line.setFrameObserver([this](const wire::FrameEvent& event) { recorder.add(event); });
  }

  void run();
  void deliver();
  void answerNow(const PendingAnswers& answers);
  void takeRealtimePriority();

  /// Runs \p request on the coordinator and delivers what it answered at once.
  template <typename Request>
  void ask(Request request)
  {
    PendingAnswers answers;
    {
      const std::lock_guard<std::mutex> guard(mutex);
      request(coordinator, clock.now());
      answers = coordinator.takeAnswers();
      poked = true;
    }
    wake.notifyOne();
    answerNow(answers);
  }

  const Configuration configuration;
  std::unique_ptr<wire::Port> port;
  Observer& observer;
  mutable util::SteadyClock clock;
  std::unique_ptr<wire::Protocol> protocol;
  wire::Line line;
  FlightRecorder recorder;

  mutable std::mutex mutex;
  util::SteadyCondition wake;
  Coordinator coordinator;
  BusLoop loop;
  bool poked = false;
  bool ending = false;
  std::vector<std::string> unconfirmed;
  std::atomic<bool> in_use{ false };
  std::thread thread;
};

void Bus::Implementation::answerNow(const PendingAnswers& answers)
{
  for (const auto& entry : answers)
  {
    entry.first(entry.second);
  }
}

void Bus::Implementation::deliver()
{
  Outputs outputs;
  PendingAnswers answers;
  {
    const std::lock_guard<std::mutex> guard(mutex);
    outputs = coordinator.takeOutputs();
    answers = coordinator.takeAnswers();
  }
  answerNow(answers);
  for (const InverterStatus& status : outputs.statuses)
  {
    observer.inverterStatus(status);
  }
  for (const BusStatus& status : outputs.bus_statuses)
  {
    observer.busStatus(status);
  }
  for (const Finding& finding : outputs.log)
  {
    observer.log(finding);
  }
  for (const TraceEvent& event : outputs.events)
  {
    recorder.add(event);
  }
  for (const std::string& reason : outputs.traces)
  {
    if (auto dump = recorder.automaticDump(reason, clock.now()))
    {
      observer.trace(std::move(*dump));
    }
  }
}

void Bus::Implementation::takeRealtimePriority()
{
  if (configuration.bus.realtime_priority <= 0)
  {
    return;
  }
  sched_param parameters{};
  parameters.sched_priority = configuration.bus.realtime_priority;
  const int error = pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters);
  if (error != 0)
  {
    observer.log({ Level::Warn, "realtime_priority " + std::to_string(configuration.bus.realtime_priority) +
                                    " is not granted (" + std::strerror(error) +
                                    "): the bus runs with normal priority; allow rtprio in limits.conf" });
  }
}

void Bus::Implementation::run()
{
  takeRealtimePriority();
  for (;;)
  {
    const TimePoint next_round = loop.step();
    in_use = loop.portInUse();
    deliver();
    std::unique_lock<std::mutex> lock(mutex);
    if (ending && coordinator.shutdownDone(clock.now()))
    {
      // Under the same lock: otherwise a stop called a moment later would be listed as not confirmed.
      unconfirmed = coordinator.endShutdown();
      return;
    }
    if (next_round > clock.now() && !poked)
    {
      wake.waitUntil(lock, next_round, [this] { return poked; });
    }
    poked = false;
  }
}

Bus::Bus(Configuration configuration, std::unique_ptr<wire::Port> port, Observer& observer)
  : implementation_(std::make_unique<Implementation>(std::move(configuration), std::move(port), observer))
{
}

Bus::~Bus()
{
  shutdown();
}

void Bus::start()
{
  implementation_->thread = std::thread([this] { implementation_->run(); });
}

bool Bus::portInUse() const
{
  return implementation_->in_use;
}

std::vector<std::string> Bus::shutdown()
{
  Implementation& bus = *implementation_;
  {
    const std::lock_guard<std::mutex> guard(bus.mutex);
    if (bus.ending)
    {
      return {};
    }
    bus.ending = true;
    bus.poked = true;
    bus.coordinator.beginShutdown(bus.clock.now());
  }
  bus.wake.notifyOne();
  if (bus.thread.joinable())
  {
    bus.thread.join();
  }
  else
  {
    const std::lock_guard<std::mutex> guard(bus.mutex);
    bus.unconfirmed = bus.coordinator.endShutdown();
  }
  bus.deliver();
  bus.loop.close();
  return bus.unconfirmed;
}

std::uint16_t Bus::command(const VelocityCommand& command)
{
  std::uint16_t error_id = 0;
  implementation_->ask([&](Coordinator& coordinator, TimePoint now) { error_id = coordinator.command(now, command); });
  return error_id;
}

bool Bus::stops(std::size_t index, double velocity) const
{
  return implementation_->coordinator.stops(index, velocity);
}

void Bus::refuse(const std::vector<std::size_t>& indices, std::uint16_t error_id, const std::string& text, bool group)
{
  implementation_->ask(
      [&](Coordinator& coordinator, TimePoint now) { coordinator.refuse(now, indices, error_id, text, group); });
}

void Bus::stop(std::optional<std::size_t> index, std::uint8_t mode, AnswerCallback callback)
{
  implementation_->ask(
      [&](Coordinator& coordinator, TimePoint now) { coordinator.stop(now, index, mode, std::move(callback)); });
}

void Bus::reset(std::size_t index, AnswerCallback callback)
{
  implementation_->ask(
      [&](Coordinator& coordinator, TimePoint now) { coordinator.reset(now, index, std::move(callback)); });
}

void Bus::readFaults(std::size_t index, AnswerCallback callback)
{
  implementation_->ask(
      [&](Coordinator& coordinator, TimePoint now) { coordinator.readFaults(now, index, std::move(callback)); });
}

void Bus::readParameter(std::size_t index, const std::string& name, AnswerCallback callback)
{
  implementation_->ask([&](Coordinator& coordinator, TimePoint now) {
    coordinator.readParameter(now, index, name, std::move(callback));
  });
}

void Bus::writeParameter(std::size_t index, const std::string& name, double value, bool persist,
                         AnswerCallback callback)
{
  implementation_->ask([&](Coordinator& coordinator, TimePoint now) {
    coordinator.writeParameter(now, index, name, value, persist, std::move(callback));
  });
}

TraceDump Bus::dumpTrace()
{
  return implementation_->recorder.dump("dump_trace", implementation_->clock.now());
}

Report Bus::report() const
{
  const std::lock_guard<std::mutex> guard(implementation_->mutex);
  return implementation_->coordinator.report(implementation_->clock.now());
}

std::vector<Finding> Bus::budget() const
{
  const std::lock_guard<std::mutex> guard(implementation_->mutex);
  return implementation_->coordinator.budget();
}

ServiceBounds Bus::bounds() const
{
  const std::lock_guard<std::mutex> guard(implementation_->mutex);
  return implementation_->coordinator.bounds();
}
}  // namespace bus
}  // namespace inverter_bus
