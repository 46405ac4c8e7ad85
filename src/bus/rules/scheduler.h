// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_BUS_SCHEDULER_H
#define INVERTER_BUS_BUS_SCHEDULER_H

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "bus/rules/probe_account.h"

namespace inverter_bus
{
namespace bus
{
/// Kinds of commands in the order in which those of one exchange go (INV003: one kind after the other).
enum class CommandKind
{
  Velocity,
  Reset,
  ReadFaults,
  ReadParameter,
  WriteParameter
};

using CommandId = std::uint64_t;

/// Contract, rule 3.3: a stop is tried so often at once, then as every second exchange at most.
constexpr unsigned STOP_ATTEMPTS_AT_ONCE = 3;

/// A command that waits for its next exchange.
struct WaitingCommand
{
  CommandId id = 0;
  CommandKind kind = CommandKind::Velocity;
  /// Inverters in node order; several for a grouped velocity.
  std::vector<std::size_t> inverters;
  /// Contains a velocity of 0: goes before every other command, since somebody wants something to stop.
  bool urgent = false;
  /// Not before this time (a pause between two frames of one command).
  TimePoint not_before;
};

/// What the scheduler must know of an inverter for one decision. The order of inverters is node order.
struct InverterView
{
  bool offline = false;
  /// Neither running nor commanded (idle_divisor).
  bool at_rest = false;
  /// Its commands other than velocities wait until the stop is confirmed (rule 3.2).
  bool stop_pending = false;
  /// Complete attempts at the pending stop that failed.
  unsigned stop_attempts = 0;
  /// The stop is written and only its read-back is due.
  bool stop_written = false;
  /// One of a flood of stops of an inverter whose RUN is off already.
  bool stop_repeats = false;
  /// No exchange before this time (the reply of an earlier one could be taken for its answer).
  TimePoint refresh_not_before;
  /// Latest start of the next exchange if the drive's own communication time-out shall not strike.
  std::optional<TimePoint> serve_by;
  /// Something is to be settled before its status: it goes in the refresh's turn.
  bool connect_due = false;
  /// Single exchanges of long jobs wait (settings to be read).
  bool background = false;
  /// No frame of its stop before this time: one is in the gateway.
  TimePoint stop_not_before;
  /// Its refresh that went in spite of a busy gateway is not answered yet.
  bool refresh_unanswered = false;
};

/// What the way to the drives allows at the moment.
struct Gate
{
  /// Only stops, and the refresh that a drive's own time-out needs: a gateway still works on a lost request.
  bool stops_only = false;
  /// When that ends.
  TimePoint until;
  /// Somebody else waits for an exchange meanwhile: a stop that insists lets it through.
  bool others_wait = false;
  /// Offline inverters without a pending stop may be probed.
  bool bare_probes = true;
};

/// The next exchange, and what it is for: decides which activity composes it, hears of its end, and how it is booked.
struct Pick
{
  enum class What
  {
    /// Nothing to send before \ref wake.
    Nothing,
    /// The stop of an inverter (its write, its read-back, or as the probe of an offline one).
    Stop,
    /// The stop of all in one frame. Not the scheduler's choice: it goes before whatever that would choose.
    Broadcast,
    /// A frame of the velocity \ref command.
    Velocity,
    /// A frame of the service \ref command.
    Service,
    Refresh,
    /// What is settled before the first status, in the turn of a refresh.
    Connect,
    /// Any read that is allowed now, in the turn of a refresh, so that the drive's own time-out does not pass; its answer is
    /// not used. Not the scheduler's choice: what stands in the way of the refresh shows when it is composed.
    KeepAlive,
    /// Is an offline inverter back?
    Probe,
    /// A read of the drive's settings, in the lowest class.
    Setting,
    /// The frame that leaves the drive to its panel. Not the scheduler's choice: the end of the program has its own order.
    Release
  };
  What what = What::Nothing;
  /// Whom the exchange is for (a broadcast: nobody in particular); of a grouped velocity the member whose turn it is. Who
  /// books another one in done() has found that this one needed no frame.
  std::size_t inverter = 0;
  CommandId command = 0;
  /// Paid from the probes' share of the bus time.
  bool probe = false;
  /// How much of its cost the next probe waits for; what it takes beyond that is a long wait (ProbeAccount).
  Duration in_turn = Duration::max();
  /// Goes before its turn, because the drive's own time-out is near.
  bool deadline = false;
  TimePoint wake;

