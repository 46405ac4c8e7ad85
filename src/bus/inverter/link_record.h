// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_BUS_LINK_RECORD_H
#define INVERTER_BUS_BUS_LINK_RECORD_H

#include <cstdint>
#include <map>
#include <string>

#include "inverter_bus/drive/drive.h"
#include "inverter_bus/wire/request.h"

namespace inverter_bus
{
namespace bus
{
/// What came in place of a status since the last complete one: for people looking for the cause. No time, no decisions.
class LinkRecord
{
public:
  /// The end of an exchange that expected a reply; a lost port is not the drive's.
  void note(const wire::Reply& reply);
  /// A reply that came after its time-out.
  void noteLate();
  /// A complete status came: a new record begins.
  void restart();

  bool empty() const;
  /// "of 40 requests 38 were answered by exception 02H: address, 2 without a reply"; in the drive's own words for the
  /// exceptions. Empty while nothing was asked.
  std::string text(const drive::Drive& drive) const;
  /// What to look at, by what came most often; no verb of a sentence before it.
  std::string advice() const;

private:
  std::uint64_t lost() const;

  std::uint64_t requests_ = 0;
  std::uint64_t timeouts_ = 0;
  std::uint64_t damaged_ = 0;
  std::uint64_t late_ = 0;
  std::uint64_t answered_ = 0;
  /// By error id.
  std::map<std::uint16_t, std::uint64_t> exceptions_;
  /// By the gateway's exception code.
  std::map<std::uint8_t, std::uint64_t> gateway_;
};
}  // namespace bus
}  // namespace inverter_bus

#endif  // INVERTER_BUS_BUS_LINK_RECORD_H
