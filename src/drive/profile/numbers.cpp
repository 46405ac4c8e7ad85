// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "drive/profile/numbers.h"

#include <cmath>

namespace inverter_bus
{
namespace drive
{
namespace
{
/// n where \p resolution is 1/n, else 0: dividing by n is exact where multiplying by 0.01 is not.
double wholeInverse(double resolution)
{
  const double inverse = std::round(1.0 / resolution);
  return inverse >= 1.0 && std::fabs(inverse * resolution - 1.0) < 1e-9 ? inverse : 0.0;
}
}  // namespace

double scaleCounts(double counts, double resolution)
{
  const double inverse = wholeInverse(resolution);
  return inverse > 0.0 ? counts / inverse : counts * resolution;
}

double toCounts(double value, double resolution)
{
  const double inverse = wholeInverse(resolution);
  return inverse > 0.0 ? value * inverse : value / resolution;
}
}  // namespace drive
}  // namespace inverter_bus
