// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_FUZZ_CHECKS_LOCKS_H
#define INVERTER_BUS_FUZZ_CHECKS_LOCKS_H

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "fuzz/bus/observed.h"
#include "fuzz/bus/recorder.h"

namespace inverter_bus
{
namespace fuzz
{
namespace checks
{
/// Rule 4.2, from the messages alone: a lock is not forgotten. After a start, a stop, a trip or an offline phase each
/// publisher must have sent 0, or have been silent, before its velocity is accepted.
class Locks
{
public:
  Locks(const Observed& observed, TimePoint start);

  /// All publishers must return to neutral; \p by_stop: once a stop is confirmed. \p stop_under_way: one had been sent
  /// before.
  void lock(TimePoint now, std::size_t index, bool by_stop, bool stop_under_way);
  /// The drive did something by itself at \p since, and the lock is that old.
  void backdate(std::size_t index, TimePoint since);
  /// A lock by a trip that was first seen after \p since: it must be gone before anything is accepted.
  void tripped(std::size_t index, TimePoint since);
  void wentOffline(std::size_t index);
  /// It is online; \p faulted: and tripped.
  void hasStatus(std::size_t index, bool faulted);
  void answered(TimePoint now, std::size_t index, const ReplyFacts& reply);
  /// Something has changed for which it may have waited.
  void tryOpen(TimePoint now, std::size_t index);

  /// What breaks a publisher's silence: 0 returns it to neutral.
  void booked(std::size_t index, const std::string& publisher, bool zero);
  /// A velocity was accepted: may it have been? Before the record knows of it.
  void check(TimePoint now, std::size_t index, const bus::Publisher& publisher);
  /// It was.
  void admitted(std::size_t index, const std::string& publisher);
  std::uint64_t checked() const;

private:
  struct Admission
  {
    bool neutral = false;
    unsigned lock = 0;  ///< after which it was let in
  };
  struct Lane
  {
    unsigned lock = 1;
    TimePoint locked_at;
    std::optional<TimePoint> open_at;
    bool needs_status = true;
    bool needs_stop_reply = false;
    bool needs_no_fault = false;
    bool stop_under_way = false;  ///< when it was locked
    TimePoint confirmed_at;       ///< RUN was read as it is after a stop was acknowledged
    std::map<std::string, Admission> admissions;
  };

  void noteRunRead(TimePoint now, std::size_t index, bool settled);
  void noteStop(TimePoint now, std::size_t index, TimePoint sent_at, bool prompt);
  void checkNeutral(TimePoint now, std::size_t index, const bus::Publisher& publisher) const;

  const Observed& observed_;
  std::vector<Lane> lanes_;
  std::uint64_t checked_ = 0;
};
}  // namespace checks
}  // namespace fuzz
}  // namespace inverter_bus

#endif  // INVERTER_BUS_FUZZ_CHECKS_LOCKS_H