  /// Takes the inverter's turn in the status cycle.
  bool inTurnOfRefresh() const
  {
    return what == What::Refresh || what == What::Connect || what == What::KeepAlive;
  }
  /// A frame of something that users asked for, and that was pushed.
  bool isCommand() const
  {
    return what == What::Velocity || what == What::Service;
  }
};

/// Who goes next on the bus (contract, section 3). Pure: time comes in as an argument, a decision goes out; no clock, no
/// thread, no I/O. Equal claims are decided by node order, so a run can be repeated exactly.
///
/// Order: stops; urgent commands (a 0); the rest of velocity units under way; drives whose own time-out is near; the
/// long jobs' eighth exchange; commands alternating with refreshes; probes within their share; refreshes; long jobs.
///
/// But for stops nobody goes on while another inverter waits (contract, 8.1): after a frame of a velocity, or a read that
/// a deadline began, another inverter's command or deadline comes first, so that the members of a group take turns frame
/// by frame; after an exchange that was lost everybody else comes first, with a refresh, too.
class Scheduler
{
public:
  struct Settings
  {
    std::size_t inverters = 0;
    /// Pause after each status cycle.
    Duration interval{ 0 };
    /// Inverters at rest take part in every n-th cycle only.
    unsigned idle_divisor = 1;
    /// Share of the bus time that probes of offline inverters may take.
    double probe_share = PROBE_SHARE;
  };

  explicit Scheduler(const Settings& settings);

  // --- commands -----------------------------------------------------------------------------------------------------
  /// Queues a command's next frame. Those queued before the same next() start together.
  /// A velocity for an inverter that has one waiting takes that one's place (the group takes the earliest place).
  void push(const WaitingCommand& command);
  /// Takes a command out, or one inverter out of a grouped velocity.
  void erase(CommandId id);
  void eraseVelocity(std::size_t inverter);
  /// The velocity that waits for an inverter has become a 0, or is none any more.
  void makeUrgent(std::size_t inverter, bool urgent);
  void postpone(CommandId id, TimePoint not_before);
  /// One member of a grouped velocity that has to wait or to be repeated goes its own way as \p own, in the group's place
  /// and not before \p not_before; the others go on without it. A velocity of one inverter is only postponed. \p urgent: it
  /// is a 0.
  void splitOff(CommandId group, std::size_t inverter, CommandId own, TimePoint not_before, bool urgent);
  bool velocityWaits(std::size_t inverter) const;
  /// Inverters that a waiting velocity still has to serve, in node order; empty: no such command.
  std::vector<std::size_t> members(CommandId id) const;

  /// The next read of this inverter's refresh goes before everything but stops, once.
  void readSoon(std::size_t inverter);
  /// This inverter takes its turn in the cycle next, with all that its refresh needs; the cycle goes on behind it.
  void turnSoon(std::size_t inverter);

  // --- decisions ----------------------------------------------------------------------------------------------------
  /// The next exchange, or when to ask again.
  Pick next(TimePoint now, const std::vector<InverterView>& views, const Gate& gate = Gate());

  /// Books the end of the exchange that was picked.
  /// \param more In the turn of a refresh: the inverter's refresh needs another exchange. Velocity: its unit goes on.
  /// \param answered a reply came (a probe that is answered costs nothing of the probes' share).
  void done(const Pick& pick, TimePoint start, TimePoint end, bool more, bool answered);

  /// What probes have cost: done() charges it, and whoever learns only later that one has cost more.
  ProbeAccount& probeAccount();

