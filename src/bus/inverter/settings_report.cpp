// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "bus/inverter/settings_report.h"

#include "util/text.h"

namespace inverter_bus
{
namespace bus
{
namespace
{
std::string withUnit(double value, const std::string& unit)
{
  return util::withUnit(util::numberText(value, 9), unit);
}

void expectationFindings(const SettingList& settings, const std::vector<drive::Expectation>& expectations,
                         const std::string& prefix, std::vector<Finding>& findings)
{
  for (const drive::Expectation& expectation : expectations)
  {
    const Setting* setting = settings.find(expectation.parameter);
    const bool judged = !expectation.when_commanded || settings.underCommand();
    if (judged && setting != nullptr && setting->told == Told::Known && expectation.accept.count(setting->raw) == 0)
    {
      findings.push_back({ Level::Warn, prefix + ": " + expectation.parameter + " = " +
                                            withUnit(setting->value, setting->parameter.item.unit) + "; " +
                                            expectation.advice });
    }
  }
}

void lossFindings(const drive::Drive& drive, const SettingList& settings, std::vector<Finding>& findings)
{
  const drive::CommunicationLoss& loss = drive.profile().communication_loss;
  if (loss.timeout_parameter.empty())
  {
    if (loss.assumed_action == "runs_on" || loss.assumed_timeout <= 0.0)
    {
      findings.push_back({ Level::Warn, "runs on when communication is lost (assumed); " + loss.advice });
    }
    return;
  }
  const Setting* timeout = settings.find(loss.timeout_parameter);
  const Setting* action = settings.find(loss.action_parameter);
  const bool off = timeout != nullptr && timeout->told == Told::Known && timeout->value <= 0.0;
  const bool ignores = action != nullptr && action->told == Told::Known && loss.runs_on.count(action->raw) != 0;
  if (!off && !ignores)
  {
    return;
  }
  std::string text = "runs on when communication is lost:";
  text += off ? " " + loss.timeout_parameter + " = 0 (off)" : "";
  text += ignores ? std::string(off ? "," : "") + " " + loss.action_parameter + " = " + std::to_string(action->raw) +
                        " (ignore)"
                  : "";
  findings.push_back({ Level::Warn, text + "; " + loss.advice });
}
}  // namespace

std::vector<Finding> settingFindings(const drive::Drive& drive, const SettingList& settings)
{
  std::vector<Finding> findings;
  expectationFindings(settings, drive.profile().command_source, "not commanded by the bus", findings);
  lossFindings(drive, settings, findings);
  expectationFindings(settings, drive.profile().self_restart, "may restart by itself", findings);
  return findings;
}

std::vector<std::pair<std::string, std::string>> settingValues(const drive::Drive& drive, const SettingList& settings)
{
  std::vector<std::pair<std::string, std::string>> values;
  for (const Setting& setting : settings.all())
  {
    std::string text =
        setting.when_commanded && !settings.underCommand() ? "read while a command is in force" : "not read yet";
    if (setting.told == Told::Known)
    {
      text = withUnit(setting.value, setting.parameter.item.unit);
    }
    else if (setting.told == Told::Refused)
    {
      text = "the drive refuses the read";
    }
    const std::string title = setting.parameter.title.empty() ? "" : " (" + setting.parameter.title + ")";
    values.emplace_back(setting.parameter.name + title, text);
  }
  const drive::CommunicationLoss& loss = drive.profile().communication_loss;
  if (loss.timeout_parameter.empty())
  {
    values.emplace_back("drive time-out",
                        "assumed " + withUnit(loss.assumed_timeout, "s") + ", " + loss.assumed_action);
  }
  return values;
}
}  // namespace bus
}  // namespace inverter_bus
