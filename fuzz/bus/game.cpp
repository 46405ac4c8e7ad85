// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "fuzz/bus/game.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace inverter_bus
{
namespace fuzz
{
namespace
{
// A drive that was switched on is deaf for 1 s; with a margin.
constexpr double DEAF_S = 2.5;
constexpr double BACK_S = 3.0;  // rule 3.7
constexpr double PROBE_SHARE = 0.05;
constexpr double SETTLED_S = 12.0;
constexpr double SLOW_REFRESH_S = 0.4;  // of one inverter at 9600 baud beside services
constexpr double ANSWERED_S = 60.0;     // each call has its own, shorter bound, which the checker knows
constexpr double UNLOCKED_S = 7.0;
constexpr int MOST_ATTEMPTS = 4;
constexpr double PAUSE_S = 2.0;
constexpr double RESET_S = 40.0;
constexpr double RUN_EACH_S = 1.2;  // where every drive has a time-out of its own that is hard to meet
constexpr double RUN_S = 4.0;
constexpr double SHUTDOWN_S = 15.0;  // with what comes before it
constexpr double STREAM_PERIOD_S = 0.1;
constexpr double WAVER_HZ = 0.1;
constexpr unsigned WAVER_STEPS = 30;
constexpr double SPEED_TOLERANCE_HZ = 0.2;
}  // namespace

Game::Game(World& world, std::uint64_t seed)
  : world_(world)
  , dice_(seed * 2654435761U + 12345U)
  , limits_dice_(seed * 40503U + 99991U)
  , streams_(world.scene().inverters.size())
{
  pace_ = dice_.any<double>({ 0.05, 0.15, 0.3, 0.6 });
  refuses_ = dice_.hits(0.5);
  harm_share_ = dice_.any<double>({ 0.0, 0.05, 0.1, 0.25, 0.5 });
}

std::size_t Game::anyone()
{
  return dice_.below(streams_.size());
}

const std::string& Game::nameOf(std::size_t index) const
{
  return world_.scene().inverters[index].name;
}

double Game::anySpeed(std::size_t index)
{
  const InverterFacts& facts = world_.scene().inverters[index];
  const double hertz = dice_.between(facts.lowest_hz, facts.highest_hz);
  return dice_.hits(0.3) ? -hertz : hertz;
}

std::string Game::anyPublisher()
{
  return dice_.hits(0.75) ? "/one" : (dice_.hits(0.7) ? "/two" : "/three");
}

bool Game::allOf(const std::function<bool(std::size_t)>& condition) const
{
  for (std::size_t index = 0; index < streams_.size(); ++index)
  {
    if (!condition(index))
    {
      return false;
    }
  }
  return true;
}

// --- play --------------------------------------------------------------------------------------------------------------------

void Game::play(Duration duration)
{
  if (dice_.hits(0.1) && world_.scene().inverters.front().brand == Brand::HITACHI)
  {
    // Somebody has left RUN on.
    world_.provoke("bus foreign 01 05 00 00 FF 00");
    world_.pass(seconds(0.3));
  }
  acting_ = true;
  streaming_ = true;
  // Sometimes a live stream waits for the node to start.
  if (dice_.hits(0.5))
  {
    beginStream(anyone());
  }
  scheduleAct();
  world_.run(duration);
  acting_ = false;
  streaming_ = false;
}

void Game::shutDown()
{
  acting_ = true;
  streaming_ = true;
  scheduleAct();
  std::optional<TimePoint> begun;
  world_.at(seconds(dice_.between(0.001, 2.0)), [this, &begun] {
    begun = world_.now();
    world_.beginShutdown();
  });
  require(seconds(SHUTDOWN_S), "the end of the program",
          [this, &begun] { return begun.has_value() && world_.shutdownDone(); });
  acting_ = false;
  streaming_ = false;
  world_.endShutdown(*begun);
}

void Game::scheduleAct()
{
  // Times of their own, not those of exchanges: in the middle of one, mostly.
  world_.at(seconds(-pace_ * std::log(1.0 - dice_.chance()) + 1e-6), [this] {
    if (acting_)
    {
      act();
      scheduleAct();
    }
  });
}

void Game::act()
{
  if (dice_.hits(harm_share_))
  {
    harm();
  }
  else
  {
    use();
  }
}

void Game::use()
{
  const double dice = dice_.chance();
  if (dice < 0.6)
  {
    move();
  }
  else if (dice < 0.75)
  {
    stopSomething();
  }
  else if (dice < 0.98)
  {
    callService(anyone());
  }
  else
  {
    storm();
  }
}

void Game::move()
{
  const double dice = dice_.chance();
  const std::size_t index = anyone();
  if (dice < 0.5)
  {
    beginStream(index);
  }
  else if (dice < 0.65)
  {
    sendVelocity(index, anySpeed(index), anyPublisher());
  }
  else if (dice < 0.78)
  {
    sendVelocity(index, 0.0, anyPublisher());
  }
  else if (dice < 0.88)
  {
    sendGroup();
  }
  else if (dice < 0.94)
  {
    sendLatched(index);
  }
  else
  {
    sendNonsense(index);
  }
}

void Game::beginStream(std::size_t index)
{
  Stream& stream = streams_[index];
  stream.on = true;
  stream.hertz = anySpeed(index);
  stream.drift = dice_.hits(0.3) ? 0.05 : 0.0;
  stream.wavers = false;
  stream.grouped = false;
  stream.period = dice_.any<double>({ 0.02, 0.05, 0.1, 0.1, 0.25 });
  stream.until = world_.now() + seconds(dice_.between(0.3, 6.0));
  stream.publisher = anyPublisher();
  stream.dips = limits_dice_.hits(0.2);
  tickStream(index, ++stream.number);
}

void Game::tickStream(std::size_t index, unsigned number)
{
  Stream& stream = streams_[index];
  if (!streaming_ || !stream.on || stream.number != number)
  {
    return;
  }
  if (world_.now() >= stream.until)
  {
    stream.on = false;
    if (dice_.hits(0.5))
    {
      sendVelocity(index, 0.0, stream.publisher);
    }
    return;
  }
  stream.hertz += stream.hertz > 0.0 ? stream.drift : -stream.drift;
  if (stream.wavers)
  {
    const double lowest = world_.scene().inverters[index].lowest_hz;
    stream.hertz = std::copysign(lowest + WAVER_HZ * (stream.sent++ % WAVER_STEPS), stream.hertz);
  }
  if (stream.dips && limits_dice_.hits(0.15))
  {
    sendNearZero(index, stream.publisher);
  }
  else
  {
    sendStream(index, stream);
  }
  world_.at(seconds(stream.period), [this, index, number] { tickStream(index, number); });
}

/// Alone, or in one message with those that waver beside it.
void Game::sendStream(std::size_t index, const Stream& stream)
{
  if (!stream.grouped)
  {
    sendVelocity(index, stream.hertz, stream.publisher);
    return;
  }
  bus::VelocityCommand command;
  command.publisher.name = stream.publisher;
  command.publisher.topic = "command";
  command.grouped = true;
  for (std::size_t one = 0; one < streams_.size(); ++one)
  {
    const Stream& other = streams_[one];
    if (one == index || (other.on && other.grouped))
    {
      command.targets.emplace_back(one, other.hertz / world_.scene().inverters[one].hz_per_unit);
    }
  }
  world_.command(command);
}

void Game::sendVelocity(std::size_t index, double hertz, const std::string& publisher)
{
  const InverterFacts& facts = world_.scene().inverters[index];
  bus::VelocityCommand command;
  command.targets = { { index, hertz == 0.0 ? 0.0 : hertz / facts.hz_per_unit } };
  command.publisher.name = publisher;
  command.publisher.topic = facts.name + "/command";
  world_.command(command);
}

/// What nobody would call a movement, in the user's unit.
double Game::nearZero(std::size_t index)
{
  const InverterFacts& facts = world_.scene().inverters[index];
  const double rounds_to_zero = 0.001 / std::fabs(facts.hz_per_unit);
  const double below = facts.min_velocity > 0.0 && limits_dice_.hits(0.5) ? 0.9 * facts.min_velocity : rounds_to_zero;
  return limits_dice_.any<double>({ below, -below, 5e-14 });
}

void Game::sendNearZero(std::size_t index, const std::string& publisher)
{
  bus::VelocityCommand command;
  command.targets = { { index, nearZero(index) } };
  command.publisher.name = publisher;
  command.publisher.topic = nameOf(index) + "/command";
  world_.command(command);
}

void Game::sendLatched(std::size_t index)
{
  const InverterFacts& facts = world_.scene().inverters[index];
  bus::VelocityCommand command;
  command.targets = { { index, anySpeed(index) / facts.hz_per_unit } };
  command.publisher.name = dice_.hits(0.5) ? "/latch" : "/one";
  command.publisher.topic = facts.name + "/command";
  command.publisher.latched = true;
  command.publisher.first_on_connection = dice_.hits(0.7);
  command.publisher.before_start = dice_.hits(0.3);
  if (limits_dice_.hits(0.2))
  {
    command.targets.front().second = nearZero(index);
  }
  world_.command(command);
}

void Game::sendGroup()
{
  bus::VelocityCommand command;
  command.publisher.name = anyPublisher();
  command.publisher.topic = "command";
  command.grouped = true;
  for (std::size_t index = 0; index < streams_.size(); ++index)
  {
    if (dice_.hits(0.6))
    {
      const double hertz = dice_.hits(0.2) ? 0.0 : anySpeed(index);
      command.targets.emplace_back(index, hertz / world_.scene().inverters[index].hz_per_unit);
      double& velocity = command.targets.back().second;
      const double dice = limits_dice_.chance();
      // Beyond the maximum, a little and far; near zero.
      velocity = dice < 0.1 ? 1.5 * velocity : (dice < 0.15 ? 20.0 * velocity : velocity);
      velocity = dice > 0.9 ? nearZero(index) : velocity;
    }
  }
  if (!command.targets.empty())
  {
    world_.command(command);
  }
}

void Game::sendNonsense(std::size_t index)
{
  bus::VelocityCommand command;
  const std::vector<double> values{ std::numeric_limits<double>::quiet_NaN(),
                                    std::numeric_limits<double>::infinity(),
                                    -std::numeric_limits<double>::infinity(),
                                    1e6,
                                    -1e6,
                                    1e-9 };
  command.targets = { { index, dice_.any(values) } };
  command.publisher.name = anyPublisher();
  command.publisher.topic = nameOf(index) + "/command";
  world_.command(command);
}

/// Many commands and calls within a moment.
void Game::storm()
{
  const std::size_t count = 10 + dice_.below(30);
  const bool calls = dice_.hits(0.5);
  for (std::size_t number = 0; number < count; ++number)
  {
    world_.at(seconds(dice_.between(0.0, 0.3)), [this, calls] {
      const std::size_t index = anyone();
      if (!acting_)
      {
        return;
      }
      if (calls)
      {
        callService(index);
      }
      else
      {
        sendVelocity(index, anySpeed(index), anyPublisher());
      }
    });
  }
}

void Game::stopSomething()
{
  const std::size_t index = anyone();
  const bool all = dice_.hits(0.25);
  const auto mode = static_cast<std::uint8_t>(dice_.hits(0.7) ? 0 : dice_.below(5));
  world_.at(seconds(dice_.between(0.0, 0.05)), [this, index, all, mode] {
    world_.stop(all ? std::optional<std::size_t>() : std::optional<std::size_t>(index), mode, nullptr);
  });
}

void Game::callService(std::size_t index)
{
  const InverterFacts& facts = world_.scene().inverters[index];
  const double dice = dice_.chance();
  if (dice < 0.3)
  {
    world_.reset(index, nullptr);
    if (dice_.hits(0.2))
    {
      // Somebody else asks for it, too.
      world_.at(seconds(dice_.between(0.0, 1.0)), [this, index] { world_.reset(index, nullptr); });
    }
  }
  else if (dice < 0.4)
  {
    world_.readFaults(index);
  }
  else if (dice < 0.75 && !facts.fixed_parameter.empty())
  {
    world_.readFixedParameter(index);
  }
  else if (dice < 0.8)
  {
    world_.readUnknownParameter(index);
  }
  else if (!facts.free_parameter.empty())
  {
    world_.writeFreeParameter(index, 1.0 + static_cast<double>(dice_.below(3)), dice_.hits(0.5));
  }
}

// --- harm --------------------------------------------------------------------------------------------------------------------

void Game::harm()
{
  const double dice = dice_.chance();
  if (dice < 0.55)
  {
    harmReplies(anyone());
  }
  else if (dice < 0.85)
  {
    harmDrive(anyone());
  }
  else if (dice < 0.93)
  {
    harmLine();
  }
  else if (dice < 0.97)
  {
    killSeveral();
  }
  else
  {
    failWhileItChanges();
  }
}

void Game::harmReplies(std::size_t index)
{
  const InverterFacts& facts = world_.scene().inverters[index];
  const std::string late = "late " + std::to_string(facts.response_timeout * dice_.between(0.5, 3.0));
  std::string refusal = facts.brand == Brand::HITACHI ? "exception 34"
                        : facts.brand == Brand::JE    ? "exception 8707"
                                                      : "exception 4";
  // A refusal that is then made another request's answer would look like the right one.
  refusal = refuses_ ? refusal : "lost_reply";
  const std::vector<std::string> faults{
    "damaged",   "truncated", "truncated 1",     late,
    late,        "noise 4",   "foreign station", refuses_ ? "damaged" : "foreign shape",
    refusal,     refusal,     "lost_request",    "lost_reply",
    "lost_reply"
  };
  world_.provoke(facts.name + " " + dice_.any(faults) + " count " +
                 std::to_string(1 + dice_.below(dice_.hits(0.8) ? 1 : 6)));
}

void Game::harmDrive(std::size_t index)
{
  const std::string& name = nameOf(index);
  const double dice = dice_.chance();
  if (dice < 0.3)
  {
    world_.cutPower(index, dice_.any<double>({ 0.02, 0.02, 0.3, 1.2, 3.0 }));
  }
  else if (dice < 0.5)
  {
    world_.provoke(name + " offline " + std::to_string(dice_.any<double>({ 0.1, 0.4, 2.0, 6.0 })));
  }
  else if (dice < 0.65)
  {
    const bool rx = world_.scene().inverters[index].drive == "omron_rx";
    world_.provoke(name + " trip " + std::to_string(1 + dice_.below(7)) +
                   (rx && limits_dice_.hits(0.4) ? " state 7" : ""));
  }
  else if (dice < 0.75)
  {
    world_.provoke(name + " panel_stop");
  }
  else if (dice < 0.83)
  {
    world_.provoke(name + " panel " + std::to_string(dice_.hits(0.5) ? 0.0 : dice_.between(5.0, 40.0)));
    world_.at(seconds(dice_.between(0.2, 3.0)), [this, name] { world_.provoke(name + " panel_release"); });
  }
  else if (dice < 0.93)
  {
    world_.provoke(name + " sto on");
    world_.at(seconds(dice_.between(0.1, 2.0)), [this, name] { world_.provoke(name + " sto off"); });
  }
  else
  {
    world_.provoke(name + " busy " + std::to_string(dice_.between(0.1, 1.5)));
  }
}

void Game::harmLine()
{
  const double dice = dice_.chance();
  if (dice < 0.35)
  {
    world_.provoke("bus unplug " + std::to_string(dice_.between(0.05, 1.5)));
  }
  else if (dice < 0.5)
  {
    world_.provoke("bus silent " + std::to_string(dice_.between(0.05, 1.0)));
    world_.checker().disturbed(world_.now());
  }
  else if (dice < 0.75 && !world_.scene().compoway)
  {
    // A block check character of CompoWay/F is a XOR: two bytes damaged alike get through.
    world_.checker().disturbed(world_.now());
    world_.provoke("bus noise " + std::to_string(1 + dice_.below(8)));
  }
  else
  {
    // A second master that speaks to a station that is not on this bus.
    world_.checker().disturbed(world_.now());
    world_.provoke(world_.scene().compoway ? "bus foreign 770000601" : "bus foreign 4D 03 10 00 00 02");
  }
}

void Game::killSeveral()
{
  const double duration = dice_.between(1.0, 8.0);
  for (std::size_t index = 0; index < streams_.size(); ++index)
  {
    if (dice_.hits(0.6))
    {
      world_.provoke(nameOf(index) + " offline " + std::to_string(duration * dice_.between(0.5, 1.0)));
    }
  }
}

/// A drive dies, or only its writes, reads or long replies do, while its own velocity changes; its neighbours are
/// commanded as well.
void Game::failWhileItChanges()
{
  const std::size_t index = anyone();
  const double period = dice_.any<double>({ 0.01, 0.02, 0.05, 0.05, 0.1, 0.25, 1.0 });
  const double duration = dice_.between(2.0, 6.0);
  const bool grouped = dice_.hits(0.3);
  for (std::size_t one = 0; one < streams_.size(); ++one)
  {
    if (one == index || dice_.hits(0.5))
    {
      beginStream(one);
      Stream& stream = streams_[one];
      stream.wavers = true;
      stream.grouped = grouped;
      stream.drift = 0.0;
      stream.period = period;
      stream.until = world_.now() + seconds(1.0 + duration);
    }
  }
  const double dice = dice_.chance();
  const std::string length = " for " + std::to_string(duration);
  world_.at(seconds(dice_.between(0.2, 1.0)), [this, index, dice, duration, length] {
    if (!acting_)
    {
      return;
    }
    if (dice < 0.4)
    {
      world_.cutPower(index, duration);
      return;
    }
    const std::string fault = dice < 0.6   ? "lost_request writes"
                              : dice < 0.8 ? "lost_reply reads"
                                           : "damaged longer " + std::string(dice < 0.9 ? "9" : "12");
    world_.provoke(nameOf(index) + " " + fault + length);
  });
}

// --- calm --------------------------------------------------------------------------------------------------------------------

void Game::require(Duration limit, const std::string& rule, const std::function<bool()>& condition)
{
  if (!world_.runUntil(limit, condition))
  {
    throw Violation(world_.now(), "liveness",
                    rule + " within " + std::to_string(toSeconds(limit)) + " s\n" + world_.state());
  }
}

void Game::mendEverything()
{
  world_.provoke("bus plug");
  world_.provoke("bus silent off");
  world_.checker().disturbed(world_.now());
  for (std::size_t index = 0; index < streams_.size(); ++index)
  {
    const std::string& name = nameOf(index);
    for (const char* mend : { "clear", "online", "power on", "panel_release", "sto off" })
    {
      world_.provoke(name + " " + mend);
    }
  }
}

void Game::calmDown()
{
  const double cycle = world_.scene().interval;
  mendEverything();
  const TimePoint mended_at = world_.now();
  const auto heardSince = [this](TimePoint time) {
    return allOf([this, time](std::size_t index) {
      return world_.checker().online(index) && world_.checker().status(index).stamp > time;
    });
  };
  const double share = SLOW_REFRESH_S * static_cast<double>(streams_.size());
  // One probe that waits a whole long response_timeout uses up the share of more than 3 s.
  const double back = std::max(BACK_S, toSeconds(world_.scene().longestProbe()) / PROBE_SHARE);
  require(seconds(DEAF_S + back + share + 2.0 * cycle), "every drive is back",
          [&heardSince, mended_at] { return heardSince(mended_at); });
  world_.stop(std::nullopt, 0, nullptr);
  const TimePoint stopped_at = world_.now();
  require(seconds(SETTLED_S + 2.0 * cycle), "every stop is confirmed", [this, stopped_at] {
    return allOf([this, stopped_at](std::size_t index) {
      const bus::InverterStatus& status = world_.checker().status(index);
      return !status.stop_active && status.stamp > stopped_at;
    });
  });
  require(seconds(ANSWERED_S), "every call is answered", [this] { return world_.checker().openCalls() == 0; });
  resetAll();
  // That it is open shows in the next status.
  require(seconds(UNLOCKED_S + share + 2.0 * cycle), "every lock opens, every status is fresh", [this, cycle] {
    return allOf([this, cycle](std::size_t index) {
      const bus::InverterStatus& status = world_.checker().status(index);
      return world_.checker().online(index) && !status.locked && !status.stop_active &&
             world_.now() - status.stamp <
                 seconds(1.0 + SLOW_REFRESH_S * static_cast<double>(streams_.size()) + 5.0 * cycle);
    });
  });
  runAll();
  stopAll();
}

void Game::resetAll()
{
  for (std::size_t index = 0; index < streams_.size(); ++index)
  {
    std::string failure = "no answer";
    bool asked = false;
    // Its identity may not have been read yet.
    require(seconds(RESET_S), "reset of " + nameOf(index), [&] {
      if (!asked && !failure.empty())
      {
        asked = true;
        world_.reset(index, [&](const bus::Answer& answer) {
          asked = false;
          failure = answer.success ? "" : answer.message;
        });
      }
      return failure.empty();
    });
  }
}

/// A drive that was reset starts anew, and is read before it gets a command: who is refused is asked to try again.
void Game::runAll()
{
  std::vector<bool> runs(streams_.size(), false);
  for (int attempt = 0; attempt < MOST_ATTEMPTS && std::count(runs.begin(), runs.end(), false) > 0; ++attempt)
  {
    world_.run(seconds(attempt == 0 ? 0.0 : PAUSE_S + world_.scene().interval));
    for (std::size_t index = 0; index < streams_.size(); ++index)
    {
      runs[index] = runs[index] || runOne(index);
    }
  }
  for (std::size_t index = 0; index < streams_.size(); ++index)
  {
    if (!runs[index])
    {
      throw Violation(world_.now(), "liveness",
                      nameOf(index) + " refuses every command after everything has come back\n" + world_.state());
    }
  }
  std::vector<int> locked(streams_.size(), 0);
  const double each = RUN_EACH_S * static_cast<double>(streams_.size());
  require(seconds(RUN_S + each + 2.0 * PAUSE_S + 2.0 * world_.scene().interval), "every motor runs", [this, &locked] {
    return allOf([this, &locked](std::size_t index) {
      startAgain(index, locked[index]);
      const Truth truth = world_.checker().truth(index);
      const double wanted = streams_[index].hertz;
      return std::fabs(truth.hertz - std::fabs(wanted)) < SPEED_TOLERANCE_HZ &&
             truth.direction == (wanted < 0.0 ? -1 : 1);
    });
  });
  world_.run(seconds(0.3));
  streaming_ = false;
}

/// A drive that tells late that it had started anew is stopped and locked once more: its user is silent, and tries again.
void Game::startAgain(std::size_t index, int& times)
{
  if (streams_[index].on && world_.checker().status(index).locked && times < MOST_ATTEMPTS)
  {
    ++times;
    streams_[index].on = false;
    world_.at(seconds(PAUSE_S), [this, index] {
      streams_[index].on = true;
      runOne(index);
    });
  }
}

bool Game::runOne(std::size_t index)
{
  const InverterFacts& facts = world_.scene().inverters[index];
  Stream& stream = streams_[index];
  stream.hertz = anySpeed(index);
  bus::VelocityCommand command;
  command.targets = { { index, stream.hertz / facts.hz_per_unit } };
  command.publisher.name = "/calm";
  command.publisher.topic = facts.name + "/command";
  if (world_.command(command) != 0)
  {
    return false;
  }
  streaming_ = true;
  stream.on = true;
  stream.drift = 0.0;
  stream.wavers = false;
  stream.grouped = false;
  stream.dips = false;
  stream.period = STREAM_PERIOD_S;
  stream.until = world_.now() + seconds(100.0);
  stream.publisher = "/calm";
  tickStream(index, ++stream.number);
  return true;
}

void Game::stopAll()
{
  bool done = false;
  std::string failure;
  world_.stop(std::nullopt, 0, [&](const bus::Answer& answer) {
    done = true;
    failure = answer.success ? "" : answer.message;
  });
  require(seconds(60.0), "the stop is answered", [&] { return done; });
  if (!failure.empty())
  {
    throw Violation(world_.now(), "liveness", "stop: " + failure + "\n" + world_.state());
  }
}
}  // namespace fuzz
}  // namespace inverter_bus
