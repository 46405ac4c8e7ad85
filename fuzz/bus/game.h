// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_FUZZ_GAME_H
#define INVERTER_BUS_FUZZ_GAME_H

#include "fuzz/bus/calm.h"
#include "fuzz/bus/harm.h"
#include "fuzz/bus/stage.h"
#include "fuzz/bus/streams.h"
#include "fuzz/bus/users.h"

namespace inverter_bus
{
namespace fuzz
{
/// What happens to one bus: users and faults by chance, then faults off and everything must come back.
class Game
{
public:
  Game(World& world, std::uint64_t seed);

  /// Users and faults for so long; the checker watches.
  void play(Duration duration);
  /// Faults off: every drive back and refreshed, every lock releasable, every motor runs and stops.
  void calmDown();
  /// Instead of calmDown(): the program is ended in the middle of everything.
  void shutDown();

private:
  void end();
  void scheduleAct();

  Stage stage_;
  double pace_;  ///< [s] between two acts, on average
  Streams streams_;
  Users users_;
  Harm harm_;
  double harm_share_;  ///< of the acts
};
}  // namespace fuzz
}  // namespace inverter_bus

#endif  // INVERTER_BUS_FUZZ_GAME_H
