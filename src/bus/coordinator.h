// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_BUS_COORDINATOR_H
#define INVERTER_BUS_BUS_COORDINATOR_H

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bus/activities/jobs.h"
#include "bus/inverter/inverter.h"
#include "bus/link/adapter_watch.h"
#include "bus/link/connection_watch.h"
#include "bus/link/freeze_watch.h"
#include "bus/link/gateway_queue.h"
#include "bus/link/link_watch.h"
#include "bus/report/load_meter.h"
#include "bus/report/refusal_log.h"
#include "bus/rules/budget.h"
#include "bus/rules/scheduler.h"
#include "inverter_bus/bus/bus.h"

namespace inverter_bus
{
namespace bus
{
/// What the bus wants to tell the world after a step; delivered with no lock held.
struct Outputs
{
  std::vector<InverterStatus> statuses;
  std::vector<BusStatus> bus_statuses;
  std::vector<Finding> log;
  /// Reasons to write the flight recorder.
  std::vector<std::string> traces;
};

using PendingAnswers = std::vector<std::pair<AnswerCallback, Answer>>;

/// Joins scheduler, interlocks and inverters: requests come in, the next exchange goes out, its reply comes back. Time comes
/// in as an argument; there is no thread, no clock and no I/O in it, so that the whole behaviour of a bus can be run in
/// virtual time. Not thread safe: the bus guards it with one mutex.
class Coordinator
{
public:
  /// \p configuration and \p line must outlive the coordinator; of the line only questions without side effects are asked.
  Coordinator(const Configuration& configuration, const wire::Line& line);
  ~Coordinator();

  // --- requests of users --------------------------------------------------------------------------------------------
  std::uint16_t command(TimePoint now, const VelocityCommand& command);
  /// \p velocity takes the RUN of this inverter off: 0, or near it. Depends on the configuration alone; any thread.
  bool stops(std::size_t index, double velocity) const;
  /// A malformed command: shows in the status of \p indices and, for a group, in the bus status.
  void refuse(TimePoint now, const std::vector<std::size_t>& indices, std::uint16_t error_id, const std::string& text,
              bool group);
  void stop(TimePoint now, std::optional<std::size_t> index, std::uint8_t mode, AnswerCallback callback);
  void reset(TimePoint now, std::size_t index, AnswerCallback callback);
  void readFaults(TimePoint now, std::size_t index, AnswerCallback callback);
  void readParameter(TimePoint now, std::size_t index, const std::string& name, AnswerCallback callback);
  void writeParameter(TimePoint now, std::size_t index, const std::string& name, double value, bool persist,
                      AnswerCallback callback);

  // --- the bus loop -------------------------------------------------------------------------------------------------
  struct Exchange
  {
    wire::Request request;
    /// Silence to keep after a broadcast.
    Duration turnaround{ 0 };
  };
  /// The next exchange to make right now; nothing: ask again at \p wake or when something was requested.
  std::optional<Exchange> next(TimePoint now, TimePoint& wake);
  /// What time alone brings: dead men, bounds, slow publications. Also while the port is closed. True: an inverter has just
  /// gone offline, because its status has not come for too long.
  bool tick(TimePoint now);
  /// The first byte of that exchange is leaving now.
  void sent(TimePoint now);
  /// Its end.
  void done(const wire::Reply& reply);

  /// A reply that came after its time-out: its station is alive.
  void lateReply(TimePoint now, const wire::LateReply& late);
  /// What the line has counted so far; kept as a copy, since others ask for it while the line is in use.
  void noteLine(TimePoint now, const wire::LineCounters& counters, bool echo_found);

  /// What the open port tells of its adapter; nothing: its driver does not tell.
  void noteAdapter(const std::optional<wire::AdapterLatency>& latency);

  void portOpened(TimePoint now);
  /// \p in_use: another process holds it.
  void portMissing(TimePoint now, const std::string& error, bool in_use);
  /// It is being opened, which takes a while.
  void portPending(TimePoint now);
  void portLost(TimePoint now);
  /// settle() found it gone: closed by its other end, or lost.
  void portClosed(TimePoint now);
  /// The next connection is not to be tried before this time.
  TimePoint openNotBefore() const;
  /// A connection that its other end closed is being opened again at once; motors run on.
  bool resuming() const;
  /// The link is mute and is to be opened anew (renewing(), then abandon and open).
  bool renewalDue(TimePoint now);
  void renewing(TimePoint now);
  /// It is opened anew for any other reason of ours: motors run on.
  void reopening(TimePoint now);
  /// It leads to a telnet server, and everything that may be sent to one was: close it (closedForTelnet()).
  bool telnetOver(TimePoint now);
  void closedForTelnet(TimePoint now);

