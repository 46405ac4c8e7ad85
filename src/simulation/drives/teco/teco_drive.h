// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

#ifndef INVERTER_BUS_SIMULATION_TECO_DRIVE_H
#define INVERTER_BUS_SIMULATION_TECO_DRIVE_H

#include <cstdint>
#include <optional>
#include <vector>

#include "inverter_bus/simulation/drive_options.h"
#include "simulation/drives/brand_drive.h"

namespace inverter_bus
{
namespace simulation
{
/// A TECO 7200MA with its motor.
///
/// From its MODBUS manual: functions, limits, characters, broadcast, reply delay, supervision of the communication with
/// its alarm, registers 0000H (command) and 0001H (frequency).
///
/// **Invented for the simulation,** because the manual's register list is lost; a driver must not rely on any of it
/// without its user's word:
/// - the bits of 0000H: 0 run forward, 1 reverse (DriveOptions::reverse_word: a run bit of its own, or the direction
///   beside bit 0), 2 external fault (trip 37), 3 fault reset, both on the rising edge; the rest does nothing;
/// - 0001H in 0.01 Hz, at most the maximum frequency Cn-02;
/// - the monitors, from DriveOptions::monitor_base on, in the order of the TECO L510: +0 status (bit 0 run, 1 reverse,
///   2 ready, 3 fault, 4 data setting error), +1 fault code (as `NAME trip` gave it; 20 over-current), +2 inputs (0),
///   +3 frequency command and +4 output frequency [0.01 Hz], +5 output voltage [0.1 V], +6 DC bus [1 V], +7 output
///   current [0.1 A];
/// - the parameters' addresses (from 0300H on, see the source) and ranges, and that a write reaches the EEPROM at once;
/// - exception 02 elsewhere, 21H for a value out of its limits, 22H for what can't be written now or ever.
///
/// Where the manual is silent: a good request to this station (or a broadcast to 0000H, 0001H) feeds the supervision
/// and ends the alarm, nothing else does; after a stop by it the motor stays stopped until RUN was off
/// (DriveOptions::restart_after_timeout: until the next request); Sn-36, 37, 38 count after a power cycle; 0000H and
/// 0001H are 0 after power-on; Sn-04 = 2 and Sn-05 = 2 mean RS-485.
class TecoDrive final : public BrandDrive<ModbusSlave>
{
public:
  /// \throws std::invalid_argument for an unknown parameter, a value out of its range, or a baud rate, station or
  /// monitor base that can't be; the text names it
  explicit TecoDrive(const DriveOptions& options);

  bool runCommand() const override;

protected:
  TimePoint nextChange(TimePoint limit) const override;
  void losePower() override;
  void gainPower() override;
  void control() override;
  void doTrip(int code) override;
  int overcurrentTrip() const override;
  Refusal stopByKey() override;
  Duration watchdogTimeout() const override;
  void onTimeout() override;
  void changeMore() override;
  void describeBrand(ShowList& list) const override;

  bool takesBroadcast(const Bytes& frame) const override;
  Duration replyDelay() const override;
  void heard(std::uint8_t function) override;
  ModbusException readRegisters(std::uint16_t wire, std::uint16_t count, std::vector<std::uint16_t>& values) override;
  ModbusException writeRegisters(std::uint16_t wire, const std::vector<std::uint16_t>& values,
                                 std::uint8_t function) override;

private:
  /// Why the motor stays stopped although the bus says RUN; ends when RUN goes off.
  enum class Hold
  {
    None,
    StopKey,
    TimeoutRamp,
    TimeoutFastRamp,
    TimeoutCoast
  };

  enum class Alarm
  {
    Off,
    Lit,
    Flashing
  };

  // teco_drive.cpp: commissioning, control, supervision
  void commissionLine();
  std::optional<LineSettings> serialInEffect() const;
  bool runBit(std::uint16_t command) const;
  bool busRuns() const;
  bool busSetsFrequency() const;
  double wantedFrequency() const;
  void setCommand(std::uint16_t command);
  void resetTrip();
  void setHold(Hold hold);
  std::optional<TimePoint> powerOnDeadline() const;
  void raiseAlarm();

  // teco_registers.cpp
  bool isMonitor(std::uint32_t wire) const;
  std::uint16_t monitor(std::uint32_t offset) const;
  std::uint16_t status() const;
  std::optional<std::uint16_t> readRegister(std::uint32_t wire) const;
  ModbusException checkWrite(std::uint32_t wire, std::uint16_t value) const;

  TimePoint powered_since_;
  Alarm alarm_ = Alarm::Off;
  std::uint64_t alarms_ = 0;
  std::uint16_t command_ = 0;    // 0000H
  std::uint16_t reference_ = 0;  // 0001H [0.01 Hz]
  bool setting_error_ = false;   // the last write was out of its limits
  Hold hold_ = Hold::None;

  struct Codes
  {
    Index bn01, bn02, bn04, cn02, cn27, sn04, sn05, sn36, sn37, sn38, sn39;
  };
  Codes code_{};
};
}  // namespace simulation
}  // namespace inverter_bus

#endif  // INVERTER_BUS_SIMULATION_TECO_DRIVE_H
