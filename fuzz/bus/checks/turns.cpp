// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "fuzz/bus/checks/turns.h"

#include <cmath>

#include "fuzz/bus/violation.h"

namespace inverter_bus
{
namespace fuzz
{
namespace checks
{
namespace
{
// After a lost exchange what is alike waits for a while (rule 3.9).
constexpr double BARRED_S = 3.0;
// Of a drive's own time-out: before it has passed, the drive is not late yet, but it has the next turn.
constexpr double NEAR_SHARE = 0.95;
// Coarser than the rounding of every brand.
constexpr double SET_POINT_STEP_HZ = 0.051;
}  // namespace

Turns::Turns(const Observed& observed) : observed_(observed), held_(observed.inverters.size())
{
}

void Turns::check(TimePoint now)
{
  const RequestFacts& facts = observed_.exchange.facts;
  const std::optional<std::size_t> last = turn_of_;
  const bool answered_before = answered_;
  answered_ = false;
  turn_of_ = isOfStop() ? std::optional<std::size_t>() : facts.inverter;
  // The lowest class has every eighth exchange, whatever else waits.
  const bool again =
      turn_of_ && last == turn_of_ && !answered_before && !facts.reads_parameter && !observed_.shutting_down;
  for (std::size_t index = 0; again && index < held_.size(); ++index)
  {
    if (index != *turn_of_ && waits(now, index))
    {
      fail(now, "no inverter takes another one's turn",
           observed_.scene.title(*turn_of_) + " gets two exchanges in a row while " + observed_.scene.title(index) +
               " waits: " + simulation::toHex(observed_.exchange.request));
    }
  }
  turn_began_ = now;
}

bool Turns::isOfStop() const
{
  const RequestFacts& facts = observed_.exchange.facts;
  if (!facts.inverter)
  {
    return facts.broadcast || facts.stop;
  }
  const InverterRecord& inverter = observed_.inverters[*facts.inverter];
  // Before a stop that a late reply could answer goes a loop-back, also before that of a 0.
  return facts.stop || inverter.stop.active || (facts.loopback && !inverter.order.valid);
}

/// Something was requested of this inverter before the last exchange began, and nothing of it has been sent;
/// or its own time-out is near.
bool Turns::waits(TimePoint now, std::size_t index) const
{
  const InverterRecord& inverter = observed_.inverters[index];
  const TimePoint lost_at = inverter.link.lost_at;
  if (!observed_.online(index) || inverter.stop.active || (lost_at != TimePoint() && now - lost_at < seconds(BARRED_S)))
  {
    return false;
  }
  return hasUnsentCommand(index) || isNearItsTimeout(now, index);
}

bool Turns::hasUnsentCommand(std::size_t index) const
{
  const Order& order = observed_.inverters[index].order;
  const Words& words = observed_.inverters[index].words;
  // Commanded once more what is in force already: there is nothing to send.
  const bool in_force = words.run_answered && words.run_reverse == (order.hertz < 0.0) && held_[index] &&
                        std::fabs(*held_[index] - std::fabs(order.hertz)) < SET_POINT_STEP_HZ;
  const bool unsent = words.run_copies == 0 && words.set_copies + words.run_set_copies == 0 && !words.set_answered;
  // The command watchdog ends a command of which nothing was sent as well.
  return order.valid && order.fed && !words.settled && !in_force && unsent && order.accepted_at < turn_began_;
}

bool Turns::isNearItsTimeout(TimePoint now, std::size_t index) const
{
  const InverterRecord& inverter = observed_.inverters[index];
  const double timeout = observed_.scene.inverters[index].drive_timeout;
  return timeout > 0.0 && inverter.link.timeout_known && inverter.told.status.run_command && inverter.link.last_heard &&
         now - *inverter.link.last_heard > seconds(NEAR_SHARE * timeout);
}

void Turns::answered(std::size_t index, const ReplyFacts& reply)
{
  answered_ = true;
  const RequestFacts& facts = observed_.exchange.facts;
  held_[index] = facts.set_hertz && reply.good ? facts.set_hertz : held_[index];
}

void Turns::ended()
{
  const RequestFacts& facts = observed_.exchange.facts;
  if (facts.inverter && facts.commands() && !observed_.exchange.answered)
  {
    held_[*facts.inverter].reset();
  }
}
}  // namespace checks
}  // namespace fuzz
}  // namespace inverter_bus
