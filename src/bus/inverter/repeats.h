// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_BUS_REPEATS_H
#define INVERTER_BUS_BUS_REPEATS_H

#include "inverter_bus/bus/types.h"

namespace inverter_bus
{
namespace bus
{
/// The repeats of one request after the other. Not thread safe; the bus guards it.
class Repeats
{
public:
  /// \p most for each request (bus parameter `retries`).
  explicit Repeats(int most);

  /// A request has ended: true if it was lost or damaged and is to be sent again. Otherwise the next one starts afresh.
  bool again(const wire::Reply& reply);
  /// The next request is another one.
  void restart();

private:
  int most_;
  int used_ = 0;
};
}  // namespace bus
}  // namespace inverter_bus

#endif  // INVERTER_BUS_BUS_REPEATS_H
