// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_FUZZ_LIMITS_H
#define INVERTER_BUS_FUZZ_LIMITS_H

#include "fuzz/bus/scene.h"
#include "inverter_bus/bus/types.h"

namespace inverter_bus
{
namespace fuzz
{
/// Rounds to 0 Hz, or lies below the minimum (contract, 8.5). Velocities are in the user's unit.
bool isNearZero(const InverterFacts& facts, double velocity);

/// Above the maximum.
bool isBeyond(const InverterFacts& facts, double velocity);

/// A command that moves its inverter: neither 0, nor near it, nor nonsense.
bool moves(const InverterFacts& facts, double velocity);

/// What all velocities of a message are multiplied by: the smallest factor that any of those that saturate needs.
double groupFactor(const Scene& scene, const bus::VelocityCommand& command);
}  // namespace fuzz
}  // namespace inverter_bus

#endif  // INVERTER_BUS_FUZZ_LIMITS_H
