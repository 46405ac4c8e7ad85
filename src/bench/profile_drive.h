// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_BENCH_PROFILE_DRIVE_H
#define INVERTER_BUS_BENCH_PROFILE_DRIVE_H

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "inverter_bus/drive/profile.h"
#include "inverter_bus/simulation/drive_options.h"
#include "simulation/drives/comm_watchdog.h"
#include "simulation/drives/motor.h"
#include "simulation/modbus/modbus_slave.h"

namespace inverter_bus
{
namespace bench
{
class ProfileMemory;

/// A Modbus drive that does what its profile says and nothing else: its registers and coils are those that the profile names,
/// the commands are the profile's sequences, the status reports what the motor does. So a slip in the profile (a wrong address, a
/// wrong scale) is played along and not found: this rehearses an installation, it does not check a profile.
///
/// What no profile says is invented: ramps of 5 s for the whole range, a communication time-out that ramps the motor down
/// (unless the profile says that it runs on), trips that cut it and are over with the reset once RUN is off, settings that are
/// as the profile wants them.
class ProfileDrive : public simulation::ModbusSlave
{
public:
  /// \throws std::invalid_argument for a parameter of the options that the profile lacks, or a station outside its range
  ProfileDrive(std::shared_ptr<const drive::Profile> profile, const simulation::DriveOptions& options);
  ~ProfileDrive() override;

  simulation::Refusal trip(int code, simulation::TimePoint now) override;
  simulation::Refusal takeOverAtPanel(double hertz, simulation::TimePoint now) override;
  simulation::Refusal releasePanel(simulation::TimePoint now) override;
  simulation::Refusal pressStopKey(simulation::TimePoint now) override;
  simulation::Refusal setSafeStop(bool active, simulation::TimePoint now) override;
  simulation::Refusal setParameter(const std::string& code, double value, simulation::TimePoint now) override;
  simulation::Refusal parameter(const std::string& code, simulation::KeyValues& values) const override;
  const simulation::Motor& motor() const override;
  bool runCommand() const override;

protected:
  simulation::Duration replyDelay() const override;
  void heard(std::uint8_t function) override;
  simulation::ModbusException readCoils(std::uint16_t wire, std::uint16_t count, std::vector<bool>& values) override;
  simulation::ModbusException writeCoils(std::uint16_t wire, const std::vector<bool>& values) override;
  simulation::ModbusException readRegisters(std::uint16_t wire, std::uint16_t count,
                                            std::vector<std::uint16_t>& values) override;
  simulation::ModbusException writeRegisters(std::uint16_t wire, const std::vector<std::uint16_t>& values,
                                             std::uint8_t function) override;
  simulation::TimePoint nextChange(simulation::TimePoint limit) const override;
  void move(double seconds) override;
  void change() override;
  void losePower() override;
  void gainPower() override;
  double startUpTime() const override;
  void takeLoad(double load) override;
  void takeBusy(simulation::TimePoint until) override;
  void describeMotor(simulation::KeyValues& values) const override;

private:
  /// What the sequences have made of the motor.
  enum class Motion
  {
    Rest,
    Coast,
    Forward,
    Reverse
  };

  void commission();
  void setAsWanted(const std::vector<drive::Expectation>& expectations);
  simulation::ModbusException write(drive::Space space, std::uint16_t wire, const std::vector<std::uint16_t>& values);
  simulation::ModbusException refusalOf(drive::Space space, std::uint16_t address, std::uint16_t value) const;
  void obey(drive::Space space, std::uint16_t first, std::size_t count);
  bool startsReset(drive::Space space, std::uint16_t first, std::size_t count) const;
  std::optional<Motion> motionOfPoints() const;
  double setpoint() const;
  void control();
  void doTrip(int code);
  void showStatus();
  void showField(const std::string& field, const drive::Item& item);
  std::optional<double> quantity(const std::string& field, const drive::Item& item) const;
  std::optional<int> state(const std::string& field) const;
  simulation::Duration timeout() const;
  const drive::Parameter* find(const std::string& code) const;

  std::shared_ptr<const drive::Profile> profile_;
  simulation::DriveOptions options_;
  std::unique_ptr<ProfileMemory> memory_;
  simulation::Motor motor_;
  simulation::CommWatchdog watchdog_;
  Motion motion_ = Motion::Rest;
  bool tripped_ = false;
  bool held_ = false;  ///< at rest until RUN was off: after a trip, a time-out, the STOP key
  int trip_ = 0;
  std::vector<int> trips_;
  std::optional<double> panel_;
};
}  // namespace bench
}  // namespace inverter_bus

#endif  // INVERTER_BUS_BENCH_PROFILE_DRIVE_H
