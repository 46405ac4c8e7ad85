// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "fuzz/bus/world.h"

#include <algorithm>
#include <sstream>

#include "fuzz/bus/violation.h"

namespace inverter_bus
{
namespace fuzz
{
namespace
{
constexpr std::size_t MOST_IDLE_STEPS = 1000;

simulation::LineOptions lineOptions(std::uint64_t seed)
{
  simulation::LineOptions options;
  options.seed = seed;
  // As an adapter hands bytes over; a whole frame at its end would be later than a short time-out allows.
  options.delivery_step = std::chrono::milliseconds(2);
  return options;
}
}  // namespace

World::World(const Scene& scene, const bus::Configuration& configuration, std::uint64_t seed)
  : scene_(scene)
  , simulated_(simulation::busConfigFromText(scene.yaml), lineOptions(seed), clock_.now())
  , checker_(scene_, simulated_, clock_, [this](std::size_t index) { return driver_.budgetWarns(clock_.now(), index); })
  , story_(simulated_.start())
  , driver_(configuration, simulated_, clock_, checker_.line())
  , calls_(driver_.coordinator, checker_, story_, clock_)
{
  simulated_.setObserver([this](const simulation::FrameRecord& frame) {
    story_.frame(frame);
    digest_.frame(frame);
    checker_.line().frame(clock_.now(), frame);
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

Calls& World::calls()
{
  return calls_;
}

const Checker& World::checker() const
{
  return checker_;
}

const Told& World::told(std::size_t index) const
{
  return checker_.observed().inverters[index].told;
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
    const TimePoint wake = driver_.loop.step();
    idle_steps = clock_.now() == before && wake <= before ? idle_steps + 1 : 0;
    if (idle_steps > MOST_IDLE_STEPS)
    {
      fail(before, "liveness", "the bus thread spins: it neither sends nor waits");
    }
    deliver();
    checker_.line().stepped(clock_.now());
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

void World::deliver()
{
  const bus::Outputs outputs = driver_.coordinator.takeOutputs();
  digest_.outputs(clock_.now(), outputs);
  for (const bus::InverterStatus& status : outputs.statuses)
  {
    checker_.statuses().published(clock_.now(), status);
  }
  for (const bus::Finding& line : outputs.log)
  {
    checker_.statuses().logged(clock_.now(), line.text);
  }
  for (auto& answer : driver_.coordinator.takeAnswers())
  {
    digest_.answer(clock_.now(), answer.second);
    answer.first(answer.second);
  }
}

// --- users -----------------------------------------------------------------------------------------------------------

std::uint16_t World::command(const bus::VelocityCommand& command)
{
  const std::vector<bool> locked = driver_.locked(clock_.now(), command);
  const std::uint16_t result = driver_.coordinator.command(clock_.now(), command);
  digest_.commanded(clock_.now(), result);
  std::ostringstream text;
  text << command.publisher.name << (command.publisher.latched ? " (latched)" : "") << " commands";
  for (const auto& target : command.targets)
  {
    text << " " << scene_.inverters[target.first].name << " " << target.second;
  }
  text << " -> " << std::hex << std::uppercase << result;
  story_.event(clock_.now(), text.str());
  checker_.users().commanded(clock_.now(), command, locked, result);
  return result;
}

void World::beginShutdown()
{
  story_.event(clock_.now(), "shutdown");
  checker_.users().shutdownBegun(clock_.now());
  driver_.coordinator.beginShutdown(clock_.now());
}

bool World::shutdownDone()
{
  return driver_.coordinator.shutdownDone(clock_.now());
}

void World::endShutdown(TimePoint begun)
{
  const TimePoint now = clock_.now();
  const std::vector<std::string> unconfirmed = driver_.coordinator.endShutdown();
  deliver();
  for (const std::string& text : unconfirmed)
  {
    digest_.unconfirmed(text);
  }
  checker_.users().shutdownEnded(now, begun, unconfirmed);
}

// --- the world -------------------------------------------------------------------------------------------------------

void World::provoke(const std::string& command)
{
  story_.event(clock_.now(), command);
  checker_.glance(clock_.now());
  simulated_.command(command, clock_.now());
  checker_.glance(clock_.now());
}

void World::loseSlowReplies(std::optional<std::size_t> index)
{
  story_.event(clock_.now(),
               index ? scene_.title(*index) + " is not heard when it tells slow values" : "all are heard");
  driver_.port.on_the_way = [this, index](const wire::Bytes& frame) {
    const RequestFacts facts = readRequest(scene_, frame);
    if (index && facts.inverter == index && facts.reads_slow)
    {
      simulated_.command(scene_.inverters[*index].name + " lost_reply", clock_.now());
    }
  };
}

void World::cutPower(std::size_t index, double duration)
{
  const InverterFacts& facts = scene_.inverters[index];
  checker_.lostPower(clock_.now(), index);
  if (facts.brand == Brand::TOSHIBA)
  {
    // It restarts and is deaf for a second, however short the cut: only thus can a driver see it between two
    // exchanges that repeat the words in force (rule 4.1).
    provoke(facts.name + " power off");
    at(seconds(duration), [this, &facts] { provoke(facts.name + " power on"); });
    return;
  }
  provoke(facts.name + " power_cycle " + std::to_string(duration));
}

void World::disturb()
{
  checker_.disturbed(clock_.now());
}

std::string World::lastFrames(std::size_t count) const
{
  return story_.lastFrames(count);
}

std::string World::digest() const
{
  Digest digest = digest_;
  digest.report(driver_.coordinator.report(clock_.now()));
  return digest.text();
}

std::string World::state() const
{
  std::ostringstream text;
  for (std::size_t index = 0; index < scene_.inverters.size(); ++index)
  {
    text << "  " << scene_.inverters[index].name << ":";
    if (told(index).any)
    {
      const bus::InverterStatus& status = told(index).status;
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
