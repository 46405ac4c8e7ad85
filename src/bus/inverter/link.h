// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_BUS_LINK_H
#define INVERTER_BUS_BUS_LINK_H

#include <cstdint>
#include <optional>

#include "bus/inverter/trial.h"

namespace inverter_bus
{
namespace bus
{
/// The link to one inverter: whether it is online, how it answers, and what was wrong last. When it goes offline is decided
/// by Liveness, what it means for a motor by Inverter. Not thread safe; the bus guards it.
class Link
{
public:
  /// \p offline_after exchanges without data after which a drive no longer sends data (bus parameter `offline_after`).
  explicit Link(int offline_after);

  // --- what happened ------------------------------------------------------------------------------------------------
  /// An exchange has ended, no matter how.
  void exchangeEnded(const wire::Reply& reply);
  /// A valid reply came, of any kind. It makes an offline inverter worth a trial, and no more: it is back with a
  /// complete status only (contract, 8.15).
  void answered(const wire::Reply& reply);
  /// The reply brought something of the status.
  void dataRead();
  /// An exchange failed with \p error_id; shown until another one is answered.
  void failed(std::uint16_t error_id);
  /// How a probe ended: while the inverter is offline that is the reason, not the port that was gone before.
  void probed(const wire::Reply& reply);
  /// A reply came \p delay after its request, when it was no longer waited for.
  void cameLate(Duration delay);
  void goOffline(std::uint16_t error_id);
  /// A complete status has come. Returns true if that brings the inverter back.
  bool statusComplete();

  // --- an offline inverter that answers -----------------------------------------------------------------------------
  /// A bare probe is on its way.
  void probeSent();
  /// Bare probes since the last answer.
  unsigned probes() const;
  /// What an exchange has cost, see Trial.
  void noteCost(bool probe, wire::Outcome outcome, Duration cost);
  /// A reply to a probe came late, \p delay after its request but no more than the response timeout: worth a trial, too.
  void beginTrial(Duration delay);
  /// The trial has led to nothing. Returns its price.
  Duration endTrial();
  bool onTrial() const;
  /// Offline, and it is not even known to answer.
  bool silent() const;

  // --- answers ------------------------------------------------------------------------------------------------------
  bool offline() const;
  /// A complete status has come since start or return.
  bool known() const;
  /// A complete status has come since the node was started.
  bool everKnown() const;
  /// The drive itself has sent data within its last `offline_after` exchanges (contract, 8.7).
  bool sendsData() const;
  /// Why it is offline, or how the last exchange failed; 0: it did not.
  std::uint16_t error() const;
  /// Exception by which a gateway said that the drive had not answered the last exchange; 0: it did not.
  std::uint8_t gatewayCode() const;
  /// Nothing: it has never answered.
  const std::optional<TimePoint>& lastAnswer() const;
  /// Longest turnaround seen while the drive answered.
  Duration slowestReply() const;
  /// Longest delay of a reply that was no longer waited for; 0: none came.
  Duration latestReply() const;
  /// How often it has come back.
  std::uint64_t returns() const;

private:
  int offline_after_;
  /// Counted up to offline_after_.
  int exchanges_without_data_;
  bool offline_ = false;
  bool known_ = false;
  bool ever_known_ = false;
  std::uint16_t error_ = 0;
  std::uint8_t gateway_code_ = 0;
  std::optional<TimePoint> last_answer_;
  Duration slowest_reply_{ 0 };
  Duration latest_reply_{ 0 };
  std::uint64_t returns_ = 0;
  Trial trial_;
};
}  // namespace bus
}  // namespace inverter_bus

#endif  // INVERTER_BUS_BUS_LINK_H
