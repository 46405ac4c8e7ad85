// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_SRC_DRIVE_PROBLEMS_H
#define INVERTER_BUS_SRC_DRIVE_PROBLEMS_H

#include <cstddef>
#include <string>
#include <vector>

namespace inverter_bus
{
namespace drive
{
/// Mistakes found while reading. Reading goes on after one, so that `check_profile` shows them all.
class Problems
{
public:
  /// \p where "file:line" or the scan list entry, \p key the way to the value ("points.run.coil"), may be empty.
  void add(const std::string& where, const std::string& key, const std::string& what);
  /// A mistake for which only the value in question is left out.
  void addHarmless(const std::string& where, const std::string& key, const std::string& what);
  /// Nothing but harmless mistakes.
  bool empty() const;
  /// The first mistakes, and at the end how many more there were.
  std::vector<std::string> lines() const;
  const std::vector<std::string>& harmless() const;

private:
  std::vector<std::string> lines_;
  std::vector<std::string> harmless_;
  std::size_t more_ = 0;
};
}  // namespace drive
}  // namespace inverter_bus

#endif  // INVERTER_BUS_SRC_DRIVE_PROBLEMS_H
