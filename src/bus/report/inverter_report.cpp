// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "bus/report/inverter_report.h"

#include "util/text.h"

namespace inverter_bus
{
namespace bus
{
namespace
{
// A drive that has answered so lately is there.
constexpr double LATELY_S = 2.0;

/// Why it is offline; otherwise in the drive's own words where it has answered.
std::string exchangeText(const Inverter& inverter)
{
  const Link& link = inverter.link;
  const std::string why = link.offline() && link.error() != wire::ERROR_PORT_LOST ? inverter.liveness.reason() : "";
  const std::string text = why.empty() ? inverter.drive.exceptionText(link.error()) : why;
  return text.empty() ? errorText(link.error(), link.gatewayCode()) : text;
}

void showExchangeError(const Inverter& inverter, InverterStatus& status)
{
  status.error_id = inverter.link.error();
  status.error_text = exchangeText(inverter);
}

/// The most informative one: why it is offline or locked rather than that it is, a command's own rather than a single
/// exchange's.
void showError(const Inverter& inverter, TimePoint now, InverterStatus& status)
{
  const bool exchange_failed = inverter.link.error() != 0;
  if (inverter.link.offline() && exchange_failed && !inverter.command_error.countsWhileOffline())
  {
    showExchangeError(inverter, status);
    return;
  }
  if (inverter.lost_writes.raised())
  {
    status.error_id = wire::ERROR_TIMEOUT;
    status.error_text = inverter.lost_writes.text();
  }
  else if (inverter.command_error.id() != 0)
  {
    status.error_id = inverter.command_error.id();
    status.error_text =
        inverter.command_error.text(inverter.obstacles(now), exchange_failed ? exchangeText(inverter) : "");
  }
  else if (exchange_failed)
  {
    showExchangeError(inverter, status);
  }
}

std::string offlineText(const Inverter& inverter, TimePoint now)
{
  const Link& link = inverter.link;
  if (link.error() == wire::ERROR_PORT_LOST)
  {
    return "offline (" + errorIdText(link.error()) + "), since the port is not open: see what is reported for the bus";
  }
  return "offline (" + errorIdText(link.error()) + " " + offlineReason(inverter) + "; last answer " +
         (link.lastAnswer() ? util::durationText(now - *link.lastAnswer()) + " ago)" : "never)") + "; " +
         inverter.record.advice();
}

/// Before the first complete status.
std::string silenceText(const Inverter& inverter)
{
  const std::string seen = inverter.record.text(inverter.drive);
  return seen.empty() ? "has not been asked yet" : "no complete status yet: " + seen + "; " + inverter.record.advice();
}

std::vector<Finding> errorsOf(const Inverter& inverter, TimePoint now)
{
  std::vector<Finding> findings;
  if (inverter.link.offline())
  {
    findings.push_back({ Level::Error, offlineText(inverter, now) });
    return findings;
  }
  if (inverter.lost_writes.raised())
  {
    findings.push_back(
        { Level::Error,
          inverter.lost_writes.text() + " (" + std::to_string(inverter.lost_writes.inARow()) +
              " in a row): stopped and locked, the stop is sent until it is acknowledged; check what "
              "else writes to the drive, its write protection, the gateway or converter, and the wiring" });
  }
  if (inverter.interlock.isFaulted())
  {
    const drive::Monitor& told = inverter.refresh.fresh().monitor;
    const std::uint16_t code = told.fault_code.value_or(0);
    const std::string why =
        told.unknown_trip ? inverter.drive.tripText(told) : std::to_string(code) + " " + inverter.drive.faultText(code);
    findings.push_back({ Level::Error, "tripped: " + why + "; remove the cause, then call reset" });
  }
  return findings;
}

/// The set-point goes to the EEPROM, because the drive could not be set otherwise at connect.
bool writesWear(const Inverter& inverter)
{
  return inverter.drive.wears("frequency") && !inverter.settings.connected() &&
         inverter.drive.sequence("forward") != nullptr;
}

/// What the profile leaves open, or the drive does not do although the profile could.
std::vector<std::string> profileWarnings(const Inverter& inverter)
{
  std::vector<std::string> warnings;
  const drive::Profile& profile = inverter.drive.profile();
  for (const std::string& mistake : profile.mistakes)
  {
    warnings.push_back("left out: " + mistake);
  }
  if (!profile.unconfirmed.empty())
  {
    warnings.push_back("unconfirmed in the profile: " + inverter.drive.unconfirmedText());
  }
  const auto slots = profile.block ? inverter.settings.blockSlots() : std::nullopt;
  if (slots && !inverter.refresh.chosen().read())
  {
    warnings.push_back(inverter.block_transfer.whyNot(*slots));
  }
  if (const std::string text = inverter.map_use.whyNot(inverter.settings.map()); !text.empty())
  {
    warnings.push_back(text);
  }
  if (writesWear(inverter))
  {
    warnings.push_back("every change of the set-point is written to the drive's EEPROM (" +
                       std::to_string(inverter.services.eepromWrites()) +
                       " writes so far): " + inverter.drive.armingAdvice("connect"));
  }
  return warnings;
}
}  // namespace

InverterStatus statusOf(const Inverter& inverter, TimePoint now)
{
  InverterStatus status;
  const auto& last_answer = inverter.link.lastAnswer();
  const bool answered_lately = last_answer && now - *last_answer < seconds(LATELY_S);
  status.index = inverter.index;
  status.model = inverter.settings.model();
  status.stamp = inverter.refresh.stamp().value_or(TimePoint());
  status.has_stamp = inverter.refresh.stamp().has_value();
  status.communication_error = inverter.link.offline();
  status.refuses = inverter.link.offline() && inverter.liveness.refusesForTheMoment() && answered_lately;
  if (!status.communication_error)
  {
    status.monitor = inverter.refresh.monitor(now);
    status.slow_age = inverter.refresh.reads().slowAge(now);
  }
  status.run_command = inverter.movement.runCommand();
  status.move_velocity_active = inverter.movement.active();
  status.reset_active = inverter.services.resetting();
  status.stop_active = inverter.stop.pending();
  status.locked = inverter.obstacles(now).locked;
  showError(inverter, now, status);
  const auto& target = inverter.movement.target();
  status.commanded_velocity = target && !target->zero ? target->velocity : 0.0;
  return status;
}

std::vector<Finding> findingsOf(const Inverter& inverter, TimePoint now)
{
  std::vector<Finding> findings = errorsOf(inverter, now);
  const auto warn = [&](const std::string& text) { findings.push_back({ Level::Warn, text }); };
  if (!inverter.link.offline() && !inverter.link.known())
  {
    warn(silenceText(inverter));
  }
  for (const Finding& finding : inverter.settings.findings())
  {
    findings.push_back(finding);
  }
  for (const std::string& text : inverter.motion.warnings(now))
  {
    warn(text);
  }
  if (inverter.interlock.activePublishers(now) > 1)
  {
    warn("several publishers command this inverter");
  }
  if (inverter.link.latestReply() > Duration::zero())
  {
    warn("a reply came " + util::durationText(inverter.link.latestReply()) +
         " after its request; a response_timeout above that "
         "would have caught it");
  }
  for (const std::string& text : profileWarnings(inverter))
  {
    warn(text);
  }
  return findings;
}

std::vector<std::pair<std::string, std::string>> valuesOf(const Inverter& inverter, TimePoint now)
{
  std::vector<std::pair<std::string, std::string>> values;
  const drive::Profile& profile = inverter.drive.profile();
  const Refresh& refresh = inverter.refresh;
  values.emplace_back("node", std::to_string(inverter.config.node));
  values.emplace_back("drive", profile.name);
  values.emplace_back("model", profile.title);
  values.emplace_back("age of status",
                      refresh.stamp() ? util::durationText(now - *refresh.stamp()) : std::string("no status yet"));
  const std::optional<Duration> slow_age = refresh.reads().slowAge(now);
  values.emplace_back("slow values", slow_age ? "read every " + util::durationText(refresh.reads().slowPeriod()) +
                                                    ", the oldest is of " + util::durationText(*slow_age) + " ago"
                                              : std::string("not read yet"));
  values.emplace_back("slowest reply", util::durationText(inverter.link.slowestReply()));
  values.emplace_back("returns", std::to_string(inverter.link.returns()));
  values.emplace_back("locked", inverter.obstacles(now).locked ? "yes" : "no");
  values.emplace_back("own reply delay", util::durationText(inverter.settings.replyDelay()));
  if (profile.writes == drive::Writes::Eeprom || inverter.drive.wears("frequency"))
  {
    values.emplace_back("EEPROM writes by this node", std::to_string(inverter.services.eepromWrites()));
  }
  if (profile.block)
  {
    values.emplace_back("block read",
                        refresh.chosen().read() ? "in use: " + util::joined(inverter.config.block_read) : "not used");
  }
  if (MapUse::wanted(inverter.drive, inverter.config))
  {
    values.emplace_back("register map", inverter.map_use.inUse() ? "in use" : "not used");
  }
  for (const auto& value : refresh.chosen().values())
  {
    values.push_back(value);
  }
  for (const auto& value : inverter.settings.values())
  {
    values.push_back(value);
  }
  return values;
}

std::string onlineText(const Inverter& inverter)
{
  const drive::Drive& drive = inverter.drive;
  const bool moves = drive.sequence("forward") != nullptr || drive.sequence("reverse") != nullptr;
  return "online; locked until it is sent 0, or nothing for " + util::durationText(inverter.interlock.silenceNeeded()) +
         (moves ? "" : "; it gets no velocity, see /diagnostics");
}

std::string offlineReason(const Inverter& inverter)
{
  const std::string seen = inverter.record.text(inverter.drive);
  const bool tell = !seen.empty() && inverter.link.error() != wire::ERROR_PORT_LOST;
  return exchangeText(inverter) + (tell ? "; since the last complete status " + seen : "");
}
}  // namespace bus
}  // namespace inverter_bus
