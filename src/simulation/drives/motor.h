// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

#ifndef INVERTER_BUS_SIMULATION_MOTOR_H
#define INVERTER_BUS_SIMULATION_MOTOR_H

namespace inverter_bus
{
namespace simulation
{
/// The drive's ramps.
struct Ramps
{
  double maximum = 50.0;       ///< [Hz] what the ramp times refer to
  double acceleration = 10.0;  ///< [s] from 0 to maximum, > 0
  double deceleration = 10.0;  ///< [s] from maximum to 0, > 0
  double start = 0.5;          ///< [Hz] below it nothing turns
};

/// Name plate.
struct MotorRating
{
  double current = 5.0;     ///< [A]
  double voltage = 230.0;   ///< [V] output voltage at the base frequency; also that of the mains
  double frequency = 50.0;  ///< [Hz] base frequency
};

/// Output stage of an inverter with a motor and its load: frequency on ramps, and plausible figures for current,
/// torque, voltages and temperature that follow from frequency, load and ramp. Deterministic; time comes in as steps.
class Motor
{
public:
  explicit Motor(const MotorRating& rating);

  void setRating(const MotorRating& rating);
  void setRamps(const Ramps& ramps);
  /// \p load >= 0; 1 = rated torque.
  void setLoad(double load);
  double load() const;

  /// From now on ramps to this output frequency, through zero where the direction changes. The sign of \p hertz is the
  /// direction; less than the start frequency means standstill.
  void rampTo(double hertz);
  /// Switches the output off at once (free run).
  void cut();
  void advance(double seconds);
  /// [s] until the present piece of the ramp ends (target or standstill reached); 0 at constant speed.
  double timeToNextCorner() const;

  double frequency() const;  ///< [Hz] of the output, signed; 0: output off
  double target() const;     ///< [Hz] signed
  bool turning() const;
  bool accelerating() const;
  bool decelerating() const;

  double current() const;      ///< [A]
  double torque() const;       ///< [% of rated], sign = direction
  double voltage() const;      ///< [V] output
  double dcVoltage() const;    ///< [V] DC bus
  double power() const;        ///< [kW] input
  double temperature() const;  ///< [degC] of the heat sink

private:
  void moveFrequency(double& seconds);

  MotorRating rating_;
  Ramps ramps_;
  double load_ = 0.3;
  double frequency_ = 0.0;
  double target_ = 0.0;
  double temperature_ = 25.0;
};
}  // namespace simulation
}  // namespace inverter_bus

#endif  // INVERTER_BUS_SIMULATION_MOTOR_H
