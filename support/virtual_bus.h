// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_TEST_VIRTUAL_BUS_H
#define INVERTER_BUS_TEST_VIRTUAL_BUS_H

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "bus/bus_loop.h"
#include "bus/coordinator.h"
#include "inverter_bus/simulation/simulated_bus.h"
#include "support/virtual_gateway.h"
#include "support/virtual_telnet.h"
#include "support/virtual_world.h"

namespace inverter_bus
{
/// A whole bus in virtual time: the driver's core on one side, simulated drives on the other, one scan list for both.
class VirtualBus
{
public:
  explicit VirtualBus(const std::string& yaml, simulation::GapRule gap = simulation::GapRule::Enforce)
    : simulated_(simulation::busConfigFromText(yaml), lineOptions(gap), clock_.now())
    , configuration_(read(yaml))
    , port_(makePort())
    , protocol_(bus::makeProtocol(configuration_.bus))
    , line_(*port_, *protocol_, clock_, bus::makeTiming(configuration_.bus))
    , coordinator_(configuration_, line_)
    , loop_(coordinator_, line_, clock_, mutex_)
  {
    line_.setGatewayTimeout(seconds(configuration_.bus.gateway_timeout));
    simulated_.setObserver([this](const simulation::FrameRecord& frame) { frames_.push_back(frame); });
  }

  // --- time ---------------------------------------------------------------------------------------------------------
  TimePoint now() const
  {
    return clock_.now();
  }

  void at(double seconds_from_now, std::function<void()> action)
  {
    clock_.at(clock_.now() + seconds(seconds_from_now), std::move(action));
  }

  /// Time passes without the driver (before it is started).
  void pass(double duration)
  {
    clock_.sleepUntil(clock_.now() + seconds(duration));
    simulated_.advance(clock_.now());
  }

  void run(double duration)
  {
    runUntil(duration, [] { return false; });
  }

  /// Runs until \p condition; false if it did not come true within \p limit seconds.
  bool runUntil(double limit, const std::function<bool()>& condition)
  {
    const TimePoint end = clock_.now() + seconds(limit);
    while (clock_.now() < end)
    {
      const TimePoint wake = loop_.step();
      deliver();
      if (condition())
      {
        return true;
      }
      if (wake > clock_.now())
      {
        clock_.waitUntil(std::min(wake, end));
        deliver();
      }
    }
    return condition();
  }

  // --- what users do ------------------------------------------------------------------------------------------------
  std::uint16_t command(std::size_t index, double velocity, const std::string& publisher = "/user")
  {
    bus::VelocityCommand command;
    command.targets = { { index, velocity } };
    command.publisher.name = publisher;
    command.publisher.topic = "command";
    return coordinator_.command(clock_.now(), command);
  }

  std::uint16_t group(const std::vector<std::pair<std::size_t, double>>& targets,
                      const std::string& publisher = "/user")
  {
    bus::VelocityCommand command;
    command.targets = targets;
    command.publisher.name = publisher;
    command.publisher.topic = "group";
    command.grouped = true;
    return coordinator_.command(clock_.now(), command);
  }

  /// Repeats a velocity every \p period until \p until seconds from now.
  void stream(std::size_t index, double velocity, double period, double until, const std::string& publisher = "/user")
  {
    for (double time = 0.0; time < until; time += period)
    {
      at(time, [this, index, velocity, publisher] { command(index, velocity, publisher); });
    }
  }

  /// A service call: the answer appears in the returned box.
  using Box = std::shared_ptr<std::optional<bus::Answer>>;

  bus::AnswerCallback into(const Box& box)
  {
    return [box](const bus::Answer& answer) { *box = answer; };
  }

  Box stop(std::optional<std::size_t> index, std::uint8_t mode = 0)
  {
    const Box box = std::make_shared<std::optional<bus::Answer>>();
    coordinator_.stop(clock_.now(), index, mode, into(box));
    return box;
  }

  Box reset(std::size_t index)
  {
    const Box box = std::make_shared<std::optional<bus::Answer>>();
    coordinator_.reset(clock_.now(), index, into(box));
    return box;
  }

