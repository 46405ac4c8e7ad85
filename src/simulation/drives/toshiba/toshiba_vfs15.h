// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

#ifndef INVERTER_BUS_SIMULATION_TOSHIBA_VFS15_H
#define INVERTER_BUS_SIMULATION_TOSHIBA_VFS15_H

#include <array>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "inverter_bus/simulation/drive_options.h"
#include "simulation/drives/brand_drive.h"
#include "simulation/drives/motor_usage.h"
#include "simulation/drives/toshiba/toshiba_model.h"

namespace inverter_bus
{
namespace simulation
{
/// A Toshiba VF-S15 (or VF-S11) on Modbus RTU with its motor, written from the communication manual E6581913 (page
/// numbers are its). It is commissioned for the bus: F829 = 1, F802 = its number, F800 and F801 as the line; everything
/// else is as from the factory (a drive for 60 Hz): the panel is in command until the bus takes over with FA00.
///
/// Rating: `parameters: {FE70: 4.8, FE71: 200.0}` [A], [V], which FB05 and the identification follow; the scan list's
/// rated_current is what a driver believes, so it doesn't count here.
///
/// Where the manual is silent: while it is busy writes are answered with exception 04; broadcasts don't feed the
/// communication timer; F805 adds to the processing time; FE00 ... FE90 follow the present values except in a trip;
/// presets win over FA01; the later of FA01 and FA13 counts; a change of F519 keeps the ramp times; the STOP key holds
/// the motor until RUN of the bus was off; coast means standstill at once.
/// Not there: FA65-FA80 (panel texts), PID, terminal inputs, the switch-over F505, retries.
class ToshibaVfs15 final : public BrandDrive<ModbusSlave>
{
public:
  /// \throws std::invalid_argument for an unknown parameter, a value out of its range, or a baud rate or station that
  /// the drive doesn't have; the text names it
  ToshibaVfs15(const ToshibaModel& model, const DriveOptions& options);

  Refusal takeOverAtPanel(double hertz, TimePoint now) override;
  Refusal releasePanel(TimePoint now) override;
  Refusal pressStopKey(TimePoint now) override;
  /// The terminal ST: off (active) coasts, without a trip.
  Refusal setSafeStop(bool active, TimePoint now) override;
  /// \p code may also be a monitor register such as "FC91": it shows this raw value until the drive is switched off.
  Refusal setParameter(const std::string& code, double value, TimePoint now) override;
  bool runCommand() const override;

protected:
  void move(double seconds) override;
  void losePower() override;
  void gainPower() override;
  void control() override;
  void doTrip(int code) override;
  Refusal noSuchTrip(int code) const override;
  int overcurrentTrip() const override;
  double ratedCurrent() const override;
  double outputCurrent() const override;
  Duration watchdogTimeout() const override;
  void onTimeout() override;
  void changeMore() override;
  Parameter asShown(Index index) const override;
  void takeCommissioned(Index index, std::uint32_t raw) override;
  void takeFromPanel(Index index, std::uint32_t raw) override;
  void describeBrand(ShowList& list) const override;

  std::optional<Answer> answer(const Bytes& frame, TimePoint now, bool& good) override;
  bool isBroadcast(const Bytes& frame) const override;
  Duration replyDelay() const override;
  void heard(std::uint8_t function) override;
  ModbusException readRegisters(std::uint16_t wire, std::uint16_t count, std::vector<std::uint16_t>& values) override;
  ModbusException writeRegisters(std::uint16_t wire, const std::vector<std::uint16_t>& values,
                                 std::uint8_t function) override;

private:
  using Number = std::uint16_t;

  /// Parameters that count as they were at the last power-up, reset or F899 (p. 47, 48).
  struct InEffect
  {
    std::array<std::uint32_t, 2> write_slots{};
    std::array<std::uint32_t, 5> read_slots{};
  };

  struct Write
  {
    Number number;
    std::uint16_t value;
  };

  // toshiba_vfs15.cpp: commissioning, power and time
  void commissionLine();
  void takeEffect();
  void clearRam();
  std::uint32_t raw(Number number) const;
  double hertz(Number number) const;
  void tripAfterStop(int code);
  void resetFault();
  bool communicationMode() const;

  // toshiba_control.cpp: who commands what, and the motor
  Ramps ramps() const;
  bool command(unsigned int bit) const;
  bool local() const;
  bool busCommands() const;
  int commandSource() const;
  int frequencySource() const;
  int accelerationPattern() const;
  unsigned int preset() const;
  bool jogging() const;
  bool forcedStop() const;
  bool coasting() const;
  bool dcBraking() const;
  bool reverse() const;
  bool runs() const;
  bool running() const;
  double busFrequency() const;
  double wantedFrequency() const;
  double limited(double hertz) const;
  double overloadLevel() const;

  // toshiba_frames.cpp: what is special about the frames
  bool fixedFieldsWrong(const Bytes& frame) const;
  Answer identify(const Bytes& frame);
  int capacityCode() const;

  // toshiba_monitors.cpp: what is read only
  void buildMonitors();
  void buildMeasurements();
  void buildRecords();
  void addMonitor(Number number, std::function<double()> raw);
  void addHeld(Number number, const std::function<double()>& raw);
  std::uint16_t status1();
  std::uint16_t status2();
  std::uint16_t status3();
  std::uint16_t outputTerminals();
  bool output(std::uint32_t function) const;
  bool reached(double target) const;
  std::uint16_t alarms() const;
  std::uint16_t unstable(std::uint16_t mask);

  // toshiba_registers.cpp: reading and writing
  bool isSlot(Number number) const;
  std::optional<std::uint16_t> readRegister(Number number);
  ModbusException readSlots(Number number, std::uint16_t count, std::vector<std::uint16_t>& values);
  ModbusException target(Number number, const std::vector<std::uint16_t>& values, std::vector<Write>& writes) const;
  ModbusException check(const Write& write) const;
  ModbusException checkCommand(const Write& write) const;
  ModbusException checkParameter(Index index, std::uint32_t raw) const;
  std::pair<std::uint32_t, std::uint32_t> rangeOf(Index index) const;
  bool locked(Index index) const;
  bool refusesAccess(Number number, bool write) const;
  void apply(const Write& write);
  void applyCommand(std::uint16_t word);
  void clearRunWhenCoasting();
  void afterStore(Number number, std::uint32_t raw);
  void setTimeUnit(std::uint32_t unit);
  void restoreFactorySettings(std::uint32_t kind);

  const ToshibaModel& model_;
  InEffect in_effect_;
  std::map<Number, std::uint16_t> ram_;  // FA00 ..., lost with the power
  bool speed_by_rpm_ = false;            // FA13 was written after FA01
  std::unordered_map<Number, std::function<double()>> monitors_;
  std::map<Number, std::uint16_t> held_;    // FExx in a trip
  std::map<Number, std::uint16_t> pinned_;  // by hand

  int panel_run_ = 0;               // -1, 0, 1: what the panel commands
  bool held_by_key_ = false;        // STOP key
  bool safe_stop_ = false;          // terminal ST off
  int trip_after_stop_ = 0;         // code
  std::deque<int> trips_;           // newest first
  std::array<double, 2> starts_{};  // forward, reverse
  TimePoint powered_since_;
  bool silent_ = false;         // the present request gets no reply
  bool stored_ = false;         // the present request wrote the EEPROM
  bool timer_renewed_ = false;  // the present request set the communication timer, so it doesn't start it
  MotorUsage usage_;
};
}  // namespace simulation
}  // namespace inverter_bus

#endif  // INVERTER_BUS_SIMULATION_TOSHIBA_VFS15_H
