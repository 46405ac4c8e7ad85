// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_FUZZ_CHECKER_H
#define INVERTER_BUS_FUZZ_CHECKER_H

#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "fuzz/bus/frames.h"
#include "fuzz/bus/scene.h"
#include "inverter_bus/bus/types.h"
#include "inverter_bus/simulation/simulated_bus.h"

namespace inverter_bus
{
namespace fuzz
{
/// A rule of the contract was broken.
class Violation : public std::runtime_error
{
public:
  Violation(TimePoint time, const std::string& rule, const std::string& text)
    : std::runtime_error(rule + ": " + text), time(time)
  {
  }
  TimePoint time;
};

/// What a motor does, and what its drive holds, at one instant.
struct Truth
{
  double hertz = 0.0;  ///< unsigned
  int direction = 0;
  std::optional<double> torque;  ///< [%] unsigned; not every simulated drive tells
};

struct Statistics
{
  std::uint64_t exchanges = 0;
  std::uint64_t commands = 0;
  std::uint64_t accepted = 0;
  std::uint64_t runs = 0;   ///< RUN frames
  std::uint64_t stops = 0;  ///< stops whose latency was checked
  std::uint64_t services = 0;
  std::uint64_t statuses = 0;
  std::uint64_t values = 0;  ///< published values compared with the motor
  Duration worst_stop{ 0 };
};

/// Watches one bus from the outside and holds every rule against it: frames on the line, answers to calls, published
/// statuses, the simulated motors. It keeps its own model of what is allowed, and never asks the driver.
class Checker
{
public:
  Checker(const Scene& scene, simulation::SimulatedBus& world);

  // --- the line -----------------------------------------------------------------------------------------------------
  void opened(TimePoint now);
  void lost(TimePoint now);
  /// The first byte of a request leaves now.
  void sending(TimePoint now, const simulation::Bytes& frame);
  /// Bytes have come out at the master's end.
  void heard(TimePoint now);
  /// The driver has done with the exchange that it began since the last call, if any; nothing is in flight now.
  void stepped(TimePoint now);
  void onFrame(TimePoint now, const simulation::FrameRecord& frame);

  // --- what users did, and what they were told ------------------------------------------------------------------------
  void commanded(TimePoint now, const bus::VelocityCommand& command, std::uint16_t result);
  void stopAsked(TimePoint now, std::optional<std::size_t> index);
  /// \p judge looks at the answer of a successful call.
  std::function<void(const bus::Answer&)> asked(TimePoint now, const std::string& what, double bound,
                                                std::function<void(const bus::Answer&)> judge);
  void published(TimePoint now, const bus::InverterStatus& status);
  /// A line of the log.
  void logged(TimePoint now, const std::string& line) const;
  void shutdownBegun(TimePoint now);
  /// \p unconfirmed what the node names, each beginning with the inverter.
  void shutdownEnded(TimePoint now, TimePoint begun, const std::vector<std::string>& unconfirmed) const;

  // --- what the world did ---------------------------------------------------------------------------------------------
  /// Something is about to happen to a drive, or has happened.
  void glance(TimePoint now);
  /// Noise, or frames of a second master.
  void disturbed(TimePoint now);
  void lostPower(TimePoint now, std::size_t index);

  void setBudgetWarns(std::function<bool(std::size_t)> warns);
  /// The time of the run, for services' answers.
  void setClock(std::function<TimePoint()> now);

  /// A flag of `show`: what the drive really holds.
  bool flag(std::size_t index, const std::string& key) const;
  /// The same as text; empty: it has no such key.
  std::string value(std::size_t index, const std::string& key) const;
  bool runLatched(std::size_t index) const;
  Truth truth(std::size_t index) const;
  bool online(std::size_t index) const;
  const bus::InverterStatus& status(std::size_t index) const;
  bool hasStatus(std::size_t index) const;
  /// Judges a stop that was answered with success.
  void stopConfirmed(std::size_t index, TimePoint asked_at) const;
  const Statistics& statistics() const;
  std::size_t openCalls() const;

private:
  struct Stream
  {
    TimePoint last;  ///< that broke a silence
    Duration spacing{ 0 };
    bool neutral = false;
    TimePoint zeroed_at;
    unsigned admitted = 0;  ///< the lock after which it was let in
    std::set<std::string> topics;
  };
  /// The last exchange in which a drive told its frequency.
  struct FrequencyRead
  {
    TimePoint end;
    double least = 0.0;
    double most = 0.0;
  };
  struct Sample
  {
    TimePoint time;
    double torque = 0.0;
  };
  struct Lane
  {
    // return to neutral
    std::map<std::string, Stream> streams;
    unsigned lock = 1;
    TimePoint locked_at;
    bool needs_status = true;
    bool needs_stop_reply = false;
    bool needs_no_fault = false;
    std::optional<TimePoint> open_at;

