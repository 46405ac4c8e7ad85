// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_FUZZ_CALM_H
#define INVERTER_BUS_FUZZ_CALM_H

#include <vector>

#include "fuzz/bus/streams.h"

namespace inverter_bus
{
namespace fuzz
{
/// Faults off, and everything must come back: every drive refreshed, every call answered, every lock releasable; every
/// motor runs and stops.
class Calm
{
public:
  Calm(Stage& stage, Streams& streams);

  void play();

private:
  void mendEverything();
  void requireEveryDriveBack();
  void requireEveryStop();
  void requireOpenLocks();
  void resetAll();
  void runAll();
  void startAll();
  void startAgain(std::size_t index, int& times);
  bool runs(std::size_t index) const;
  void stopAll();

  Stage& stage_;
  Streams& streams_;
};
}  // namespace fuzz
}  // namespace inverter_bus

#endif  // INVERTER_BUS_FUZZ_CALM_H
