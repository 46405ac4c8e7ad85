// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

#ifndef INVERTER_BUS_SIMULATION_DRIVE_OPTIONS_H
#define INVERTER_BUS_SIMULATION_DRIVE_OPTIONS_H

#include <cstdint>
#include <map>
#include <string>

#include "inverter_bus/simulation/line_settings.h"
#include "inverter_bus/simulation/time.h"

namespace inverter_bus
{
namespace simulation
{
/// How one simulated drive is mounted and commissioned.
struct DriveOptions
{
  std::string name;
  int station = 1;
  LineSettings line;             ///< what the drive's serial parameters are set to
  TimePoint start{};             ///< the drive is ready at this time
  std::uint64_t seed = 1;        ///< of its chance
  double turnaround = 0.002;     ///< [s] processing time after the 3.5-character silence, before the reply
  double start_up_time = 1.0;    ///< [s] deaf after power-on
  double reset_silence = 1.0;    ///< [s] deaf after a trip reset (LinuxCNC's wj200_vfd waits 1 s for that reason)
  double eeprom_time = 0.3;      ///< [s] that storing parameters takes
  double rated_current = 5.0;    ///< [A]
  double rated_voltage = 230.0;  ///< [V] of motor and mains
  double load = 0.3;             ///< 1.0 = rated torque
  /// After its watchdog stopped the motor without a trip (C076 = 3, 4) and the master is back with RUN still on: run
  /// again (true), or wait until RUN was off (false). The manuals don't say.
  bool restart_after_timeout = false;
  /// The coils for external trip and reset fall back by themselves (true) or stay as written (false). The manuals don't
  /// say; LinuxCNC's wj200_vfd writes them on only.
  bool self_clearing_coils = false;
  /// MX2: a read of several registers may hold mapped ones (P200). The manuals show reads of one only.
  bool mapped_reads_in_blocks = true;
  /// MX2: registers that its lists call "reserved" can be read (0), else they answer 02. The manuals don't say.
  bool reserved_readable = true;
  /// 7200MA: command word for reverse, 2 (a run bit of its own) or 3 (direction bit beside RUN). Unknown, see TecoDrive.
  int reverse_word = 2;
  int monitor_base = 0x0020;  ///< 7200MA: first monitor register. Unknown, see TecoDrive.
  /// 3G3JE: service 30 05 by meaning, four hexadecimal digits (command code, related information). Unknown, see JeDrive;
  /// replaces its invented ones by name: { "run_forward", "1101" }
  std::map<std::string, std::string> operation_codes;
  bool area_1_readable = true;               ///< 3G3JE: C3 can be read in setup area 0; the manual doesn't say
  std::map<std::string, double> parameters;  ///< as set at the panel, in the panel's unit: { "C077", 1.0 }
};
}  // namespace simulation
}  // namespace inverter_bus

#endif  // INVERTER_BUS_SIMULATION_DRIVE_OPTIONS_H
