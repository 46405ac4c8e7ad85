// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_BUS_ABSENCES_H
#define INVERTER_BUS_BUS_ABSENCES_H

#include "bus/activities/services.h"

namespace inverter_bus
{
namespace bus
{
/// What follows when an inverter can't be reached, or loses what it is sent (contract, 8.1 and 8.15): it goes offline, its
/// services fail, and what may run is stopped.
class Absences
{
public:
  Absences(BusState& bus, Stops& stops, Services& services);

  /// Draws the conclusion from the end of an exchange.
  void take(Ending ending, const wire::Reply& reply, Inverter& inverter);
  void noteLost(TimePoint now, Inverter& inverter, std::uint16_t error_id);
  void noteRefusal(TimePoint now, Inverter& inverter, std::uint16_t error_id);
  void noteLostWrite(TimePoint now, Inverter& inverter, std::uint16_t error_id);
  void writesLost(TimePoint now, Inverter& inverter);
  /// The port is gone, or no drive answers over it.
  void loseEverybody(TimePoint now, std::uint16_t error_id);
  /// True: an inverter has just gone offline, because its status has not come for too long.
  bool watchStatuses(TimePoint now);

private:
  void failTrial(TimePoint now, Inverter& inverter, std::uint16_t error_id);
  void wentOffline(TimePoint now, Inverter& inverter);
  Duration refreshPeriod(const Inverter& inverter) const;

  BusState& bus_;
  Stops& stops_;
  Services& services_;
};
}  // namespace bus
}  // namespace inverter_bus

#endif  // INVERTER_BUS_BUS_ABSENCES_H
