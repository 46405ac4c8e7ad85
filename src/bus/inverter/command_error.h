// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_BUS_COMMAND_ERROR_H
#define INVERTER_BUS_BUS_COMMAND_ERROR_H

#include <cstdint>
#include <string>

namespace inverter_bus
{
namespace bus
{
/// What may bar an inverter from a velocity at a given moment.
struct Obstacles
{
  bool locked = false;
  /// The drive has tripped, which locks it until it has been reset.
  bool tripped = false;
  bool offline = false;
  bool stop_pending = false;
  bool reset_active = false;
  bool in_setup = false;
  bool wrong_drive = false;
};

/// The last velocity that was refused or could not be carried out. The id of a refusal stays until the next accepted
/// command (contract, section 2); its text stays true: what is over is reported as over. Behind a refusal, a failure at
/// the drive stays until a velocity is confirmed, since a stream of accepted ones would hide it.
class CommandError
{
public:
  /// \p now what was in the way when it was refused (locked is not asked for)
  void set(std::uint16_t error_id, const std::string& text, const Obstacles& now);
  /// The whole group was refused for the sake of other members, for \p reasons (names and texts). \p own_error_id and
  /// \p own_text: what was in the way of this one as well, but counts less; 0: nothing did.
  void setForOther(std::uint16_t error_id, const std::string& reasons, std::uint16_t own_error_id,
                   const std::string& own_text, const Obstacles& now);
  /// A velocity was accepted: no refusal is left.
  void clear();
  /// One that was accepted has failed at the drive.
  void failed(std::uint16_t error_id, const std::string& text);
  /// One was confirmed, or a 0 came: no failure is left.
  void confirmed();
  /// The inverter has gone offline: that is newer, and what counts.
  void wentOffline();

  /// 0: none.
  std::uint16_t id() const;
  /// Says more about an inverter that is offline than the reason why it is.
  bool countsWhileOffline() const;
  /// \p offline_reason why the inverter is offline, if it is
  std::string text(const Obstacles& now, const std::string& offline_reason) const;

private:
  enum class Cause
  {
    Lasting,
    Lock,
    Offline,
    Stop,
    Reset,
    Setup,
    WrongDrive
  };
  static Cause causeOf(std::uint16_t error_id, const std::string& text, const Obstacles& now);
  bool lasts(const Obstacles& now) const;
  std::string lastingText(const Obstacles& now, const std::string& offline_reason) const;
  std::string pastText() const;

  std::uint16_t id_ = 0;
  /// That other members of the group were the reason; empty: this inverter's own.
  std::string group_text_;
  /// The inverter's own reason; empty: it has none.
  std::string text_;
  Cause cause_ = Cause::Lasting;
  bool before_offline_ = false;
  /// 0: none.
  std::uint16_t failed_id_ = 0;
  std::string failed_text_;
};
}  // namespace bus
}  // namespace inverter_bus

#endif  // INVERTER_BUS_BUS_COMMAND_ERROR_H
