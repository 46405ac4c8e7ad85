// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_BUS_SETTING_LIST_H
#define INVERTER_BUS_BUS_SETTING_LIST_H

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "inverter_bus/bus/types.h"

namespace inverter_bus
{
namespace bus
{
/// How far a question to the drive has come.
enum class Told
{
  NotYet,
  Known,
  Refused
};

/// One of the drive's own settings and what is known of it.
struct Setting
{
  drive::Parameter parameter;
  /// Read before the first status.
  bool urgent = false;
  /// Read only while a command of this node is in force.
  bool when_commanded = false;
  Told told = Told::NotYet;
  /// Known, but to be read again.
  bool again = false;
  /// In a row, each of them temporary.
  unsigned refusals = 0;
  std::uint32_t raw = 0;
  double value = 0.0;
};

/// The drive's own settings that decide safety, and which of them is read next: those that identify the drive before all
/// others; one that the drive could not report just now lets the others go first. Pure. Not thread safe; the bus guards it.
class SettingList
{
public:
  /// Those that the profile names and the drive has. \p drive must outlive it.
  explicit SettingList(const drive::Drive& drive);

  /// All are read again (the drive has come back). \p urgent_too: also those that come before the first status.
  void restart(bool urgent_too = true);
  /// This one is read again: it was written through the node.
  void reread(const std::string& parameter);
  /// A command of this node is in force: only now can it be seen what commands the drive. Calling it again re-reads it.
  void commanded();
  /// A stop from this node was confirmed: what was seen under command no longer counts.
  void released();
  bool underCommand() const;

  /// The next one to be read; null: none.
  const Setting* next() const;
  /// It was reported before, or refused for the moment.
  bool nextRepeats() const;
  /// The answer to it.
  void done(const wire::Reply& reply);
  /// One is to be read before the first status.
  bool urgent() const;
  /// How long next() is to wait: 0, or, when all that is left was refused for the moment, 1 s, doubled with each refusal up
  /// to 64 s.
  Duration pauseBeforeNext() const;

  /// Null: not among them.
  const Setting* find(const std::string& parameter) const;
  /// Null: not known.
  const Setting* known(const std::string& parameter) const;
  const std::vector<Setting>& all() const;

private:
  void want(const std::string& parameter);
  void want(const std::vector<drive::Expectation>& expectations, bool urgent);
  bool due(const Setting& setting) const;

  const drive::Drive& drive_;
  std::vector<Setting> settings_;
  bool commanded_ = false;
};
}  // namespace bus
}  // namespace inverter_bus

#endif  // INVERTER_BUS_BUS_SETTING_LIST_H
