// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_BUS_VELOCITIES_H
#define INVERTER_BUS_BUS_VELOCITIES_H

#include <string>
#include <vector>

#include "bus/activities/absences.h"
#include "bus/line_view.h"

namespace inverter_bus
{
namespace bus
{
/// A velocity from its verdict to the words that the drive has confirmed (contract, 3.4 to 3.6, 4.2, 4.6, 8.1 and 8.5).
class Velocities
{
public:
  Velocities(BusState& bus, Turns& turns, const GatewayTraffic& traffic, Stops& stops, Absences& absences);

  /// All of it or nothing; stopping members are always carried out. Returns the error id of a refused command, else 0.
  std::uint16_t command(TimePoint now, const VelocityCommand& command);
  /// A malformed command.
  void refuse(TimePoint now, const std::vector<std::size_t>& indices, std::uint16_t error_id, const std::string& text,
              bool group);

  /// Nothing: no member needs a frame now.
  std::optional<InFlight> compose(TimePoint now, const Pick& pick, const LineView& line);
  void sent(const InFlight& current);
  void ended(const InFlight& current, const wire::Reply& reply);
  /// A stop has ended the wait for its reply (contract, 8.4): it goes again, and that is no try.
  void cut(const InFlight& current, const wire::Reply& reply);
  /// A velocity of 0 of this inverter came at \p time or later, and waits.
  bool zeroAskedSince(std::size_t index, TimePoint time) const;
  /// The frame reaches the drive's EEPROM.
  bool wears(const InFlight& current) const;

private:
  std::uint16_t judgeGroup(TimePoint now, const VelocityCommand& command, std::vector<JudgedVelocity>& judged,
                           bool& repeat);
  double factorOf(const VelocityCommand& command) const;
  std::uint16_t judgeOne(TimePoint now, const Inverter& inverter, const Publisher& publisher,
                         const Interlock::Verdict& verdict, JudgedVelocity& judged) const;
  void apply(TimePoint now, const VelocityCommand& command, const std::vector<JudgedVelocity>& judged, bool refused);
  bool applyZero(TimePoint now, Inverter& inverter, const Publisher& publisher, const Target& target);
  bool applyMove(TimePoint now, Inverter& inverter, const Publisher& publisher, const Target& target);
  void tellRefusal(TimePoint now, const VelocityCommand& command, const std::vector<JudgedVelocity>& judged,
                   std::uint16_t error_id);
  std::optional<Write> nextWrite(TimePoint now, Inverter& inverter, const LineView& line, bool& with_status) const;
  bool refusedWithStatus(const InFlight& current, const wire::Reply& reply);
  bool mustBeReadFirst(const Inverter& inverter) const;
  void noteLostRead(const InFlight& current, const wire::Reply& reply);
  void fail(const InFlight& current, const wire::Reply& reply, bool too_many_lost);
  void noteBlockRefusal(const InFlight& current, const wire::Reply& reply);
  void finish(const InFlight& current, const wire::Reply& reply);

  BusState& bus_;
  Turns& turns_;
  const GatewayTraffic& traffic_;
  Stops& stops_;
  Absences& absences_;
  /// By inverter: frames of the velocity unit under way, so that a stream of changes can't keep a unit going for ever.
  std::vector<unsigned> frames_;
  /// By inverter: when a write with a read (17H) got lost. A plain read is next, and what is not confirmed goes by plain
  /// writes (contract, 3.10).
  std::vector<std::optional<TimePoint>> read_lost_at_;
  /// By inverter: it has refused such a write of its frequency.
  std::vector<bool> single_;
  /// By inverter: when the last velocity of 0 came that needs a frame.
  std::vector<TimePoint> zero_at_;
};
}  // namespace bus
}  // namespace inverter_bus

#endif  // INVERTER_BUS_BUS_VELOCITIES_H
