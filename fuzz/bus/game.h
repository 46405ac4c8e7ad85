// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_FUZZ_GAME_H
#define INVERTER_BUS_FUZZ_GAME_H

#include <string>
#include <vector>

#include "fuzz/bus/dice.h"
#include "fuzz/bus/world.h"

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
  /// Repeats a velocity as a user's program does.
  struct Stream
  {
    bool on = false;
    unsigned number = 0;
    double hertz = 0.0;
    double drift = 0.0;
    bool wavers = false;  ///< changes with every message and stays in its range
    bool grouped = false;
    unsigned sent = 0;
    double period = 0.1;
    bool dips = false;  ///< goes near zero now and then, as a controller does
    TimePoint until;
    std::string publisher;
  };

  void act();
  void scheduleAct();
  void use();
  void harm();
  void move();
  void beginStream(std::size_t index);
  void tickStream(std::size_t index, unsigned number);
  void sendVelocity(std::size_t index, double hertz, const std::string& publisher);
  void sendStream(std::size_t index, const Stream& stream);
  void sendNearZero(std::size_t index, const std::string& publisher);
  double nearZero(std::size_t index);
  void sendLatched(std::size_t index);
  void sendGroup();
  void sendNonsense(std::size_t index);
  void storm();
  void stopSomething();
  void callService(std::size_t index);
  void harmReplies(std::size_t index);
  void harmDrive(std::size_t index);
  void harmLine();
  void killSeveral();
  void failWhileItChanges();
  std::size_t anyone();
  double anySpeed(std::size_t index);
  std::string anyPublisher();
  const std::string& nameOf(std::size_t index) const;
  bool allOf(const std::function<bool(std::size_t)>& condition) const;
  void require(Duration limit, const std::string& rule, const std::function<bool()>& condition);
  void mendEverything();
  void resetAll();
  void runAll();
  bool runOne(std::size_t index);
  void startAgain(std::size_t index, int& times);
  void stopAll();

  World& world_;
  Dice dice_;
  /// For what goes beyond limits and near zero: the rest of a story does not depend on it.
  Dice limits_dice_;
  std::vector<Stream> streams_;
  bool acting_ = false;      ///< chance goes on
  bool streaming_ = false;   ///< streams go on
  bool refuses_ = false;     ///< drives refuse requests; otherwise replies of another kind come
  double pace_ = 0.1;        ///< [s] between two acts, on average
  double harm_share_ = 0.3;  ///< of the acts
};
}  // namespace fuzz
}  // namespace inverter_bus

#endif  // INVERTER_BUS_FUZZ_GAME_H