  void beginShutdown(TimePoint now);
  /// All motors confirmed, or the time is up.
  bool shutdownDone(TimePoint now);
  /// Answers whoever still waits with 0xB003; names what could not be confirmed.
  std::vector<std::string> endShutdown();

  // --- what it tells ------------------------------------------------------------------------------------------------
  Outputs takeOutputs();
  PendingAnswers takeAnswers();
  Report report(TimePoint now) const;
  ServiceBounds bounds() const;
  std::vector<Finding> budget() const;

private:
  enum class Purpose
  {
    StopFrame,
    Broadcast,
    Velocity,
    Job,
    Refresh,
    /// Any read that is allowed now, so that the drive's own time-out does not pass; its answer is not used.
    KeepAlive,
    Probe,
    Setting,
    Release
  };
  struct Current
  {
    Pick pick;
    Purpose purpose = Purpose::Refresh;
    std::size_t inverter = 0;
    wire::Request request;
    /// A loop-back that makes sure that no late reply is on its way; the real request follows.
    bool resync = false;
    /// The request is a loop-back, as a probe or for resync.
    bool loopback = false;
    /// A stop's write that a late reply to an earlier request could answer.
    bool may_be_late = false;
    /// A velocity's frame that may set RUN or raise the frequency.
    bool moves = false;
    Write write;
    CommandId job = 0;
  };
  struct RunningJob
  {
    std::unique_ptr<Job> job;
    std::size_t inverter;
    TimePoint expires;
    /// One, or the callers of a reset that was asked for again while it was under way.
    std::vector<AnswerCallback> callbacks;
    int tries = 0;
  };
  struct StopCall
  {
    std::vector<std::size_t> waiting;
    std::vector<std::string> problems;
    std::uint16_t error_id = 0;
    std::string note;
    TimePoint expires;
    AnswerCallback callback;
  };

  // velocity
  std::uint16_t judgeGroup(TimePoint now, const VelocityCommand& command, std::vector<JudgedVelocity>& judged,
                           bool& repeat);
  double factorOf(const VelocityCommand& command) const;
  std::uint16_t judgeOne(TimePoint now, std::size_t index, const Publisher& publisher, JudgedVelocity& judged) const;
  void applyVelocities(TimePoint now, const VelocityCommand& command, const std::vector<JudgedVelocity>& judged,
                       bool refused);
  bool applyZero(TimePoint now, Inverter& inverter, const Publisher& publisher, const Target& target);
  bool applyMove(TimePoint now, Inverter& inverter, const Publisher& publisher, const Target& target);

  void noteGroupError(TimePoint now, std::uint16_t error_id);
  void clearGroupError(TimePoint now, bool by_group);
  void tellRefusal(TimePoint now, const VelocityCommand& command, const std::vector<JudgedVelocity>& judged,
                   std::uint16_t error_id);

  // stops
  void requestStop(TimePoint now, Inverter& inverter, StopMode mode, bool lock, const std::string& reason);
  void stopConfirmed(TimePoint now, Inverter& inverter);
  void finishStopCalls(TimePoint now);
  bool broadcastIsSafe() const;
  std::string stopProblem(const Inverter& inverter) const;
  std::string refusalText(const Inverter& inverter, std::uint16_t error_id) const;
  void refuseParameter(const Inverter& inverter, const std::string& name, const AnswerCallback& callback);
  bool refuseWrongDrive(const Inverter& inverter, const AnswerCallback& callback);

  // jobs
  std::uint16_t judgeWrite(const Inverter& inverter, const std::string& name, double value, bool persist,
                           std::string& why, std::uint32_t& raw) const;
  void startJob(TimePoint now, std::size_t index, std::unique_ptr<Job> job, double bound, AnswerCallback callback);
  bool refuseJob(std::size_t index, const AnswerCallback& callback);
  bool joinReset(std::size_t index, const AnswerCallback& callback);
  void queueJob(CommandId id, TimePoint not_before);
  void advanceJob(TimePoint now, CommandId id, Job::Progress progress);
  void endJob(CommandId id, const Answer& answer);
  void failJobs(std::size_t index, std::uint16_t error_id, const std::string& message);
  void answer(const AnswerCallback& callback, const Answer& answer);
  void refuseCall(const AnswerCallback& callback, std::uint16_t error_id, const std::string& message);

