// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "bus/report/refusal_log.h"

#include "util/text.h"

namespace inverter_bus
{
namespace bus
{
namespace
{
constexpr double PERIOD_S = 5.0;
}  // namespace

RefusalLog::RefusalLog(std::size_t inverters) : since_accepted_(inverters)
{
}

void RefusalLog::refused(TimePoint now, std::optional<std::size_t> inverter, std::uint16_t error_id,
                         const std::string& text)
{
  const auto found = kinds_.find({ inverter, error_id });
  if (found != kinds_.end())
  {
    ++found->second.held_back;
    found->second.last = text;
    return;
  }
  kinds_[{ inverter, error_id }].told_at = now;
  lines_.push_back(text);
}

std::vector<std::string> RefusalLog::takeLines(TimePoint now)
{
  for (auto kind = kinds_.begin(); kind != kinds_.end();)
  {
    Kind& refused = kind->second;
    if (now - refused.told_at < seconds(PERIOD_S))
    {
      ++kind;
      continue;
    }
    if (refused.held_back == 0)
    {
      kind = kinds_.erase(kind);
      continue;
    }
    lines_.push_back(refused.last + " (the last of " + std::to_string(refused.held_back) + " since the previous line)");
    refused.told_at = now;
    refused.held_back = 0;
    ++kind;
  }
  std::vector<std::string> lines;
  lines.swap(lines_);
  return lines;
}

void RefusalLog::notCommanded(std::size_t inverter, const std::string& reason)
{
  ++since_accepted_[inverter].count;
  since_accepted_[inverter].last_reason = reason;
}

void RefusalLog::accepted(std::size_t inverter)
{
  since_accepted_[inverter] = Refused();
}

std::string RefusalLog::watchdogReason(std::size_t inverter, double command_timeout) const
{
  const Refused& refused = since_accepted_[inverter];
  const std::string timeout = util::numberText(command_timeout, 9) + " s (command_timeout)";
  if (refused.count == 0)
  {
    return "no command for " + timeout;
  }
  const std::string all = refused.count == 1 ? "1 command came in " + timeout + " and was refused: "
                                             : std::to_string(refused.count) + " commands came in " + timeout +
                                                   " and all were refused, the last: ";
  return all + refused.last_reason;
}

std::string refusedVelocity(double velocity, std::uint16_t error_id, const std::string& reason)
{
  return error_id == ERROR_OUT_OF_RANGE ? reason : "velocity " + util::numberText(velocity, 9) + ": " + reason;
}
}  // namespace bus
}  // namespace inverter_bus
