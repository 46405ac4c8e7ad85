// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "fuzz/bus/game.h"

#include <cmath>
#include <optional>

namespace inverter_bus
{
namespace fuzz
{
namespace
{
constexpr double SLOW_REPLIES_LOST = 0.1;
constexpr double SHUTDOWN_S = 15.0;  // with what comes before it
}  // namespace

Game::Game(World& world, std::uint64_t seed)
  : stage_(world, seed)
  , pace_(stage_.dice.any<double>({ 0.05, 0.15, 0.3, 0.6 }))
  , streams_(stage_)
  , users_(stage_, streams_)
  , harm_(stage_, streams_, stage_.dice.hits(0.5))
  , harm_share_(stage_.dice.any<double>({ 0.0, 0.05, 0.1, 0.25, 0.5 }))
{
}

void Game::play(Duration duration)
{
  World& world = stage_.world;
  if (stage_.dice.hits(0.1) && world.scene().inverters.front().brand == Brand::HITACHI)
  {
    // A RUN was left on.
    world.provoke("bus foreign 01 05 00 00 FF 00");
    world.pass(seconds(0.3));
  }
  stage_.acting = true;
  stage_.streaming = true;
  // Sometimes a live stream waits for the node to start.
  if (stage_.dice.hits(0.5))
  {
    streams_.begin(stage_.anyone());
  }
  if (stage_.limits_dice.hits(SLOW_REPLIES_LOST))
  {
    const std::size_t index = stage_.limits_dice.below(stage_.inverters());
    world.at(seconds(toSeconds(duration) * 0.2), [&world, index] { world.loseSlowReplies(index); });
    world.at(seconds(toSeconds(duration) * 0.95), [&world] { world.loseSlowReplies(std::nullopt); });
  }
  scheduleAct();
  world.run(duration);
  end();
}

void Game::end()
{
  stage_.acting = false;
  stage_.streaming = false;
}

void Game::calmDown()
{
  Calm(stage_, streams_).play();
}

void Game::shutDown()
{
  World& world = stage_.world;
  stage_.acting = true;
  stage_.streaming = true;
  scheduleAct();
  std::optional<TimePoint> begun;
  world.at(seconds(stage_.dice.between(0.001, 2.0)), [&world, &begun] {
    begun = world.now();
    world.beginShutdown();
  });
  stage_.require(seconds(SHUTDOWN_S), "the end of the program",
                 [&world, &begun] { return begun.has_value() && world.shutdownDone(); });
  end();
  world.endShutdown(*begun);
}

void Game::scheduleAct()
{
  // Times of their own, not those of exchanges: in the middle of one, mostly.
  stage_.world.at(seconds(-pace_ * std::log(1.0 - stage_.dice.chance()) + 1e-6), [this] {
    if (!stage_.acting)
    {
      return;
    }
    if (stage_.dice.hits(harm_share_))
    {
      harm_.act();
    }
    else
    {
      users_.act();
    }
    scheduleAct();
  });
}
}  // namespace fuzz
}  // namespace inverter_bus
