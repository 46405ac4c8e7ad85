// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "fuzz/bus/calls.h"

namespace inverter_bus
{
namespace fuzz
{
namespace
{
/// First the check, then the caller.
Calls::Callback both(const Calls::Callback& check, const Calls::Callback& answered)
{
  return [check, answered](const bus::Answer& answer) {
    check(answer);
    if (answered)
    {
      answered(answer);
    }
  };
}
}  // namespace

Calls::Calls(bus::Coordinator& coordinator, Checker& checker, Story& story, const util::Clock& clock)
  : coordinator_(coordinator), checker_(checker), story_(story), clock_(clock), bounds_(coordinator.bounds())
{
}

const InverterFacts& Calls::facts(std::size_t index) const
{
  return checker_.observed().scene.inverters[index];
}

void Calls::stop(std::optional<std::size_t> index, std::uint8_t mode, const Callback& answered)
{
  const TimePoint now = clock_.now();
  story_.event(now, index ? "stop of " + facts(*index).name : std::string("stop of all"));
  const Callback check = checker_.users().stopCalled(now, index, bounds_.stop);
  coordinator_.stop(now, index, mode, both(check, answered));
  checker_.users().stopRequested(now, index);
}

void Calls::reset(std::size_t index, const Callback& answered)
{
  story_.event(clock_.now(), "reset of " + facts(index).name);
  const Callback check = checker_.services().resetAsked(index, bounds_.reset);
  coordinator_.reset(clock_.now(), index, both(check, answered));
}

void Calls::readFaults(std::size_t index)
{
  const Callback check = checker_.services().asked("read_faults of " + facts(index).name, bounds_.read_faults, nullptr);
  coordinator_.readFaults(clock_.now(), index, check);
}

void Calls::readFixedParameter(std::size_t index)
{
  const Callback check = checker_.services().readAsked(index, bounds_.read_parameter);
  coordinator_.readParameter(clock_.now(), index, facts(index).fixed_parameter, check);
}

void Calls::readUnknownParameter(std::size_t index)
{
  const Callback check = checker_.services().asked("read_parameter of nothing", bounds_.read_parameter, nullptr);
  coordinator_.readParameter(clock_.now(), index, "Z999", check);
}

void Calls::writeFreeParameter(std::size_t index, double value, bool persist)
{
  const Callback check = checker_.services().writeAsked(index, value, bounds_.write_parameter);
  coordinator_.writeParameter(clock_.now(), index, facts(index).free_parameter, value, persist, check);
}
}  // namespace fuzz
}  // namespace inverter_bus