    // what may move
    bool permit = false;
    TimePoint permit_off_at;
    TimePoint accepted_at;
    double hertz = 0.0;  ///< signed, as the drive is to turn
    std::optional<TimePoint> fed;
    std::string commander;
    std::optional<TimePoint> refused_at;  ///< the first one that was refused since the last accepted command
    int run_copies = 0;
    int set_copies = 0;
    int run_set_copies = 0;  ///< in one frame with RUN
    bool run_sent = false;
    bool run_answered = false;
    bool run_reverse = false;
    bool settled = false;
    std::optional<double> set_answered;
    std::optional<double> held;  ///< the set-point that it has acknowledged last; a stop doesn't take it away [Hz]
    bool shown = false;          ///< the last exchange succeeded and showed RUN in force
    std::optional<TimePoint> power_lost;
    TimePoint cut_at;             ///< of the supply, the last time
    bool latched_at_cut = false;  ///< RUN, just before
    TimePoint imitated_at;        ///< another drive has answered under its station
    TimePoint reply_end;          ///< on the line, of its last reply

    // stops
    std::optional<TimePoint> due;
    bool due_counts = false;
    bool stopping = false;
    bool stop_under_way = false;  ///< at the last lock a stop had been sent already
    std::optional<TimePoint> zero_due;
    TimePoint stop_sent;
    /// Stops in a row since its last RUN, none of them long after the one before.
    unsigned stops_in_a_row = 0;
    TimePoint stop_replied;
    TimePoint run_read;
    TimePoint confirmed_at;  ///< RUN was read as it is after a stop was acknowledged

    // status
    unsigned statuses_tripped = 0;  ///< complete ones, with other stamps, since the drive has tripped
    unsigned failed_reads = 0;      ///< of its status, since the last complete one
    TimePoint asked_at;             ///< the last of these reads
    /// The longest time without one since the last complete status, and before that.
    Duration pause{ 0 };
    Duration pause_before{ 0 };
    TimePoint deaf_until;  ///< after a reset
    bool heard_of = false;
    bool online = false;
    TimePoint online_since;
    bus::InverterStatus status;
    std::deque<TimePoint> ends;
    std::deque<FrequencyRead> frequencies;
    std::deque<Sample> samples;
    /// Speeds since the exchange in flight began [Hz], and the sign of the last one.
    double least = 0.0;
    double most = 0.0;
    int sign = 0;

    /// Frames of velocities in a row that were not answered.
    int lost_frames = 0;

    // supervision
    std::optional<TimePoint> last_heard;
    bool timeout_known = false;
    std::set<unsigned> settings_read;
    bool first_time = true;
    std::uint64_t served = 0;  ///< number of the request that the drive has heard last
    simulation::Bytes heard;
    TimePoint lost_at;       ///< the last exchange without an answer
    TimePoint exception_at;  ///< the last one that was answered by a refusal
    unsigned silences = 0;   ///< exchanges in a row that it has not answered
  };
  struct Call
  {
    std::string what;
    TimePoint until;
  };

  [[noreturn]] void fail(TimePoint now, const std::string& rule, const std::string& text) const;
  std::string nameOf(std::size_t index) const;
  bool recent(TimePoint then, TimePoint now) const;

