// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_BUS_DRIVE_IDENTITY_H
#define INVERTER_BUS_BUS_DRIVE_IDENTITY_H

#include <cstdint>
#include <optional>
#include <string>

#include "bus/inverter/setting_list.h"

namespace inverter_bus
{
namespace bus
{
/// What the drive says about itself, compared with what its profile expects.
enum class Identity
{
  /// It fits, or the profile has nothing that distinguishes it from another drive.
  Right,
  /// It has not been asked yet.
  Unknown,
  Wrong
};

/// Whether the drive is the one that its profile describes (contract, 4.5): by the model that it names itself (CompoWay/F),
/// and by settings. Pure. Not thread safe; the bus guards it.
class DriveIdentity
{
public:
  /// \p drive must outlive it.
  DriveIdentity(const drive::Drive& drive, std::uint8_t station);

  /// The model is asked for again (the drive has come back).
  void restart();
  /// The request for the model; empty: it is known, refused, or cannot be read.
  std::optional<wire::Request> next() const;
  /// The answer to it.
  void done(const wire::Reply& reply);

  /// \p settings as far as the drive has reported them.
  Identity judge(const SettingList& settings) const;
  /// Why the drive gets no command but a stop: it is the wrong one, or has not reported yet what it is; empty: it is right.
  std::string text(const SettingList& settings) const;
  /// As the drive names itself; empty: not reported.
  const std::string& model() const;
  /// Of the model, for /diagnostics; empty: it is not asked for.
  std::string modelText() const;

private:
  const drive::Drive& drive_;
  std::uint8_t station_;
  bool wants_model_ = false;
  Told told_ = Told::NotYet;
  std::string model_;
};
}  // namespace bus
}  // namespace inverter_bus

#endif  // INVERTER_BUS_BUS_DRIVE_IDENTITY_H
