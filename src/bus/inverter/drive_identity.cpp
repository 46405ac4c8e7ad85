// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "bus/inverter/drive_identity.h"

namespace inverter_bus
{
namespace bus
{
DriveIdentity::DriveIdentity(const drive::Drive& drive, std::uint8_t station) : drive_(drive), station_(station)
{
  for (const drive::Expectation& expectation : drive.profile().identity)
  {
    wants_model_ = wants_model_ || !expectation.model.empty();
  }
  // A model that is not checked is still worth showing.
  wants_model_ = wants_model_ || drive.readAttributes(station).has_value();
}

void DriveIdentity::restart()
{
  told_ = Told::NotYet;
}

std::optional<wire::Request> DriveIdentity::next() const
{
  return wants_model_ && told_ == Told::NotYet ? drive_.readAttributes(station_) : std::nullopt;
}

void DriveIdentity::done(const wire::Reply& reply)
{
  if (reply.outcome == wire::Outcome::Ok)
  {
    model_ = drive_.decodeModel(reply.pdu);
    told_ = Told::Known;
  }
  else if (isLastingRefusal(reply))
  {
    model_.clear();
    told_ = Told::Refused;
  }
}

Identity DriveIdentity::judge(const SettingList& settings) const
{
  bool unknown = false;
  for (const drive::Expectation& expectation : drive_.profile().identity)
  {
    if (!expectation.model.empty())
    {
      unknown = unknown || told_ == Told::NotYet;
      const bool fits = model_.compare(0, expectation.model.size(), expectation.model) == 0;
      if (told_ == Told::Refused || (told_ == Told::Known && !fits))
      {
        return Identity::Wrong;
      }
      continue;
    }
    const Setting* setting = settings.find(expectation.parameter);
    if (setting == nullptr)
    {
      continue;
    }
    unknown = unknown || setting->told == Told::NotYet;
    const bool fits = expectation.accept.count(setting->raw) != 0;
    if (setting->told == Told::Refused || (setting->told == Told::Known && !fits))
    {
      return Identity::Wrong;
    }
  }
  return unknown ? Identity::Unknown : Identity::Right;
}

std::string DriveIdentity::text(const SettingList& settings) const
{
  if (judge(settings) == Identity::Unknown)
  {
    return "the drive has not reported yet what it is";
  }
  for (const drive::Expectation& expectation : drive_.profile().identity)
  {
    const Setting* setting = settings.find(expectation.parameter);
    const bool refused =
        expectation.model.empty() ? setting != nullptr && setting->told == Told::Refused : told_ == Told::Refused;
    const bool fits = expectation.model.empty() ? setting == nullptr || expectation.accept.count(setting->raw) != 0
                                                : model_.compare(0, expectation.model.size(), expectation.model) == 0;
    if (!refused && fits)
    {
      continue;
    }
    const std::string what = expectation.model.empty() ? expectation.parameter : "its model";
    const std::string told = expectation.model.empty() && setting != nullptr ? std::to_string(setting->raw) : model_;
    return "wrong drive: " + what + (refused ? " cannot be read" : " is '" + told + "'") +
           (expectation.advice.empty() ? "" : "; " + expectation.advice);
  }
  return "";
}

const std::string& DriveIdentity::model() const
{
  return model_;
}

std::string DriveIdentity::modelText() const
{
  const std::string text = told_ == Told::Known ? model_ : "not reported";
  return wants_model_ ? text : "";
}
}  // namespace bus
}  // namespace inverter_bus
