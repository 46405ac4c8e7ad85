// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_FUZZ_DIGEST_H
#define INVERTER_BUS_FUZZ_DIGEST_H

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "bus/coordinator.h"
#include "inverter_bus/bus/types.h"
#include "inverter_bus/simulation/simulated_line.h"

namespace inverter_bus
{
namespace fuzz
{
/// FNV-1a over values, in the order in which they come. Doubles count by their bits, so two digests compare only where
/// the same machine and compiler made both.
class Hash
{
public:
  void bytes(const void* data, std::size_t size);
  void text(const std::string& value);
  void number(std::uint64_t value);
  void real(double value);
  void time(TimePoint value);

  template <typename T>
  void field(const std::optional<T>& value)
  {
    number(value ? 1 : 0);
    real(value ? static_cast<double>(*value) : 0.0);
  }

  std::uint64_t value() const
  {
    return value_;
  }

private:
  std::uint64_t value_ = 0xCBF29CE484222325ULL;
};

/// What a story looks like from outside, as three numbers: the frames on the wire; what was decided (results of
/// commands, statuses and answers without their texts); and the texts. A change that only moves code keeps all three,
/// one that only rewords messages keeps the first two.
class Digest
{
public:
  void frame(const simulation::FrameRecord& frame);
  void commanded(TimePoint now, std::uint16_t result);
  void outputs(TimePoint now, const bus::Outputs& outputs);
  void answer(TimePoint now, const bus::Answer& answer);
  void report(const bus::Report& report);
  void unconfirmed(const std::string& text);

  /// Three times 16 hex digits.
  std::string text() const;

private:
  void monitor(const drive::Monitor& monitor);
  void status(const bus::InverterStatus& status);
  void busStatus(const bus::BusStatus& status);
  void record(const drive::FaultRecord& record);
  void finding(const bus::Finding& finding);

  Hash frames_;
  Hash decisions_;
  Hash texts_;
};
}  // namespace fuzz
}  // namespace inverter_bus

#endif  // INVERTER_BUS_FUZZ_DIGEST_H