  // the way to the drives
  GatewayRisk riskOf(const Current& current) const;
  void noteGateway(const Current& current, const wire::Reply& reply);
  void noteConnection(TimePoint now, const Current& current, const wire::Reply& reply);
  void noteLink(const wire::Reply& reply);
  void othersFirst(TimePoint free_at, Inverter& inverter);
  Gate gate(TimePoint now);
  const Inverter* endangered() const;
  void tellOfCostlyStop(Inverter& inverter);
  void tellOfTheGateway();
  Duration probePrice(const Current& current, const wire::Reply& reply) const;
  TimePoint stopNotBefore(TimePoint now, const Inverter& inverter) const;
  void stopInsteadOfZeros(TimePoint now);
  bool zeroNeedsStop(TimePoint now, const Inverter& inverter) const;
  Duration worstStop() const;
  Duration gatewayBlock() const;
  std::string returnText() const;
  std::optional<Finding> gatewayFinding() const;
  std::optional<Finding> quirkFinding() const;
  std::vector<std::size_t> onlineInverters() const;
  bool resumes(TimePoint now, std::optional<std::size_t> index);
  void loseEverybody(TimePoint now, std::uint16_t error_id);
  std::optional<Pick> pickCheck(TimePoint now, Gate& gate);
  void portFails(TimePoint now, const std::string& error);
  Pick pick(TimePoint now);
  bool untested(const Inverter& inverter) const;
  bool mustWait(TimePoint now, const Current& current);
  Pick pickOverTelnet(TimePoint now) const;
  bool triedOverTelnet(const Inverter& inverter) const;

  // loop
  void noteRunning(TimePoint now);
  Duration longestExchange() const;
  TimePoint countedFrom(const wire::Reply& reply) const;
  void watchDeadMen(TimePoint now);
  bool watchStatuses(TimePoint now);
  Duration refreshPeriod(const Inverter& inverter) const;
  void expireJobs(TimePoint now);
  void publishSlowly(TimePoint now);
  std::vector<InverterView> views(TimePoint now) const;
  std::optional<Current> composeBroadcast(TimePoint now);
  bool releaseDue(const Inverter& inverter) const;
  TimePoint nextStop(TimePoint now) const;
  void noteStopLatency(Duration latency);
  Duration longestReplyDelay() const;
  Pick pickShutdown(TimePoint now);
  std::optional<Current> compose(TimePoint now, const Pick& pick);
  Current composeRefresh(TimePoint now, const Pick& pick);
  std::optional<wire::Request> keepAlive(const Inverter& inverter) const;
  std::optional<Write> nextWrite(TimePoint now, const Inverter& inverter) const;
  std::optional<Current> composeVelocity(TimePoint now, const Pick& pick);
  std::optional<Current> composeJob(TimePoint now, const Pick& pick);
  Current composeProbe(const Pick& pick);
  bool makeSafe(TimePoint now, Current& current);
  bool readBackSafely(Inverter& inverter, Current& current) const;
  Duration probeTimeout(const Inverter& inverter) const;
  TimePoint earliestDeadMan(TimePoint wake) const;

