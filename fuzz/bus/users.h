// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_FUZZ_USERS_H
#define INVERTER_BUS_FUZZ_USERS_H

#include "fuzz/bus/streams.h"

namespace inverter_bus
{
namespace fuzz
{
/// Users by chance: streams, single and grouped commands, nonsense, stops and calls.
class Users
{
public:
  Users(Stage& stage, Streams& streams);

  /// One of them does something.
  void act();

private:
  void move();
  void sendGroup();
  void sendLatched(std::size_t index);
  void sendNonsense(std::size_t index);
  void stopSomething();
  void callService(std::size_t index);
  void callReset(std::size_t index);
  void storm();

  Stage& stage_;
  Streams& streams_;
};
}  // namespace fuzz
}  // namespace inverter_bus

#endif  // INVERTER_BUS_FUZZ_USERS_H
