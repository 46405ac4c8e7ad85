// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "support/heap_story.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <utility>

namespace inverter_bus
{
namespace heap
{
namespace
{
constexpr double STREAM_PERIOD_S = 0.1;
constexpr double LONGEST_PAUSE_S = 0.8;
/// The quiet minute refills the flight recorder: what it holds is the same at every end.
constexpr double BACK_S = 10.0;
constexpr double ANSWERED_S = 15.0;
constexpr double QUIET_S = 60.0;
constexpr double HARM_SHARE = 0.12;

const char* const MODBUS = R"(
port: /dev/virtual
baud_rate: 9600
parity: even
scan_list:
  - {name: belt, node: 1, drive: omron_mx2}
  - {name: crusher, node: 2, drive: omron_rx}
  - {name: pump, node: 3, drive: toshiba_vfs15}
  - {name: press, node: 4, drive: toshiba_vfs15}
  - name: mixer
    node: 5
    drive: teco_7200ma
    confirm: [run_forward, fault_reset, frequency_scale, monitor_layout, fault_coding]
    overrides: {reverse_word: 2, monitor_base: 0x0020}
simulation:
  belt: {parameters: {F002: 1.0, F003: 1.0}}
  crusher: {parameters: {F002: 1.0, F003: 1.0}}
  press: {parameters: {F870: 1, F871: 3, F875: 1, F876: 2, F877: 3, F878: 4, F879: 14}}
  mixer: {parameters: {Cn-27: 4.0}}
)";

/// The codes are those that the simulated drive was given; the manual's own are not public.
const char* const COMPOWAY = R"(
port: /dev/virtual
protocol: compoway_f
baud_rate: 9600
parity: even
data_bits: 7
stop_bits: 2
defaults:
  drive: omron_3g3je
  confirm: [current_scale, controller_status_meaning]
  overrides:
    operation_codes: {run_forward: "1101", run_reverse: "1102", stop: "1100", fault_reset: "1201", ram_write_mode: "1401",
                      setup_area_0: "1700", setup_area_1: "1701"}
scan_list:
  - {name: fan_1, node: 1}
  - {name: fan_2, node: 2}
)";

bus::Configuration read(const std::string& yaml, const std::string& profiles)
{
  char path[] = "/tmp/inverter_bus_heap_XXXXXX";
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

simulation::LineOptions lineOptions(std::uint64_t seed)
{
  simulation::LineOptions options;
  options.seed = seed;
  options.delivery_step = std::chrono::milliseconds(2);
  return options;
}
}  // namespace

const std::vector<Stage>& stages()
{
  static const std::vector<Stage> STAGES{
    { "modbus", MODBUS, "exception 4", "bus foreign 4D 03 10 00 00 02", { "A020", "A020", "ACC", "ACC", "" } },
    { "compoway", COMPOWAY, "exception 8707", "bus foreign 770000601", { "P05", "P05" } },
  };
  return STAGES;
}

/// The simulated line as a port. What it takes from the heap is the simulation's; what it hands over, the driver's.
class Story::Port : public VirtualPort
{
public:
  using VirtualPort::VirtualPort;

  wire::OpenResult open(std::string& error) override
  {
    const Scope scope(Owner::SIMULATION);
    return VirtualPort::open(error);
  }

  bool send(const wire::Bytes& frame) override
  {
    const Scope scope(Owner::SIMULATION);
    return VirtualPort::send(frame);
  }