  Box readFaults(std::size_t index)
  {
    const Box box = std::make_shared<std::optional<bus::Answer>>();
    coordinator_.readFaults(clock_.now(), index, into(box));
    return box;
  }

  Box readParameter(std::size_t index, const std::string& name)
  {
    const Box box = std::make_shared<std::optional<bus::Answer>>();
    coordinator_.readParameter(clock_.now(), index, name, into(box));
    return box;
  }

  Box writeParameter(std::size_t index, const std::string& name, double value, bool persist)
  {
    const Box box = std::make_shared<std::optional<bus::Answer>>();
    coordinator_.writeParameter(clock_.now(), index, name, value, persist, into(box));
    return box;
  }

  /// What makes the inverter's lamp yellow or red; empty: it is green.
  std::string findings(std::size_t index)
  {
    const bus::InverterReport report = coordinator_.report(clock_.now()).inverters.at(index);
    std::string text;
    for (const bus::Finding& finding : report.findings)
    {
      text += finding.text + "\n";
    }
    return text;
  }

  /// All lines of /diagnostics about one inverter, findings and values.
  std::string diagnostics(std::size_t index)
  {
    const bus::InverterReport report = coordinator_.report(clock_.now()).inverters.at(index);
    std::string text;
    for (const bus::Finding& finding : report.findings)
    {
      text += finding.text + "\n";
    }
    for (const auto& value : report.values)
    {
      text += value.first + " = " + value.second + "\n";
    }
    return text;
  }

  /// The answer of a call within \p limit seconds; a failed one if none came.
  bus::Answer wait(const Box& box, double limit = 20.0)
  {
    runUntil(limit, [&] { return box->has_value(); });
    EXPECT_TRUE(box->has_value()) << "no answer";
    return box->value_or(bus::Answer());
  }

  // --- what the world does ------------------------------------------------------------------------------------------
  std::string world(const std::string& command)
  {
    const std::string answer = simulated_.command(command, clock_.now());
    EXPECT_EQ(answer.compare(0, 2, "ok"), 0) << command << " -> " << answer;
    return answer;
  }

  /// The same where it does not matter whether it can happen now (a drive without power can't trip).
  void provoke(const std::string& command)
  {
    simulated_.command(command, clock_.now());
  }

  /// A value of `show`: what the motor really does.
  double motor(const std::string& name, const std::string& key)
  {
    std::istringstream words(world(name + " show"));
    std::string word;
    while (words >> word)
    {
      if (word.compare(0, key.size() + 1, key + "=") == 0)
      {
        return std::stod(word.substr(key.size() + 1));
      }
    }
    ADD_FAILURE() << "show of " << name << " has no " << key;
    return -1.0;
  }

  // --- what is seen -------------------------------------------------------------------------------------------------
  const bus::InverterStatus& status(std::size_t index) const
  {
    return statuses_.at(index);
  }

  bool hasStatus(std::size_t index) const
  {
    return statuses_.count(index) != 0;
  }

  /// Frames of the master since the last clearFrames(), as hex text without the check sum.
  std::vector<std::string> requests() const
  {
    std::vector<std::string> texts;
    for (const simulation::FrameRecord& frame : frames_)
    {
      if (frame.source == simulation::FrameRecord::Source::Master)
      {
        texts.push_back(hex(frame.bytes));
      }
    }
    return texts;
  }

  static std::string hex(const simulation::Bytes& bytes)
  {
    std::string text;
    for (std::size_t index = 0; index + 2 < bytes.size(); ++index)
    {
      char word[4];
      std::snprintf(word, sizeof word, "%02X", bytes[index]);
      text += (text.empty() ? "" : " ") + std::string(word);
    }
    return text;
  }

  std::size_t count(const std::string& beginning) const
  {
    const auto texts = requests();
    return static_cast<std::size_t>(std::count_if(texts.begin(), texts.end(), [&](const std::string& text) {
      return text.compare(0, beginning.size(), beginning) == 0;
    }));
  }

  const std::vector<simulation::FrameRecord>& frames() const
  {
    return frames_;
  }

  void clearFrames()
  {
    frames_.clear();
  }

  std::vector<std::string> logTexts() const
  {
    std::vector<std::string> texts;
    for (const bus::Finding& finding : log_)
    {
      texts.push_back(finding.text);
    }
    return texts;
  }

