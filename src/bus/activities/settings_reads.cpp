// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "bus/activities/settings_reads.h"

#include <string>
#include <utility>

namespace inverter_bus
{
namespace bus
{
SettingsReads::SettingsReads(BusState& bus, Turns& turns, Services& services, Absences& absences)
  : bus_(bus), turns_(turns), services_(services), absences_(absences)
{
}

InFlight SettingsReads::compose(const Pick& pick) const
{
  Inverter& inverter = *bus_.inverters[pick.inverter];
  InFlight current = exchangeFor(pick);
  current.slow = inverter.settings.repeats();
  current.lasting = inverter.settings.nextWrites() && inverter.drive.profile().writes != drive::Writes::Ram;
  current.request = inverter.prepared(inverter.settings.next());
  return current;
}

void SettingsReads::ended(const InFlight& current, const wire::Reply& reply)
{
  Inverter& inverter = *bus_.inverters[current.inverter];
  if (isAnswered(reply))
  {
    inverter.setting_repeats.restart();
    inverter.settled(reply.finished_at, reply);
    // Before a status it took the refresh's turn, and gives it back.
    turns_.finish(current, reply, current.pick.what == Pick::What::Connect);
    configureBlock(reply.finished_at, inverter);
    configureMap(reply.finished_at, inverter);
    return;
  }
  inverter.settled(reply.finished_at, reply);
  const bool again = !inverter.link.offline() && inverter.setting_repeats.again(reply);
  turns_.finish(current, reply, false);
  if (!again)
  {
    absences_.noteLost(reply.finished_at, inverter, reply.error_id);
  }
}

void SettingsReads::cut(const InFlight& current, const wire::Reply& reply)
{
  bus_.inverters[current.inverter]->settled(reply.finished_at, reply);
  turns_.finish(current, reply, false);
}

void SettingsReads::configureBlock(TimePoint now, Inverter& inverter)
{
  const bool may_write = !bus_.shutting_down && inverter.standsStill();
  const auto wanted =
      inverter.block_transfer.takeWrites(may_write ? inverter.settings.blockSlots() : std::optional<BlockSlots>());
  if (wanted.empty())
  {
    return;
  }
  bus_.outbox.log(Level::Warn, inverter.config.name + ": configure_block: writing " + std::to_string(wanted.size()) +
                                   " parameters to the drive's EEPROM, once");
  services_.start(now, inverter.index,
                  std::make_unique<ConfigureBlockJob>(inverter.drive, inverter.config.node, wanted),
                  serviceBounds(bus_).write_parameter, AnswerCallback());
}

void SettingsReads::configureMap(TimePoint now, Inverter& inverter)
{
  if (bus_.shutting_down)
  {
    return;
  }
  if (const std::string refusal = inverter.map_use.takeRefusal(inverter.settings.map()); !refusal.empty())
  {
    bus_.outbox.log(Level::Warn, inverter.config.name + ": " + refusal);
  }
  const auto wanted = inverter.map_use.takeWrites(inverter.settings.map(), inverter.standsStill());
  if (wanted.empty())
  {
    return;
  }
  bus_.outbox.log(Level::Warn, inverter.config.name + ": configure_map: writing " + std::to_string(wanted.size()) +
                                   " parameters and storing them in the drive's EEPROM, once");
  services_.configureMap(now, inverter.index, wanted);
}
}  // namespace bus
}  // namespace inverter_bus
