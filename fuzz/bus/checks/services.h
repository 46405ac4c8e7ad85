// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_FUZZ_CHECKS_SERVICES_H
#define INVERTER_BUS_FUZZ_CHECKS_SERVICES_H

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "fuzz/bus/observed.h"
#include "fuzz/bus/plant.h"

namespace inverter_bus
{
namespace fuzz
{
namespace checks
{
/// Every service is answered once and within its bound, and succeeds when the drive has confirmed.
class Services
{
public:
  using Callback = std::function<void(const bus::Answer&)>;

  Services(const Observed& observed, const Plant& plant, const util::Clock& clock);

  /// A call that has to be answered within \p bound [s]; what it returns is to be given the answer. \p judge (may be
  /// empty) looks at that of a call that succeeded.
  Callback asked(const std::string& what, double bound, const Callback& judge);
  Callback resetAsked(std::size_t index, double bound);
  /// Of the parameter that is never written.
  Callback readAsked(std::size_t index, double bound);
  /// Of the parameter that is written.
  Callback writeAsked(std::size_t index, double value, double bound);

  void check(TimePoint now) const;
  void checkNoneLeft(TimePoint now) const;
  std::size_t open() const;
  std::uint64_t total() const;

private:
  struct Call
  {
    std::string what;
    TimePoint until;
  };

  void answered(std::uint64_t id, const std::string& what, const bus::Answer& answer, const Callback& judge);
  void checkWritten(std::size_t index, double value, TimePoint asked_at, double bound) const;

  const Observed& observed_;
  const Plant& plant_;
  const util::Clock& clock_;
  std::map<std::uint64_t, Call> calls_;
  std::uint64_t total_ = 0;
  /// Values that each free parameter was to be set to, and when.
  std::vector<std::vector<std::pair<TimePoint, double>>> writes_;
};
}  // namespace checks
}  // namespace fuzz
}  // namespace inverter_bus

#endif  // INVERTER_BUS_FUZZ_CHECKS_SERVICES_H
