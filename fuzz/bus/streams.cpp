// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "fuzz/bus/streams.h"

#include <cmath>

namespace inverter_bus
{
namespace fuzz
{
namespace
{
constexpr double STEADY_PERIOD_S = 0.1;
constexpr double STEADY_S = 100.0;
constexpr double WAVER_HZ = 0.1;
constexpr unsigned WAVER_STEPS = 30;
}  // namespace

Streams::Streams(Stage& stage) : stage_(stage), streams_(stage.inverters())
{
}

double Streams::anySpeed(std::size_t index)
{
  const InverterFacts& facts = stage_.facts(index);
  const double hertz = stage_.dice.between(facts.lowest_hz, facts.highest_hz);
  return stage_.dice.hits(0.3) ? -hertz : hertz;
}

std::string Streams::anyPublisher()
{
  return stage_.dice.hits(0.75) ? "/one" : (stage_.dice.hits(0.7) ? "/two" : "/three");
}

bool Streams::isOn(std::size_t index) const
{
  return streams_[index].on;
}

double Streams::hertz(std::size_t index) const
{
  return streams_[index].hertz;
}

void Streams::begin(std::size_t index)
{
  Stream& stream = streams_[index];
  stream.on = true;
  stream.hertz = anySpeed(index);
  stream.drift = stage_.dice.hits(0.3) ? 0.05 : 0.0;
  stream.wavers = false;
  stream.grouped = false;
  stream.period = stage_.dice.any<double>({ 0.02, 0.05, 0.1, 0.1, 0.25 });
  stream.until = stage_.world.now() + seconds(stage_.dice.between(0.3, 6.0));
  stream.publisher = anyPublisher();
  stream.dips = stage_.limits_dice.hits(0.2);
  tick(index, ++stream.number);
}

void Streams::beginWavering(std::size_t index, double period, Duration duration, bool grouped)
{
  begin(index);
  Stream& stream = streams_[index];
  stream.wavers = true;
  stream.grouped = grouped;
  stream.drift = 0.0;
  stream.period = period;
  stream.until = stage_.world.now() + duration;
}

bool Streams::beginSteady(std::size_t index, const std::string& publisher)
{
  Stream& stream = streams_[index];
  stream.hertz = anySpeed(index);
  bus::VelocityCommand command;
  command.targets = { { index, stream.hertz / stage_.facts(index).hz_per_unit } };
  command.publisher.name = publisher;
  command.publisher.topic = stage_.nameOf(index) + "/command";
  if (stage_.world.command(command) != 0)
  {
    return false;
  }
  stage_.streaming = true;
  stream.on = true;
  stream.drift = 0.0;
  stream.wavers = false;
  stream.grouped = false;
  stream.dips = false;
  stream.period = STEADY_PERIOD_S;
  stream.until = stage_.world.now() + seconds(STEADY_S);
  stream.publisher = publisher;
  tick(index, ++stream.number);
  return true;
}

void Streams::pause(std::size_t index)
{
  streams_[index].on = false;
}

void Streams::resumeSteady(std::size_t index, const std::string& publisher)
{
  streams_[index].on = true;
  beginSteady(index, publisher);
}

void Streams::tick(std::size_t index, unsigned number)
{
  Stream& stream = streams_[index];
  if (!stage_.streaming || !stream.on || stream.number != number)
  {
    return;
  }
  if (stage_.world.now() >= stream.until)
  {
    stream.on = false;
    if (stage_.dice.hits(0.5))
    {
      send(index, 0.0, stream.publisher);
    }
    return;
  }
  stream.hertz += stream.hertz > 0.0 ? stream.drift : -stream.drift;
  if (stream.wavers)
  {
    const double lowest = stage_.facts(index).lowest_hz;
    stream.hertz = std::copysign(lowest + WAVER_HZ * (stream.sent++ % WAVER_STEPS), stream.hertz);
  }
  sendOne(index);
  stage_.world.at(seconds(stream.period), [this, index, number] { tick(index, number); });
}

void Streams::sendOne(std::size_t index)
{
  const Stream& stream = streams_[index];
  if (stream.dips && stage_.limits_dice.hits(0.15))
  {
    sendNearZero(index);
  }
  else if (stream.grouped)
  {
    sendGroup(index);
  }
  else
  {
    send(index, stream.hertz, stream.publisher);
  }
}

/// In one message with those that waver beside it.
void Streams::sendGroup(std::size_t index)
{
  bus::VelocityCommand command;
  command.publisher.name = streams_[index].publisher;
  command.publisher.topic = "command";
  command.grouped = true;
  for (std::size_t one = 0; one < streams_.size(); ++one)
  {
    const Stream& other = streams_[one];
    if (one == index || (other.on && other.grouped))
    {
      command.targets.emplace_back(one, other.hertz / stage_.facts(one).hz_per_unit);
    }
  }
  stage_.world.command(command);
}

void Streams::send(std::size_t index, double hertz, const std::string& publisher)
{
  const InverterFacts& facts = stage_.facts(index);
  bus::VelocityCommand command;
  command.targets = { { index, hertz == 0.0 ? 0.0 : hertz / facts.hz_per_unit } };
  command.publisher.name = publisher;
  command.publisher.topic = facts.name + "/command";
  stage_.world.command(command);
}

void Streams::sendAny(std::size_t index)
{
  const std::string publisher = anyPublisher();
  send(index, anySpeed(index), publisher);
}

double Streams::nearZero(std::size_t index)
{
  const InverterFacts& facts = stage_.facts(index);
  Dice& dice = stage_.limits_dice;
  const double rounds_to_zero = 0.001 / std::fabs(facts.hz_per_unit);
  const double below = facts.min_velocity > 0.0 && dice.hits(0.5) ? 0.9 * facts.min_velocity : rounds_to_zero;
  return dice.any<double>({ below, -below, 5e-14 });
}

void Streams::sendNearZero(std::size_t index)
{
  bus::VelocityCommand command;
  command.targets = { { index, nearZero(index) } };
  command.publisher.name = streams_[index].publisher;
  command.publisher.topic = stage_.nameOf(index) + "/command";
  stage_.world.command(command);
}
}  // namespace fuzz
}  // namespace inverter_bus
