// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_BUS_GATEWAY_QUEUE_H
#define INVERTER_BUS_BUS_GATEWAY_QUEUE_H

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "inverter_bus/util/clock.h"

namespace inverter_bus
{
namespace bus
{
/// What a request would do if a gateway carried it out late.
enum class GatewayRisk
{
  /// A read, or a write that moves nothing.
  None,
  /// The refresh of a drive whose own time-out is near, which goes in spite of an older request.
  Refresh,
  /// A frame of a stop, or of a velocity of 0 or near it, which is one, too.
  Stop,
  /// May set RUN or raise the frequency.
  Motion
};

/// The requests that a Modbus TCP gateway may still be working on (contract, 8.8). It works on one after the other, and
/// behind a silent station each takes its own time-out: what is sent meanwhile waits in it, a stop too. So nothing but a
/// stop follows a request that was lost, before that one was answered late or `gateway_timeout` has passed.
///
/// Pure: time comes in as an argument. Bus thread only (the coordinator's).
class GatewayQueue
{
public:
  struct Settings
  {
    /// There is a gateway (tcp://); without one this keeps nothing and allows everything.
    bool active = false;
    /// Key `gateway_timeout`: after that a gateway has given up.
    Duration timeout{ 0 };
    /// The longest one of the bus.
    Duration response_timeout{ 0 };
  };

  explicit GatewayQueue(const Settings& settings);

  bool active() const;

  // --- what happened --------------------------------------------------------------------------------------------------
  /// A request has left for \p inverter; \p probe: it is paid from the probes' share of the time.
  void sent(TimePoint now, std::uint64_t ticket, std::size_t inverter, GatewayRisk risk, bool probe = false);
  /// It was answered in time, by the drive, or \p by_gateway for a station that is silent.
  void answered(TimePoint now, std::uint64_t ticket, bool by_gateway = false);
  /// This node's own time-out has passed.
  void lost(TimePoint now, std::uint64_t ticket);
  /// What is known of a request that was answered after all.
  struct Late
  {
    std::size_t inverter = 0;
    GatewayRisk risk = GatewayRisk::None;
    /// It was alone in the gateway, so that a longer `response_timeout` would have caught its answer.
    bool alone = false;
    bool probe = false;
  };
  /// The answer came after all; empty for a ticket that is no longer owed an answer.
  std::optional<Late> answeredLate(TimePoint now, std::uint64_t ticket);
  /// The connection has ended: no answer comes any more, but what was under way may still be carried out.
  void connectionEnded(TimePoint now);
  /// Time has passed: what was waited for long enough is not owed any more. Returns how long a probe that was given up
  /// since the last call has blocked the gateway, whatever has shown it; the longest one of several, which ran side by
  /// side.
  std::optional<Duration> tick(TimePoint now);

  // --- what may go ----------------------------------------------------------------------------------------------------
  /// Nothing is unanswered: anything may be sent.
  bool free(TimePoint now) const;
  /// When free() becomes true if no answer comes.
  TimePoint freeAt(TimePoint now) const;
  /// When the next frame of a stop of \p inverter may go: at most one is in the gateway.
  TimePoint stopMayGoAt(TimePoint now, std::size_t inverter) const;
  /// A refresh of \p inverter that went in spite of older requests is unanswered.
  bool refreshUnanswered(TimePoint now, std::size_t inverter) const;
  /// Until when a request that may set \p inverter running can still be carried out; nothing: there is none.
  std::optional<TimePoint> motionUntil(TimePoint now, std::size_t inverter) const;
  /// An older request than \p ticket was unanswered when that one was sent: its time-out says nothing.
  bool behindAnother(std::uint64_t ticket) const;

  // --- what it has learned --------------------------------------------------------------------------------------------
  /// How long the last request that no drive answered has blocked the gateway; 0: none has. One that the gateway itself
  /// answered in time, perhaps because it had asked in vain a moment ago, makes it shorter only after several such in a
  /// row.
  Duration block() const;
  /// How long nothing but stops may go because of one lost request, by what is known now: block(), or while one is waited
  /// for, the wait.
  Duration longestPause() const;
  /// It leaves requests unanswered for ever, as a server without a line behind it does.
  bool silentByNature() const;
  /// How long a lost request is waited for, counted from when it was sent.
  Duration wait() const;

private:
  struct Entry
  {
    std::uint64_t ticket = 0;
    std::size_t inverter = 0;
    GatewayRisk risk = GatewayRisk::None;
    bool probe = false;
    TimePoint sent_at;
    /// This node's time-out has passed without an answer.
    bool lost = false;
    bool behind_another = false;
    /// Of a connection that has ended.
    bool orphan = false;
  };
  TimePoint givenUpAt(const Entry& entry) const;
  bool owed(const Entry& entry, TimePoint now) const;
  std::vector<Entry>::iterator find(std::uint64_t ticket);
  void giveUp(TimePoint now);
  void noteInTime(Duration took);
  void noteBlock(Duration block);
  void noteCutShort(const Entry& entry, TimePoint now);
  void noteKept(const Entry& entry, Duration kept);
  void noteUnanswered(const Entry& entry);

  Settings settings_;
  std::vector<Entry> entries_;
  Duration block_{ 0 };
  /// The gateway's own answers in time since the last request that was not answered in time, or since so many of them.
  unsigned in_time_ = 0;
  Duration longest_in_time_{ 0 };
  Duration longest_reply_{ 0 };
  /// By probes that were given up since the last tick().
  std::optional<Duration> kept_;
  /// Lost requests in a row that were not answered within `gateway_timeout`.
  unsigned unanswered_ = 0;
};
}  // namespace bus
}  // namespace inverter_bus

#endif  // INVERTER_BUS_BUS_GATEWAY_QUEUE_H