  const std::vector<bus::Finding>& log() const
  {
    return log_;
  }

  /// Runs until every inverter has been silent long enough to be unlocked.
  void settleIn(double limit = 5.0)
  {
    const std::size_t inverters = configuration_.bus.inverters.size();
    const bool unlocked = runUntil(limit, [&] {
      for (std::size_t index = 0; index < inverters; ++index)
      {
        if (!hasStatus(index) || status(index).locked)
        {
          return false;
        }
      }
      return true;
    });
    ASSERT_TRUE(unlocked) << "the bus did not settle in";
    clearFrames();
  }

  /// What the flight recorder gets beside the frames.
  const std::vector<bus::TraceEvent>& events() const
  {
    return events_;
  }

  std::vector<std::string> eventTexts() const
  {
    std::vector<std::string> texts;
    for (const bus::TraceEvent& event : events_)
    {
      texts.push_back(event.text.data());
    }
    return texts;
  }

  bus::Coordinator& coordinator()
  {
    return coordinator_;
  }

  const bus::Configuration& configuration() const
  {
    return configuration_;
  }

  /// Where the scan list's port is tcp://.
  VirtualGateway& gateway()
  {
    return dynamic_cast<VirtualGateway&>(*port_);
  }

  /// Where it is rtu+tcp://.
  VirtualTelnet& telnet()
  {
    return dynamic_cast<VirtualTelnet&>(*port_);
  }

  const std::vector<bus::BusStatus>& busStatuses() const
  {
    return bus_statuses_;
  }

  const wire::Line& line() const
  {
    return line_;
  }

private:
  static simulation::LineOptions lineOptions(simulation::GapRule gap)
  {
    simulation::LineOptions options;
    options.gap = gap;
    return options;
  }

  static bus::Configuration read(const std::string& yaml)
  {
    const std::string path = ::testing::TempDir() + "virtual_bus_" + std::to_string(::getpid()) + ".yaml";
    std::ofstream(path) << yaml;
    const bus::Value value = bus::readYamlFile(path);
    std::remove(path.c_str());
    return bus::readConfiguration(value, "scan list", INVERTER_BUS_ROOT "/config/drives");
  }

  std::unique_ptr<wire::Port> makePort()
  {
    if (!configuration_.bus.gateway)
    {
      return std::make_unique<VirtualPort>(simulated_, clock_);
    }
    if (!configuration_.bus.modbus_tcp)
    {
      return std::make_unique<VirtualTelnet>(simulated_, clock_);
    }
    const double gap = 3.5 * wire::bitsPerCharacter(configuration_.bus.serial) / configuration_.bus.serial.baud_rate;
    return std::make_unique<VirtualGateway>(simulated_, clock_, gap);
  }

  void deliver()
  {
    const bus::Outputs outputs = coordinator_.takeOutputs();
    bus_statuses_.insert(bus_statuses_.end(), outputs.bus_statuses.begin(), outputs.bus_statuses.end());
    for (const bus::InverterStatus& status : outputs.statuses)
    {
      statuses_[status.index] = status;
    }
    for (const bus::Finding& finding : outputs.log)
    {
      log_.push_back(finding);
    }
    events_.insert(events_.end(), outputs.events.begin(), outputs.events.end());
    for (auto& answer : coordinator_.takeAnswers())
    {
      answer.first(answer.second);
    }
  }

  AppointedClock clock_;
  simulation::SimulatedBus simulated_;
  bus::Configuration configuration_;
  std::unique_ptr<wire::Port> port_;
  std::unique_ptr<wire::Protocol> protocol_;
  wire::Line line_;
  std::mutex mutex_;
  bus::Coordinator coordinator_;
  bus::BusLoop loop_;
  std::map<std::size_t, bus::InverterStatus> statuses_;
  std::vector<simulation::FrameRecord> frames_;
  std::vector<bus::Finding> log_;
  std::vector<bus::TraceEvent> events_;
  std::vector<bus::BusStatus> bus_statuses_;
};
}  // namespace inverter_bus

#endif  // INVERTER_BUS_TEST_VIRTUAL_BUS_H
