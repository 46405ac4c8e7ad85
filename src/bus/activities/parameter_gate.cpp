// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "bus/activities/parameter_gate.h"

#include <algorithm>

#include "inverter_bus/bus/types.h"
#include "util/printable.h"

namespace inverter_bus
{
namespace bus
{
namespace
{
WriteVerdict refusal(std::uint16_t error_id, const std::string& text)
{
  WriteVerdict verdict;
  verdict.error_id = error_id;
  verdict.text = text;
  return verdict;
}

/// What its kind of parameter, the access that the user has allowed, and a running motor forbid; empty: nothing.
std::string forbidden(const drive::Drive& drive, const std::string& name, const drive::Parameter& parameter,
                      bool persist, bool read_only_access, bool may_run)
{
  const drive::Profile& profile = drive.profile();
  if (read_only_access)
  {
    return "parameter_access is read_only";
  }
  if (parameter.read_only)
  {
    return name + " can't be written";
  }
  if (parameter.communication && !persist)
  {
    return name + " is a setting of the bus itself: it is written with persist only";
  }
  if (profile.writes == drive::Writes::Eeprom && !persist)
  {
    return "on this drive every write reaches the EEPROM: call with persist = true";
  }
  if (persist && profile.writes == drive::Writes::Ram && drive.sequence("store") == nullptr)
  {
    return "this drive can't store by a command";
  }
  if (!(parameter.while_running.value_or(true) && !parameter.setup) && may_run)
  {
    return name + " can't be written while the motor runs";
  }
  return "";
}

/// What the profile lacks; error id 0: nothing.
WriteVerdict unarmed(const drive::Drive& drive, const std::string& name, const drive::Parameter& parameter)
{
  for (const char* sequence : { "open_setup", "close_setup" })
  {
    if (parameter.setup && drive.sequence(sequence) == nullptr)
    {
      return refusal(ERROR_NOT_ARMED,
                     name + " is accepted in the drive's setup area only, and the way there is not armed: " +
                         drive.armingAdvice(sequence));
    }
  }
  if (!drive.findParameter(name, true))
  {
    return refusal(ERROR_NOT_ARMED, name + (parameter.item.missing ? ": its place is unknown: set it under overrides"
                                                                   : " is unconfirmed: confirm '" +
                                                                         drive.missingForParameter(name) + "'"));
  }
  return WriteVerdict();
}
}  // namespace

WriteVerdict checkWrite(const drive::Drive& drive, const std::string& name, double value, bool persist,
                        bool read_only_access, bool may_run)
{
  const drive::Profile& profile = drive.profile();
  const auto known = profile.parameters.find(name);
  if (known == profile.parameters.end())
  {
    return refusal(ERROR_OUT_OF_RANGE,
                   "'" + util::printable(name) + "' is no parameter of " + profile.name + " that can be written");
  }
  drive::Encoded encoded;
  if (const auto parameter = drive.findParameter(name, true))
  {
    encoded = drive.encodeParameter(*parameter, value);
    if (!encoded.ok)
    {
      return refusal(ERROR_OUT_OF_RANGE, encoded.error);
    }
  }
  const std::string why = forbidden(drive, name, known->second, persist, read_only_access, may_run);
  if (!why.empty())
  {
    return refusal(ERROR_NOT_OFFERED, why);
  }
  WriteVerdict lacking = unarmed(drive, name, known->second);
  if (lacking.error_id != 0)
  {
    return lacking;
  }
  if (persist && profile.writes == drive::Writes::Unknown)
  {
    return refusal(ERROR_NOT_OFFERED,
                   "the drive's manual does not say whether a write survives a power-off: call with persist = false");
  }
  WriteVerdict verdict;
  verdict.raw = encoded.raw;
  return verdict;
}

WriteVerdict whyNotReadable(const drive::Drive& drive, const std::string& name)
{
  const drive::Profile& profile = drive.profile();
  const std::string missing = drive.missingForParameter(name);
  if (!missing.empty())
  {
    const bool unknown = profile.parameters.at(name).item.missing;
    return refusal(ERROR_NOT_ARMED, "parameter '" + name +
                                        (unknown ? "': its register is unknown: set it under overrides (parameters: {" +
                                                       name + ": {register: ...}})"
                                                 : "' is unconfirmed: confirm '" + missing + "'"));
  }
  const bool any = std::any_of(profile.parameters.begin(), profile.parameters.end(),
                               [](const auto& entry) { return entry.second.item.unconfirmed.empty(); });
  if (!any)
  {
    return refusal(ERROR_NOT_ARMED, "the profile " + profile.name + " knows no parameter's place: set '" +
                                        util::printable(name) + "' under overrides");
  }
  return refusal(ERROR_OUT_OF_RANGE, "'" + util::printable(name) + "' is no parameter of " + profile.name +
                                         "; use the drive's own code, or 0x and the number printed in its manual");
}
}  // namespace bus
}  // namespace inverter_bus
