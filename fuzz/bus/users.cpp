// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "fuzz/bus/users.h"

#include <limits>
#include <optional>

namespace inverter_bus
{
namespace fuzz
{
Users::Users(Stage& stage, Streams& streams) : stage_(stage), streams_(streams)
{
}

void Users::act()
{
  const double dice = stage_.dice.chance();
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
    callService(stage_.anyone());
  }
  else
  {
    storm();
  }
}

void Users::move()
{
  const double dice = stage_.dice.chance();
  const std::size_t index = stage_.anyone();
  if (dice < 0.5)
  {
    streams_.begin(index);
  }
  else if (dice < 0.65)
  {
    streams_.sendAny(index);
  }
  else if (dice < 0.78)
  {
    streams_.send(index, 0.0, streams_.anyPublisher());
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

void Users::sendLatched(std::size_t index)
{
  const InverterFacts& facts = stage_.facts(index);
  bus::VelocityCommand command;
  command.targets = { { index, streams_.anySpeed(index) / facts.hz_per_unit } };
  command.publisher.name = stage_.dice.hits(0.5) ? "/latch" : "/one";
  command.publisher.topic = facts.name + "/command";
  command.publisher.latched = true;
  command.publisher.first_on_connection = stage_.dice.hits(0.7);
  command.publisher.before_start = stage_.dice.hits(0.3);
  if (stage_.limits_dice.hits(0.2))
  {
    command.targets.front().second = streams_.nearZero(index);
  }
  stage_.world.command(command);
}

void Users::sendGroup()
{
  bus::VelocityCommand command;
  command.publisher.name = streams_.anyPublisher();
  command.publisher.topic = "command";
  command.grouped = true;
  for (std::size_t index = 0; index < stage_.inverters(); ++index)
  {
    if (stage_.dice.hits(0.6))
    {
      const double hertz = stage_.dice.hits(0.2) ? 0.0 : streams_.anySpeed(index);
      command.targets.emplace_back(index, hertz / stage_.facts(index).hz_per_unit);
      double& velocity = command.targets.back().second;
      const double dice = stage_.limits_dice.chance();
      // Beyond the maximum, a little and far; near zero.
      velocity = dice < 0.1 ? 1.5 * velocity : (dice < 0.15 ? 20.0 * velocity : velocity);
      velocity = dice > 0.9 ? streams_.nearZero(index) : velocity;
    }
  }
  if (!command.targets.empty())
  {
    stage_.world.command(command);
  }
}

void Users::sendNonsense(std::size_t index)
{
  bus::VelocityCommand command;
  const std::vector<double> values{ std::numeric_limits<double>::quiet_NaN(),
                                    std::numeric_limits<double>::infinity(),
                                    -std::numeric_limits<double>::infinity(),
                                    1e6,
                                    -1e6,
                                    1e-9 };
  command.targets = { { index, stage_.dice.any(values) } };
  command.publisher.name = streams_.anyPublisher();
  command.publisher.topic = stage_.nameOf(index) + "/command";
  stage_.world.command(command);
}

/// Many commands and calls within a moment.
void Users::storm()
{
  const std::size_t count = 10 + stage_.dice.below(30);
  const bool calls = stage_.dice.hits(0.5);
  for (std::size_t number = 0; number < count; ++number)
  {
    stage_.world.at(seconds(stage_.dice.between(0.0, 0.3)), [this, calls] {
      const std::size_t index = stage_.anyone();
      if (!stage_.acting)
      {
        return;
      }
      if (calls)
      {
        callService(index);
      }
      else
      {
        streams_.sendAny(index);
      }
    });
  }
}

void Users::stopSomething()
{
  const std::size_t index = stage_.anyone();
  const bool all = stage_.dice.hits(0.25);
  const auto mode = static_cast<std::uint8_t>(stage_.dice.hits(0.7) ? 0 : stage_.dice.below(5));
  stage_.world.at(seconds(stage_.dice.between(0.0, 0.05)), [this, index, all, mode] {
    const auto which = all ? std::optional<std::size_t>() : std::optional<std::size_t>(index);
    stage_.world.calls().stop(which, mode, nullptr);
  });
}

void Users::callService(std::size_t index)
{
  const InverterFacts& facts = stage_.facts(index);
  Calls& calls = stage_.world.calls();
  const double dice = stage_.dice.chance();
  if (dice < 0.3)
  {
    callReset(index);
  }
  else if (dice < 0.4)
  {
    calls.readFaults(index);
  }
  else if (dice < 0.75 && !facts.fixed_parameter.empty())
  {
    calls.readFixedParameter(index);
  }
  else if (dice < 0.8)
  {
    calls.readUnknownParameter(index);
  }
  else if (!facts.free_parameter.empty())
  {
    const bool persist = stage_.dice.hits(0.5);
    calls.writeFreeParameter(index, 1.0 + static_cast<double>(stage_.dice.below(3)), persist);
  }
}

void Users::callReset(std::size_t index)
{
  stage_.world.calls().reset(index, nullptr);
  if (stage_.dice.hits(0.2))
  {
    // Another caller asks for it, too.
    stage_.world.at(seconds(stage_.dice.between(0.0, 1.0)),
                    [this, index] { stage_.world.calls().reset(index, nullptr); });
  }
}
}  // namespace fuzz
}  // namespace inverter_bus
