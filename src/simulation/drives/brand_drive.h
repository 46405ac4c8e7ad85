// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

#ifndef INVERTER_BUS_SIMULATION_BRAND_DRIVE_H
#define INVERTER_BUS_SIMULATION_BRAND_DRIVE_H

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "inverter_bus/simulation/drive_options.h"
#include "simulation/compoway/compoway_slave.h"
#include "simulation/drives/comm_watchdog.h"
#include "simulation/drives/motor.h"
#include "simulation/drives/panel_control.h"
#include "simulation/drives/parameter_memory.h"
#include "simulation/drives/show_list.h"
#include "simulation/modbus/modbus_slave.h"

namespace inverter_bus
{
namespace simulation
{
/// What the drives of all brands have in common: parameters that a panel shows and sets, a motor that trips the drive on
/// over-current, a supervision of the communication, a trip. A brand adds its registers and what its manual says about
/// commands; it must call commission() for its serial settings before it is used.
///
/// \p Slave is the protocol: ModbusSlave or CompowaySlave.
template <class Slave>
class BrandDrive : public Slave
{
public:
  /// \p model is the drive's name in all texts, \p table what it has of parameters, as from the factory.
  /// \throws std::invalid_argument for a table with a register or a code twice
  BrandDrive(const DriveOptions& options, std::string model, const typename Slave::Limits& limits,
             std::vector<Parameter> table);

  Refusal trip(int code, TimePoint now) override;
  Refusal takeOverAtPanel(double hertz, TimePoint now) override;
  Refusal releasePanel(TimePoint now) override;
  Refusal pressStopKey(TimePoint now) override;
  Refusal setSafeStop(bool active, TimePoint now) override;
  Refusal setParameter(const std::string& code, double value, TimePoint now) override;
  Refusal parameter(const std::string& code, KeyValues& values) const override;
  const Motor& motor() const override;

protected:
  using Index = ParameterMemory::Index;

  TimePoint nextChange(TimePoint limit) const override;
  void move(double seconds) override;
  void change() override;
  void losePower() override;
  double startUpTime() const override;
  void takeLoad(double load) override;
  void takeBusy(TimePoint until) override;
  void describeMotor(KeyValues& values) const override;

  /// Makes the motor follow what is commanded now; may be called at any time, however often.
  virtual void control() = 0;
  virtual void doTrip(int code) = 0;
  /// Why the drive has no trip \p code, or nothing: it has.
  virtual Refusal noSuchTrip(int code) const;
  /// The code of the trip on over-current, as the motor is now.
  virtual int overcurrentTrip() const = 0;
  virtual double ratedCurrent() const;   ///< [A]
  virtual double outputCurrent() const;  ///< [A] as the drive measures it
  /// The STOP key while the bus is in command. Returns why the key does nothing, or nothing: it stops.
  virtual Refusal stopByKey();
  /// The drive's own time-out of the communication as it counts now; 0: none.
  virtual Duration watchdogTimeout() const;
  virtual void onTimeout();
  /// What else happens at clock() without a request: after the time-out, before the over-current.
  virtual void changeMore();
  /// The parameter as the panel shows it now: some drives move the decimal point.
  virtual Parameter asShown(Index index) const;
  /// \p raw is how the drive was set before the simulation began.
  virtual void takeCommissioned(Index index, std::uint32_t raw);
  /// \p raw was set at the panel.
  virtual void takeFromPanel(Index index, std::uint32_t raw);
  /// What this brand has to show beside describeMotor()'s own.
  virtual void describeBrand(ShowList& list) const = 0;

  /// Sets what \p code shows on the panel before the simulation begins. \throws std::invalid_argument for a code or value
  /// that the drive doesn't have
  void commission(const std::string& code, double value);
  void commissionOptions();
  /// \throws std::invalid_argument when the options name a station outside \p first to \p last
  void requireStation(int first, int last) const;
  /// The code of the options' baud rate in \p bauds (baud rate -> code). \throws std::invalid_argument without one
  std::uint32_t baudCode(const std::map<int, std::uint32_t>& bauds) const;
  /// The baud rate whose code is \p code; nothing where none has it.
  static std::optional<int> baudOf(const std::map<int, std::uint32_t>& bauds, std::uint32_t code);
  double panelValue(Index index) const;  ///< what the RAM holds, in the panel's unit
  void recordTrip(int code);
  bool busy() const;

  const std::string model_name_;
  DriveOptions options_;
  ParameterMemory memory_;
  Motor motor_;
  CommWatchdog watchdog_;
  PanelControl panel_;
  TimePoint busy_until_;
  bool tripped_ = false;
  int last_trip_ = 0;
  std::uint64_t trip_count_ = 0;
};

extern template class BrandDrive<ModbusSlave>;
extern template class BrandDrive<CompowaySlave>;
}  // namespace simulation
}  // namespace inverter_bus

#endif  // INVERTER_BUS_SIMULATION_BRAND_DRIVE_H