  void ended(const Current& current, const wire::Reply& reply);
  void finishExchange(const Current& current, const wire::Reply& reply, bool more);
  void doneStop(const Current& current, const wire::Reply& reply);
  void noteLostStop(TimePoint now, Inverter& inverter, bool write, std::uint16_t error_id);
  void doneKeepAlive(const Current& current, const wire::Reply& reply);
  void doneVelocity(const Current& current, const wire::Reply& reply);
  void failVelocity(const Current& current, const wire::Reply& reply, bool too_many_lost);
  void writesLost(TimePoint now, Inverter& inverter);
  void countWear(const Current& current);
  void noteBlockRefusal(const Current& current, const wire::Reply& reply);
  void configureBlock(TimePoint now, Inverter& inverter);
  void doneStep(TimePoint now, const Current& current);
  void noteJobEnd(Inverter& inverter, const Job& job, const Answer& result);
  void finishVelocity(const Current& current, const wire::Reply& reply);
  void doneJob(const Current& current, const wire::Reply& reply);
  void doneRefresh(const Current& current, const wire::Reply& reply);
  void refusedStatus(const wire::Reply& reply, Inverter& inverter);
  void doneSetting(const Current& current, const wire::Reply& reply);
  bool repeat(int& tries, const wire::Reply& reply) const;
  void portWorks();
  void noteLost(TimePoint now, Inverter& inverter, std::uint16_t error_id);
  void noteLostWrite(TimePoint now, Inverter& inverter, std::uint16_t error_id);
  void noteRefusal(TimePoint now, Inverter& inverter, std::uint16_t error_id);
  void failTrial(TimePoint now, Inverter& inverter, std::uint16_t error_id);
  void wentOffline(TimePoint now, Inverter& inverter);
  void judgeRefresh(TimePoint now, Inverter& inverter);
  void actOn(TimePoint now, Inverter& inverter, const Judgement& judgement);
  void publish(TimePoint now, const Inverter& inverter);
  BusStatus busStatus(TimePoint now) const;
  /// Subject of the lines that tell the state of the port; no inverter's name has a space.
  static constexpr const char* PORT = "the port";
  /// \p subject see Finding.
  void log(Level level, const std::string& text, const std::string& subject = "");

  const Configuration& configuration_;
  const wire::Line& line_;
  /// Of the configuration alone: it does not change while the bus runs.
  const Budget::Figures budget_;
  std::vector<std::unique_ptr<Inverter>> inverters_;
  std::unique_ptr<Scheduler> scheduler_;
  LoadMeter meter_;
  GatewayQueue gateway_;
  ConnectionWatch connection_;
  LinkWatch link_;
  FreezeWatch freeze_;
  /// The exchange that has just ended was not answered, and says nothing: an older request was unanswered.
  bool behind_another_ = false;
  /// To whom the last request went, if it was not answered.
  std::optional<std::size_t> last_unanswered_;
  /// The link is being opened anew because it was mute.
  bool renewing_ = false;
  /// The connection leads to a telnet server, and everybody was given up because of it.
  bool telnet_ = false;
  bool told_of_gateway_ = false;
  /// Attempts at each pending stop when the connection was opened.
  std::vector<unsigned> attempts_at_open_;
  std::size_t resumed_ = 0;
  std::optional<TimePoint> resumed_logged_at_;

  std::optional<Current> current_;
  std::map<CommandId, RunningJob> jobs_;
  std::vector<StopCall> stop_calls_;
  CommandId next_command_ = 1;
  std::uint16_t loopback_number_ = 0;

  bool connected_ = false;
  TimePoint opened_at_;
  /// Since it was opened.
  bool port_works_ = false;
  /// It can be opened, and then fails before anything was read from it.
  bool port_failing_ = false;
  bool port_complained_ = false;
  std::string port_error_;
  AdapterWatch adapter_;
  std::uint64_t reconnects_ = 0;
  bool ever_opened_ = false;
  Duration stop_latency_max_{ 0 };
  std::uint16_t last_error_ = 0;
  std::uint16_t group_error_ = 0;
  TimePoint group_error_at_;
  RefusalLog refusals_;
  std::uint8_t last_node_ = 0;
  wire::LineCounters counters_;
  bool echo_found_ = false;
  TimePoint foreign_at_;

  TimePoint last_bus_status_;
  std::uint64_t published_cycle_ = 0;
  bool published_connected_ = false;
  std::vector<TimePoint> last_published_;

  bool shutting_down_ = false;
  /// Nobody asks for the next exchange any more.
  bool ended_ = false;
  TimePoint shutdown_deadline_;
  std::vector<bool> shutdown_tried_;
  std::vector<bool> released_;
  bool broadcast_due_ = false;
  /// The last exchange was one.
  bool broadcast_last_ = false;
  /// The last one went into a gateway that was kept busy.
  bool broadcast_waits_ = false;
  TimePoint broadcast_requested_;

  Outputs outputs_;
  PendingAnswers answers_;
};
}  // namespace bus
}  // namespace inverter_bus

#endif  // INVERTER_BUS_BUS_COORDINATOR_H
