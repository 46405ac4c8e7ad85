// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "bus/inverter/drive_settings.h"

#include <algorithm>
#include <tuple>

#include "util/text.h"

namespace inverter_bus
{
namespace bus
{
namespace
{
// A setting that the drive could not tell just now (exception 04H, 06H, response code 2203) is asked for again, since what
// it says may decide over safety; to one that never can it costs nothing worth speaking of.
constexpr double FIRST_PAUSE_S = 1.0;
constexpr unsigned MOST_DOUBLINGS = 6;

std::string withUnit(double value, const std::string& unit)
{
  return util::withUnit(util::numberText(value, 9), unit);
}
}  // namespace

DriveSettings::DriveSettings(const drive::Drive& drive, std::uint8_t station) : drive_(drive), station_(station)
{
  const drive::Profile& profile = drive.profile();
  want(profile.identity, true);
  for (const drive::Expectation& expectation : profile.identity)
  {
    wants_model_ = wants_model_ || !expectation.model.empty();
  }
  // A model that nobody judges is still worth showing.
  wants_model_ = wants_model_ || drive.readAttributes(station).has_value();
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

void DriveSettings::want(const std::vector<drive::Expectation>& expectations, bool urgent)
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

const DriveSettings::Setting* DriveSettings::find(const std::string& parameter) const
{
  const auto found = std::find_if(settings_.begin(), settings_.end(),
                                  [&](const Setting& setting) { return setting.parameter.name == parameter; });
  return found == settings_.end() ? nullptr : &*found;
}

const DriveSettings::Setting* DriveSettings::known(const std::string& parameter) const
{
  const Setting* setting = find(parameter);
  return setting != nullptr && setting->state == State::Known ? setting : nullptr;
}

bool DriveSettings::due(const Setting& setting) const
{
  const bool asked = setting.state == State::Unread || setting.again || setting.refusals > 0;
  return asked && (!setting.when_commanded || commanded_);
}

const DriveSettings::Setting* DriveSettings::unread() const
{
  // One that the drive could not tell just now lets the others go first.
  const auto found =
      std::min_element(settings_.begin(), settings_.end(), [this](const Setting& one, const Setting& other) {
        return std::make_tuple(!due(one), !one.urgent, one.refusals) <
               std::make_tuple(!due(other), !other.urgent, other.refusals);
      });
  return found == settings_.end() || !due(*found) ? nullptr : &*found;
}

void DriveSettings::restart()
{
  for (Setting& setting : settings_)
  {
    setting.state = State::Unread;
    setting.refusals = 0;
  }
  model_state_ = State::Unread;
  commanded_ = false;
  connectAgain();
}

void DriveSettings::connectAgain()
{
  connect_step_ = 0;
  connect_state_ = State::Unread;
  connect_error_ = 0;
}

void DriveSettings::reread(const std::string& parameter)
{
  for (Setting& setting : settings_)
  {
    if (setting.parameter.name == parameter)
    {
      setting.state = State::Unread;
      setting.refusals = 0;
    }
  }
}

void DriveSettings::commanded()
{
  for (Setting& setting : settings_)
  {
    if (setting.when_commanded && !commanded_)
    {
      setting.state = State::Unread;
    }
    setting.again = setting.again || setting.when_commanded;
  }
  commanded_ = true;
}

void DriveSettings::released()
{
  commanded_ = false;
  for (Setting& setting : settings_)
  {
    setting.state = setting.when_commanded ? State::Unread : setting.state;
  }
}

bool DriveSettings::modelDue() const
{
  return wants_model_ && model_state_ == State::Unread;
}

bool DriveSettings::connectDue() const
{
  // A drive that is another one than expected is told nothing.
  return connect_state_ == State::Unread && identity() == Identity::Right && drive_.sequence("connect") != nullptr;
}

void DriveSettings::leaveSetup()
{
  leave_setup_ = drive_.sequence("close_setup") != nullptr;
}

bool DriveSettings::leavingSetup() const
{
  return leave_setup_;
}

bool DriveSettings::urgent() const
{
  if (leave_setup_)
  {
    return true;
  }
  const bool parameter = std::any_of(settings_.begin(), settings_.end(),
                                     [this](const Setting& setting) { return setting.urgent && due(setting); });
  return modelDue() || parameter || connectDue();
}

bool DriveSettings::pending() const
{
  return urgent() || unread() != nullptr;
}

bool DriveSettings::nextWrites() const
{
  const Setting* setting = unread();
  return leave_setup_ || (!modelDue() && connectDue() && (setting == nullptr || !setting->urgent));
}

wire::Request DriveSettings::next() const
{
  if (leave_setup_)
  {
    return drive_.command(station_, drive_.sequence("close_setup")->steps.front());
  }
  if (modelDue())
  {
    return *drive_.readAttributes(station_);
  }
  const Setting* setting = unread();
  // The urgent ones stand first in the list.
  if (connectDue() && (setting == nullptr || !setting->urgent))
  {
    return drive_.command(station_, drive_.sequence("connect")->steps[connect_step_]);
  }
  return drive_.readParameter(station_, setting->parameter);
}

void DriveSettings::doneModel(const wire::Reply& reply)
{
  if (reply.outcome == wire::Outcome::Ok)
  {
    model_ = drive_.decodeModel(reply.pdu);
    model_state_ = State::Known;
  }
  else if (isLastingRefusal(reply))
  {
    model_.clear();
    model_state_ = State::Refused;
  }
}

void DriveSettings::doneConnect(const wire::Reply& reply)
{
  if (isLastingRefusal(reply))
  {
    connect_error_ = reply.error_id;
    connect_state_ = State::Refused;
  }
  else if (reply.outcome == wire::Outcome::Ok && ++connect_step_ >= drive_.sequence("connect")->steps.size())
  {
    connect_state_ = State::Known;
  }
}

void DriveSettings::done(const wire::Reply& reply)
{
  if (leave_setup_)
  {
    leave_setup_ = reply.outcome != wire::Outcome::Ok && !isLastingRefusal(reply);
    return;
  }
  if (modelDue())
  {
    doneModel(reply);
    return;
  }
  const Setting* asked = unread();
  if (connectDue() && (asked == nullptr || !asked->urgent))
  {
    doneConnect(reply);
    return;
  }
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
    setting.state = State::Known;
    setting.refusals = 0;
  }
  else if (isLastingRefusal(reply))
  {
    setting.state = State::Refused;
    setting.refusals = 0;
  }
  else if (reply.outcome == wire::Outcome::Exception)
  {
    ++setting.refusals;
    setting.state = setting.urgent ? setting.state : State::Refused;
  }
}

Duration DriveSettings::pauseBeforeNext() const
{
  const Setting* setting = unread();
  if (urgent() || setting == nullptr || setting->refusals == 0)
  {
    return Duration{ 0 };
  }
  const unsigned doublings = std::min(setting->refusals - 1, MOST_DOUBLINGS);
  return seconds(FIRST_PAUSE_S * static_cast<double>(1U << doublings));
}

// --- what it is ------------------------------------------------------------------------------------------------------

Identity DriveSettings::identity() const
{
  bool unknown = false;
  for (const drive::Expectation& expectation : drive_.profile().identity)
  {
    if (!expectation.model.empty())
    {
      unknown = unknown || model_state_ == State::Unread;
      const bool fits = model_.compare(0, expectation.model.size(), expectation.model) == 0;
      if (model_state_ == State::Refused || (model_state_ == State::Known && !fits))
      {
        return Identity::Wrong;
      }
      continue;
    }
    const Setting* setting = find(expectation.parameter);
    if (setting == nullptr)
    {
      continue;
    }
    unknown = unknown || setting->state == State::Unread;
    const bool fits = expectation.accept.count(setting->raw) != 0;
    if (setting->state == State::Refused || (setting->state == State::Known && !fits))
    {
      return Identity::Wrong;
    }
  }
  return unknown ? Identity::Unknown : Identity::Right;
}

std::string DriveSettings::identityText() const
{
  if (identity() == Identity::Unknown)
  {
    return "the drive has not told yet what it is";
  }
  for (const drive::Expectation& expectation : drive_.profile().identity)
  {
    const Setting* setting = find(expectation.parameter);
    const bool refused = expectation.model.empty() ? setting != nullptr && setting->state == State::Refused
                                                   : model_state_ == State::Refused;
    const bool fits = expectation.model.empty() ? setting == nullptr || expectation.accept.count(setting->raw) != 0
                                                : model_.compare(0, expectation.model.size(), expectation.model) == 0;
    if (!refused && fits)
    {
      continue;
    }
    const std::string what = expectation.model.empty() ? expectation.parameter : "its model";
    const std::string told = expectation.model.empty() && setting != nullptr ? std::to_string(setting->raw) : model_;
    return "wrong drive: " + what + (refused ? " is not to be had" : " is '" + told + "'") +
           (expectation.advice.empty() ? "" : "; " + expectation.advice);
  }
  return "";
}

const std::string& DriveSettings::model() const
{
  return model_;
}

bool DriveSettings::connected() const
{
  const auto& sequences = drive_.profile().sequences;
  return sequences.count("connect") == 0 || connect_state_ == State::Known;
}

drive::Ratings DriveSettings::ratings() const
{
  const auto rating = [this](const std::string& parameter) {
    const Setting* setting = known(parameter);
    return setting != nullptr && setting->value > 0.0 ? std::optional<double>(setting->value) : std::nullopt;
  };
  drive::Ratings ratings;
  ratings.current = rating(drive_.profile().rated_current_parameter);
  ratings.voltage = rating(drive_.profile().rated_voltage_parameter);
  return ratings;
}

std::optional<std::vector<int>> DriveSettings::codesOf(const std::vector<std::string>& slots) const
{
  std::vector<int> codes;
  for (const std::string& slot : slots)
  {
    const Setting* setting = known(slot);
    if (setting == nullptr)
    {
      return std::nullopt;
    }
    codes.push_back(static_cast<int>(setting->raw));
  }
  return codes;
}

std::optional<BlockSlots> DriveSettings::blockSlots() const
{
  if (!drive_.profile().block)
  {
    return std::nullopt;
  }
  const auto read = codesOf(drive_.profile().block->read_slots);
  const auto write = codesOf(drive_.profile().block->write_slots);
  return read && write ? std::optional<BlockSlots>(BlockSlots{ *read, *write }) : std::nullopt;
}

// --- what it does by itself ------------------------------------------------------------------------------------------

std::optional<Duration> DriveSettings::driveTimeout() const
{
  const drive::CommunicationLoss& loss = drive_.profile().communication_loss;
  if (loss.timeout_parameter.empty())
  {
    return loss.assumed_timeout > 0.0 ? std::optional<Duration>(seconds(loss.assumed_timeout)) : std::nullopt;
  }
  const Setting* setting = find(loss.timeout_parameter);
  if (setting == nullptr || setting->state != State::Known)
  {
    // Until it is read the usual one is the safe assumption.
    return loss.assumed_timeout > 0.0 ? std::optional<Duration>(seconds(loss.assumed_timeout)) : std::nullopt;
  }
  return setting->value > 0.0 ? std::optional<Duration>(seconds(setting->value)) : std::nullopt;
}

Duration DriveSettings::replyDelay() const
{
  const Setting* setting = find(drive_.profile().reply_delay_parameter);
  if (setting == nullptr || setting->state != State::Known)
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
    const bool judged = !expectation.when_commanded || commanded_;
    if (judged && setting != nullptr && setting->state == State::Known && expectation.accept.count(setting->raw) == 0)
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
  const bool off = timeout != nullptr && timeout->state == State::Known && timeout->value <= 0.0;
  const bool ignores = action != nullptr && action->state == State::Known && loss.runs_on.count(action->raw) != 0;
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
  if (identity() == Identity::Wrong)
  {
    findings.push_back({ Level::Error, identityText() + "; it gets no command but a stop" });
  }
  if (connect_state_ == State::Refused)
  {
    findings.push_back({ Level::Warn, "the drive refused what it is told at connect: " +
                                          drive_.exceptionText(connect_error_) + "; check the sequence connect" });
  }
  expectationFindings(drive_.profile().command_source, "not commanded by the bus", findings);
  lossFindings(findings);
  expectationFindings(drive_.profile().self_restart, "may restart by itself", findings);
  return findings;
}

std::vector<std::pair<std::string, std::string>> DriveSettings::values() const
{
  std::vector<std::pair<std::string, std::string>> values;
  if (wants_model_)
  {
    values.emplace_back("model as the drive names itself", model_state_ == State::Known ? model_ : "not told");
  }
  for (const Setting& setting : settings_)
  {
    std::string text = setting.when_commanded && !commanded_ ? "read while a command is in force" : "not read yet";
    if (setting.state == State::Known)
    {
      text = withUnit(setting.value, setting.parameter.item.unit);
    }
    else if (setting.state == State::Refused)
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
