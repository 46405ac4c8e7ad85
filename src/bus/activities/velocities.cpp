// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "bus/activities/velocities.h"

#include <algorithm>
#include <array>

#include "util/printable.h"

namespace inverter_bus
{
namespace bus
{
namespace
{
// Inverters that the line about a refused group names; a group may have sixty that are all locked.
constexpr std::size_t MOST_NAMED = 4;

/// Contract, section 2: which id counts if several apply.
int rank(std::uint16_t error_id)
{
  constexpr std::array<std::uint16_t, 7> ORDER{ ERROR_SHUTTING_DOWN, ERROR_OUT_OF_RANGE, ERROR_NOT_OFFERED,
                                                ERROR_NOT_ARMED,     ERROR_OFFLINE,      ERROR_CANCELLED,
                                                ERROR_LOCKED };
  return static_cast<int>(std::find(ORDER.begin(), ORDER.end(), error_id) - ORDER.begin());
}

/// 0: a velocity may move it.
std::uint16_t errorOf(Permission permission)
{
  switch (permission)
  {
    case Permission::Offline:
      return ERROR_OFFLINE;
    case Permission::StopPending:
      return ERROR_CANCELLED;
    case Permission::Locked:
      return ERROR_LOCKED;
    default:
      return 0;
  }
}

/// Why velocities of \p publisher are refused with 0xB005.
std::string textOf(LockReason reason, TimePoint now, const Inverter& inverter, const Publisher& publisher)
{
  switch (reason)
  {
    case LockReason::Unidentified:
      return inverter.settings.identityText();
    case LockReason::Resetting:
      return "a reset of the drive is under way";
    case LockReason::InSetup:
      return "a parameter is being written in the drive's setup area";
    case LockReason::Tripped:
      return lockedText(true);
    case LockReason::Neutral:
      return inverter.obstacles(now).locked ? lockedText(false)
                                            : "locked for " + util::printable(publisher.name) +
                                                  ", which has neither sent 0 nor been silent since the last stop";
    default:
      return lockedText(false);
  }
}
}  // namespace

Velocities::Velocities(BusState& bus, Turns& turns, const GatewayTraffic& traffic, Stops& stops, Absences& absences)
  : bus_(bus)
  , turns_(turns)
  , traffic_(traffic)
  , stops_(stops)
  , absences_(absences)
  , frames_(bus.inverters.size(), 0)
  , read_lost_at_(bus.inverters.size())
  , single_(bus.inverters.size(), false)
  , zero_at_(bus.inverters.size())
{
}

std::uint16_t Velocities::judgeOne(TimePoint now, const Inverter& inverter, const Publisher& publisher,
                                   const Interlock::Verdict& verdict, JudgedVelocity& judged) const
{
  if (judged.target.zero && judged.error_id == 0)
  {
    return 0;
  }
  // In the order in which ids count (contract, section 2); the velocity itself was judged before.
  if (bus_.shutting_down)
  {
    judged.error_id = ERROR_SHUTTING_DOWN;
    judged.text.clear();
  }
  else if (judged.error_id == 0 && inverter.settings.identity() == Identity::Wrong)
  {
    judged.error_id = ERROR_NOT_ARMED;
    judged.text = inverter.settings.identityText();
  }
  else if (judged.error_id == 0)
  {
    judged.error_id = errorOf(verdict.permission);
    judged.text = verdict.permission == Permission::Locked ? textOf(verdict.reason, now, inverter, publisher) : "";
  }
  if (judged.error_id != 0 && judged.text.empty())
  {
    judged.text = errorText(judged.error_id);
  }
  return judged.error_id;
}

/// One factor for all, the smallest that any of them needs: a vehicle that is too fast goes on in its direction.
double Velocities::factorOf(const VelocityCommand& command) const
{
  double factor = 1.0;
  for (const auto& target : command.targets)
  {
    factor = std::min(factor, bus_.inverters[target.first]->movement.range().factorFor(target.second));
  }
  return factor;
}

std::uint16_t Velocities::judgeGroup(TimePoint now, const VelocityCommand& command, std::vector<JudgedVelocity>& judged,
                                     bool& repeat)
{
  std::uint16_t worst = 0;
  const double factor = factorOf(command);
  for (const auto& target : command.targets)
  {
    const Inverter& inverter = *bus_.inverters[target.first];
    JudgedVelocity one = inverter.movement.judge(target.second, factor);
    const bool zero = one.error_id == 0 && one.target.zero;
    const Interlock::Verdict verdict = inverter.interlock.judge(now, command.publisher, inverter.holds());
    repeat = repeat || (!zero && verdict.permission == Permission::Repeat);
    const std::uint16_t error_id = judgeOne(now, inverter, command.publisher, verdict, one);
    if (error_id != 0 && (worst == 0 || rank(error_id) < rank(worst)))
    {
      worst = error_id;
    }
    judged.push_back(one);
  }
  return worst;
}

std::uint16_t Velocities::command(TimePoint now, const VelocityCommand& command)
{
  std::vector<JudgedVelocity> judged;
  bool repeat = false;
  const std::uint16_t error_id = judgeGroup(now, command, judged, repeat);
  if (repeat)
  {
    // An old message of a latched publisher is no command at all; only its zeros still stop what can be stopped.
    for (std::size_t position = 0; position < judged.size(); ++position)
    {
      if (judged[position].error_id == 0 && judged[position].target.zero)
      {
        apply(now, VelocityCommand{ { command.targets[position] }, command.publisher, false }, { judged[position] },
              false);
      }
    }
    return 0;
  }
  apply(now, command, judged, error_id != 0);
  if (error_id == 0)
  {
    bus_.group_error.clear(now, command.grouped);
    return 0;
  }
  if (command.grouped)
  {
    bus_.group_error.note(now, error_id);
  }
  tellRefusal(now, command, judged, error_id);
  return error_id;
}

/// In the status of every inverter of the command, and in the log.
void Velocities::tellRefusal(TimePoint now, const VelocityCommand& command, const std::vector<JudgedVelocity>& judged,
                             std::uint16_t error_id)
{
  std::optional<std::size_t> culprit;
  std::string reasons;
  std::size_t named = 0;
  std::size_t refused = 0;
  for (std::size_t position = 0; position < judged.size(); ++position)
  {
    const auto& target = command.targets[position];
    const JudgedVelocity& one = judged[position];
    refused += one.error_id != 0 ? 1 : 0;
    if (one.error_id == error_id && named++ < MOST_NAMED)
    {
      culprit = culprit ? culprit : target.first;
      reasons += (reasons.empty() ? "" : "; ") + bus_.inverters[target.first]->config.name + ": " +
                 refusedVelocity(target.second, one.error_id, one.text);
    }
  }
  for (std::size_t position = 0; position < judged.size(); ++position)
  {
    const auto& target = command.targets[position];
    const JudgedVelocity& one = judged[position];
    Inverter& inverter = *bus_.inverters[target.first];
    const Obstacles obstacles = inverter.obstacles(now);
    one.error_id == error_id ? inverter.command_error.set(error_id, one.text, obstacles)
                             : inverter.command_error.setForOther(error_id, reasons, one.error_id, one.text, obstacles);
    bus_.refusals.notCommanded(target.first, one.error_id != 0 ? refusedVelocity(target.second, one.error_id, one.text)
                                                               : "the group was refused: " + reasons);
  }
  const std::size_t others = refused - std::min(named, MOST_NAMED);
  bus_.refusals.refused(now, culprit, error_id,
                        (command.grouped ? "group refused: " : "refused: ") + reasons +
                            (others == 0 ? "" : "; and " + std::to_string(others) + " more of the group") + " (" +
                            errorIdText(error_id) + ")");
}

void Velocities::apply(TimePoint now, const VelocityCommand& command, const std::vector<JudgedVelocity>& judged,
                       bool refused)
{
  WaitingCommand waiting;
  waiting.kind = CommandKind::Velocity;
  for (std::size_t position = 0; position < judged.size(); ++position)
  {
    Inverter& inverter = *bus_.inverters[command.targets[position].first];
    const JudgedVelocity& one = judged[position];
    bool moves = false;
    if (one.error_id == 0 && one.target.zero)
    {
      moves = applyZero(now, inverter, command.publisher, one.target);
      waiting.urgent = waiting.urgent || moves;
    }
    else if (refused)
    {
      inverter.interlock.commanded(now, command.publisher, false, inverter.holds());
    }
    else
    {
      moves = applyMove(now, inverter, command.publisher, one.target);
    }
    if (moves)
    {
      // A unit that is under way goes on counting, whatever new target enters it.
      frames_[inverter.index] = bus_.scheduler.velocityWaits(inverter.index) ? frames_[inverter.index] : 0;
      waiting.inverters.push_back(inverter.index);
    }
  }
  const bool queued = waiting.inverters.size() == 1 && bus_.scheduler.velocityWaits(waiting.inverters.front());
  if (queued)
  {
    bus_.scheduler.makeUrgent(waiting.inverters.front(), waiting.urgent);
  }
  if (!queued && !waiting.inverters.empty())
  {
    std::sort(waiting.inverters.begin(), waiting.inverters.end());
    waiting.id = bus_.next_command++;
    waiting.not_before = now;
    bus_.scheduler.push(waiting);
  }
}

/// Never refused; returns true if a frame is needed.
bool Velocities::applyZero(TimePoint now, Inverter& inverter, const Publisher& publisher, const Target& target)
{
  if (target.near_zero)
  {
    inverter.interlock.nearlyZeroed(now, publisher);
  }
  else
  {
    inverter.interlock.zeroed(now, publisher);
  }
  inverter.command_error.clear();
  inverter.command_error.confirmed();
  bus_.refusals.accepted(inverter.index);
  if (inverter.stop.pending())
  {
    return false;
  }
  if (!inverter.movement.runPossible())
  {
    inverter.movement.drop();
    bus_.scheduler.eraseVelocity(inverter.index);
    inverter.interlock.resting();
    return false;
  }
  if (traffic_.zeroNeedsStop(now, inverter))
  {
    stops_.request(now, inverter, StopMode::Decelerate, false, "");
    return false;
  }
  inverter.movement.aim(target);
  zero_at_[inverter.index] = now;
  return inverter.movement.active();
}

bool Velocities::zeroAskedSince(std::size_t index, TimePoint time) const
{
  const auto& target = bus_.inverters[index]->movement.target();
  return zero_at_[index] >= time && target && target->zero && bus_.scheduler.velocityWaits(index);
}

bool Velocities::applyMove(TimePoint now, Inverter& inverter, const Publisher& publisher, const Target& target)
{
  inverter.interlock.commanded(now, publisher, true, inverter.holds());
  inverter.command_error.clear();
  bus_.refusals.accepted(inverter.index);
  // Only the stop of a command of 0 can be pending here; the newer command takes its place.
  inverter.stop.cancel();
  inverter.movement.aim(target);
  return inverter.movement.active();
}

void Velocities::refuse(TimePoint now, const std::vector<std::size_t>& indices, std::uint16_t error_id,
                        const std::string& text, bool group)
{
  for (const std::size_t index : indices)
  {
    Inverter& inverter = *bus_.inverters[index];
    inverter.command_error.set(error_id, text, inverter.obstacles(now));
    bus_.refusals.notCommanded(index, text);
  }
  if (group)
  {
    bus_.group_error.note(now, error_id);
    // The text contains what a publisher has sent: a stream of groups, each wrong in a different way, is one kind all the
    // same.
    bus_.refusals.refused(now, std::nullopt, error_id, "grouped command refused: " + text);
  }
}
}  // namespace bus
}  // namespace inverter_bus