  // the line
  void checkGap(TimePoint now);
  void checkPatience(TimePoint now);
  void endExchange(TimePoint now);
  void noteImitation(TimePoint now, const simulation::FrameRecord& frame, std::size_t index);
  void takeReply(TimePoint now, const simulation::FrameRecord& frame, std::size_t index);
  ReplyKind readNoisyReply(const simulation::Bytes& request, const simulation::Bytes& reply, unsigned& refusal) const;
  void notePromptReply(TimePoint now, std::size_t index, ReplyKind kind, unsigned refusal);
  void noteHeard(TimePoint end, std::size_t index);
  void checkTurn(TimePoint now);
  void checkBounded(TimePoint now) const;
  bool waits(TimePoint now, std::size_t index) const;
  void checkBlindness(TimePoint now) const;
  void noteFailedRead();
  void checkWentOffline(TimePoint now, std::size_t index) const;
  void payProbe(TimePoint now, Duration cost);
  void checkBackground(TimePoint now);
  bool clearsLineForSetting(TimePoint now) const;
  bool unreadSettings(std::size_t index) const;
  std::set<unsigned> settingsOf(std::size_t index) const;

  // motion
  void watchDeadMen(TimePoint now);
  bool decidedBefore(TimePoint now, TimePoint time) const;
  void checkStopFirst(TimePoint now);
  void checkOverdue(TimePoint now);
  void checkMotion(TimePoint now);
  void checkRun(TimePoint now, Lane& lane);
  void checkSetPoint(TimePoint now, Lane& lane);
  void noteStopFrame(TimePoint now, std::size_t index);
  void lockUp(TimePoint now, Lane& lane, bool by_stop);
  void forbid(TimePoint now, Lane& lane);
  void tryOpen(TimePoint now, Lane& lane);
  Duration babble(TimePoint now) const;

  // users
  bool isRepeat(const Lane& lane, const bus::Publisher& publisher) const;
  void book(TimePoint now, Lane& lane, const bus::Publisher& publisher, bool zero);
  void accept(TimePoint now, std::size_t index, double velocity, const bus::Publisher& publisher);
  void takeZero(TimePoint now, std::size_t index, const bus::Publisher& publisher);
  void takeNearZero(TimePoint now, std::size_t index, const bus::Publisher& publisher);
  void takeRunOff(TimePoint now, Lane& lane, std::size_t index);
  bool isNearZero(std::size_t index, double velocity) const;
  bool isBeyond(std::size_t index, double velocity) const;
  double factorOf(const bus::VelocityCommand& command) const;
  void checkResult(TimePoint now, const bus::VelocityCommand& command, std::uint16_t result) const;

  // status
  void checkValues(TimePoint now, std::size_t index, const bus::InverterStatus& status);
  bool unlistedTrip(std::size_t index) const;
  void checkTrip(TimePoint now, std::size_t index, const bus::InverterStatus& status);
  void sample(TimePoint now, std::size_t index);
  void widen(std::size_t index);

  const Scene& scene_;
  simulation::SimulatedBus& world_;
  std::vector<Lane> lanes_;
  Statistics statistics_;
  std::map<std::uint64_t, Call> calls_;
  std::uint64_t next_call_ = 1;
  std::function<bool(std::size_t)> budget_warns_;
  std::function<TimePoint()> now_;

  bool shutting_down_ = false;
  bool connected_ = false;
  TimePoint connected_since_;
  // the exchange in flight, or the last one
  bool in_flight_ = false;
  std::uint64_t exchange_ = 0;
  /// Whose the last exchange was, if it was none of a stop, and when it began.
  std::optional<std::size_t> turn_of_;
  TimePoint turn_began_;
  bool answered_before_ = false;
  TimePoint sent_at_;
  TimePoint request_end_;
  simulation::Bytes request_;
  RequestFacts facts_;
  bool was_probe_ = false;
  bool answered_ = false;
  bool anything_heard_ = false;
  TimePoint last_heard_at_;
  /// Between two exchanges.
  TimePoint between_heard_at_;
  TimePoint disturbed_at_;
  std::deque<TimePoint> unanswered_;
  TimePoint last_due_served_;
  double probe_debt_ = 0.0;
  double probe_allowance_ = 0.0;
  TimePoint probe_paid_at_;
  unsigned without_background_ = 0;
};
}  // namespace fuzz
}  // namespace inverter_bus

#endif  // INVERTER_BUS_FUZZ_CHECKER_H
