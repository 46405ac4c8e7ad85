// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "fuzz/bus/checks/services.h"

#include <algorithm>
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
constexpr double SLACK_S = 0.6;  // the loop looks at its clock at least every 0.25 s
constexpr double ROUNDING = 1e-6;
constexpr double WRITTEN_RESOLUTION = 0.051;
}  // namespace

Services::Services(const Observed& observed, const Plant& plant, const util::Clock& clock)
  : observed_(observed), plant_(plant), clock_(clock), writes_(observed.inverters.size())
{
}

Services::Callback Services::asked(const std::string& what, double bound, const Callback& judge)
{
  const std::uint64_t id = ++total_;
  calls_[id] = { what, clock_.now() + seconds(bound + SLACK_S) };
  return [this, id, what, judge](const bus::Answer& answer) { answered(id, what, answer, judge); };
}

void Services::answered(std::uint64_t id, const std::string& what, const bus::Answer& answer, const Callback& judge)
{
  if (calls_.erase(id) == 0)
  {
    fail(clock_.now(), "every service is answered once", what + " is answered twice");
  }
  if (answer.success && judge)
  {
    judge(answer);
  }
  if (!answer.success && answer.error_id == 0)
  {
    fail(clock_.now(), "services", what + " failed without an error id: " + answer.message);
  }
}

Services::Callback Services::resetAsked(std::size_t index, double bound)
{
  const std::string what = "reset of " + observed_.scene.inverters[index].name;
  const std::string trips = plant_.value(index, "trips");
  return asked(what, bound, [this, index, what, trips](const bus::Answer& answer) {
    // The 3G3JE can't report whether its trip is gone. A trip that the node has not seen yet is nothing to reset.
    const bool tells = observed_.scene.inverters[index].brand != Brand::JE;
    const bool sent = answer.message.compare(0, 7, "no trip") != 0;
    const bool new_trip = plant_.value(index, "trips") != trips;
    if (tells && sent && !new_trip && plant_.flag(index, "tripped"))
    {
      fail(clock_.now(), "a service succeeds when the drive has confirmed", what);
    }
  });
}

Services::Callback Services::readAsked(std::size_t index, double bound)
{
  const InverterFacts& facts = observed_.scene.inverters[index];
  return asked("read_parameter of " + facts.name, bound, [this, &facts](const bus::Answer& answer) {
    if (std::fabs(answer.value - facts.fixed_value) > ROUNDING)
    {
      fail(clock_.now(), "no value from another request's reply",
           facts.fixed_parameter + " of " + facts.name + " is " + std::to_string(facts.fixed_value) +
               ", the answer is " + std::to_string(answer.value));
    }
  });
}

Services::Callback Services::writeAsked(std::size_t index, double value, double bound)
{
  const TimePoint asked_at = clock_.now();
  writes_[index].emplace_back(asked_at, value);
  return asked("write_parameter of " + observed_.scene.inverters[index].name, bound,
               [this, index, value, asked_at, bound](const bus::Answer& /*answer*/) {
                 checkWritten(index, value, asked_at, bound);
               });
}

void Services::checkWritten(std::size_t index, double value, TimePoint asked_at, double bound) const
{
  const InverterFacts& facts = observed_.scene.inverters[index];
  const double held = plant_.ram(index, facts.free_parameter);
  const bool powered = plant_.flag(index, "powered") && plant_.flag(index, "listening");
  // Another call may have written it since.
  const bool asked = std::any_of(writes_[index].begin(), writes_[index].end(), [&](const auto& write) {
    return asked_at - write.first < seconds(bound) && std::fabs(held - write.second) < WRITTEN_RESOLUTION;
  });
  // What is in the RAM gets lost with the supply.
  if (powered && !asked && observed_.inverters[index].link.cut_at < asked_at)
  {
    fail(clock_.now(), "a service succeeds when the drive has confirmed",
         "write_parameter of " + facts.name + ": " + std::to_string(value) + " is " + std::to_string(held));
  }
}

void Services::check(TimePoint now) const
{
  for (const auto& call : calls_)
  {
    if (now > call.second.until + observed_.scene.longestExchange() + observed_.babble(now))
    {
      fail(now, "every service is answered within its bound", call.second.what + " has no answer");
    }
  }
}

void Services::checkNoneLeft(TimePoint now) const
{
  if (!calls_.empty())
  {
    fail(now, "every service is answered within its bound", calls_.begin()->second.what + " at the end");
  }
}

std::size_t Services::open() const
{
  return calls_.size();
}

std::uint64_t Services::total() const
{
  return total_;
}
}  // namespace checks
}  // namespace fuzz
}  // namespace inverter_bus
