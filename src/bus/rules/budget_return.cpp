// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

// When an inverter that was offline is back (contract, 3.7 and 8.8).

#include <algorithm>

#include "bus/rules/budget.h"
#include "bus/rules/probe_account.h"
#include "util/text.h"

namespace inverter_bus
{
namespace bus
{
namespace
{
// Contract, rule 3.7: offline inverters are found again within this time, where a probe costs no more than its share of it.
constexpr double RETURN_S = 3.0;
constexpr double SHORT_BLOCK_S = PROBE_SHARE * RETURN_S;
// What an inverter that has answered needs for its first status.
constexpr double FIRST_STATUS_S = 0.3;
}  // namespace

Duration Budget::returnTime(std::size_t offline) const
{
  Duration probe{ 0 };
  for (std::size_t index = 0; index < configuration_.drives.size(); ++index)
  {
    const drive::Drive& drive = configuration_.drives[index];
    const InverterConfig& config = configuration_.bus.inverters[index];
    wire::Request request = drive.read(config.node, drive.fastBlocks().front());
    request.reply_delay = seconds(drive.profile().reply_delay);
    request.response_timeout =
        std::min(seconds(config.response_timeout), leastProbeTimeout(request.reply_delay, request.reply_delay));
    probe = std::max(probe, line_.costUnanswered(request));
  }
  const double round = static_cast<double>(offline) * toSeconds(probe) / PROBE_TURNS_SHARE;
  return seconds(std::max(RETURN_S, round + FIRST_STATUS_S));
}

/// Contract, 3.7 and 3.11. Behind a gateway its block counts (returnBehindGateway()).
std::string Budget::returnText() const
{
  const std::size_t all = configuration_.drives.size();
  std::size_t in_time = all;
  while (in_time > 1 && returnTime(in_time) > seconds(RETURN_S))
  {
    --in_time;
  }
  if (configuration_.bus.modbus_tcp)
  {
    return "";
  }
  const std::string within = ", an inverter that answers again back within " + util::durationText(returnTime(in_time));
  return in_time == all ? within
                        : within + " with up to " + std::to_string(in_time) + " offline, within " +
                              util::durationText(returnTime(all)) + " with all";
}

Duration Budget::longestReturn(Duration block, std::size_t offline)
{
  const double each = std::max(toSeconds(block) / PROBE_SHARE, PROBE_PERIOD_S);
  return seconds(std::max(RETURN_S, static_cast<double>(std::max<std::size_t>(offline, 1)) * each));
}

/// Contract, 8.8: what the probes' share makes of 3.7 where the gateway is kept for long.
std::optional<Finding> Budget::returnBehindGateway() const
{
  const Duration block = seconds(configuration_.bus.gateway_timeout);
  if (!configuration_.bus.modbus_tcp || block <= seconds(SHORT_BLOCK_S))
  {
    return std::nullopt;
  }
  return Finding{ Level::Ok,
                  "an inverter that was offline may need up to " + util::durationText(longestReturn(block, 1)) +
                      " (times the number of those that are offline) to be back, if a silent station keeps the "
                      "gateway for gateway_timeout (" +
                      util::durationText(block) + "); " + util::durationText(longestReturn({}, 1)) +
                      " if it does so for " + util::durationText(seconds(SHORT_BLOCK_S)) + " at most" };
}
}  // namespace bus
}  // namespace inverter_bus
