// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "bus/inverter/merge_monitor.h"

#include <set>
#include <tuple>

#include <gtest/gtest.h>

#include "drive/monitor_fields.h"

namespace inverter_bus
{
namespace bus
{
namespace
{
TEST(MergeMonitor, mergingKeepsWhatIsKnownAndTakesWhatIsNew)
{
  drive::Monitor to;
  to.run_seen = true;
  to.output_current = 1.0;
  drive::Monitor from;
  from.output_current = 2.0;
  from.torque = 3.0;
  mergeMonitor(from, to);
  EXPECT_EQ(to.run_seen, true);
  EXPECT_DOUBLE_EQ(to.output_current.value(), 2.0);
  EXPECT_DOUBLE_EQ(to.torque.value(), 3.0);
}

TEST(MergeMonitor, forgetsNoField)
{
  // That as many fields are listed as there are is asserted where the list is; none may stand for another.
  const drive::Monitor empty;
  const auto fields = drive::monitorFields(empty);
  const auto places = std::apply(
      [](const auto&... field) { return std::set<const void*>{ static_cast<const void*>(&field)... }; }, fields);
  EXPECT_EQ(places.size(), std::tuple_size<decltype(fields)>::value);
  drive::Monitor from;
  std::apply([](auto&... field) { ((field = 1), ...); }, drive::monitorFields(from));
  drive::Monitor to;
  mergeMonitor(from, to);
  const auto merged = drive::monitorFields(to);
  std::apply([](const auto&... field) { EXPECT_TRUE((field && ...)); }, merged);
  EXPECT_EQ(merged, drive::monitorFields(from));
}
}  // namespace
}  // namespace bus
}  // namespace inverter_bus
