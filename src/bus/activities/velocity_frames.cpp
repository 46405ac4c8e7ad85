// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "bus/activities/velocities.h"

#include <algorithm>

namespace inverter_bus
{
namespace bus
{
namespace
{
// A velocity unit that ever newer targets keep going before it is complete makes room for others after this many frames
// per inverter.
constexpr unsigned MOST_FRAMES_PER_UNIT = 4;
constexpr double STATUS_WAIT_S = 0.02;

/// Where the drive has 17H but no block write: the new frequency of a running motor may go with a read of its status.
bool joinsRead(const Inverter& inverter, const std::optional<Write>& write)
{
  constexpr std::uint8_t WRITE_AND_READ = 0x17;
  const drive::Profile& profile = inverter.drive.profile();
  return write && write->last && !write->starts && write->point == "frequency" && inverter.movement.runConfirmed() &&
         !profile.block && profile.functions.count(WRITE_AND_READ) != 0 &&
         profile.points.at(write->point).item.space == drive::Space::Register;
}

/// No maker's text shows a 17H over the numbers of a register map.
bool isRegisterRead(const StatusRead& read)
{
  return read.kind == StatusRead::Kind::Fast && read.block.space == drive::Space::Register &&
         !read.block.fields.empty() && read.block.mirrors.empty();
}

/// RUN must not be sent again before a status has shown that the motor runs: a frame that reverses it got lost.
bool mustBeSeenRunning(const Inverter& inverter)
{
  return inverter.movement.turnLostAt() && (inverter.drive.reports("operation") || inverter.drive.reports("running"));
}
}  // namespace

/// All command words in one frame where the drive can, with the status in the same exchange where that is what its refresh
/// wants next (contract, 3.10); a word at a time where such a frame could restore a RUN that the drive has lost (rule 4.1),
/// where a late reply could be taken for its answer, and after one that got lost.
std::optional<Write> Velocities::nextWrite(TimePoint now, Inverter& inverter, const LineView& line,
                                           bool& with_status) const
{
  with_status = false;
  const bool in_force = inverter.mayRepeatWords(now);
  const bool combines = inverter.refresh.chosen().read() && (in_force || !inverter.movement.runConfirmed());
  if (combines && !read_lost_at_[inverter.index] && inverter.movement.nextCombined(std::nullopt))
  {
    const drive::ReadBlock& read = turns_.nextRead(now, inverter);
    with_status = in_force && !read.chosen.empty();
    auto combined = inverter.movement.nextCombined(with_status ? std::optional<drive::ReadBlock>(read) : std::nullopt);
    if (combined && line.mayAsk(combined->request, now))
    {
      return combined;
    }
    with_status = false;
  }
  std::optional<Write> write = inverter.movement.next();
  if (!read_lost_at_[inverter.index] && !single_[inverter.index] && !bus_.configuration.bus.gateway &&
      joinsRead(inverter, write))
  {
    const wire::Request both = inverter.drive.writeAndRead(inverter.config.node, { { write->point, write->raw } },
                                                           turns_.nextRead(now, inverter));
    with_status = isRegisterRead(inverter.refresh.asked()) && line.mayAsk(both, now);
    write->request = with_status ? both : write->request;
  }
  return write;
}

std::optional<InFlight> Velocities::compose(TimePoint now, const Pick& pick, const LineView& line)
{
  std::vector<std::size_t> members = bus_.scheduler.members(pick.command);
  // The member whose turn it is, and if it needs no frame any more, the next one.
  std::rotate(members.begin(), std::lower_bound(members.begin(), members.end(), pick.inverter), members.end());
  for (const std::size_t member : members)
  {
    Inverter& inverter = *bus_.inverters[member];
    bool with_status = false;
    if (const auto write = nextWrite(now, inverter, line, with_status))
    {
      if ((write->starts && mustBeSeenRunning(inverter)) || mustBeReadFirst(inverter))
      {
        bus_.scheduler.splitOff(pick.command, member, bus_.next_command++, now + seconds(STATUS_WAIT_S), false);
        continue;
      }
      Pick of_member = pick;
      of_member.inverter = member;
      InFlight current = exchangeFor(of_member);
      current.write = *write;
      current.with_status = with_status;
      current.moves = inverter.movement.target() && !inverter.movement.target()->zero;
      current.may_start = write->starts || (current.moves && !write->more.empty());
      current.lasting = wears(current);
      current.request = inverter.prepared(write->request);
      return current;
    }
    bus_.scheduler.eraseVelocity(member);
  }
  return std::nullopt;
}

void Velocities::sent(const InFlight& current)
{
  if (current.pick.what != Pick::What::Velocity || current.resync)
  {
    return;
  }
  Inverter& inverter = *bus_.inverters[current.inverter];
  inverter.movement.sent(current.write);
  if (current.write.starts)
  {
    // The stop that follows is none of a flood.
    inverter.stop.forgetConfirmation();
  }
}

bool Velocities::wears(const InFlight& current) const
{
  const Inverter& inverter = *bus_.inverters[current.inverter];
  return current.pick.what == Pick::What::Velocity && inverter.drive.wears(current.write.point) &&
         !inverter.settings.connected();
}

void Velocities::ended(const InFlight& current, const wire::Reply& reply)
{
  Inverter& inverter = *bus_.inverters[current.inverter];
  const TimePoint now = reply.finished_at;
  const bool cancelled = !bus_.scheduler.velocityWaits(current.inverter);
  noteBlockRefusal(current, reply);
  noteLostRead(current, reply);
  if (reply.outcome == wire::Outcome::Ok && !cancelled)
  {
    inverter.movement.confirmed(current.write, now);
    if (current.write.starts)
    {
      inverter.settings.underCommand(true);
    }
    inverter.lost_writes.acknowledged();
    ++frames_[inverter.index];
    finish(current, reply);
    return;
  }
  if (!current.resync)
  {
    // A loop-back that went in its place has changed nothing: what was in force still is, and is not sent again.
    inverter.movement.doubtful(current.write, now);
  }
  if (refusedWithStatus(current, reply) && !cancelled)
  {
    return;
  }
  const bool lost = !isAnswered(reply);
  // A loop-back that was lost writes nothing.
  const bool too_many = lost && !current.resync && !bus_.behind_another && inverter.lost_writes.lost();
  // A gateway that reports it has tried already.
  const bool again = lost && inverter.lost_writes.tryAgain() && !too_many && reply.gateway_code == 0;
  if (again && !cancelled)
  {
    // The other members of a group go on without it.
    bus_.scheduler.splitOff(current.pick.command, current.inverter, bus_.next_command++, now,
                            inverter.movement.target() && inverter.movement.target()->zero);
    turns_.finish(current, reply, true);
    return;
  }
  bus_.scheduler.eraseVelocity(current.inverter);
  turns_.finish(current, reply, !bus_.scheduler.members(current.pick.command).empty());
  if (reply.outcome == wire::Outcome::Ok)
  {
    return;
  }
  inverter.lost_writes.velocityEnded();
  read_lost_at_[inverter.index].reset();
  if (lost)
  {
    absences_.noteLostWrite(now, inverter, reply.error_id);
  }
  if (!cancelled)
  {
    fail(current, reply, too_many);
  }
}

/// A drive that refuses a frequency in one frame with a read gets it by a plain write, once more and from now on: it may
/// not know that function, whatever its manual says.
bool Velocities::refusedWithStatus(const InFlight& current, const wire::Reply& reply)
{
  if (reply.outcome != wire::Outcome::Exception || !current.with_status || !current.write.more.empty())
  {
    return false;
  }
  single_[current.inverter] = true;
  bus_.scheduler.splitOff(current.pick.command, current.inverter, bus_.next_command++, reply.finished_at, false);
  turns_.finish(current, reply, true);
  return true;
}

void Velocities::cut(const InFlight& current, const wire::Reply& reply)
{
  Inverter& inverter = *bus_.inverters[current.inverter];
  const TimePoint now = reply.finished_at;
  noteLostRead(current, reply);
  if (!current.resync)
  {
    inverter.movement.doubtful(current.write, now);
  }
  if (bus_.scheduler.velocityWaits(current.inverter))
  {
    bus_.scheduler.splitOff(current.pick.command, current.inverter, bus_.next_command++, now,
                            inverter.movement.target() && inverter.movement.target()->zero);
  }
  turns_.finish(current, reply, !bus_.scheduler.members(current.pick.command).empty());
}

/// It is not sent again.
void Velocities::fail(const InFlight& current, const wire::Reply& reply, bool too_many_lost)
{
  Inverter& inverter = *bus_.inverters[current.inverter];
  if (inverter.link.offline())
  {
    return;
  }
  const bool zero = inverter.movement.target() && inverter.movement.target()->zero;
  inverter.command_error.failed(reply.error_id, refusalText(inverter, reply.error_id));
  inverter.movement.giveUp();
  if (!isAnswered(reply) && (too_many_lost || inverter.movement.runPossible()))
  {
    absences_.writesLost(reply.finished_at, inverter);
    return;
  }
  if (!inverter.movement.runPossible())
  {
    inverter.interlock.resting();
  }
  if (zero || current.write.starts)
  {
    // It is unknown whether the motor runs: it must not.
    stops_.request(reply.finished_at, inverter, StopMode::Decelerate, false, "");
  }
  if (current.write.starts)
  {
    inverter.stop.hold();
  }
}

/// Not what takes RUN off: that never waits.
bool Velocities::mustBeReadFirst(const Inverter& inverter) const
{
  const auto& lost_at = read_lost_at_[inverter.index];
  const auto& target = inverter.movement.target();
  return lost_at && target && !target->zero && inverter.refresh.stamp().value_or(TimePoint()) <= *lost_at;
}

/// What the drive took of a lost write with a read shows in a plain read, which goes before the plain writes (contract,
/// 3.10).
void Velocities::noteLostRead(const InFlight& current, const wire::Reply& reply)
{
  if (!isAnswered(reply) && current.with_status && !current.resync)
  {
    read_lost_at_[current.inverter] = reply.finished_at;
    bus_.scheduler.readSoon(current.inverter);
  }
}

/// A drive that can't carry out a block write (slots empty or not in effect) gets its words one by one from the next
/// command on; this one is refused like any other, since it is unknown what the drive took of it.
void Velocities::noteBlockRefusal(const InFlight& current, const wire::Reply& reply)
{
  constexpr std::uint8_t CANNOT_BE_EXECUTED = 0x04;
  const bool refused = reply.outcome == wire::Outcome::Exception && !current.write.more.empty();
  if (refused && (reply.error_id & 0xFFU) == CANNOT_BE_EXECUTED)
  {
    Inverter& inverter = *bus_.inverters[current.inverter];
    inverter.dropBlock("the drive refuses the block write (" + inverter.drive.exceptionText(reply.error_id) + ")");
  }
}

void Velocities::finish(const InFlight& current, const wire::Reply& reply)
{
  Inverter& inverter = *bus_.inverters[current.inverter];
  const bool complete = !inverter.movement.next();
  // A newer target has come during its last frame: it has its own place in the order (contract, 3.6 and 8.1).
  const bool over = current.write.last || frames_[inverter.index] >= MOST_FRAMES_PER_UNIT;
  if (complete)
  {
    read_lost_at_[inverter.index].reset();
    inverter.command_error.confirmed();
  }
  if (complete || over)
  {
    bus_.scheduler.eraseVelocity(current.inverter);
  }
  turns_.finish(current, reply, !bus_.scheduler.members(current.pick.command).empty());
  if (!complete && over)
  {
    frames_[inverter.index] = 0;
    WaitingCommand waiting;
    waiting.id = bus_.next_command++;
    waiting.inverters = { inverter.index };
    waiting.not_before = reply.finished_at;
    bus_.scheduler.push(waiting);
  }
  if (complete && inverter.movement.zeroUnverified() && !inverter.drive.runBlock())
  {
    inverter.cameToRest(reply.finished_at);
  }
}
}  // namespace bus
}  // namespace inverter_bus
