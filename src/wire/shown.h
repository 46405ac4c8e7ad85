// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_WIRE_SHOWN_H
#define INVERTER_BUS_WIRE_SHOWN_H

#include "config/shown.h"

namespace inverter_bus
{
namespace wire
{
using config::shown;
}  // namespace wire
}  // namespace inverter_bus

#endif  // INVERTER_BUS_WIRE_SHOWN_H
