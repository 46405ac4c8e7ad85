// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "fuzz/bus/harm.h"

namespace inverter_bus
{
namespace fuzz
{
Harm::Harm(Stage& stage, Streams& streams, bool refuses) : stage_(stage), streams_(streams), refuses_(refuses)
{
}

void Harm::act()
{
  const double dice = stage_.dice.chance();
  if (dice < 0.55)
  {
    harmReplies(stage_.anyone());
  }
  else if (dice < 0.85)
  {
    harmDrive(stage_.anyone());
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

void Harm::harmReplies(std::size_t index)
{
  const InverterFacts& facts = stage_.facts(index);
  const std::string late = "late " + std::to_string(facts.response_timeout * stage_.dice.between(0.5, 3.0));
  std::string refusal = facts.brand == Brand::HITACHI ? "exception 34"
                        : facts.brand == Brand::JE    ? "exception 8707"
                                                      : "exception 4";
  refusal = refuses_ ? refusal : "lost_reply";
  const std::vector<std::string> faults{
    "damaged",   "truncated", "truncated 1",     late,
    late,        "noise 4",   "foreign station", refuses_ ? "damaged" : "foreign shape",
    refusal,     refusal,     "lost_request",    "lost_reply",
    "lost_reply"
  };
  const std::size_t count = 1 + stage_.dice.below(stage_.dice.hits(0.8) ? 1 : 6);
  const std::string fault = stage_.dice.any(faults);
  stage_.world.provoke(facts.name + " " + fault + " count " + std::to_string(count));
}

void Harm::harmDrive(std::size_t index)
{
  World& world = stage_.world;
  Dice& dice = stage_.dice;
  const std::string& name = stage_.nameOf(index);
  const double what = dice.chance();
  if (what < 0.3)
  {
    world.cutPower(index, dice.any<double>({ 0.02, 0.02, 0.3, 1.2, 3.0 }));
  }
  else if (what < 0.5)
  {
    world.provoke(name + " offline " + std::to_string(dice.any<double>({ 0.1, 0.4, 2.0, 6.0 })));
  }
  else if (what < 0.65)
  {
    const bool rx = stage_.facts(index).drive == "omron_rx";
    world.provoke(name + " trip " + std::to_string(1 + dice.below(7)) +
                  (rx && stage_.limits_dice.hits(0.4) ? " state 7" : ""));
  }
  else if (what < 0.75)
  {
    world.provoke(name + " panel_stop");
  }
  else if (what < 0.83)
  {
    takeOver(index);
  }
  else if (what < 0.93)
  {
    world.provoke(name + " sto on");
    world.at(seconds(dice.between(0.1, 2.0)), [&world, name] { world.provoke(name + " sto off"); });
  }
  else
  {
    world.provoke(name + " busy " + std::to_string(dice.between(0.1, 1.5)));
  }
}

/// The panel of a drive is used.
void Harm::takeOver(std::size_t index)
{
  World& world = stage_.world;
  const std::string& name = stage_.nameOf(index);
  world.provoke(name + " panel " + std::to_string(stage_.dice.hits(0.5) ? 0.0 : stage_.dice.between(5.0, 40.0)));
  world.at(seconds(stage_.dice.between(0.2, 3.0)), [&world, name] { world.provoke(name + " panel_release"); });
}

void Harm::harmLine()
{
  World& world = stage_.world;
  const bool compoway = world.scene().compoway;
  const double dice = stage_.dice.chance();
  if (dice < 0.35)
  {
    world.provoke("bus unplug " + std::to_string(stage_.dice.between(0.05, 1.5)));
  }
  else if (dice < 0.5)
  {
    world.provoke("bus silent " + std::to_string(stage_.dice.between(0.05, 1.0)));
    world.disturb();
  }
  else if (dice < 0.75 && !compoway)
  {
    // A block check character of CompoWay/F is a XOR: two bytes damaged alike get through.
    world.disturb();
    world.provoke("bus noise " + std::to_string(1 + stage_.dice.below(8)));
  }
  else
  {
    // A second master that speaks to a station that is not on this bus.
    world.disturb();
    world.provoke(compoway ? "bus foreign 770000601" : "bus foreign 4D 03 10 00 00 02");
  }
}

void Harm::killSeveral()
{
  const double duration = stage_.dice.between(1.0, 8.0);
  for (std::size_t index = 0; index < stage_.inverters(); ++index)
  {
    if (stage_.dice.hits(0.6))
    {
      const double share = stage_.dice.between(0.5, 1.0);
      stage_.world.provoke(stage_.nameOf(index) + " offline " + std::to_string(duration * share));
    }
  }
}

/// A drive dies, or only its writes, reads or long replies do, while its own velocity changes; its neighbours are
/// commanded as well.
void Harm::failWhileItChanges()
{
  const std::size_t index = stage_.anyone();
  const double period = stage_.dice.any<double>({ 0.01, 0.02, 0.05, 0.05, 0.1, 0.25, 1.0 });
  const double duration = stage_.dice.between(2.0, 6.0);
  const bool grouped = stage_.dice.hits(0.3);
  for (std::size_t one = 0; one < stage_.inverters(); ++one)
  {
    if (one == index || stage_.dice.hits(0.5))
    {
      streams_.beginWavering(one, period, seconds(1.0 + duration), grouped);
    }
  }
  const double how = stage_.dice.chance();
  stage_.world.at(seconds(stage_.dice.between(0.2, 1.0)), [this, index, how, duration] {
    if (stage_.acting)
    {
      fail(index, how, duration);
    }
  });
}

void Harm::fail(std::size_t index, double how, double duration)
{
  if (how < 0.4)
  {
    stage_.world.cutPower(index, duration);
    return;
  }
  const std::string fault = how < 0.6   ? "lost_request writes"
                            : how < 0.8 ? "lost_reply reads"
                                        : "damaged longer " + std::string(how < 0.9 ? "9" : "12");
  stage_.world.provoke(stage_.nameOf(index) + " " + fault + " for " + std::to_string(duration));
}
}  // namespace fuzz
}  // namespace inverter_bus
