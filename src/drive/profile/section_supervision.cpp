// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
// Sections identity, command_source, self_restart, communication_loss: settings of the drive that are read at connect.

#include "drive/profile/profile_builder.h"

namespace inverter_bus
{
namespace drive
{
namespace
{
std::set<std::uint32_t> readCodes(const Cursor& cursor)
{
  std::set<std::uint32_t> codes;
  for (const Cursor& entry : cursor.list())
  {
    if (const auto code = entry.integer(0, 0xFFFF))
    {
      codes.insert(static_cast<std::uint32_t>(*code));
    }
  }
  return codes;
}

std::vector<Expectation> readExpectations(Section& root, const std::string& key, bool compoway = false)
{
  std::vector<Expectation> expectations;
  const auto cursor = root.find(key);
  if (!cursor)
  {
    return expectations;
  }
  for (const Cursor& entry : cursor->list())
  {
    Section map(entry);
    Expectation expectation;
    const auto model = key == "identity" && compoway ? map.find("model") : std::nullopt;
    if (model && model->text().value_or("").empty())
    {
      model->complain("is empty: needs the text that the drive's model begins with");
    }
    const auto parameter = model ? std::nullopt : map.require("parameter");
    const auto accept = model ? std::nullopt : map.require("accept");
    expectation.model = model ? model->text().value_or("") : "";
    expectation.parameter = parameter ? parameter->name().value_or("") : "";
    expectation.accept = accept ? readCodes(*accept) : std::set<std::uint32_t>();
    expectation.advice = map.text("advice");
    const auto when = key == "command_source" ? map.find("when") : std::nullopt;
    expectation.when_commanded = when && when->choice({ "commanded" });
    map.text("source");
    map.finish();
    if (accept && accept->isList() && accept->value().list.empty())
    {
      accept->complain("is an empty list: at least one value is needed");
    }
    expectations.push_back(expectation);
  }
  return expectations;
}
}  // namespace

void readSupervision(Section& root, Profile& profile)
{
  profile.identity = readExpectations(root, "identity", profile.protocol == "compoway_f");
  profile.command_source = readExpectations(root, "command_source");
  profile.self_restart = readExpectations(root, "self_restart");
  CommunicationLoss& loss = profile.communication_loss;
  loss.assumed_timeout = root.number("drive_timeout", { 0.0, 3600.0 }, 0.0);
  if (const auto action = root.find("drive_loss_action"))
  {
    loss.assumed_action = action->choice({ "runs_on", "decelerate", "coast", "trip" }).value_or("");
  }
  const auto cursor = root.find("communication_loss");
  if (!cursor)
  {
    return;
  }
  Section map(*cursor);
  loss.timeout_parameter = map.name("timeout_parameter");
  loss.action_parameter = map.name("action_parameter");
  if (const auto runs_on = map.find("runs_on"))
  {
    loss.runs_on = readCodes(*runs_on);
  }
  loss.also_idle = map.flag("also_idle", false);
  loss.advice = map.text("advice");
  map.text("source");
  map.finish();
}
}  // namespace drive
}  // namespace inverter_bus