  wire::ReceiveResult receive(wire::Bytes& buffer, TimePoint deadline) override
  {
    wire::Bytes received;
    const wire::ReceiveResult result = simulate(received, deadline);
    buffer.insert(buffer.end(), received.begin(), received.end());
    return result;
  }

private:
  wire::ReceiveResult simulate(wire::Bytes& received, TimePoint deadline)
  {
    const Scope scope(Owner::SIMULATION);
    return VirtualPort::receive(received, deadline);
  }
};

Story::Story(const Stage& stage, const std::string& profiles, std::uint64_t seed)
  : stage_(stage), configuration_(read(stage.yaml, profiles)), start_(clock_.now()), random_(seed)
{
  {
    const Scope scope(Owner::SIMULATION);
    simulated_ = std::make_unique<simulation::SimulatedBus>(simulation::busConfigFromText(stage.yaml),
                                                            lineOptions(seed), start_);
  }
  port_ = std::make_unique<Port>(*simulated_, clock_);
  const Scope scope(Owner::DRIVER);
  protocol_ = bus::makeProtocol(configuration_.bus);
  line_ = std::make_unique<wire::Line>(*port_, *protocol_, clock_, bus::makeTiming(configuration_.bus));
  line_->setFrameObserver([this](const wire::FrameEvent& event) { recorder_.add(event); });
  coordinator_ = std::make_unique<bus::Coordinator>(configuration_, *line_);
  loop_ = std::make_unique<bus::BusLoop>(*coordinator_, *line_, clock_, mutex_);
  streams_.resize(configuration_.bus.inverters.size());
}

Story::~Story() = default;

const Events& Story::events() const
{
  return events_;
}

wire::LineCounters Story::counters() const
{
  return line_->counters();
}

std::uint64_t Story::reconnects() const
{
  return coordinator_->report(clock_.now()).bus.reconnects;
}

double Story::time() const
{
  return toSeconds(clock_.now() - start_);
}

bool Story::calm() const
{
  const bus::Report report = coordinator_->report(clock_.now());
  const bool rest = std::all_of(report.inverters.begin(), report.inverters.end(), [](const auto& inverter) {
    const bus::InverterStatus& status = inverter.status;
    return !status.communication_error && !status.run_command && !status.stop_active;
  });
  return rest && report.bus.connected && events_.answers == events_.services + events_.stops;
}

// --- time --------------------------------------------------------------------------------------------------------------------

void Story::play(double duration)
{
  acting_ = true;
  scheduleStreams();
  const TimePoint end = clock_.now() + seconds(duration);
  while (clock_.now() < end)
  {
    act();
    run(between(0.0, LONGEST_PAUSE_S));
  }
  acting_ = false;
  mend();
  run(QUIET_S);
}

void Story::run(double duration)
{
  const TimePoint end = clock_.now() + seconds(duration);
  while (clock_.now() < end)
  {
    TimePoint wake;
    {
      const Scope scope(Owner::DRIVER);
      wake = loop_->step();
    }
    deliver();
    if (wake > clock_.now())
    {
      clock_.waitUntil(std::min(wake, end));
      deliver();
    }
  }
}

/// As Bus does it: answers, statuses, log lines, the flight recorder.
void Story::deliver()
{
  const Scope scope(Owner::DRIVER);
  const bus::Outputs outputs = coordinator_->takeOutputs();
  for (const auto& answer : coordinator_->takeAnswers())
  {
    answer.first(answer.second);
  }
  events_.statuses += outputs.statuses.size();
  events_.log_lines += outputs.log.size();
  for (const std::string& reason : outputs.traces)
  {
    events_.dumps += recorder_.automaticDump(reason, clock_.now()) ? 1 : 0;
  }
}

// --- users -------------------------------------------------------------------------------------------------------------------

double Story::chance()
{
  return static_cast<double>(random_.next() >> 11U) / 9007199254740992.0;
}

double Story::between(double least, double most)
{
  return least + (most - least) * chance();
}

template <typename T>
const T& Story::any(const std::vector<T>& values)
{
  return values[static_cast<std::size_t>(random_.below(values.size()))];
}

void Story::scheduleStreams()
{
  clock_.at(clock_.now() + seconds(STREAM_PERIOD_S), [this] {
    if (acting_)
    {
      tickStreams();
      scheduleStreams();
    }
  });
}

void Story::tickStreams()
{
  for (std::size_t index = 0; index < streams_.size(); ++index)
  {
    // An unsteady publisher: what it leaves out is for the command watchdog.
    if (!streams_[index].publisher.empty() && chance() < 0.9)
    {
      send(index, streams_[index], false);
    }
  }
}

void Story::act()
{
  if (chance() < HARM_SHARE)
  {
    harm();
  }
  else
  {
    use();
  }
}

void Story::use()
{
  const double dice = chance();
  if (dice < 0.45)
  {
    const auto index = static_cast<std::size_t>(random_.below(streams_.size()));
    changeStream(streams_[index]);
    send(index, streams_[index], true);
  }
  else if (dice < 0.6)
  {
    sendGroup();
  }
  else if (dice < 0.7)
  {
    stop();
  }
  else if (dice < 0.9)
  {
    callService();
  }
  else
  {
    ask();
  }
}

/// Now and then a publisher that was never heard before, with a name of any length, as anonymous nodes have.
void Story::changeStream(Stream& stream)
{
  const std::vector<double> wrong{ std::numeric_limits<double>::quiet_NaN(), 1e9, -1e9, 1e-9 };
  const double dice = chance();
  stream.velocity = dice < 0.1 ? any(wrong) : (dice < 0.3 ? 0.0 : between(-40.0, 40.0));
  if (chance() < 0.3 || stream.publisher.empty())
  {
    ++events_.publishers;
    stream.publisher =
        "/teleop_" + std::to_string(random_.next()) + std::string(static_cast<std::size_t>(random_.below(40)), 'x');
    stream.latched = chance() < 0.2;
  }
}

void Story::command(const bus::VelocityCommand& command)
{
  const Scope scope(Owner::DRIVER);
  ++events_.commands;
  events_.refused += coordinator_->command(clock_.now(), command) != 0 ? 1 : 0;
}

void Story::send(std::size_t index, const Stream& stream, bool first)
{
  bus::VelocityCommand one;
  one.targets = { { index, stream.velocity } };
  one.publisher.name = stream.publisher;
  one.publisher.topic = "inverter";
  one.publisher.latched = stream.latched;
  one.publisher.first_on_connection = first;
  command(one);
}

void Story::sendGroup()
{
  bus::VelocityCommand group;
  group.grouped = true;
  group.publisher.name = "/group_" + std::to_string(random_.next());
  group.publisher.topic = "group";
  for (std::size_t index = 0; index < streams_.size(); ++index)
  {
    group.targets.emplace_back(index, chance() < 0.5 ? 0.0 : between(-40.0, 40.0));
  }
  command(group);
  if (chance() < 0.2)
  {
    const Scope scope(Owner::DRIVER);
    coordinator_->refuse(clock_.now(), { 0 }, bus::ERROR_OUT_OF_RANGE, "unknown name " + group.publisher.name, true);
  }
}

bus::AnswerCallback Story::answered()
{
  return [this](const bus::Answer&) { ++events_.answers; };
}

void Story::stop()
{
  const Scope scope(Owner::DRIVER);
  ++events_.stops;
  const auto index = static_cast<std::size_t>(random_.below(streams_.size() + 1));
  const auto mode = static_cast<std::uint8_t>(random_.below(4));
  const bool all = index == streams_.size();
  coordinator_->stop(clock_.now(), all ? std::nullopt : std::optional<std::size_t>(index), mode, answered());
}

void Story::callService()
{
  const Scope scope(Owner::DRIVER);
  ++events_.services;
  const TimePoint now = clock_.now();
  const auto index = static_cast<std::size_t>(random_.below(streams_.size()));
  const std::string& parameter = stage_.parameters[index];
  const double dice = chance();
  if (dice < 0.3)
  {
    coordinator_->reset(now, index, answered());
  }
  else if (dice < 0.5)
  {
    coordinator_->readFaults(now, index, answered());
  }
  else if (dice < 0.6)
  {
    coordinator_->readParameter(now, index, "nonsense_" + std::to_string(random_.next()), answered());
  }
  else if (dice < 0.8 || parameter.empty())
  {
    coordinator_->readParameter(now, index, parameter, answered());
  }
  else
  {
    coordinator_->writeParameter(now, index, parameter, 1.0 + static_cast<double>(random_.below(3)), chance() < 0.5,
                                 answered());
  }
}

void Story::ask()
{
  const Scope scope(Owner::DRIVER);
  coordinator_->report(clock_.now());
  coordinator_->budget();
  recorder_.dump("dump_trace", clock_.now());
}

// --- harm --------------------------------------------------------------------------------------------------------------------

void Story::provoke(const std::string& command)
{
  const Scope scope(Owner::SIMULATION);
  simulated_->command(command, clock_.now());
}

void Story::harm()
{
  ++events_.faults;
  const auto index = static_cast<std::size_t>(random_.below(streams_.size()));
  const std::string& name = configuration_.bus.inverters[index].name;
  const double dice = chance();
  if (dice < 0.4)
  {
    const std::vector<std::string> replies{ "damaged",      "truncated",    "truncated 1",   "late 0.05",
                                            "late 0.25",    "noise 4",      "foreign shape", "foreign station",
                                            stage_.refusal, "lost_request", "lost_reply" };
    provoke(name + " " + any(replies) + " count " + std::to_string(1 + random_.below(4)));
  }
  else if (dice < 0.85)
  {
    harmDrive(name);
  }
  else
  {
    const std::vector<std::string> line{ "bus unplug 0.05", "bus unplug 1.5", "bus silent 0.5", "bus noise 6",
                                         stage_.foreign };
    provoke(any(line));
  }
}

void Story::harmDrive(const std::string& name)
{
  const std::vector<std::string> harms{ "power_cycle 0.02", "power_cycle 1.5", "offline 0.4", "offline 6", "trip 1",
                                        "trip 3",           "panel_stop",      "busy 0.5",    "sto on",    "panel 10" };
  const std::string& harm = any(harms);
  provoke(name + " " + harm);
  const std::string mend = harm == "sto on" ? "sto off" : (harm == "panel 10" ? "panel_release" : "");
  if (!mend.empty())
  {
    clock_.at(clock_.now() + seconds(between(0.2, 3.0)), [this, name, mend] { provoke(name + " " + mend); });
  }
}

void Story::mend()
{
  provoke("bus plug");
  provoke("bus silent off");
  for (const bus::InverterConfig& inverter : configuration_.bus.inverters)
  {
    for (const char* word : { "clear", "online", "power on", "panel_release", "sto off" })
    {
      provoke(inverter.name + " " + word);
    }
  }
  run(BACK_S);
  for (std::size_t index = 0; index < streams_.size(); ++index)
  {
    const Scope scope(Owner::DRIVER);
    events_.stops += 1;
    coordinator_->stop(clock_.now(), index, 0, answered());
  }
  run(ANSWERED_S);
  for (std::size_t index = 0; index < streams_.size(); ++index)
  {
    const Scope scope(Owner::DRIVER);
    events_.services += 1;
    coordinator_->reset(clock_.now(), index, answered());
  }
  run(ANSWERED_S);
}
}  // namespace heap
}  // namespace inverter_bus
