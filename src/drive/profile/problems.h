// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_SRC_DRIVE_PROBLEMS_H
#define INVERTER_BUS_SRC_DRIVE_PROBLEMS_H

#include <cstddef>
#include <string>
#include <vector>

#include "config/complaints.h"

namespace inverter_bus
{
namespace drive
{
/// Mistakes found while reading. Reading goes on after one, so that `check_profile` shows them all.
class Problems : public config::Complaints
{
public:
  void complain(const config::Spot& spot, const std::string& what) override;
  bool empty() const;
  /// The first mistakes, and at the end how many more there were.
  std::vector<std::string> lines() const;

private:
  std::vector<std::string> lines_;
  std::size_t more_ = 0;
};
}  // namespace drive
}  // namespace inverter_bus

#endif  // INVERTER_BUS_SRC_DRIVE_PROBLEMS_H
