// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "bus/inverter/drive_settings.h"

#include "bus/inverter/settings_report.h"

namespace inverter_bus
{
namespace bus
{
DriveSettings::DriveSettings(const drive::Drive& drive, std::uint8_t station, bool map_wanted)
  : drive_(drive)
  , station_(station)
  , settings_(drive)
  , identity_(drive, station)
  , connect_(drive)
  , map_(drive, map_wanted)
{
}

void DriveSettings::restart(bool perhaps_another)
{
  settings_.restart(perhaps_another);
  connect_.restart();
  map_.restart();
  if (perhaps_another)
  {
    identity_.restart();
  }
}

void DriveSettings::connectAgain()
{
  connect_.restart();
}

void DriveSettings::reread(const std::string& parameter)
{
  settings_.reread(parameter);
  if (map_.has(parameter))
  {
    map_.restart();
  }
}

void DriveSettings::underCommand(bool in_force)
{
  in_force ? settings_.commanded() : settings_.released();
}

/// The step of the sequence `connect` that is due: a drive other than the expected one is sent nothing, and the reads that
/// show whether it is go first.
const drive::Step* DriveSettings::connectStep() const
{
  const bool right = identity() == Identity::Right && !settings_.urgent();
  return right ? connect_.next() : nullptr;
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
  return leave_setup_ || identity_.next() || settings_.urgent() || connectStep() != nullptr;
}

bool DriveSettings::pending() const
{
  return urgent() || settings_.next() != nullptr || map_.next() != nullptr;
}

bool DriveSettings::nextWrites() const
{
  return leave_setup_ || (!identity_.next() && connectStep() != nullptr);
}

bool DriveSettings::repeats() const
{
  return !urgent() && settings_.nextRepeats();
}

wire::Request DriveSettings::next() const
{
  if (leave_setup_)
  {
    return drive_.command(station_, drive_.sequence("close_setup")->steps.front());
  }
  if (const auto model = identity_.next())
  {
    return *model;
  }
  const drive::Step* step = connectStep();
  if (step != nullptr)
  {
    return drive_.command(station_, *step);
  }
  return settings_.next() != nullptr ? drive_.readParameter(station_, settings_.next()->parameter)
                                     : drive_.read(station_, *map_.next());
}

void DriveSettings::done(const wire::Reply& reply)
{
  if (leave_setup_)
  {
    leave_setup_ = reply.outcome != wire::Outcome::Ok && !isLastingRefusal(reply);
  }
  else if (identity_.next())
  {
    identity_.done(reply);
  }
  else if (connectStep() != nullptr)
  {
    connect_.done(reply);
  }
  else if (settings_.next() != nullptr)
  {
    settings_.done(reply);
  }
  else
  {
    map_.done(reply);
  }
}

Duration DriveSettings::pauseBeforeNext() const
{
  return urgent() ? Duration{ 0 } : settings_.pauseBeforeNext();
}

Identity DriveSettings::identity() const
{
  return identity_.judge(settings_);
}

std::string DriveSettings::identityText() const
{
  return identity_.text(settings_);
}

const std::string& DriveSettings::model() const
{
  return identity_.model();
}

bool DriveSettings::connected() const
{
  return connect_.complete();
}

drive::Ratings DriveSettings::ratings() const
{
  return ratingsOf(drive_, settings_);
}

std::optional<BlockSlots> DriveSettings::blockSlots() const
{
  return blockSlotsOf(drive_, settings_);
}

const MapTable& DriveSettings::map() const
{
  return map_;
}

std::optional<Duration> DriveSettings::driveTimeout() const
{
  return driveTimeoutOf(drive_, settings_);
}

Duration DriveSettings::replyDelay() const
{
  return replyDelayOf(drive_, settings_);
}

std::vector<Finding> DriveSettings::findings() const
{
  std::vector<Finding> findings;
  if (identity() == Identity::Wrong)
  {
    findings.push_back({ Level::Error, identityText() + "; it gets no command but a stop" });
  }
  if (connect_.refusedWith() != 0)
  {
    findings.push_back({ Level::Warn, "the drive refused a command of the sequence connect: " +
                                          drive_.exceptionText(connect_.refusedWith()) + "; check that sequence" });
  }
  const std::vector<Finding> own = settingFindings(drive_, settings_);
  findings.insert(findings.end(), own.begin(), own.end());
  return findings;
}

std::vector<std::pair<std::string, std::string>> DriveSettings::values() const
{
  std::vector<std::pair<std::string, std::string>> values;
  if (const std::string model = identity_.modelText(); !model.empty())
  {
    values.emplace_back("model reported by the drive", model);
  }
  const auto own = settingValues(drive_, settings_);
  values.insert(values.end(), own.begin(), own.end());
  return values;
}
}  // namespace bus
}  // namespace inverter_bus
