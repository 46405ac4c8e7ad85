// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "bus/inverter/setting_list.h"

#include <algorithm>
#include <tuple>

namespace inverter_bus
{
namespace bus
{
namespace
{
// A setting that the drive could not report just now (exception 04H, 06H, response code 2203) is asked for again, since
// safety may depend on it; for one that the drive can never report, that costs next to nothing.
constexpr double FIRST_PAUSE_S = 1.0;
constexpr unsigned MOST_DOUBLINGS = 6;
}  // namespace

SettingList::SettingList(const drive::Drive& drive) : drive_(drive)
{
  const drive::Profile& profile = drive.profile();
  want(profile.identity, true);
  want(profile.reply_delay_parameter);
  want(profile.communication_loss.timeout_parameter);
  want(profile.communication_loss.action_parameter);
  want(profile.rated_current_parameter);
  want(profile.rated_voltage_parameter);
  if (profile.block)
  {
    for (const auto* slots : { &profile.block->write_slots, &profile.block->read_slots })
    {
      for (const std::string& slot : *slots)
      {
        want(slot);
      }
    }
  }
  want(profile.command_source, false);
  want(profile.self_restart, false);
}

void SettingList::want(const std::string& parameter)
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

void SettingList::want(const std::vector<drive::Expectation>& expectations, bool urgent)
{
  for (const drive::Expectation& expectation : expectations)
  {
    const std::size_t before = settings_.size();
    want(expectation.parameter);
    if (settings_.size() > before)
    {
      settings_.back().urgent = urgent;
      settings_.back().when_commanded = expectation.when_commanded;
    }
  }
}

const Setting* SettingList::find(const std::string& parameter) const
{
  const auto found = std::find_if(settings_.begin(), settings_.end(),
                                  [&](const Setting& setting) { return setting.parameter.name == parameter; });
  return found == settings_.end() ? nullptr : &*found;
}

const Setting* SettingList::known(const std::string& parameter) const
{
  const Setting* setting = find(parameter);
  return setting != nullptr && setting->told == Told::Known ? setting : nullptr;
}

const std::vector<Setting>& SettingList::all() const
{
  return settings_;
}

bool SettingList::due(const Setting& setting) const
{
  const bool asked = setting.told == Told::NotYet || setting.again || setting.refusals > 0;
  return asked && (!setting.when_commanded || commanded_);
}

const Setting* SettingList::next() const
{
  // A setting that the drive could not report just now lets the others go first; a repeated one, those not reported yet.
  const auto found =
      std::min_element(settings_.begin(), settings_.end(), [this](const Setting& one, const Setting& other) {
        const auto claim = [this](const Setting& setting) {
          return std::make_tuple(!due(setting), !setting.urgent, setting.refusals, setting.told != Told::NotYet);
        };
        return claim(one) < claim(other);
      });
  return found == settings_.end() || !due(*found) ? nullptr : &*found;
}

void SettingList::restart(bool urgent_too)
{
  for (Setting& setting : settings_)
  {
    setting.told = setting.urgent && !urgent_too ? setting.told : Told::NotYet;
    setting.refusals = 0;
  }
  commanded_ = false;
}

void SettingList::reread(const std::string& parameter)
{
  for (Setting& setting : settings_)
  {
    if (setting.parameter.name == parameter)
    {
      setting.told = Told::NotYet;
      setting.refusals = 0;
    }
  }
}

void SettingList::commanded()
{
  for (Setting& setting : settings_)
  {
    if (setting.when_commanded && !commanded_)
    {
      setting.told = Told::NotYet;
    }
    setting.again = setting.again || setting.when_commanded;
  }
  commanded_ = true;
}

void SettingList::released()
{
  commanded_ = false;
  for (Setting& setting : settings_)
  {
    setting.told = setting.when_commanded ? Told::NotYet : setting.told;
  }
}

bool SettingList::underCommand() const
{
  return commanded_;
}

bool SettingList::nextRepeats() const
{
  const Setting* setting = next();
  return setting != nullptr && setting->told != Told::NotYet;
}

bool SettingList::urgent() const
{
  return std::any_of(settings_.begin(), settings_.end(),
                     [this](const Setting& setting) { return setting.urgent && due(setting); });
}

void SettingList::done(const wire::Reply& reply)
{
  const Setting* asked = next();
  if (asked == nullptr)
  {
    return;
  }
  Setting& setting = settings_[static_cast<std::size_t>(asked - settings_.data())];
  setting.again = setting.again && reply.outcome != wire::Outcome::Ok && reply.outcome != wire::Outcome::Exception;
  if (reply.outcome == wire::Outcome::Ok)
  {
    setting.raw = drive_.rawParameter(setting.parameter, reply.pdu);
    setting.value = drive_.decodeParameter(setting.parameter, reply.pdu);
    setting.told = Told::Known;
    setting.refusals = 0;
  }
  else if (isLastingRefusal(reply))
  {
    setting.told = Told::Refused;
    setting.refusals = 0;
  }
  else if (reply.outcome == wire::Outcome::Exception)
  {
    ++setting.refusals;
    setting.told = setting.urgent ? setting.told : Told::Refused;
  }
}

Duration SettingList::pauseBeforeNext() const
{
  const Setting* setting = next();
  if (setting == nullptr || setting->refusals == 0)
  {
    return Duration{ 0 };
  }
  const unsigned doublings = std::min(setting->refusals - 1, MOST_DOUBLINGS);
  return seconds(FIRST_PAUSE_S * static_cast<double>(1U << doublings));
}
}  // namespace bus
}  // namespace inverter_bus
