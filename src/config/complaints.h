// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_SRC_CONFIG_COMPLAINTS_H
#define INVERTER_BUS_SRC_CONFIG_COMPLAINTS_H

#include <string>
#include <vector>

#include "inverter_bus/config/value.h"

namespace inverter_bus
{
namespace config
{
/// Where a mistake is.
struct Spot
{
  std::string place;  ///< "file:line" or the scan list entry; empty: unknown
  std::string path;   ///< the key, with those that lead to it: "points.run.coil"; empty: the whole text or map
};

/// "place: key 'path': what": one line, fit for a log.
std::string lineOf(const Spot& spot, const std::string& what);

/// Receives the mistakes in a file or a tree. Each reader decides whether the first one ends the reading (by an exception) or all
/// are collected, and how they are worded; the words here are those of a profile.
class Complaints
{
public:
  virtual ~Complaints() = default;

  /// \p what is any bytes.
  virtual void complain(const Spot& spot, const std::string& what) = 0;
  /// \p problem: "is not a number"; \p allowed: "a number from 0 to 10".
  virtual void refuse(const Spot& spot, const Value& value, const std::string& problem, const std::string& allowed);
  /// The key at \p spot must be there.
  virtual void miss(const Spot& spot, const std::string& allowed);
  /// \p key, the end of the path at \p spot, is none of \p known.
  virtual void refuseKey(const Spot& spot, const Entry& entry, const std::vector<std::string>& known);
  /// Something was taken although it should be written in another way.
  virtual void remark(const Spot& spot, const Value& value, const std::string& what);
};

/// The nearest of \p known that is at most two letters away from \p key, else one that has a word in common; empty: none.
std::string nearest(const std::string& key, const std::vector<std::string>& known);
}  // namespace config
}  // namespace inverter_bus

#endif  // INVERTER_BUS_SRC_CONFIG_COMPLAINTS_H
