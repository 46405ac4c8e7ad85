// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "bus/rules/budget.h"

#include <algorithm>

#include "bus/rules/reply_times.h"
#include "util/text.h"

namespace inverter_bus
{
namespace bus
{
namespace
{
constexpr double STOP_SLACK_CHARACTERS = 64.0;
// Contract, 8.3: slow values that are read less often are worth a warning.
constexpr double LONG_SLOW_PERIOD_S = 5.0;
}  // namespace

namespace
{
/// Block read and write, what is settled at connect.
void addSpecialRequests(const InverterConfig& config, const drive::Drive& drive, std::vector<wire::Request>& requests)
{
  if (const auto block = drive.chosenRead(config.block_read))
  {
    std::vector<drive::Word> words;
    for (const auto& entry : drive.profile().block->select)
    {
      words.emplace_back(entry.first, 0);
    }
    requests.push_back(drive.read(config.node, *block));
    requests.push_back(drive.writeChosen(config.node, words));
    requests.push_back(drive.writeAndRead(config.node, words, *block));
  }
  if (const auto attributes = drive.readAttributes(config.node))
  {
    requests.push_back(*attributes);
  }
  if (const drive::Sequence* connect = drive.sequence("connect"))
  {
    for (const drive::Step& step : connect->steps)
    {
      requests.push_back(drive.command(config.node, step));
    }
  }
}

/// What takes from the share of the slow values, once: their reads, and the settings that are repeated while a motor runs.
std::vector<wire::Request> slowRequests(const Configuration& configuration, std::size_t index)
{
  const drive::Drive& drive = configuration.drives[index];
  const std::uint8_t station = configuration.bus.inverters[index].node;
  std::vector<wire::Request> requests;
  for (const drive::ReadBlock& block : drive.slowBlocks())
  {
    if (isSlowed(block) && configuration.bus.slow_interval > 0.0)
    {
      requests.push_back(drive.read(station, block));
    }
  }
  for (const drive::Expectation& source : drive.profile().command_source)
  {
    const auto parameter = source.when_commanded ? drive.findParameter(source.parameter, false) : std::nullopt;
    if (parameter)
    {
      requests.push_back(drive.readParameter(station, *parameter));
    }
  }
  for (wire::Request& request : requests)
  {
    request.reply_delay = seconds(drive.profile().reply_delay);
  }
  return requests;
}
}  // namespace

Budget::Budget(const Configuration& configuration, const wire::Line& line) : configuration_(configuration), line_(line)
{
}

std::vector<wire::Request> Budget::requests(std::size_t index) const
{
  const InverterConfig& config = configuration_.bus.inverters[index];
  const drive::Drive& drive = configuration_.drives[index];
  std::vector<wire::Request> requests;
  for (const auto* blocks : { &drive.fastBlocks(), &drive.slowBlocks(), &drive.faultBlocks() })
  {
    for (const drive::ReadBlock& block : *blocks)
    {
      requests.push_back(drive.read(config.node, block));
    }
  }
  for (const char* name : { "forward", "reverse", "stop", "reset" })
  {
    if (const drive::Sequence* sequence = drive.sequence(name))
    {
      for (const drive::Step& step : sequence->steps)
      {
        requests.push_back(drive.write(config.node, step.point, step.value.value_or(0)));
      }
    }
  }
  addSpecialRequests(config, drive, requests);
  for (wire::Request& request : requests)
  {
    request.response_timeout = seconds(config.response_timeout);
    request.reply_delay = seconds(drive.profile().reply_delay);
  }
  return requests;
}

Duration Budget::readCost(std::size_t index, const drive::ReadBlock& block) const
{
  const drive::Drive& drive = configuration_.drives[index];
  return line_.cost(drive.read(configuration_.bus.inverters[index].node, block), seconds(drive.profile().reply_delay));
}

Duration Budget::refreshCost(std::size_t index) const
{
  Duration cost{ 0 };
  for (const drive::ReadBlock& block : configuration_.drives[index].fastBlocks())
  {
    cost += readCost(index, block);
  }
  return cost;
}

Duration Budget::slowNeeds() const
{
  Duration needs{ 0 };
  for (std::size_t index = 0; index < configuration_.drives.size(); ++index)
  {
    for (const wire::Request& request : slowRequests(configuration_, index))
    {
      needs += line_.cost(request, request.reply_delay);
    }
  }
  return needs;
}

SlowShare::Settings Budget::slowSettings() const
{
  SlowShare::Settings settings;
  settings.interval = seconds(configuration_.bus.slow_interval);
  settings.gap = line_.timing().gap(MODBUS_GAP_CHARACTERS);
  settings.cycle = cycle() + seconds(configuration_.bus.interval);
  for (std::size_t index = 0; index < configuration_.drives.size(); ++index)
  {
    for (const wire::Request& request : slowRequests(configuration_, index))
    {
      settings.longest = std::max(settings.longest, line_.cost(request, request.reply_delay));
    }
  }
  return settings;
}

Duration Budget::slowPeriod() const
{
  return SlowShare(slowSettings()).period(slowNeeds());
}

Duration Budget::cycle() const
{
  Duration fast{ 0 };
  Duration guards{ 0 };
  for (std::size_t index = 0; index < configuration_.drives.size(); ++index)
  {
    fast += refreshCost(index);
    for (const drive::ReadBlock& block : configuration_.drives[index].slowBlocks())
    {
      guards += isSlowed(block) ? Duration{ 0 } : readCost(index, block);
    }
  }
  const double interval = configuration_.bus.slow_interval;
  const double slow = interval > 0.0 ? std::min(SLOW_SHARE, toSeconds(slowNeeds()) / interval) : 0.0;
  // What is never slowed comes once a second, but never takes more than a refresh's place.
  return seconds(toSeconds(fast) / (1.0 - slow - std::min(0.5, toSeconds(guards))));
}

Duration Budget::longestExchange() const
{
  Duration longest{ 0 };
  for (std::size_t index = 0; index < configuration_.drives.size(); ++index)
  {
    for (const wire::Request& request : requests(index))
    {
      // A reply may begin when its time is almost up: nothing on the line takes longer.
      longest = std::max(longest, line_.cost(request, request.reply_delay) + request.response_timeout);
    }
  }
  // A reply that breaks off, or pauses, ends a pause later.
  return longest + line_.patience();
}

Duration Budget::longestCutExchange() const
{
  Duration longest{ 0 };
  for (std::size_t index = 0; index < configuration_.drives.size(); ++index)
  {
    for (const wire::Request& request : requests(index))
    {
      longest = std::max(longest, line_.cost(request, ReplyTimes().cutAfter(request.reply_delay, Duration{ 0 })));
    }
  }
  return longest + line_.timing().briefPause();
}

Duration Budget::stopFrame() const
{
  Duration frame{ 0 };
  for (std::size_t index = 0; index < configuration_.drives.size(); ++index)
  {
    if (const drive::Sequence* stop = configuration_.drives[index].sequence("stop"))
    {
      const drive::Step& step = stop->steps.front();
      wire::Request request = configuration_.drives[index].write(1, step.point, step.value.value_or(0));
      request.response_timeout = Duration{ 0 };
      // Two gaps: the second one ends the frame for the drive.
      frame = std::max(frame, line_.costUnanswered(request));
    }
  }
  return frame;
}

Duration Budget::worstStop() const
{
  return configuration_.bus.modbus_tcp ? worstStopUncut() : longestCutExchange() + stopFrame();
}

Duration Budget::worstStopUncut() const
{
  return longestExchange() + stopFrame();
}

Duration Budget::velocityUnit(std::size_t index) const
{
  const drive::Drive& drive = configuration_.drives[index];
  Duration unit{ 0 };
  if (const drive::Sequence* forward = drive.sequence("forward"))
  {
    for (const drive::Step& step : forward->steps)
    {
      unit += line_.cost(drive.write(configuration_.bus.inverters[index].node, step.point, step.value.value_or(0)),
                         seconds(drive.profile().reply_delay));
    }
  }
  return unit;
}

Duration Budget::longestGap() const
{
  Duration commands{ 0 };
  for (std::size_t index = 0; index < configuration_.drives.size(); ++index)
  {
    commands += static_cast<int>(configuration_.drives[index].fastBlocks().size()) * velocityUnit(index);
  }
  return cycle() + commands + seconds(configuration_.bus.interval) + longestExchange();
}

Duration Budget::deadlineMargin() const
{
  Duration margin = longestExchange();
  for (std::size_t index = 0; index < configuration_.drives.size(); ++index)
  {
    Duration read{ 0 };
    for (const drive::ReadBlock& block : configuration_.drives[index].fastBlocks())
    {
      read = std::max(read, readCost(index, block));
    }
    margin += read + velocityUnit(index);
  }
  return margin;
}

std::optional<Finding> Budget::judgeDriveTimeout(const std::string& name, Duration timeout) const
{
  return judgeDriveTimeout(name, timeout, deadlineMargin());
}

std::optional<Finding> Budget::judgeDriveTimeout(const std::string& name, Duration timeout, Duration margin)
{
  if (timeout > margin)
  {
    return std::nullopt;
  }
  return Finding{ Level::Warn, name + ": its own communication time-out of " + util::millisecondsText(timeout) +
                                   " can't be kept with certainty: up to " + util::millisecondsText(margin) +
                                   " may pass between two frames; raise it, or the baud rate, or use fewer inverters" };
}

Budget::Figures Budget::figures() const
{
  Figures figures;
  figures.cycle = cycle();
  figures.worst_stop = worstStop();
  figures.worst_stop_uncut = worstStopUncut();
  figures.longest_exchange = longestExchange();
  figures.deadline_margin = deadlineMargin();
  figures.longest_pause = line_.patience();
  figures.stop_slack = line_.timing().characters(STOP_SLACK_CHARACTERS);
  figures.slow = slowSettings();
  figures.findings = findings();
  return figures;
}

/// What comes on top of the worst stop latency, and when.
std::string Budget::behindOthers() const
{
  return configuration_.bus.modbus_tcp
             ? " and up to " + util::millisecondsText(seconds(configuration_.bus.gateway_timeout)) +
                   " for each inverter that does not answer"
             : ", " + util::millisecondsText(worstStopUncut()) +
                   " behind another stop, a reset or a write to an EEPROM that is not answered";
}

/// Contract, 8.3: the share is small; fresher values are had by leaving others out.
std::optional<Finding> Budget::slowFinding() const
{
  const Duration period = slowPeriod();
  if (period <= std::max(seconds(LONG_SLOW_PERIOD_S), seconds(configuration_.bus.slow_interval)))
  {
    return std::nullopt;
  }
  return Finding{ Level::Warn, "slow values (voltages, torque, temperature, warnings) can be read only every " +
                                   util::durationText(period) + " within " + util::numberText(SLOW_SHARE * 100.0) +
                                   " % of the wire; use skip to leave out what is not needed, or raise the baud rate" };
}

std::vector<Finding> Budget::findings() const
{
  std::vector<Finding> findings;
  findings.push_back(
      { Level::Ok, "bus budget: status cycle " + util::millisecondsText(cycle()) + ", worst stop latency " +
                       util::millisecondsText(worstStop()) + behindOthers() +
                       " (plus the ramp), longest gap between two frames to "
                       "an inverter " +
                       util::millisecondsText(longestGap()) + ", slow values " +
                       (configuration_.bus.slow_interval > 0.0 ? "every " + util::durationText(slowPeriod())
                                                               : "never (slow_interval is 0)") +
                       returnText() });
  for (const auto& finding : { slowFinding(), returnBehindGateway() })
  {
    if (finding)
    {
      findings.push_back(*finding);
    }
  }
  for (std::size_t index = 0; index < configuration_.drives.size(); ++index)
  {
    const InverterConfig& config = configuration_.bus.inverters[index];
    if (config.command_timeout > 0.0 && seconds(config.command_timeout) < cycle())
    {
      findings.push_back({ Level::Warn, config.name + ": command_timeout " + util::numberText(config.command_timeout) +
                                            " s is shorter than a status cycle (" + util::millisecondsText(cycle()) +
                                            ")" });
    }
    const drive::CommunicationLoss& loss = configuration_.drives[index].profile().communication_loss;
    if (loss.timeout_parameter.empty() && loss.assumed_timeout > 0.0)
    {
      if (const auto finding = judgeDriveTimeout(config.name, seconds(loss.assumed_timeout)))
      {
        findings.push_back(*finding);
      }
    }
  }
  return findings;
}
}  // namespace bus
}  // namespace inverter_bus
