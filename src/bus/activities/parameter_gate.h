// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_BUS_PARAMETER_GATE_H
#define INVERTER_BUS_BUS_PARAMETER_GATE_H

#include <cstdint>
#include <string>

#include "inverter_bus/drive/drive.h"

namespace inverter_bus
{
namespace bus
{
/// The verdict on a parameter that is to be written, or can't be read (contract, 4.10). Pure: only the drive's profile
/// and the arguments decide.
struct WriteVerdict
{
  /// 0: it may.
  std::uint16_t error_id = 0;
  /// Why not, for the user.
  std::string text;
  /// The value in counts of the drive.
  std::uint32_t raw = 0;
};

/// May this parameter be written? \p value in its own unit. \p read_only_access: key `parameter_access: read_only`. \p
/// may_run: the motor runs, or may.
WriteVerdict checkWrite(const drive::Drive& drive, const std::string& name, double value, bool persist,
                        bool read_only_access, bool may_run);

/// Why a parameter that Drive::findParameter() does not find for reading can't be read.
WriteVerdict whyNotReadable(const drive::Drive& drive, const std::string& name);
}  // namespace bus
}  // namespace inverter_bus

#endif  // INVERTER_BUS_BUS_PARAMETER_GATE_H
