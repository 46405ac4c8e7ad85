// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_BUS_STOP_JOB_H
#define INVERTER_BUS_BUS_STOP_JOB_H

#include <cstdint>
#include <optional>
#include <string>

#include "inverter_bus/bus/types.h"

namespace inverter_bus
{
namespace bus
{
/// The mode of this number (srv/Stop.srv); empty: there is none.
std::optional<StopMode> stopModeOf(std::uint8_t number);

/// The stop of one inverter (contract, rules 3.1 to 3.3): write RUN off, read back that it is off, and keep trying until both
/// have happened. It knows no priority and no time-out; the scheduler decides when its next exchange goes.
class StopJob
{
public:
  StopJob(const drive::Drive& drive, std::uint8_t station);

  /// Asks for a stop. While one is pending, another only upgrades its mode; attempts go on counting.
  void request(TimePoint now, StopMode mode);
  /// The sequence that carries out \p mode on this drive: coast, quick or stop.
  std::string sequenceFor(StopMode mode) const;

  bool pending() const;
  /// It was asked for at \p time or later, and no frame of it has left yet.
  bool askedSince(TimePoint time) const;
  unsigned attempts() const;
  /// Written and acknowledged: the read-back is next.
  bool written() const;
  /// It is requested again and again: it was confirmed several times in a row, each time shortly before the next one.
  bool repeats() const;
  /// The inverter can't be reached, or RUN was sent: what was confirmed may no longer hold.
  void forgetConfirmation();
  /// It is to be reported that its tries cost others dearly: once while it is pending.
  bool takeCostly();
  /// When the last frame of any stop of this inverter left; the epoch: none has.
  TimePoint lastSentAt() const;

  /// The next frame of the stop.
  wire::Request next() const;
  /// Its first byte leaves; returns the latency from the request to it if this is the first frame of the stop.
  std::optional<Duration> sent(TimePoint now);

  enum class Progress
  {
    /// Another exchange is needed.
    GoesOn,
    /// This attempt failed; the next one starts with the write.
    Failed,
    Confirmed
  };
  /// \p may_be_late: the answer could also be the late one to an earlier request of the same shape (rule 3.9), from
  /// which a stop's writes are exempt. Then only a read-back of RUN confirms, or a write that no late reply can answer.
  Progress done(const wire::Reply& reply, bool may_be_late = false);
  /// The write that has just ended may be followed by an older request that sets RUN, in a gateway (contract, 8.8):
  /// whatever its answer, only another write confirms.
  void writeOnceMore();
  /// Such a write has ended, and the other one has not gone yet.
  bool provisional() const;
  /// Time from the request to the answer of its first frame, once; for ports where the first byte on the wire can't be
  /// observed.
  std::optional<Duration> answered(TimePoint now);
  /// The next write shall go only when no late reply of its shape can come any more; a loop-back ensures that.
  bool wantsClearLine() const;
  /// The read-back can't be asked now: the next attempt begins.
  void writeAgain();
  /// No newer velocity replaces the pending stop; without this, a stop by a command of 0 gives way to one.
  void hold();
  bool held() const;
  /// RUN was seen off by a status read that was sent after the write.
  void confirm();
  /// A newer command of the same user takes its place (a command of 0 that was superseded).
  void cancel();
  /// Error id of the last failed attempt.
  std::uint16_t lastError() const;

private:
  Progress confirmByAcknowledgement();
  Progress fail(std::uint16_t error_id);

  const drive::Drive& drive_;
  std::uint8_t station_;
  bool pending_ = false;
  bool held_ = false;
  StopMode mode_ = StopMode::Decelerate;
  unsigned attempts_ = 0;
  std::size_t step_ = 0;
  std::uint16_t last_error_ = 0;
  TimePoint requested_at_;
  TimePoint last_sent_at_;
  bool confirmed_ = false;
  unsigned repeats_ = 0;
  bool first_frame_left_ = false;
  bool first_frame_answered_ = false;
  bool provisional_ = false;
  bool told_costly_ = false;
  /// A write of this attempt may have been answered by a late reply to an earlier request.
  bool acknowledged_in_doubt_ = false;
  bool wants_clear_line_ = false;
  /// The read-back has worked before.
  bool has_told_ = false;
  /// Counts changes of what is to be done, and which one the frame on the wire belongs to.
  unsigned version_ = 0;
  unsigned version_on_wire_ = 0;
};
}  // namespace bus
}  // namespace inverter_bus

#endif  // INVERTER_BUS_BUS_STOP_JOB_H
