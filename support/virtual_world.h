// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_TEST_VIRTUAL_WORLD_H
#define INVERTER_BUS_TEST_VIRTUAL_WORLD_H

#include <algorithm>
#include <functional>
#include <map>
#include <string>
#include <utility>

#include "inverter_bus/simulation/simulated_bus.h"
#include "inverter_bus/util/clock.h"
#include "inverter_bus/wire/port.h"

// The basis of a whole bus in virtual time; for the unit tests and for the fuzz program (fuzz/).

namespace inverter_bus
{
/// Virtual time with appointments: what is to be done at an instant happens at that instant, also in the middle of an
/// exchange.
class AppointedClock : public util::Clock
{
public:
  TimePoint now() const override
  {
    return now_;
  }

  void sleepUntil(TimePoint time) override
  {
    while (!appointments_.empty() && appointments_.begin()->first <= time)
    {
      keepAppointment();
    }
    now_ = std::max(now_, time);
  }

  /// Like a wait on a condition variable: returns after the first appointment.
  void waitUntil(TimePoint time)
  {
    if (!appointments_.empty() && appointments_.begin()->first <= time)
    {
      keepAppointment();
      return;
    }
    now_ = std::max(now_, time);
  }

  void at(TimePoint time, std::function<void()> action)
  {
    appointments_.emplace(time, std::move(action));
  }

private:
  void keepAppointment()
  {
    const auto first = appointments_.begin();
    now_ = std::max(now_, first->first);
    const std::function<void()> action = first->second;
    appointments_.erase(first);
    action();
  }

  TimePoint now_ = TimePoint() + std::chrono::hours(1);
  std::multimap<TimePoint, std::function<void()>> appointments_;
};

/// The simulated line as a port of the driver.
class VirtualPort : public wire::Port
{
public:
  VirtualPort(simulation::SimulatedBus& bus, AppointedClock& clock) : bus_(bus), clock_(clock)
  {
  }

  wire::OpenResult open(std::string& error) override
  {
    bus_.advance(clock_.now());
    open_ = bus_.pluggedIn();
    error = open_ ? "" : "virtual port: not plugged in";
    bus_.takeOutput(clock_.now());
    return open_ ? wire::OpenResult::Opened : wire::OpenResult::NotThere;
  }

  void close() override
  {
    open_ = false;
  }

  bool isOpen() const override
  {
    return open_;
  }

  std::string name() const override
  {
    return "virtual";
  }

  bool send(const wire::Bytes& frame) override
  {
    bus_.advance(clock_.now());
    if (!bus_.pluggedIn())
    {
      return false;
    }
    bus_.send(frame, clock_.now());
    return true;
  }

  wire::ReceiveResult receive(wire::Bytes& buffer, TimePoint deadline) override
  {
    for (;;)
    {
      bus_.advance(clock_.now());
      if (!bus_.pluggedIn())
      {
        return wire::ReceiveResult::Gone;
      }
      bool any = false;
      for (const simulation::Delivery& delivery : bus_.takeOutput(clock_.now()))
      {
        buffer.insert(buffer.end(), delivery.bytes.begin(), delivery.bytes.end());
        any = true;
      }
      if (any)
      {
        return wire::ReceiveResult::Data;
      }
      if (clock_.now() >= deadline)
      {
        return wire::ReceiveResult::Silence;
      }
      const auto event = bus_.nextEvent();
      clock_.sleepUntil(event && *event > clock_.now() ? std::min(*event, deadline) : deadline);
    }
  }

private:
  simulation::SimulatedBus& bus_;
  AppointedClock& clock_;
  bool open_ = false;
};
}  // namespace inverter_bus

#endif  // INVERTER_BUS_TEST_VIRTUAL_WORLD_H
