// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "bus/inverter/setting_facts.h"

#include <string>

namespace inverter_bus
{
namespace bus
{
namespace
{
std::optional<std::vector<int>> codesOf(const SettingList& settings, const std::vector<std::string>& slots)
{
  std::vector<int> codes;
  for (const std::string& slot : slots)
  {
    const Setting* setting = settings.known(slot);
    if (setting == nullptr)
    {
      return std::nullopt;
    }
    codes.push_back(static_cast<int>(setting->raw));
  }
  return codes;
}
}  // namespace

drive::Ratings ratingsOf(const drive::Drive& drive, const SettingList& settings)
{
  const auto rating = [&settings](const std::string& parameter) {
    const Setting* setting = settings.known(parameter);
    return setting != nullptr && setting->value > 0.0 ? std::optional<double>(setting->value) : std::nullopt;
  };
  drive::Ratings ratings;
  ratings.current = rating(drive.profile().rated_current_parameter);
  ratings.voltage = rating(drive.profile().rated_voltage_parameter);
  return ratings;
}

std::optional<BlockSlots> blockSlotsOf(const drive::Drive& drive, const SettingList& settings)
{
  if (!drive.profile().block)
  {
    return std::nullopt;
  }
  const auto read = codesOf(settings, drive.profile().block->read_slots);
  const auto write = codesOf(settings, drive.profile().block->write_slots);
  return read && write ? std::optional<BlockSlots>(BlockSlots{ *read, *write }) : std::nullopt;
}

std::optional<Duration> driveTimeoutOf(const drive::Drive& drive, const SettingList& settings)
{
  const drive::CommunicationLoss& loss = drive.profile().communication_loss;
  if (loss.timeout_parameter.empty())
  {
    return loss.assumed_timeout > 0.0 ? std::optional<Duration>(seconds(loss.assumed_timeout)) : std::nullopt;
  }
  const Setting* setting = settings.find(loss.timeout_parameter);
  if (setting == nullptr || setting->told != Told::Known)
  {
    // Until it is read the usual one is the safe assumption.
    return loss.assumed_timeout > 0.0 ? std::optional<Duration>(seconds(loss.assumed_timeout)) : std::nullopt;
  }
  return setting->value > 0.0 ? std::optional<Duration>(seconds(setting->value)) : std::nullopt;
}

Duration replyDelayOf(const drive::Drive& drive, const SettingList& settings)
{
  const Setting* setting = settings.find(drive.profile().reply_delay_parameter);
  if (setting == nullptr || setting->told != Told::Known)
  {
    return seconds(drive.profile().reply_delay);
  }
  // The drive's manual gives this parameter in its own unit.
  const double scale = setting->parameter.item.unit == "ms" ? 0.001 : 1.0;
  return seconds(drive.profile().reply_delay + setting->value * scale);
}
}  // namespace bus
}  // namespace inverter_bus
