// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "drive/profile/profile_skip.h"

#include <algorithm>
#include <set>

#include "inverter_bus/drive/profile.h"

namespace inverter_bus
{
namespace drive
{
namespace
{
const std::string STORE_BUSY = "store_busy";
const std::string TRIP_MEMORY = "trip_memory";
const std::string CONSTANTS = "constants";

void collectTexts(const Value& value, std::set<std::string>& texts)
{
  if (value.isScalar())
  {
    texts.insert(value.text);
  }
  for (const Value& item : value.list)
  {
    collectTexts(item, texts);
  }
  for (const Entry& entry : value.map)
  {
    collectTexts(entry.value, texts);
  }
}

/// Constants that something outside their own section names.
std::set<std::string> namedConstants(const Value& root)
{
  std::set<std::string> texts;
  for (const Entry& entry : root.map)
  {
    if (entry.key != CONSTANTS)
    {
      collectTexts(entry.value, texts);
    }
  }
  std::set<std::string> named;
  const Value* constants = root.find(CONSTANTS);
  for (const Entry& entry : constants == nullptr ? std::vector<Entry>() : constants->map)
  {
    if (texts.count(entry.key) != 0)
    {
      named.insert(entry.key);
    }
  }
  return named;
}

/// The reason of a trip stays; the values that the drive kept beside it go.
void eraseAllButCode(Value& fields)
{
  fields.map.erase(
      std::remove_if(fields.map.begin(), fields.map.end(), [](const Entry& entry) { return entry.key != "code"; }),
      fields.map.end());
}

void skipTripMemory(Value& root)
{
  Value* faults = root.find("faults");
  Value* history = faults == nullptr ? nullptr : faults->find("history");
  if (history == nullptr)
  {
    return;
  }
  for (Value& entry : history->list)
  {
    eraseAllButCode(entry);
  }
  if (Value* fields = history->find("fields"))
  {
    eraseAllButCode(*fields);
  }
}
}  // namespace

const std::set<std::string>& skippableFields()
{
  static const std::set<std::string> NAMES = { "ready",         "at_speed",     "at_set_frequency", "overload_warning",
                                               "pid_deviation", "warning_code", "output_current",   "output_voltage",
                                               "dc_voltage",    "torque",       "temperature",      STORE_BUSY,
                                               TRIP_MEMORY };
  return NAMES;
}

const std::set<std::string>& protectedFields()
{
  // The drive's own word is among them: run bits lie in it, and it proves that a read of chosen words brings these.
  static const std::set<std::string> NAMES = { "run_seen", "operation",  "running",   "direction", "output_frequency",
                                               "faulted",  "fault_code", "restarted", "raw_status" };
  return NAMES;
}

void skipFields(Value& root, const std::vector<std::string>& names)
{
  const std::set<std::string> before = namedConstants(root);
  for (const std::string& name : names)
  {
    if (name == STORE_BUSY)
    {
      root.erase(STORE_BUSY);
    }
    else if (name == TRIP_MEMORY)
    {
      skipTripMemory(root);
    }
    else if (Value* status = root.find("status"))
    {
      status->erase(name);
    }
  }
  const std::set<std::string> after = namedConstants(root);
  for (const std::string& constant : before)
  {
    if (after.count(constant) == 0)
    {
      root.find(CONSTANTS)->erase(constant);
    }
  }
}
}  // namespace drive
}  // namespace inverter_bus
