// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "inverter_bus/bus/drive_settings.h"

#include <algorithm>
#include <sstream>

namespace inverter_bus
{
namespace bus
{
namespace
{
std::string withUnit(double value, const std::string& unit)
{
  std::ostringstream text;
  text << value << (unit.empty() ? "" : " ") << unit;
  return text.str();
}
}  // namespace

DriveSettings::DriveSettings(const drive::Drive& drive, std::uint8_t station) : drive_(drive), station_(station)
{
  const drive::Profile& profile = drive.profile();
  want(profile.reply_delay_parameter);
  want(profile.communication_loss.timeout_parameter);
  want(profile.communication_loss.action_parameter);
  for (const drive::Expectation& expectation : profile.command_source)
  {
    want(expectation.parameter);
  }
  for (const drive::Expectation& expectation : profile.self_restart)
  {
    want(expectation.parameter);
  }
}

void DriveSettings::want(const std::string& parameter)
{
  if (parameter.empty() || find(parameter) != nullptr)
  {
    return;
  }
  if (const auto found = drive_.findParameter(parameter, false))
  {
    Setting setting;
    setting.parameter = *found;
    settings_.push_back(setting);
  }
}

const DriveSettings::Setting* DriveSettings::find(const std::string& parameter) const
{
  const auto found = std::find_if(settings_.begin(), settings_.end(),
                                  [&](const Setting& setting) { return setting.parameter.name == parameter; });
  return found == settings_.end() ? nullptr : &*found;
}

void DriveSettings::restart()
{
  for (Setting& setting : settings_)
  {
    setting.state = Setting::State::Unread;
  }
}

void DriveSettings::reread(const std::string& parameter)
{
  for (Setting& setting : settings_)
  {
    if (setting.parameter.name == parameter)
    {
      setting.state = Setting::State::Unread;
    }
  }
}

bool DriveSettings::pending() const
{
  return std::any_of(settings_.begin(), settings_.end(),
                     [](const Setting& setting) { return setting.state == Setting::State::Unread; });
}

wire::Request DriveSettings::next() const
{
  const auto unread = std::find_if(settings_.begin(), settings_.end(),
                                   [](const Setting& setting) { return setting.state == Setting::State::Unread; });
  return drive_.readParameter(station_, unread->parameter);
}

void DriveSettings::done(const wire::Reply& reply)
{
  const auto unread = std::find_if(settings_.begin(), settings_.end(),
                                   [](const Setting& setting) { return setting.state == Setting::State::Unread; });
  if (unread == settings_.end())
  {
    return;
  }
  if (reply.outcome == wire::Outcome::Ok)
  {
    unread->raw = drive_.rawParameter(unread->parameter, reply.pdu);
    unread->value = drive_.decodeParameter(unread->parameter, reply.pdu);
    unread->state = Setting::State::Known;
  }
  else if (reply.outcome == wire::Outcome::Exception)
  {
    unread->state = Setting::State::Refused;
  }
}

std::optional<Duration> DriveSettings::driveTimeout() const
{
  const drive::CommunicationLoss& loss = drive_.profile().communication_loss;
  if (loss.timeout_parameter.empty())
  {
    return loss.assumed_timeout > 0.0 ? std::optional<Duration>(seconds(loss.assumed_timeout)) : std::nullopt;
  }
  const Setting* setting = find(loss.timeout_parameter);
  if (setting == nullptr || setting->state != Setting::State::Known || setting->value <= 0.0)
  {
    return std::nullopt;
  }
  return seconds(setting->value);
}

Duration DriveSettings::replyDelay() const
{
  const Setting* setting = find(drive_.profile().reply_delay_parameter);
  if (setting == nullptr || setting->state != Setting::State::Known)
  {
    return seconds(drive_.profile().reply_delay);
  }
  // The drive's manual gives this parameter in its own unit.
  const double scale = setting->parameter.item.unit == "ms" ? 0.001 : 1.0;
  return seconds(drive_.profile().reply_delay + setting->value * scale);
}

void DriveSettings::expectationFindings(const std::vector<drive::Expectation>& expectations, const std::string& prefix,
                                        std::vector<Finding>& findings) const
{
  for (const drive::Expectation& expectation : expectations)
  {
    const Setting* setting = find(expectation.parameter);
    if (setting != nullptr && setting->state == Setting::State::Known && expectation.accept.count(setting->raw) == 0)
    {
      findings.push_back({ Level::Warn, prefix + ": " + expectation.parameter + " = " +
                                            withUnit(setting->value, setting->parameter.item.unit) + "; " +
                                            expectation.advice });
    }
  }
}

void DriveSettings::lossFindings(std::vector<Finding>& findings) const
{
  const drive::CommunicationLoss& loss = drive_.profile().communication_loss;
  if (loss.timeout_parameter.empty())
  {
    if (loss.assumed_action == "runs_on" || loss.assumed_timeout <= 0.0)
    {
      findings.push_back({ Level::Warn, "runs on when communication is lost (assumed); " + loss.advice });
    }
    return;
  }
  const Setting* timeout = find(loss.timeout_parameter);
  const Setting* action = find(loss.action_parameter);
  const bool off = timeout != nullptr && timeout->state == Setting::State::Known && timeout->value <= 0.0;
  const bool ignores =
      action != nullptr && action->state == Setting::State::Known && loss.runs_on.count(action->raw) != 0;
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

std::vector<Finding> DriveSettings::findings() const
{
  std::vector<Finding> findings;
  expectationFindings(drive_.profile().command_source, "not commanded by the bus", findings);
  lossFindings(findings);
  expectationFindings(drive_.profile().self_restart, "may restart by itself", findings);
  return findings;
}

std::vector<std::pair<std::string, std::string>> DriveSettings::values() const
{
  std::vector<std::pair<std::string, std::string>> values;
  for (const Setting& setting : settings_)
  {
    std::string text = "not read yet";
    if (setting.state == Setting::State::Known)
    {
      text = withUnit(setting.value, setting.parameter.item.unit);
    }
    else if (setting.state == Setting::State::Refused)
    {
      text = "the drive refuses to tell";
    }
    const std::string title = setting.parameter.title.empty() ? "" : " (" + setting.parameter.title + ")";
    values.emplace_back(setting.parameter.name + title, text);
  }
  const drive::CommunicationLoss& loss = drive_.profile().communication_loss;
  if (loss.timeout_parameter.empty())
  {
    values.emplace_back("drive time-out",
                        "assumed " + withUnit(loss.assumed_timeout, "s") + ", " + loss.assumed_action);
  }
  return values;
}
}  // namespace bus
}  // namespace inverter_bus