  // --- cycle --------------------------------------------------------------------------------------------------------
  /// Complete status cycles so far.
  std::uint64_t cycles() const;
  /// Duration of the last one, without the interval's pause.
  Duration cycleTime() const;
  /// The interval's pause had to be cut short for a drive's own time-out.
  bool pauseWasCut() const;
  /// Exchanges so far.
  std::uint64_t exchanges() const;
  /// The whole bus starts afresh (port opened again). \p probes_at_once: what probes have cost before doesn't count.
  void restartCycle(TimePoint now, bool probes_at_once = true);

private:
  struct Ticket
  {
    WaitingCommand command;
    std::uint64_t epoch;
    std::uint64_t sequence;
    /// A velocity of which a frame has gone: a unit under way.
    bool begun = false;
    unsigned frames = 0;
    /// The member that had the last frame.
    std::optional<std::size_t> served;
  };
  std::optional<Pick> pickStop(TimePoint now, const std::vector<InverterView>& views, bool nothing_else) const;
  std::optional<Pick> pickDeadline(TimePoint now, const std::vector<InverterView>& views);
  std::optional<Pick> pickCommand(TimePoint now, bool urgent_only) const;
  std::optional<Pick> pickProbe(TimePoint now, const std::vector<InverterView>& views) const;
  bool mayProbe(TimePoint now, const InverterView& view, std::size_t index) const;
  std::optional<Pick> pickRefresh(TimePoint now, const std::vector<InverterView>& views);
  std::optional<Pick> pickPutOff(TimePoint now, const std::vector<InverterView>& views) const;
  std::optional<Pick> pickOfCycle(TimePoint now, const std::vector<InverterView>& views);
  std::optional<Pick> pickBackground(const std::vector<InverterView>& views) const;
  Pick nothing(TimePoint now, const std::vector<InverterView>& views) const;
  bool takesPart(const InverterView& view) const;
  std::optional<std::size_t> nextOfCycle(TimePoint now, const std::vector<InverterView>& views);
  bool isPutOff(std::size_t inverter) const;
  void closeCycle(TimePoint now);
  Pick choose(TimePoint now, const std::vector<InverterView>& views);
  Pick chooseBehindGateway(TimePoint now, const std::vector<InverterView>& views, const Gate& gate);
  std::optional<Pick> chooseBehindStops(TimePoint now, const std::vector<InverterView>& views);
  std::optional<Pick> chooseGoingOn(TimePoint now, const std::vector<InverterView>& views);
  bool commandsGiveWay(TimePoint now, const std::vector<InverterView>& views) const;
  std::optional<Pick> chooseInTurn(TimePoint now, const std::vector<InverterView>& views);
  std::optional<Pick> pickReadSoon(TimePoint now, const std::vector<InverterView>& views) const;
  std::optional<Pick> chooseForAnother(TimePoint now, const std::vector<InverterView>& views);
  std::optional<Pick> goOnWithUnit(TimePoint now, const std::vector<InverterView>& views);
  std::optional<Pick> goOnWithRefresh(TimePoint now, const std::vector<InverterView>& views);
  bool deadlinesMayGo(const std::vector<InverterView>& views) const;
  std::optional<Pick> backgroundInTurn(TimePoint now, const std::vector<InverterView>& views);
  bool backgroundIsDue(TimePoint now, const std::vector<InverterView>& views) const;
  void doneCommand(const Pick& pick, bool more);
  void doneRefresh(const Pick& pick, bool more, bool answered);
  void noteHalfRefresh(const Pick& pick, bool more);
  void forgetOffline(const std::vector<InverterView>& views);
  void bookStop(const Pick& pick, const std::vector<InverterView>& views);
  std::size_t readyCommands(TimePoint now) const;
  bool ready(const Ticket& ticket, TimePoint now) const;
  std::size_t nextMember(const Ticket& ticket) const;
  bool startsTogether(const Ticket& ticket, TimePoint now) const;
  int rank(const Ticket& ticket, TimePoint now, bool one_goes_on) const;
  const Ticket* firstReady(TimePoint now, bool urgent_only) const;
  std::deque<Ticket>::iterator find(CommandId id);

  Settings settings_;
  std::deque<Ticket> tickets_;
  std::uint64_t sequence_ = 0;
  std::uint64_t epoch_ = 0;
  std::uint64_t exchanges_ = 0;

  // stops
  std::vector<bool> stop_pending_;
  std::vector<std::uint64_t> last_stop_exchange_;
  /// The exchange in which its refresh was not answered last; 0: it has answered since.
  std::vector<std::uint64_t> silent_at_deadline_;
  std::uint64_t last_insisting_exchange_ = 0;
  /// After a stop that was not answered: as long as it took.
  TimePoint patient_until_;
  /// Frames of stops since the last exchange that took nothing from a stop.
  unsigned stops_in_a_row_ = 0;
  /// The last exchange went although a stop waited.
  bool let_through_ = false;

  // who had the last exchange
  /// Nobody after a stop: stops are free of the rule.
  std::optional<std::size_t> last_inverter_;
  bool last_lost_ = false;
  CommandId last_command_ = 0;
  /// Not to be chosen in the decision at hand, if there is anybody else.
  std::optional<std::size_t> avoided_;

  // commands and refreshes
  unsigned commands_in_a_row_ = 0;
  /// Since the last refresh that no deadline had begun.
  unsigned commands_since_turn_ = 0;
  unsigned exchanges_without_background_ = 0;
  unsigned deadlines_in_a_row_ = 0;
  /// Refreshes that a deadline began and that need another read.
  std::deque<std::size_t> half_refreshed_;
  /// Those whose turn in the cycle came just after an exchange of theirs was lost: they take it after somebody else. And
  /// those for whom the whole cycle would be too long to wait.
  std::deque<std::size_t> put_off_;
  std::deque<std::size_t> read_soon_;
  /// One of them had its turn last: the cycle goes on before the next one has.
  bool cycle_first_ = false;

  // probes
  std::size_t probe_cursor_ = 0;
  ProbeAccount probe_account_;
  /// Of the gate at hand.
  bool bare_probes_ = true;

  // cycle
  std::size_t cursor_ = 0;
  bool cycle_open_ = false;
  bool refreshed_in_cycle_ = false;
  TimePoint cycle_start_;
  TimePoint pause_until_;
  bool pause_cut_ = false;
  Duration cycle_time_{ 0 };
  std::uint64_t cycles_ = 0;
  std::uint64_t rounds_ = 0;
  std::size_t background_cursor_ = 0;
};
}  // namespace bus
}  // namespace inverter_bus

#endif  // INVERTER_BUS_BUS_SCHEDULER_H
