// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "bus/inverter/repeats.h"

namespace inverter_bus
{
namespace bus
{
Repeats::Repeats(int most) : most_(most)
{
}

bool Repeats::again(const wire::Reply& reply)
{
  // A gateway that reports the drive as silent has tried by itself.
  const bool lost = !isAnswered(reply) && reply.gateway_code == 0;
  used_ = lost && used_ < most_ ? used_ + 1 : 0;
  return used_ > 0;
}

void Repeats::restart()
{
  used_ = 0;
}
}  // namespace bus
}  // namespace inverter_bus
