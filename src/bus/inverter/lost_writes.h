// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_BUS_LOST_WRITES_H
#define INVERTER_BUS_BUS_LOST_WRITES_H

#include <string>

namespace inverter_bus
{
namespace bus
{
/// Writes of command words that one inverter has not answered (contract, 8.1). They are counted separately: a drive
/// that answers every read and loses every write is not offline, but it can't be commanded either. Pure; not thread safe.
class LostWrites
{
public:
  /// \p retries repeats of a lost frame of a velocity (bus parameter `retries`); \p offline_after lost writes in a row
  /// (bus parameter `offline_after`) after which the inverter is to be stopped and locked.
  LostWrites(int retries, int offline_after);

  // --- the tries of a velocity --------------------------------------------------------------------------------------
  /// A frame of a velocity, or the loop-back before it, was lost; true: another try is left. A newer velocity does not
  /// give new tries, only an acknowledged write does, or the end of this velocity.
  bool tryAgain();
  /// The velocity has failed: the next one is a new command.
  void velocityEnded();

  // --- all command writes, a stop's too -----------------------------------------------------------------------------
  /// A command write was lost; true: so many in a row that the inverter is to be stopped and locked.
  bool lost();
  void acknowledged();
  /// A read of the status was answered; clears nothing. True, once, if it shows that what was raised concerns writes only.
  bool readAnswered();

  /// The inverter was stopped and locked for it; ends with an acknowledged write, or when the inverter goes offline.
  void raise();
  void lower();
  bool raised() const;
  /// For users: what is lost and what is not.
  std::string text() const;
  /// Lost command writes since the last acknowledged one.
  int inARow() const;

private:
  int retries_;
  int offline_after_;
  int tries_ = 0;
  int in_a_row_ = 0;
  bool read_answered_ = false;
  bool raised_ = false;
};
}  // namespace bus
}  // namespace inverter_bus

#endif  // INVERTER_BUS_BUS_LOST_WRITES_H
