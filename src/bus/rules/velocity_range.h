// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_BUS_VELOCITY_RANGE_H
#define INVERTER_BUS_BUS_VELOCITY_RANGE_H

#include <string>

#include "inverter_bus/bus/configuration.h"

namespace inverter_bus
{
namespace bus
{
/// What a velocity asks for, before anything armed or locked is considered.
struct RangedVelocity
{
  enum class Kind
  {
    /// Exactly 0.
    Zero,
    /// Rounds to 0 Hz, or is below the minimum: takes RUN off like a 0.
    NearZero,
    /// Within the range; \ref velocity is what to command.
    Motion,
    /// \ref why says in words what is allowed.
    Refused
  };
  Kind kind = Kind::Refused;
  /// In the user's unit, clamped; never larger than what was commanded.
  double velocity = 0.0;
  std::string why;
};

/// The range of one inverter's velocities (contract, 8.5): NaN and infinity are refused, near zero is a stop, 1e-6 beyond
/// the maximum is the maximum (a publisher that computes in 32 bits means it), and what is further beyond is refused or
/// clamped. No state.
class VelocityRange
{
public:
  /// Both must outlive it.
  VelocityRange(const drive::Drive& drive, const InverterConfig& config);

  /// 0 or near zero: takes RUN off, and is never refused.
  bool stops(double velocity) const;
  /// What \p velocity must be multiplied with to come down to the maximum, where `limit: saturate` allows that; else 1.
  double factorFor(double velocity) const;
  /// \p factor of the group, 0 < \p factor <= 1: the smallest that any of its members needs.
  RangedVelocity judge(double velocity, double factor) const;

private:
  bool nearZero(double velocity) const;
  bool beyond(double velocity) const;

  const drive::Drive& drive_;
  const InverterConfig& config_;
};
}  // namespace bus
}  // namespace inverter_bus

#endif  // INVERTER_BUS_BUS_VELOCITY_RANGE_H
