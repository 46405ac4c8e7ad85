// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_BUS_INVERTER_REPORT_H
#define INVERTER_BUS_BUS_INVERTER_REPORT_H

#include <string>
#include <utility>
#include <vector>

#include "bus/inverter/inverter.h"

// What is reported to users of one inverter.

namespace inverter_bus
{
namespace bus
{
/// The status message as of \p now; its values keep the time of the reply that brought them.
InverterStatus statusOf(const Inverter& inverter, TimePoint now);
/// Errors and warnings for /diagnostics, most severe first, each with what to do.
std::vector<Finding> findingsOf(const Inverter& inverter, TimePoint now);
/// Key and value pairs for /diagnostics.
std::vector<std::pair<std::string, std::string>> valuesOf(const Inverter& inverter, TimePoint now);

/// For the log when it answers (again): what is to be done before it moves.
std::string onlineText(const Inverter& inverter);
/// Why it is offline: the last error, and what came in place of a status.
std::string offlineReason(const Inverter& inverter);
}  // namespace bus
}  // namespace inverter_bus

#endif  // INVERTER_BUS_BUS_INVERTER_REPORT_H
