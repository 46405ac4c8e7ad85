// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
// Sections parameters and command_registers.

#include "drive/profile/numbers.h"
#include "drive/profile/profile_builder.h"
#include "util/printable.h"
#include "util/text.h"

namespace inverter_bus
{
namespace drive
{
namespace
{
/// The smallest and largest value that the register itself can hold.
std::pair<double, double> registerRange(const Item& item)
{
  const double counts = static_cast<double>(largestRaw(item)) + 1.0;
  const double lowest = item.is_signed ? -counts / 2.0 : 0.0;
  return { scaleCounts(lowest, item.resolution), scaleCounts(lowest + counts - 1.0, item.resolution) };
}

void readRange(const Cursor& cursor, Parameter& parameter)
{
  const std::vector<Cursor> ends = cursor.list();
  if (ends.size() != 2)
  {
    cursor.complain("allowed: [lowest, highest]");
    return;
  }
  const auto lowest = ends[0].number({ -5e9, 5e9 });
  const auto highest = ends[1].number({ -5e9, 5e9 });
  if (!lowest || !highest)
  {
    return;
  }
  const auto holds = registerRange(parameter.item);
  if (*lowest > *highest)
  {
    cursor.complain("the lowest value " + util::exactText(*lowest) + " is above the highest " +
                    util::exactText(*highest));
  }
  else if (*lowest < holds.first || *highest > holds.second)
  {
    cursor.complain("the register holds only " + util::exactText(holds.first) + " to " + util::exactText(holds.second) +
                    ": allowed: a range inside it, words: 2 or another resolution");
  }
  else
  {
    parameter.range = { *lowest, *highest };
  }
}

void readParameter(const std::string& name, const Cursor& cursor, const Numbering& numbering, Profile& profile)
{
  ItemRules rules;
  rules.coil = false;
  Parameter parameter;
  Section map(cursor);
  const auto item = readItem(map, numbering, rules);
  parameter.name = name;
  parameter.title = map.text("title");
  parameter.item = item.value_or(Item());
  const auto range = map.find("range");
  const std::string range_mark = map.name("range_unconfirmed");
  if (map.has("while_running"))
  {
    parameter.while_running = map.flag("while_running", false);
  }
  else
  {
    map.find("while_running");
  }
  parameter.read_only = map.flag("read_only", false);
  parameter.communication = map.flag("communication", false);
  parameter.setup = map.flag("setup", false);
  map.finish();
  if (!item)
  {
    return;
  }
  if (range)
  {
    readRange(*range, parameter);
  }
  if (!range_mark.empty())
  {
    parameter.range_unconfirmed = true;
    profile.unconfirmed_tables.insert(range_mark);
  }
  if (!item->unconfirmed.empty())
  {
    profile.unconfirmed_tables.insert(item->unconfirmed);
  }
  profile.parameters[name] = parameter;
}

void checkName(const std::string& name, const Cursor& cursor)
{
  const bool number = name.size() > 1 && name[0] == '0' && (name[1] == 'x' || name[1] == 'X');
  if (!config::isName(name))
  {
    cursor.complain("the name '" + util::printable(name) + "': allowed: " + config::NAME_FORM);
  }
  else if (number)
  {
    cursor.complain("names that begin with 0x are register numbers: allowed: any other name");
  }
}
}  // namespace

void readParameters(Section& root, const Numbering& numbering, Profile& profile)
{
  if (const auto cursor = root.find("parameters"))
  {
    for (const auto& [name, parameter] : cursor->entries())
    {
      checkName(name, parameter);
      readParameter(name, parameter, numbering, profile);
    }
  }
  if (const auto cursor = root.find("command_registers"))
  {
    profile.command_registers = readSpans(*cursor, numbering, Space::Register);
  }
}
}  // namespace drive
}  // namespace inverter_bus
