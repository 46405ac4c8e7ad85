// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_BUS_SETTINGS_READS_H
#define INVERTER_BUS_BUS_SETTINGS_READS_H

#include "bus/activities/absences.h"

namespace inverter_bus
{
namespace bus
{
/// The drive's own settings that decide safety, read at connect and in the lowest class (contract, 4.5), and what is
/// configured after them.
class SettingsReads
{
public:
  SettingsReads(BusState& bus, Turns& turns, Services& services, Absences& absences);

  InFlight compose(const Pick& pick) const;
  void ended(const InFlight& current, const wire::Reply& reply);
  /// A stop has ended the wait for its reply (contract, 8.4): it goes again in its turn.
  void cut(const InFlight& current, const wire::Reply& reply);

private:
  void configureBlock(TimePoint now, Inverter& inverter);
  void configureMap(TimePoint now, Inverter& inverter);

  BusState& bus_;
  Turns& turns_;
  Services& services_;
  Absences& absences_;
};
}  // namespace bus
}  // namespace inverter_bus

#endif  // INVERTER_BUS_BUS_SETTINGS_READS_H
