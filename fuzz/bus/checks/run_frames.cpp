// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "fuzz/bus/checks/run_frames.h"

#include "fuzz/bus/violation.h"

namespace inverter_bus
{
namespace fuzz
{
namespace checks
{
RunFrames::RunFrames(const Observed& observed, const Plant& plant)
  : observed_(observed), plant_(plant), power_lost_(observed.inverters.size())
{
}

void RunFrames::lostPower(TimePoint now, std::size_t index)
{
  if (observed_.inverters[index].words.run_answered && plant_.runLatched(index))
  {
    power_lost_[index] = now;
  }
}

void RunFrames::check(TimePoint now)
{
  const Exchange& exchange = observed_.exchange;
  const RequestFacts& facts = exchange.facts;
  if (!facts.run || !facts.inverter)
  {
    return;
  }
  ++checked_;
  const std::size_t index = *facts.inverter;
  const Order& order = observed_.inverters[index].order;
  const bool just_ended = now == order.ended_at || observed_.decidedBefore(now, order.ended_at);
  if (!order.valid && !just_ended)
  {
    fail(now, "no RUN without a fresh, allowed command", observed_.scene.title(index));
  }
  if (order.valid && facts.reverse != (order.hertz < 0.0) && !exchange.precedes_command)
  {
    fail(now, "the newest velocity wins", observed_.scene.title(index) + " is sent the wrong direction");
  }
  checkRepeat(now, index);
  checkPowerCycle(now, index);
}

void RunFrames::checkRepeat(TimePoint now, std::size_t index) const
{
  const Exchange& exchange = observed_.exchange;
  const InverterRecord& inverter = observed_.inverters[index];
  if ((exchange.repeats_run || exchange.facts.with_read) && !inverter.words.shown)
  {
    fail(now, "no RUN by a refresh or a repeat",
         observed_.scene.title(index) + ": RUN is repeated though the last exchange has not shown it in force");
  }
  const bool settled = exchange.repeats_run && inverter.words.settled && exchange.facts.set_hertz &&
                       inverter.words.set_answered == exchange.facts.set_hertz;
  if (exchange.facts.with_read && settled && !observed_.scene.inverters[index].fed_by_word)
  {
    fail(now, "17H only where there is something to write",
         observed_.scene.title(index) + ": a settled command is sent again");
  }
  const bool counts = !exchange.repeats_run && inverter.order.valid && !exchange.precedes_command;
  if (counts && inverter.words.run_copies > observed_.scene.retries)
  {
    fail(now, "no RUN by a retry", observed_.scene.title(index) + ": more copies of RUN than retries");
  }
}

void RunFrames::checkPowerCycle(TimePoint now, std::size_t index) const
{
  const InverterRecord& inverter = observed_.inverters[index];
  const std::optional<TimePoint>& lost = power_lost_[index];
  // An acknowledged RUN goes once more, or reverses the motor.
  if (!lost || inverter.words.run_answered)
  {
    return;
  }
  const auto stream = inverter.streams.find(inverter.order.publisher);
  const bool zeroed = stream != inverter.streams.end() && stream->second.zeroed_at >= *lost;
  const bool silent = inverter.order.accepted_at - *lost >= seconds(SHORTEST_SILENCE_S - SILENCE_TOLERANCE_S);
  if (!zeroed && !silent)
  {
    fail(now, "no RUN by a power cycle",
         observed_.scene.title(index) + " had lost its RUN, and no publisher has returned to neutral");
  }
}

void RunFrames::sent()
{
  const RequestFacts& facts = observed_.exchange.facts;
  if (facts.inverter && facts.stop)
  {
    power_lost_[*facts.inverter].reset();
  }
}

std::uint64_t RunFrames::checked() const
{
  return checked_;
}
}  // namespace checks
}  // namespace fuzz
}  // namespace inverter_bus
