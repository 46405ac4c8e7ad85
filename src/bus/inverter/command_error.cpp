// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "bus/inverter/command_error.h"

#include "inverter_bus/bus/types.h"

namespace inverter_bus
{
namespace bus
{
namespace
{
/// What lasts is reported in the present tense; what has passed, in the past.
std::string otherText(std::uint16_t error_id, const std::string& reasons)
{
  switch (error_id)
  {
    case ERROR_OFFLINE:
      return "one of its inverters was offline";
    case ERROR_CANCELLED:
      return "a stop of one of its inverters was under way";
    case ERROR_LOCKED:
      return "one of its inverters was locked";
    default:
      return reasons.empty() ? errorText(error_id) : reasons;
  }
}
}  // namespace

CommandError::Cause CommandError::causeOf(std::uint16_t error_id, const std::string& text, const Obstacles& now)
{
  switch (error_id)
  {
    case ERROR_OFFLINE:
      return Cause::Offline;
    case ERROR_CANCELLED:
      return now.stop_pending ? Cause::Stop : Cause::Lasting;
    case ERROR_NOT_ARMED:
      return now.wrong_drive ? Cause::WrongDrive : Cause::Lasting;
    case ERROR_LOCKED:
      break;
    default:
      return Cause::Lasting;
  }
  if (text == lockedText(false) || text == lockedText(true))
  {
    return Cause::Lock;
  }
  if (now.wrong_drive)
  {
    return Cause::WrongDrive;
  }
  return now.reset_active ? Cause::Reset : now.in_setup ? Cause::Setup : Cause::Lasting;
}

void CommandError::set(std::uint16_t error_id, const std::string& text, const Obstacles& now)
{
  id_ = error_id;
  group_text_.clear();
  text_ = text;
  cause_ = causeOf(error_id, text, now);
  before_offline_ = false;
}

void CommandError::setForOther(std::uint16_t error_id, const std::string& reasons, std::uint16_t own_error_id,
                               const std::string& own_text, const Obstacles& now)
{
  set(own_error_id, own_text, now);
  id_ = error_id;
  group_text_ = "the group was refused: " + otherText(error_id, reasons);
}

void CommandError::clear()
{
  set(0, "", Obstacles());
}

void CommandError::failed(std::uint16_t error_id, const std::string& text)
{
  failed_id_ = error_id;
  failed_text_ = text;
}

void CommandError::confirmed()
{
  failed_id_ = 0;
  failed_text_.clear();
}

void CommandError::wentOffline()
{
  before_offline_ = id_ != 0;
  confirmed();
}

std::uint16_t CommandError::id() const
{
  return id_ != 0 ? id_ : failed_id_;
}

bool CommandError::countsWhileOffline() const
{
  // Of what was refused since then, a lock says less than the silence behind it (contract, section 2: the order of ids).
  return id_ != 0 && !before_offline_ && id_ != ERROR_LOCKED && id_ != ERROR_CANCELLED;
}

bool CommandError::lasts(const Obstacles& now) const
{
  switch (cause_)
  {
    case Cause::Lock:
      return now.locked;
    case Cause::Offline:
      return now.offline;
    case Cause::Stop:
      return now.stop_pending;
    case Cause::Reset:
      return now.reset_active;
    case Cause::Setup:
      return now.in_setup;
    case Cause::WrongDrive:
      return now.wrong_drive;
    default:
      return true;
  }
}

std::string CommandError::pastText() const
{
  switch (cause_)
  {
    case Cause::Lock:
      return "was refused: the inverter was locked; it is unlocked now";
    case Cause::Offline:
      return "was refused: the inverter was offline; it answers again";
    case Cause::Stop:
      return "was refused: a stop was under way; it is over";
    default:
      return "was refused: " + text_ + "; that is over";
  }
}

/// A trip may have come, or have been reset, since it was refused because of a lock.
std::string CommandError::lastingText(const Obstacles& now, const std::string& offline_reason) const
{
  if (cause_ == Cause::Lock)
  {
    return lockedText(now.tripped);
  }
  return text_ + (cause_ == Cause::Offline && !offline_reason.empty() ? ": " + offline_reason : "");
}

std::string CommandError::text(const Obstacles& now, const std::string& offline_reason) const
{
  if (id_ == 0)
  {
    return failed_id_ == 0 ? "" : "the last velocity was not carried out: " + failed_text_;
  }
  const bool lasting = lasts(now);
  if (group_text_.empty())
  {
    return lasting ? lastingText(now, offline_reason) : pastText();
  }
  const bool own = lasting && !text_.empty();
  return group_text_ + (own ? "; this inverter itself: " + lastingText(now, offline_reason) : "");
}
}  // namespace bus
}  // namespace inverter_bus
