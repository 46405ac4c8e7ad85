// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "fuzz/bus/calm.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "fuzz/bus/violation.h"

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
constexpr double SPEED_TOLERANCE_HZ = 0.2;
constexpr char PUBLISHER[] = "/calm";
}  // namespace

Calm::Calm(Stage& stage, Streams& streams) : stage_(stage), streams_(streams)
{
}

void Calm::play()
{
  mendEverything();
  requireEveryDriveBack();
  requireEveryStop();
  stage_.require(seconds(ANSWERED_S), "every call is answered",
                 [this] { return stage_.world.checker().openCalls() == 0; });
  resetAll();
  requireOpenLocks();
  startAll();
  runAll();
  stopAll();
}

void Calm::mendEverything()
{
  World& world = stage_.world;
  world.provoke("bus plug");
  world.provoke("bus silent off");
  world.disturb();
  for (std::size_t index = 0; index < stage_.inverters(); ++index)
  {
    for (const char* mend : { "clear", "online", "power on", "panel_release", "sto off" })
    {
      world.provoke(stage_.nameOf(index) + " " + mend);
    }
  }
}

void Calm::requireEveryDriveBack()
{
  const World& world = stage_.world;
  const TimePoint mended_at = world.now();
  const double share = SLOW_REFRESH_S * static_cast<double>(stage_.inverters());
  // One probe that waits a whole long response_timeout uses up the share of more than 3 s.
  const double back = std::max(BACK_S, toSeconds(world.scene().longestProbe()) / PROBE_SHARE);
  const double limit = DEAF_S + back + share + 2.0 * world.scene().interval;
  stage_.require(seconds(limit), "every drive is back", [this, &world, mended_at] {
    return stage_.allOf([&world, mended_at](std::size_t index) {
      return world.checker().observed().online(index) && world.told(index).status.stamp > mended_at;
    });
  });
}

void Calm::requireEveryStop()
{
  World& world = stage_.world;
  world.calls().stop(std::nullopt, 0, nullptr);
  const TimePoint stopped_at = world.now();
  stage_.require(seconds(SETTLED_S + 2.0 * world.scene().interval), "every stop is confirmed", [&] {
    return stage_.allOf([&](std::size_t index) {
      const bus::InverterStatus& status = world.told(index).status;
      return !status.stop_active && status.stamp > stopped_at;
    });
  });
}

void Calm::requireOpenLocks()
{
  const World& world = stage_.world;
  const double cycle = world.scene().interval;
  const double share = SLOW_REFRESH_S * static_cast<double>(stage_.inverters());
  // That it is open shows in the next status.
  stage_.require(seconds(UNLOCKED_S + share + 2.0 * cycle), "every lock opens, every status is fresh", [&] {
    return stage_.allOf([&](std::size_t index) {
      const bus::InverterStatus& status = world.told(index).status;
      return world.checker().observed().online(index) && !status.locked && !status.stop_active &&
             world.now() - status.stamp < seconds(1.0 + share + 5.0 * cycle);
    });
  });
}

void Calm::resetAll()
{
  for (std::size_t index = 0; index < stage_.inverters(); ++index)
  {
    std::string failure = "no answer";
    bool asked = false;
    // Its identity may not have been read yet.
    stage_.require(seconds(RESET_S), "reset of " + stage_.nameOf(index), [&] {
      if (!asked && !failure.empty())
      {
        asked = true;
        stage_.world.calls().reset(index, [&](const bus::Answer& answer) {
          asked = false;
          failure = answer.success ? "" : answer.message;
        });
      }
      return failure.empty();
    });
  }
}

/// A drive that was reset restarts, and is read before it gets a command: a refused command is retried.
void Calm::startAll()
{
  std::vector<bool> started(stage_.inverters(), false);
  for (int attempt = 0; attempt < MOST_ATTEMPTS && std::count(started.begin(), started.end(), false) > 0; ++attempt)
  {
    stage_.world.run(seconds(attempt == 0 ? 0.0 : PAUSE_S + stage_.world.scene().interval));
    for (std::size_t index = 0; index < started.size(); ++index)
    {
      started[index] = started[index] || streams_.beginSteady(index, PUBLISHER);
    }
  }
  for (std::size_t index = 0; index < started.size(); ++index)
  {
    if (!started[index])
    {
      fail(stage_.world.now(), "liveness",
           stage_.nameOf(index) + " refuses every command after everything has come back\n" + stage_.world.state());
    }
  }
}

void Calm::runAll()
{
  std::vector<int> locked(stage_.inverters(), 0);
  const double each = RUN_EACH_S * static_cast<double>(stage_.inverters());
  const double limit = RUN_S + each + 2.0 * PAUSE_S + 2.0 * stage_.world.scene().interval;
  stage_.require(seconds(limit), "every motor runs", [this, &locked] {
    return stage_.allOf([this, &locked](std::size_t index) {
      startAgain(index, locked[index]);
      return runs(index);
    });
  });
  stage_.world.run(seconds(0.3));
  stage_.streaming = false;
}

/// A drive that reports late that it had restarted is stopped and locked once more: its user is silent, and tries
/// again.
void Calm::startAgain(std::size_t index, int& times)
{
  if (streams_.isOn(index) && stage_.world.told(index).status.locked && times < MOST_ATTEMPTS)
  {
    ++times;
    streams_.pause(index);
    stage_.world.at(seconds(PAUSE_S), [this, index] { streams_.resumeSteady(index, PUBLISHER); });
  }
}

bool Calm::runs(std::size_t index) const
{
  const Truth truth = stage_.world.checker().plant().truth(index);
  const double wanted = streams_.hertz(index);
  return std::fabs(truth.hertz - std::fabs(wanted)) < SPEED_TOLERANCE_HZ && truth.direction == (wanted < 0.0 ? -1 : 1);
}

void Calm::stopAll()
{
  bool done = false;
  std::string failure;
  stage_.world.calls().stop(std::nullopt, 0, [&](const bus::Answer& answer) {
    done = true;
    failure = answer.success ? "" : answer.message;
  });
  stage_.require(seconds(60.0), "the stop is answered", [&] { return done; });
  if (!failure.empty())
  {
    fail(stage_.world.now(), "liveness", "stop: " + failure + "\n" + stage_.world.state());
  }
}
}  // namespace fuzz
}  // namespace inverter_bus
