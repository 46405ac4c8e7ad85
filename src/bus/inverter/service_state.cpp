// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "bus/inverter/service_state.h"

namespace inverter_bus
{
namespace bus
{
void ServiceState::resetBegun()
{
  resetting_ = true;
}

void ServiceState::resetEnded()
{
  resetting_ = false;
}

bool ServiceState::resetting() const
{
  return resetting_;
}

void ServiceState::setupOpened()
{
  setup_open_ = true;
}

void ServiceState::setupLeft()
{
  setup_open_ = false;
}

bool ServiceState::setupOpen() const
{
  return setup_open_;
}

void ServiceState::eepromWritten()
{
  ++eeprom_writes_;
}

std::uint64_t ServiceState::eepromWrites() const
{
  return eeprom_writes_;
}
}  // namespace bus
}  // namespace inverter_bus
