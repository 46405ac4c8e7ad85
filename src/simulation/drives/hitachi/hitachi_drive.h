// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

#ifndef INVERTER_BUS_SIMULATION_HITACHI_DRIVE_H
#define INVERTER_BUS_SIMULATION_HITACHI_DRIVE_H

#include <array>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "inverter_bus/simulation/drive_options.h"
#include "simulation/drives/brand_drive.h"
#include "simulation/drives/hitachi/hitachi_model.h"
#include "simulation/drives/hitachi/register_map.h"
#include "simulation/drives/motor_usage.h"

namespace inverter_bus
{
namespace simulation
{
/// A drive of the Hitachi family (OMRON MX2, RX) on Modbus RTU with its motor, written from the manuals (sources: see
/// HitachiModel). It is commissioned for the bus: A001 = A002 = 03 and serial parameters that fit the line; everything
/// else is as from the factory.
///
/// Where the manuals are silent: A001, A002 and C076-C078 take effect at once, C071-C075 and C072 after a power cycle;
/// only requests to this station and broadcasts feed the watchdog; reset and external trip act on the coil's rising
/// edge.
class HitachiDrive final : public BrandDrive<ModbusSlave>
{
public:
  /// \throws std::invalid_argument for an unknown parameter, a value out of its range, or a baud rate or station that
  /// the drive doesn't have; the text names it
  HitachiDrive(const HitachiModel& model, const DriveOptions& options);

  Refusal showTripAs(unsigned state) override;
  Refusal setSafeStop(bool active, TimePoint now) override;
  bool runCommand() const override;

protected:
  void move(double seconds) override;
  void losePower() override;
  void gainPower() override;
  void control() override;
  void doTrip(int code) override;
  Refusal noSuchTrip(int code) const override;
  int overcurrentTrip() const override;
  Refusal stopByKey() override;
  Duration watchdogTimeout() const override;
  void onTimeout() override;
  void changeMore() override;
  void describeBrand(ShowList& list) const override;

  bool isGroup(std::uint8_t station) const override;
  Duration replyDelay() const override;
  void heard(std::uint8_t function) override;
  ModbusException readCoils(std::uint16_t wire, std::uint16_t count, std::vector<bool>& values) override;
  ModbusException writeCoils(std::uint16_t wire, const std::vector<bool>& values) override;
  ModbusException readRegisters(std::uint16_t wire, std::uint16_t count, std::vector<std::uint16_t>& values) override;
  ModbusException writeRegisters(std::uint16_t wire, const std::vector<std::uint16_t>& values,
                                 std::uint8_t function) override;

private:
  /// One block of the trip history (d081-d086).
  struct TripRecord
  {
    int code = 0;
    int state = 0;
    double frequency = 0.0;   // [Hz]
    double current = 0.0;     // [A]
    double dc_voltage = 0.0;  // [V]
    double run_time = 0.0;    // [s]
    double power_time = 0.0;  // [s]
  };

  /// A read-only register (or pair) and where its raw value comes from.
  struct Monitor
  {
    int words;
    std::function<double()> raw;
  };

  /// Why the motor stays stopped although the bus says RUN; ends when RUN goes off.
  enum class Hold
  {
    None,
    StopKey,
    TimeoutRamp,
    TimeoutFreeRun
  };

  /// What one write request is about to change; applied only when all of it is allowed.
  struct Change
  {
    std::map<Index, std::uint32_t> parameters;
    std::optional<std::uint32_t> reference;
    std::optional<std::uint16_t> pid_feedback;
    std::optional<std::uint16_t> enter;
    std::optional<std::uint16_t> write_mode;
    std::optional<std::uint16_t> coils;
  };

  // hitachi_drive.cpp: commissioning and control
  void commissionLine();
  Index known(const char* code) const;
  std::optional<LineSettings> serialInEffect() const;
  bool runCommanded() const;
  double wantedFrequency() const;
  double limited(double hertz) const;
  double maximumFrequency() const;
  bool freeRunInput() const;
  void resetTrip();
  void setHold(Hold hold);
  int runState() const;

  // hitachi_coils.cpp
  bool coil(int number) const;
  bool statusCoil(int number) const;
  bool writableCoil(int number) const;
  void setCoil(int number, bool value);
  std::uint16_t coilWord(int first) const;
  bool atSetFrequency() const;
  bool atArrivalFrequency() const;

  // hitachi_mapping.cpp
  int wordsAt(std::uint16_t number) const;
  std::uint16_t otherHalf(std::uint16_t number) const;
  bool mapsAny(std::uint32_t first, std::uint32_t count) const;
  ModbusException resolve(std::uint16_t number, std::uint16_t& internal, const RegisterMap::Slot*& slot) const;
  ModbusException readMapped(std::uint16_t number, std::uint16_t& value) const;
  ModbusException stageMapped(std::uint16_t number, std::uint16_t value, Change& change) const;

  // hitachi_registers.cpp
  void buildMonitors();
  void buildTripMonitors();
  void buildModelMonitors();
  void addMonitor(std::uint16_t number, int words, const std::function<double()>& raw);
  std::optional<std::uint16_t> readRegister(std::uint16_t number) const;
  ModbusException stage(std::uint16_t number, std::uint16_t value, Change& change) const;
  ModbusException check(const Change& change) const;
  ModbusException checkParameter(Index index, std::uint32_t raw) const;
  void apply(const Change& change, bool to_eeprom);

  const HitachiModel& model_;
  std::unordered_map<std::uint16_t, std::pair<std::uint16_t, Monitor>>
      monitors_;  // by register; first = start register

  std::array<bool, 16> coils_{};  // by printed number, 0001h-000Eh
  std::uint32_t reference_ = 0;   // F001 [0.01 Hz]
  std::uint16_t pid_feedback_ = 0;
  Hold hold_ = Hold::None;
  bool trip_after_stop_ = false;
  bool safe_stop_ = false;
  static constexpr unsigned TRIP_STATE = 2;
  unsigned trip_state_ = TRIP_STATE;  ///< status B while it is tripped
  std::deque<TripRecord> trips_;      // newest first
  bool store_next_write_ = false;     // register 0902h
  bool store_this_write_ = false;
  MotorUsage usage_;
  RegisterMap map_;

  struct Codes
  {
    Index f002, f003, a001, a002, a003, a004, a020, a061, a062, b012, b031, b035, b082, b086, b087, b091, c041, c042,
        c043, c063, c071, c072, c074, c075, c076, c077, c078;
  };
  Codes code_{};
  std::vector<Index> input_functions_;  // C001 ...
};
}  // namespace simulation
}  // namespace inverter_bus

#endif  // INVERTER_BUS_SIMULATION_HITACHI_DRIVE_H
