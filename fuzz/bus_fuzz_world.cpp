// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "bus_fuzz_world.h"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace inverter_bus
{
namespace fuzz
{
namespace
{
constexpr std::size_t KEPT_FRAMES = 5000;
constexpr std::size_t MOST_IDLE_STEPS = 1000;
}  // namespace

wire::OpenResult WatchedPort::open(std::string& error)
{
  const wire::OpenResult result = VirtualPort::open(error);
  if (result == wire::OpenResult::Opened)
  {
    checker_.opened(clock_.now());
  }
  return result;
}

bool WatchedPort::send(const wire::Bytes& frame)
{
  checker_.sending(clock_.now(), frame);
  const bool sent = VirtualPort::send(frame);
  if (!sent)
  {
    checker_.lost(clock_.now());
  }
  return sent;
}

wire::ReceiveResult WatchedPort::receive(wire::Bytes& buffer, TimePoint deadline)
{
  const wire::ReceiveResult result = VirtualPort::receive(buffer, deadline);
  if (result == wire::ReceiveResult::Data)
  {
    checker_.heard(clock_.now());
  }
  if (result == wire::ReceiveResult::Gone)
  {
    checker_.lost(clock_.now());
  }
  return result;
}

simulation::LineOptions World::options(std::uint64_t seed)
{
  simulation::LineOptions options;
  options.seed = seed;
  // As an adapter hands bytes over; a whole frame at its end would be later than a short time-out allows.
  options.delivery_step = std::chrono::milliseconds(2);
  return options;
}

World::World(const Scene& scene, const bus::Configuration& configuration, std::uint64_t seed)
  : scene_(scene)
  , simulated_(simulation::busConfigFromText(scene.yaml), options(seed), clock_.now())
  , checker_(scene_, simulated_)
  , port_(simulated_, clock_, checker_)
  , protocol_(bus::makeProtocol(configuration.bus))
  , line_(port_, *protocol_, clock_, bus::makeTiming(configuration.bus))
  , coordinator_(configuration, line_)
  , loop_(coordinator_, line_, clock_, mutex_)
  , bounds_(coordinator_.bounds())
  , writes_(scene.inverters.size())
  , cuts_(scene.inverters.size())
{
  line_.setGatewayTimeout(seconds(configuration.bus.gateway_timeout));
  simulated_.setObserver([this](const simulation::FrameRecord& frame) {
    frames_.push_back(frame);
    if (frames_.size() > KEPT_FRAMES)
    {
      frames_.pop_front();
    }
    digest_.frame(frame);
    checker_.onFrame(clock_.now(), frame);
  });
  checker_.setClock([this] { return clock_.now(); });
  checker_.setBudgetWarns([this](std::size_t index) {
    const bus::Report report = coordinator_.report(clock_.now());
    const auto warns = [](const bus::Finding& finding) {
      return finding.text.find("can't be met for certain") != std::string::npos;
    };
    const auto& findings = report.inverters[index].findings;
    return std::any_of(findings.begin(), findings.end(), warns) ||
           std::any_of(report.findings.begin(), report.findings.end(), warns);
  });
}

TimePoint World::now() const
{
  return clock_.now();
}

TimePoint World::start() const
{
  return simulated_.start();
}

Checker& World::checker()
{
  return checker_;
}

const Scene& World::scene() const
{
  return scene_;
}

void World::at(Duration from_now, std::function<void()> action)
{
  clock_.at(clock_.now() + from_now, std::move(action));
}

void World::run(Duration duration)
{
  runUntil(duration, [] { return false; });
}

void World::pass(Duration duration)
{
  clock_.sleepUntil(clock_.now() + duration);
  simulated_.advance(clock_.now());
}

bool World::runUntil(Duration limit, const std::function<bool()>& condition)
{
  const TimePoint end = clock_.now() + limit;
  std::size_t idle_steps = 0;
  while (clock_.now() < end)
  {
    const TimePoint before = clock_.now();
    const TimePoint wake = loop_.step();
    idle_steps = clock_.now() == before && wake <= before ? idle_steps + 1 : 0;
    if (idle_steps > MOST_IDLE_STEPS)
    {
      throw Violation(before, "liveness", "the bus thread spins: it neither sends nor waits");
    }
    deliver();
    checker_.stepped(clock_.now());
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

void World::note(const std::string& text)
{
  events_.emplace_back(clock_.now(), text);
  if (events_.size() > KEPT_FRAMES)
  {
    events_.pop_front();
  }
}

void World::deliver()
{
  const bus::Outputs outputs = coordinator_.takeOutputs();
  digest_.outputs(clock_.now(), outputs);
  for (const bus::InverterStatus& status : outputs.statuses)
  {
    checker_.published(clock_.now(), status);
  }
  for (const bus::Finding& line : outputs.log)
  {
    checker_.logged(clock_.now(), line.text);
  }
  for (auto& answer : coordinator_.takeAnswers())
  {
    digest_.answer(clock_.now(), answer.second);
    answer.first(answer.second);
  }
}

// --- users -------------------------------------------------------------------------------------------------------------------

std::uint16_t World::command(const bus::VelocityCommand& command)
{
  const std::uint16_t result = coordinator_.command(clock_.now(), command);
  digest_.commanded(clock_.now(), result);
  std::ostringstream text;
  text << command.publisher.name << (command.publisher.latched ? " (latched)" : "") << " commands";
  for (const auto& target : command.targets)
  {
    text << " " << scene_.inverters[target.first].name << " " << target.second;
  }
  text << " -> " << std::hex << std::uppercase << result;
  note(text.str());
  checker_.commanded(clock_.now(), command, result);
  return result;
}

void World::stop(std::optional<std::size_t> index, std::uint8_t mode, std::function<void(const bus::Answer&)> answered)
{
  const TimePoint asked_at = clock_.now();
  const std::string what = index ? "stop of " + scene_.inverters[*index].name : std::string("stop of all");
  note(what);
  const auto callback = checker_.asked(asked_at, what, bounds_.stop, [this, index, asked_at](const bus::Answer&) {
    for (std::size_t one = 0; one < scene_.inverters.size(); ++one)
    {
      if (!index || *index == one)
      {
        checker_.stopConfirmed(one, asked_at);
      }
    }
  });
  coordinator_.stop(asked_at, index, mode, [callback, answered](const bus::Answer& answer) {
    callback(answer);
    if (answered)
    {
      answered(answer);
    }
  });
  checker_.stopAsked(asked_at, index);
}

void World::reset(std::size_t index, std::function<void(const bus::Answer&)> answered)
{
  const std::string& name = scene_.inverters[index].name;
  note("reset of " + name);
  const Brand brand = scene_.inverters[index].brand;
  const std::string trips = checker_.value(index, "trips");
  const auto callback = checker_.asked(
      clock_.now(), "reset of " + name, bounds_.reset, [this, index, name, brand, trips](const bus::Answer& answer) {
        // The 3G3JE can't tell whether its trip is gone. A trip that the node has not seen yet is nothing to reset.
        const bool sent = answer.message.compare(0, 7, "no trip") != 0;
        const bool new_trip = checker_.value(index, "trips") != trips;
        if (brand != Brand::JE && sent && !new_trip && checker_.flag(index, "tripped"))
        {
          throw Violation(clock_.now(), "a service succeeds when the drive has confirmed", "reset of " + name);
        }
      });

  coordinator_.reset(clock_.now(), index, [callback, answered](const bus::Answer& answer) {
    callback(answer);
    if (answered)
    {
      answered(answer);
    }
  });
}

void World::readFaults(std::size_t index)
{
  const auto callback =
      checker_.asked(clock_.now(), "read_faults of " + scene_.inverters[index].name, bounds_.read_faults, nullptr);
  coordinator_.readFaults(clock_.now(), index, callback);
}

void World::readFixedParameter(std::size_t index)
{
  const InverterFacts& facts = scene_.inverters[index];
  const auto callback = checker_.asked(clock_.now(), "read_parameter of " + facts.name, bounds_.read_parameter,
                                       [this, &facts](const bus::Answer& answer) {
                                         if (std::fabs(answer.value - facts.fixed_value) > 1e-6)
                                         {
                                           throw Violation(clock_.now(), "no value from another request's reply",
                                                           facts.fixed_parameter + " of " + facts.name + " is " +
                                                               std::to_string(facts.fixed_value) + ", the answer is " +
                                                               std::to_string(answer.value));
                                         }
                                       });
  coordinator_.readParameter(clock_.now(), index, facts.fixed_parameter, callback);
}

void World::readUnknownParameter(std::size_t index)
{
  const auto callback = checker_.asked(clock_.now(), "read_parameter of nothing", bounds_.read_parameter, nullptr);
  coordinator_.readParameter(clock_.now(), index, "Z999", callback);
}

void World::writeFreeParameter(std::size_t index, double value, bool persist)
{
  const InverterFacts& facts = scene_.inverters[index];
  const TimePoint asked_at = clock_.now();
  writes_[index].emplace_back(asked_at, value);
  const auto judge = [this, index, &facts, value, asked_at](const bus::Answer&) {
    const double held = ram(index, facts.free_parameter);
    const bool powered = checker_.flag(index, "powered") && checker_.flag(index, "listening");
    // Another call may have written it since.
    const bool asked = std::any_of(writes_[index].begin(), writes_[index].end(), [&](const auto& write) {
      return asked_at - write.first < seconds(bounds_.write_parameter) && std::fabs(held - write.second) < 0.051;
    });
    // What is in the RAM gets lost with the supply.
    if (powered && !asked && cuts_[index] < asked_at)
    {
      throw Violation(
          clock_.now(), "a service succeeds when the drive has confirmed",
          "write_parameter of " + facts.name + ": " + std::to_string(value) + " is " + std::to_string(held));
    }
  };
  const auto callback = checker_.asked(asked_at, "write_parameter of " + facts.name, bounds_.write_parameter, judge);
  coordinator_.writeParameter(clock_.now(), index, facts.free_parameter, value, persist, callback);
}

void World::beginShutdown()
{
  note("shutdown");
  checker_.shutdownBegun(clock_.now());
  coordinator_.beginShutdown(clock_.now());
}

bool World::shutdownDone()
{
  return coordinator_.shutdownDone(clock_.now());
}

void World::endShutdown(TimePoint begun)
{
  const TimePoint now = clock_.now();
  const std::vector<std::string> unconfirmed = coordinator_.endShutdown();
  deliver();
  for (const std::string& text : unconfirmed)
  {
    digest_.unconfirmed(text);
  }
  checker_.shutdownEnded(now, begun, unconfirmed);
}

double World::ram(std::size_t index, const std::string& parameter) const
{
  simulation::KeyValues values;
  simulated_.drives()[index]->parameter(parameter, values);
  for (const auto& value : values)
  {
    if (value.first == "ram")
    {
      return std::stod(value.second);
    }
  }
  return 0.0;
}

// --- the world ---------------------------------------------------------------------------------------------------------------

bool World::provoke(const std::string& command)
{
  note(command);
  checker_.glance(clock_.now());
  const bool done = simulated_.command(command, clock_.now()).compare(0, 2, "ok") == 0;
  checker_.glance(clock_.now());
  return done;
}

void World::cutPower(std::size_t index, double duration)
{
  const InverterFacts& facts = scene_.inverters[index];
  cuts_[index] = clock_.now();
  checker_.lostPower(clock_.now(), index);
  if (facts.brand == Brand::TOSHIBA)
  {
    // It starts anew and is deaf for a second, however short the cut: only by that a driver can see it between two
    // exchanges that repeat the words in force (rule 4.1).
    provoke(facts.name + " power off");
    at(seconds(duration), [this, &facts] { provoke(facts.name + " power on"); });
    return;
  }
  provoke(facts.name + " power_cycle " + std::to_string(duration));
}

std::string World::lastFrames(std::size_t count) const
{
  std::ostringstream text;
  text << std::fixed;
  text.precision(6);
  auto event = events_.begin();
  const auto tellUntil = [&](TimePoint time) {
    for (; event != events_.end() && event->first <= time; ++event)
    {
      text << "  " << toSeconds(event->first - simulated_.start()) << " ----- " << event->second << "\n";
    }
  };
  const std::size_t first = frames_.size() - std::min(count, frames_.size());
  for (std::size_t index = first; index < frames_.size(); ++index)
  {
    while (index == first && event != events_.end() && event->first < frames_[index].time)
    {
      ++event;
    }
    tellUntil(frames_[index].time);
    text << "  " << simulation::frameText(frames_[index], simulated_.start()) << "\n";
  }
  tellUntil(clock_.now());
  return text.str();
}

std::string World::digest() const
{
  Digest digest = digest_;
  digest.report(coordinator_.report(clock_.now()));
  return digest.text();
}

std::string World::state() const
{
  std::ostringstream text;
  for (std::size_t index = 0; index < scene_.inverters.size(); ++index)
  {
    text << "  " << scene_.inverters[index].name << ":";
    if (checker_.hasStatus(index))
    {
      const bus::InverterStatus& status = checker_.status(index);
      text << " offline " << status.communication_error << " locked " << status.locked << " stop " << status.stop_active
           << " run_command " << status.run_command << " error " << status.error_id << " age "
           << toSeconds(clock_.now() - status.stamp);
    }
    for (const auto& value : simulated_.drives()[index]->describe())
    {
      text << " " << value.first << "=" << value.second;
    }
    text << "\n";
  }
  return text.str();
}
}  // namespace fuzz
}  // namespace inverter_bus
