// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_SRC_BUS_CONFIGURATION_REFUSALS_H
#define INVERTER_BUS_SRC_BUS_CONFIGURATION_REFUSALS_H

#include <string>
#include <vector>

#include "config/complaints.h"
#include "config/cursor.h"
#include "inverter_bus/bus/configuration.h"

namespace inverter_bus
{
namespace bus
{
using config::Range;
using config::Section;

/// \p value in one short line of printable characters, for messages.
std::string describe(const Value& value);

/// The first mistake in a configuration ends the reading: each function throws drive::ConfigurationError with one line that names
/// place, key, value and what is allowed.
class Refusals : public config::Complaints
{
public:
  void complain(const config::Spot& spot, const std::string& what) override;
  void refuse(const config::Spot& spot, const Value& value, const std::string& problem,
              const std::string& allowed) override;
  void miss(const config::Spot& spot, const std::string& allowed) override;
  void refuseKey(const config::Spot& spot, const config::Entry& entry, const std::vector<std::string>& known) override;
  void remark(const config::Spot& spot, const Value& value, const std::string& what) override;

  /// What is accepted but should be corrected, one line each.
  std::vector<std::string> remarks;
};

/// A map of the configuration that is being judged. \throws drive::ConfigurationError if \p value is not a map
Section sectionOf(const Value& value, config::Complaints& complaints);

/// \throws drive::ConfigurationError "place: key 'key' = value: problem; allowed: ..."
[[noreturn]] void fail(const Section& section, const std::string& key, const std::string& problem,
                       const std::string& allowed);

/// Key `limit` of the bus or of an entry.
Limit readLimit(const Section& section, Limit fallback);
}  // namespace bus
}  // namespace inverter_bus

#endif  // INVERTER_BUS_SRC_BUS_CONFIGURATION_REFUSALS_H
