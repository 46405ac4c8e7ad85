// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_BUS_FEEDING_H
#define INVERTER_BUS_BUS_FEEDING_H

#include <optional>

#include "inverter_bus/bus/types.h"

namespace inverter_bus
{
namespace bus
{
/// When a drive's own communication time-out was fed last: by every answered request, or where its profile says so (`feeds`,
/// contract, 8.17) by writes, or by writes of its command word alone. Pure. Not thread safe; the bus guards it.
class Feeding
{
public:
  /// \p drive must outlive it.
  explicit Feeding(const drive::Drive& drive);

  /// The drive has answered \p request at \p at.
  void answered(const wire::Request& request, TimePoint at);
  /// Reads alone don't feed it.
  bool needsWrites() const;
  /// Nothing: it never was.
  const std::optional<TimePoint>& fedAt() const;

private:
  bool feeds(const wire::Bytes& pdu) const;

  const drive::Drive& drive_;
  std::optional<TimePoint> fed_at_;
};
}  // namespace bus
}  // namespace inverter_bus

#endif  // INVERTER_BUS_BUS_FEEDING_H
