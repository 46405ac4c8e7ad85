// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_FUZZ_RECORDER_H
#define INVERTER_BUS_FUZZ_RECORDER_H

#include <cstdint>
#include <vector>

#include "fuzz/bus/observed.h"
#include "fuzz/bus/plant.h"
#include "inverter_bus/simulation/simulated_line.h"

namespace inverter_bus
{
namespace fuzz
{
/// What a drive's bytes are to the requests that it was sent.
struct ReplyFacts
{
  enum class Kind
  {
    Nothing,   ///< damaged, too late, or not asked for
    Answer,    ///< to the exchange in flight
    LateStop,  ///< to a stop that is no longer waited for
  };
  Kind kind = Kind::Nothing;
  bool good = false;  ///< an Answer that is no refusal
  unsigned refusal = 0;

  /// After a read of RUN nothing more can be learned of it. Refusals 1 to 3: the drive has no such read, and the
  /// acknowledged write must suffice.
  bool settlesRun() const
  {
    return good || refusal <= 3;
  }
};

/// Keeps the record. The one place that changes it; it judges nothing.
class Recorder
{
public:
  Recorder(const Scene& scene, const Plant& plant);
  const Observed& observed() const;

  // --- the line -----------------------------------------------------------------------------------------------------
  void opened(TimePoint now);
  void lost(TimePoint now);
  void disturbed(TimePoint now);
  void heard(TimePoint now);
  /// A request is about to go.
  void begins(TimePoint now, const simulation::Bytes& request);
  /// It goes: what it asks of the drive counts as sent.
  void sent(TimePoint now);
  void ended(TimePoint now);
  /// A request has reached its drive; \p ours: it is the one in flight, and no second master's.
  void reached(TimePoint now, std::size_t index, const simulation::Bytes& request, bool ours);
  /// Looks at what a drive has sent.
  ReplyFacts replied(TimePoint now, const simulation::FrameRecord& frame, std::size_t index);
  /// It was an answer, or a stop's late one.
  void answered(TimePoint now, std::size_t index, const ReplyFacts& reply);

  // --- users --------------------------------------------------------------------------------------------------------
  /// A publisher has sent something that breaks its silence.
  void booked(TimePoint now, std::size_t index, const bus::Publisher& publisher, bool zero);
  /// Near zero is silence, but the publisher was heard on this topic.
  void bookedNearZero(std::size_t index, const bus::Publisher& publisher);
  void accepted(TimePoint now, std::size_t index, double hertz, const std::string& publisher);
  /// The order is void.
  void forbidden(TimePoint now, std::size_t index);
  /// Its command watchdog has run out.
  void starved(std::size_t index);
  void stopRequested(std::size_t index);
  void shutdownBegun();

  // --- the drives, and what is published of them ---------------------------------------------------------------------
  void lostPower(TimePoint now, std::size_t index);
  void wentOffline(std::size_t index);
  void isOnline(const bus::InverterStatus& status);
  void published(const bus::InverterStatus& status);

private:
  /// What only the reading of replies needs.
  struct Station
  {
    std::uint64_t exchange = 0;  ///< in which the drive heard its last request; 0: none of the node's
    simulation::Bytes request;
    TimePoint reply_began;
    bool latched_at_cut = false;  ///< RUN, just before its supply went
  };

  ReplyKind readNoisyReply(const simulation::Bytes& request, const simulation::Bytes& reply, unsigned& refusal) const;
  void noteWords(std::size_t index, bool good);
  bool givenUpEarly(TimePoint now) const;

  const Scene& scene_;
  const Plant& plant_;
  Observed observed_;
  std::vector<Station> stations_;
};
}  // namespace fuzz
}  // namespace inverter_bus

#endif  // INVERTER_BUS_FUZZ_RECORDER_H
