// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_BUS_SERVICE_STATE_H
#define INVERTER_BUS_BUS_SERVICE_STATE_H

#include <cstdint>

namespace inverter_bus
{
namespace bus
{
/// What services have under way in one drive, and how often this node has written its EEPROM. Not thread safe; the bus
/// guards it.
class ServiceState
{
public:
  /// A reset of a trip is under way.
  void resetBegun();
  void resetEnded();
  bool resetting() const;

  /// Frames of a job have led the drive into its setup area, where it can't run.
  void setupOpened();
  void setupLeft();
  bool setupOpen() const;

  /// The drive's EEPROM has been written once more by this node.
  void eepromWritten();
  std::uint64_t eepromWrites() const;

private:
  bool resetting_ = false;
  bool setup_open_ = false;
  std::uint64_t eeprom_writes_ = 0;
};
}  // namespace bus
}  // namespace inverter_bus

#endif  // INVERTER_BUS_BUS_SERVICE_STATE_H
