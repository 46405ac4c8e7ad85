// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "drive/profile/status_fields.h"

namespace inverter_bus
{
namespace drive
{
const std::map<std::string, FlagField>& flagFields()
{
  static const std::map<std::string, FlagField> FIELDS = {
    { "run_seen", &Monitor::run_seen },
    { "operation", &Monitor::operation },
    { "running", &Monitor::running },
    { "ready", &Monitor::ready },
    { "at_speed", &Monitor::at_speed },
    { "at_set_frequency", &Monitor::at_set_frequency },
    { "overload_warning", &Monitor::overload_warning },
    { "pid_deviation", &Monitor::pid_deviation },
    { "faulted", &Monitor::faulted },
    { "restarted", &Monitor::restarted },
  };
  return FIELDS;
}

const std::map<std::string, QuantityField>& quantityFields()
{
  static const std::map<std::string, QuantityField> FIELDS = {
    { "output_frequency", &Monitor::output_frequency },
    { "output_current", &Monitor::output_current },
    { "output_voltage", &Monitor::output_voltage },
    { "dc_voltage", &Monitor::dc_voltage },
    { "torque", &Monitor::torque },
    { "temperature", &Monitor::temperature },
  };
  return FIELDS;
}

const std::set<std::string>& codeFields()
{
  static const std::set<std::string> FIELDS = { "raw_status", "fault_code", "warning_code" };
  return FIELDS;
}

const std::map<std::string, RecordField>& recordFields()
{
  static const std::map<std::string, RecordField> FIELDS = {
    { "output_frequency", &FaultRecord::output_frequency },
    { "output_current", &FaultRecord::output_current },
    { "dc_voltage", &FaultRecord::dc_voltage },
    { "run_hours", &FaultRecord::run_hours },
    { "power_on_hours", &FaultRecord::power_on_hours },
  };
  return FIELDS;
}
}  // namespace drive
}  // namespace inverter_bus
