// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_BUS_DRIVE_SETTINGS_H
#define INVERTER_BUS_BUS_DRIVE_SETTINGS_H

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "inverter_bus/bus/types.h"

namespace inverter_bus
{
namespace bus
{
/// The drive's own settings that decide over safety, read once at every connect in the lowest class: who may command it,
/// what it does when the bus falls silent, whether it restarts by itself, how long it waits before it answers (contract,
/// sections 3.8, 3.12, 4.1 and 4.5).
class DriveSettings
{
public:
  DriveSettings(const drive::Drive& drive, std::uint8_t station);

  /// Reads everything again (the drive has come back).
  void restart();
  /// Another parameter is to be read.
  bool pending() const;
  wire::Request next() const;
  void done(const wire::Reply& reply);
  /// A parameter was written through the node: what it means may have changed.
  void reread(const std::string& parameter);

  /// The drive's own communication time-out, as read or assumed; nothing: none, or not known yet.
  std::optional<Duration> driveTimeout() const;
  /// The drive's own reply delay; 0 before it is known.
  Duration replyDelay() const;
  /// WARN lines that say what to set.
  std::vector<Finding> findings() const;
  /// Settings as read, for /diagnostics.
  std::vector<std::pair<std::string, std::string>> values() const;

private:
  struct Setting
  {
    drive::Parameter parameter;
    enum class State
    {
      Unread,
      Known,
      Refused
    } state = State::Unread;
    std::uint32_t raw = 0;
    double value = 0.0;
  };
  void want(const std::string& parameter);
  const Setting* find(const std::string& parameter) const;
  void expectationFindings(const std::vector<drive::Expectation>& expectations, const std::string& prefix,
                           std::vector<Finding>& findings) const;
  void lossFindings(std::vector<Finding>& findings) const;

  const drive::Drive& drive_;
  std::uint8_t station_;
  std::vector<Setting> settings_;
};
}  // namespace bus
}  // namespace inverter_bus

#endif  // INVERTER_BUS_BUS_DRIVE_SETTINGS_H
