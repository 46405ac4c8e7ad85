// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "support/stop_latency_story.h"

#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace inverter_bus
{
namespace
{
constexpr double STREAM_PERIOD_S = 0.02;
constexpr double SETTLING_S = 20.0;
/// Between the confirmation of a stop and the next one.
constexpr double LONGEST_PAUSE_S = 0.12;
constexpr double LONGEST_STOP_S = 5.0;
constexpr double LONGEST_ABSENCE_S = 60.0;
/// Far beyond every time-out.
constexpr const char* LATE = " late 0.16 for 86400";
constexpr const char* BROKEN = " truncated 4 for 86400";

std::string name(unsigned index)
{
  return "belt_" + std::to_string(index + 1);
}

std::string scanList(unsigned inverters)
{
  std::ostringstream yaml;
  yaml << "port: /dev/virtual\nbaud_rate: 19200\ndefaults: {drive: omron_mx2, command_timeout: 2.0}\nscan_list:\n";
  for (unsigned index = 0; index < inverters; ++index)
  {
    yaml << "  - {name: " << name(index) << ", node: " << index + 1 << "}\n";
  }
  return yaml.str();
}

bus::Configuration read(const std::string& yaml, const std::string& profiles)
{
  char path[] = "/tmp/inverter_bus_stops_XXXXXX";
  const int file = ::mkstemp(path);
  if (file >= 0)
  {
    ::close(file);
  }
  std::ofstream(path) << yaml;
  const bus::Value value = bus::readYamlFile(path);
  std::remove(path);
  return bus::readConfiguration(value, "scan list", profiles);
}
}  // namespace

/// The simulated line as a port; looks for the first byte of the stop that is waited for.
class StopLatencyStory::Port : public VirtualPort
{
public:
  Port(simulation::SimulatedBus& bus, AppointedClock& clock) : VirtualPort(bus, clock), clock_(clock)
  {
  }

  bool send(const wire::Bytes& frame) override
  {
    // Coil 0001H, RUN, off.
    const wire::Bytes off{ station_, 0x05, 0x00, 0x00, 0x00, 0x00 };
    if (station_ != 0 && frame.size() > off.size() && std::equal(off.begin(), off.end(), frame.begin()))
    {
      first_byte_at_ = clock_.now();
      station_ = 0;
    }
    return VirtualPort::send(frame);
  }

  void watch(std::uint8_t station)
  {
    station_ = station;
    first_byte_at_.reset();
  }

  const std::optional<TimePoint>& firstByteAt() const
  {
    return first_byte_at_;
  }

private:
  AppointedClock& clock_;
  std::uint8_t station_ = 0;
  std::optional<TimePoint> first_byte_at_;
};

StopLatencyStory::StopLatencyStory(const Plan& plan, const std::string& profiles)
  : plan_(plan), configuration_(read(scanList(plan.inverters), profiles)), random_(plan.seed), streams_(plan.inverters)
{
  simulation::LineOptions options;
  options.seed = plan.seed;
  // As an adapter hands bytes over.
  options.delivery_step = std::chrono::milliseconds(1);
  simulated_ = std::make_unique<simulation::SimulatedBus>(simulation::busConfigFromText(scanList(plan.inverters)),
                                                          options, clock_.now());
  port_ = std::make_unique<Port>(*simulated_, clock_);
  protocol_ = bus::makeProtocol(configuration_.bus);
  line_ = std::make_unique<wire::Line>(*port_, *protocol_, clock_, bus::makeTiming(configuration_.bus));
  coordinator_ = std::make_unique<bus::Coordinator>(configuration_, *line_);
  loop_ = std::make_unique<bus::BusLoop>(*coordinator_, *line_, clock_, mutex_);
}

StopLatencyStory::~StopLatencyStory() = default;

std::vector<Duration> StopLatencyStory::play()
{
  run(seconds(SETTLING_S));
  tickStreams();
  askForParameter();
  run(seconds(SETTLING_S));
  kill();
  run(seconds(SETTLING_S));
  while (latencies_.size() < plan_.stops)
  {
    if (!stopOne())
    {
      break;
    }
  }
  return latencies_;
}

Duration StopLatencyStory::worstTold()
{
  return seconds(coordinator_->report(clock_.now()).bus.stop_latency_max);
}

void StopLatencyStory::run(Duration duration)
{
  runUntil(duration, [] { return false; });
}

bool StopLatencyStory::runUntil(Duration limit, const std::function<bool()>& condition)
{
  const TimePoint end = clock_.now() + limit;
  while (clock_.now() < end && !condition())
  {
    const TimePoint wake = loop_->step();
    coordinator_->takeOutputs();
    for (auto& answer : coordinator_->takeAnswers())
    {
      answer.first(answer.second);
    }
    if (wake > clock_.now())
    {
      clock_.waitUntil(std::min(wake, end));
    }
  }
  return condition();
}

/// Each message is another velocity than the one before.
void StopLatencyStory::tickStreams()
{
  for (std::size_t index = 0; index < streams_.size(); ++index)
  {
    Stream& stream = streams_[index];
    if (stream.stopping)
    {
      continue;
    }
    stream.velocity = stream.zero_due ? 0.0 : 20.0 + 10.0 * chance();
    stream.zero_due = false;
    bus::VelocityCommand command;
    command.targets = { { index, stream.velocity } };
    command.publisher.name = "/user";
    command.publisher.topic = "command";
    coordinator_->command(clock_.now(), command);
  }
  clock_.at(clock_.now() + seconds(STREAM_PERIOD_S), [this] { tickStreams(); });
}

void StopLatencyStory::askForParameter()
{
  coordinator_->readParameter(clock_.now(), random_.below(living()), "F002",
                              [this](const bus::Answer&) { askForParameter(); });
}

/// The last ones of the scan list.
void StopLatencyStory::kill()
{
  for (unsigned index = living(); index < plan_.inverters; ++index)
  {
    const std::string what = plan_.death == Death::Silent ? " offline" : plan_.death == Death::Late ? LATE : BROKEN;
    const std::string answer = simulated_->command(name(index) + what, clock_.now());
    if (answer.compare(0, 2, "ok") != 0)
    {
      throw std::logic_error(what + ": " + answer);
    }
  }
}

/// False: its call was not answered.
bool StopLatencyStory::stopOne()
{
  const std::size_t index = anyOnline();
  Stream& stream = streams_[index];
  std::optional<TimePoint> called;
  bool answered = false;
  clock_.at(clock_.now() + seconds(LONGEST_PAUSE_S * chance()), [&] {
    called = clock_.now();
    stream.stopping = true;
    port_->watch(static_cast<std::uint8_t>(index + 1));
    coordinator_->stop(*called, index, 0, [&](const bus::Answer&) { answered = true; });
  });
  runUntil(seconds(LONGEST_STOP_S), [&] { return answered; });
  // One that has just been taken for dead is stopped by its probes.
  if (!answered && (!port_->firstByteAt() || !runUntil(seconds(LONGEST_ABSENCE_S), [&] { return answered; })))
  {
    return false;
  }
  if (port_->firstByteAt())
  {
    latencies_.push_back(*port_->firstByteAt() - *called);
  }
  // Else one was under way already, since the drive has lost its velocity: its frame had left.
  stream.stopping = false;
  stream.zero_due = true;
  return true;
}

/// A drive that lives can be taken for dead for a while: late replies damage those of others.
std::size_t StopLatencyStory::anyOnline()
{
  const std::vector<std::uint8_t> offline = coordinator_->report(clock_.now()).bus.offline_nodes;
  std::size_t index = random_.below(living());
  while (std::count(offline.begin(), offline.end(), index + 1) != 0)
  {
    index = random_.below(living());
  }
  return index;
}

unsigned StopLatencyStory::living() const
{
  return plan_.inverters - plan_.dead;
}

double StopLatencyStory::chance()
{
  return static_cast<double>(random_.below(1000000)) / 1e6;
}
}  // namespace inverter_bus
