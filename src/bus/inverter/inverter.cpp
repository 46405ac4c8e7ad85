// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "bus/inverter/inverter.h"

#include <algorithm>
#include <cmath>

#include "bus/link/own_exceptions.h"
#include "util/text.h"

namespace inverter_bus
{
namespace bus
{
namespace
{
// Share of the drive's own time-out after which it is served whatever else waits.
constexpr double TIMEOUT_SHARE = 0.8;
// At reversal a drive may show "stopped" for a moment: only a longer one means that it lost its RUN.
constexpr double OPERATION_LOST_S = 0.5;
// Below this a drive may legitimately stand still with RUN on (start frequency).
constexpr double LOWEST_JUDGED_HZ = 1.0;
constexpr double MOVEMENT_PATIENCE_S = 3.0;
constexpr double DEVIATION_PATIENCE_S = 2.0;
// A drive that was switched off and on is deaf for a second: within half of that it can't have lost our RUN unseen.
constexpr double RUN_EVIDENCE_S = 0.5;
// Loop-backs that may be left unanswered; contract, 8.8, for those over TCP.
constexpr unsigned MOST_MISSED_LOOPBACKS = 3;
constexpr unsigned MOST_MISSED_LOOPBACKS_TCP = 1;
// A drive that has answered so lately is there.
constexpr double LATELY_S = 2.0;
constexpr double CONNECT_PAUSE_S = 0.5;
constexpr double COMMAND_SOURCE_PERIOD_S = 5.0;
// 5 % of 2.7 s: an offline inverter is to be found again within 3 s (contract, rule 3.7).
constexpr double MOST_PAID_FOR_DATA_S = 0.135;

/// The drive's own no, not silence or damage.
bool isRefusal(std::uint16_t error_id)
{
  return error_id != 0 && error_id != wire::ERROR_TIMEOUT && error_id != wire::ERROR_DAMAGED &&
         error_id != wire::ERROR_PORT_LOST;
}

bool lasts(std::optional<TimePoint>& since, bool condition, TimePoint now, double patience)
{
  if (!condition)
  {
    since.reset();
    return false;
  }
  if (!since)
  {
    since = now;
  }
  return now - *since >= seconds(patience);
}
}  // namespace

Inverter::Inverter(std::size_t index, const InverterConfig& config, const drive::Drive& drive, int offline_after,
                   int retries)
  : index(index)
  , config(config)
  , drive(drive)
  , interlock(config.command_timeout)
  , movement(drive, config)
  , stop(drive, config.node)
  , refresh(drive, config.node)
  , settings(drive, config.node)
  , loopback(config.modbus_tcp ? MOST_MISSED_LOOPBACKS_TCP : MOST_MISSED_LOOPBACKS)
  , lost_writes(retries, offline_after)
  , liveness(offline_after)
  , offline_after_(offline_after)
  , exchanges_without_data_(offline_after)
{
}

// --- link ------------------------------------------------------------------------------------------------------------

void Inverter::answered(const wire::Reply& reply)
{
  last_reply_ = reply.finished_at;
  ever_answered_ = true;
  slowest_reply_ = std::max(slowest_reply_, reply.turnaround);
  probes = 0;
  if (offline_)
  {
    probed_ = false;
    on_trial_ = true;
    return;
  }
  exchange_error_ = 0;
}

void Inverter::beginTrial(Duration delay)
{
  if (silent() && probed_)
  {
    slowest_reply_ = std::max(slowest_reply_, std::min(delay, seconds(config.response_timeout)));
    on_trial_ = true;
    probed_ = false;
    // That probe is paid for.
    trial_cost_ = Duration::zero();
    trial_waste_ = Duration::zero();
  }
}

bool Inverter::onTrial() const
{
  return on_trial_;
}

Duration Inverter::endTrial(std::uint16_t error_id)
{
  on_trial_ = false;
  refresh_tries = 0;
  settings_tries = 0;
  forgetDrive(!isRefusal(error_id));
  // What was lost or refused is paid for in full, what brought something as far as it does not delay the next probe for long.
  return std::max(trial_waste_, std::min(trial_cost_, seconds(MOST_PAID_FOR_DATA_S)));
}

bool Inverter::silent() const
{
  return offline_ && !on_trial_;
}

void Inverter::noteCost(bool probe, wire::Outcome outcome, Duration cost)
{
  probed_ = probed_ || (offline_ && probe);
  const bool wasted = outcome != wire::Outcome::Ok;
  trial_cost_ = (on_trial_ ? trial_cost_ : Duration::zero()) + cost;
  trial_waste_ = (on_trial_ ? trial_waste_ : Duration::zero()) + (wasted ? cost : Duration::zero());
}

bool Inverter::failed(TimePoint now, std::uint16_t error_id, bool write)
{
  if (now < silence_until_ || offline_)
  {
    return false;
  }
  exchange_error_ = error_id;
  if (liveness.lost(write))
  {
    goOffline(error_id);
  }
  return offline_;
}

bool Inverter::refusedStatus(std::uint16_t error_id)
{
  if (!offline_ && liveness.refused())
  {
    goOffline(error_id);
    return true;
  }
  return false;
}

bool Inverter::overdue(TimePoint now, Duration period) const
{
  return !offline_ && liveness.overdue(now, period);
}

void Inverter::goOffline(std::uint16_t error_id)
{
  // What refuses to tell its status has been there all the time: what it is need not be asked again.
  const bool refused = isRefusal(error_id);
  offline_ = true;
  on_trial_ = false;
  probed_ = false;
  known_ = false;
  exchange_error_ = error_id;
  command_error_.wentOffline();
  velocityConfirmed();
  interlock.offline();
  stop.forgetConfirmation();
  movement.drop();
  unexpected_motion_ = false;
  reset_active = false;
  silence_until_ = TimePoint();
  // From now on nothing of it is answered, and that is what users are told.
  lost_writes.lower();
  forgetDrive(!refused);
}

/// What was read of it counts no more; after silence another drive may stand there, or it may have been switched off and on.
void Inverter::forgetDrive(bool after_silence)
{
  leftover_judged_ = false;
  early_trip_ = false;
  run_shown_at_.reset();
  run_proven_ = false;
  setup_open = false;
  block_note_.clear();
  connect_not_before = TimePoint();
  setting_not_before = TimePoint();
  movement.forgetWords();
  refresh.forget();
  if (after_silence)
  {
    settings.restart();
  }
  operation_seen_ = false;
  operation_off_since_.reset();
}

/// A complete status has come.
void Inverter::noteBack()
{
  if (offline_)
  {
    offline_ = false;
    on_trial_ = false;
    exchange_error_ = 0;
    loopback.tryAgain();
    ++returns_;
  }
  known_ = true;
  ever_known_ = true;
}

bool Inverter::offline() const
{
  return offline_;
}

bool Inverter::known() const
{
  return known_;
}

bool Inverter::everKnown() const
{
  return ever_known_;
}

void Inverter::expectSilence(TimePoint now, Duration duration)
{
  silence_until_ = now + duration;
  liveness.deafUntil(silence_until_);
}

void Inverter::noDeafness()
{
  silence_until_ = TimePoint();
}

wire::Request Inverter::prepared(wire::Request request) const
{
  request.response_timeout = seconds(config.response_timeout);
  request.reply_delay = settings.replyDelay();
  request.quiet_before = seconds(drive.profile().quiet_before);
  if (config.modbus_tcp)
  {
    request.own_exceptions = ownExceptions(drive.profile().exceptions, exchanges_without_data_ < offline_after_);
  }
  return request;
}

// --- what is settled at connect --------------------------------------------------------------------------------------

bool Inverter::connectDue(TimePoint now) const
{
  // Nothing but reads goes to a port of the drive's own before it has told its status (contract, 8.8).
  const bool must_wait = config.ownPort() && !ever_known_ && settings.nextWrites();
  return !silent() && now >= std::max(connect_not_before, setting_not_before) && settings.urgent() && !must_wait;
}

void Inverter::settled(TimePoint now, const wire::Reply& reply)
{
  settings.done(reply);
  if (reply.outcome != wire::Outcome::Ok)
  {
    // Not at once again: the status is worth more.
    connect_not_before = now + seconds(CONNECT_PAUSE_S);
  }
  refused_setting_not_before_ = now + settings.pauseBeforeNext();
  adoptSettings();
}

void Inverter::adoptSettings()
{
  drive::Ratings ratings = settings.ratings();
  ratings.current = config.rated_current ? config.rated_current : ratings.current;
  ratings.voltage = config.rated_voltage ? config.rated_voltage : ratings.voltage;
  refresh.setRatings(ratings);
  const bool use = block_note_.empty() && blockFits();
  refresh.useBlock(use ? drive.chosenRead(config.block_read) : std::nullopt);
}

bool Inverter::blockFits() const
{
  const auto slots = settings.blockSlots();
  if (!slots || slots->read != config.block_read)
  {
    return false;
  }
  const auto& select = drive.profile().block->select;
  return std::equal(select.begin(), select.end(), slots->write.begin(), slots->write.end(),
                    [](const auto& wanted, int code) { return static_cast<int>(wanted.second) == code; });
}

std::vector<std::pair<std::string, std::uint32_t>> Inverter::blockToConfigure()
{
  std::vector<std::pair<std::string, std::uint32_t>> wanted;
  const auto slots = settings.blockSlots();
  const bool at_rest = known_ && !movement.runPossible() && !movement.target() && !interlock.isFaulted() &&
                       !refresh.fresh().running.value_or(true);
  if (!config.configure_block || block_configured_ || !slots || blockFits() || !at_rest ||
      settings.identity() != Identity::Right)
  {
    return wanted;
  }
  // Once: each of these writes wears the EEPROM.
  block_configured_ = true;
  const drive::Block& block = *drive.profile().block;
  const auto add = [&](const std::string& name, std::uint32_t raw) {
    if (drive.findParameter(name, true))
    {
      wanted.emplace_back(name, raw);
    }
  };
  for (std::size_t slot = 0; slot < block.write_slots.size(); ++slot)
  {
    if (slots->write[slot] != static_cast<int>(block.select[slot].second))
    {
      add(block.write_slots[slot], block.select[slot].second);
    }
  }
  for (std::size_t slot = 0; slot < block.read_slots.size() && slot < config.block_read.size(); ++slot)
  {
    if (slots->read[slot] != config.block_read[slot])
    {
      add(block.read_slots[slot], static_cast<std::uint32_t>(config.block_read[slot]));
    }
  }
  if (!block.apply_parameter.empty())
  {
    add(block.apply_parameter, block.apply_value);
  }
  return wanted;
}

void Inverter::dropBlock(const std::string& why)
{
  block_note_ = why;
  refresh.useBlock(std::nullopt);
}

void Inverter::noteExchange(const wire::Reply& reply)
{
  const wire::Outcome outcome = reply.outcome;
  gateway_code_ = reply.gateway_code;
  exchanges_without_data_ = std::min(exchanges_without_data_ + 1, offline_after_);
  run_shown_at_.reset();
  if (outcome == wire::Outcome::Ok)
  {
    return;
  }
  run_proven_ = false;
  if (outcome == wire::Outcome::Exception)
  {
    return;
  }
  // A short power cut may be behind it.
  refresh.suspectRestart();
  if (drive.wears("frequency"))
  {
    // After one the drive writes set-points to its EEPROM again.
    settings.connectAgain();
  }
}

/// The motor turns as we want it, or is on its way there: not on its way to rest after a RUN that the drive has lost.
bool Inverter::followsTarget(const drive::Monitor& monitor)
{
  const auto& target = movement.target();
  if (!target || target->zero || !monitor.output_frequency)
  {
    return false;
  }
  const double wanted = target->counts * drive.frequencyResolution();
  const double distance = std::fabs(*monitor.output_frequency - wanted);
  const double before = std::fabs(last_shown_hz_ - wanted);
  last_shown_hz_ = *monitor.output_frequency;
  const bool turns_right = !monitor.direction || *monitor.direction == (target->reverse ? -1 : 1);
  return turns_right && (distance <= std::max(0.5, 0.02 * wanted) || distance < before);
}

void Inverter::noteStatus(const wire::Reply& reply, bool more)
{
  if (reply.outcome != wire::Outcome::Ok)
  {
    return;
  }
  exchanges_without_data_ = 0;
  if (!refresh.block() && refresh.takeBlockRefusal())
  {
    block_note_ = "it is selected but not in effect, or the drive refuses it";
  }
  const drive::Monitor& words = more ? refresh.words() : refresh.fresh();
  const bool evidence = reply.sent_at >= movement.runChangedAt();
  if (words.run_seen)
  {
    run_proven_ = *words.run_seen && evidence && movement.runConfirmed();
  }
  const bool runs = words.operation.value_or(false) || words.running.value_or(false);
  if (runs && evidence && run_proven_ && followsTarget(words))
  {
    run_shown_at_ = reply.finished_at;
  }
}

void Inverter::parameterWritten(const std::string& name)
{
  settings.reread(name);
  const auto& block = drive.profile().block;
  const auto among = [&name](const std::vector<std::string>& slots) {
    return std::find(slots.begin(), slots.end(), name) != slots.end();
  };
  if (block && (among(block->read_slots) || among(block->write_slots)))
  {
    dropBlock("its selection was changed; that counts after the drive was switched off and on");
  }
}

bool Inverter::inSetup() const
{
  return setup_open || settings.leavingSetup();
}

bool Inverter::mayRepeatWords(TimePoint now) const
{
  return run_shown_at_ && now - *run_shown_at_ < seconds(RUN_EVIDENCE_S) && *run_shown_at_ >= movement.runChangedAt() &&
         movement.runConfirmed() && !stop.pending() && !interlock.isFaulted();
}

bool Inverter::mustBeSeenRunning() const
{
  return movement.turnLostAt() && (drive.reports("operation") || drive.reports("running"));
}

bool Inverter::mayRun() const
{
  const drive::Monitor& monitor = refresh.fresh();
  return movement.runPossible() || monitor.operation.value_or(false) || monitor.running.value_or(false) ||
         monitor.output_frequency.value_or(0.0) > 0.0;
}

std::string Inverter::wrongDrive() const
{
  return settings.identity() == Identity::Right ? "" : settings.identityText();
}

void Inverter::noteEepromWrite()
{
  ++eeprom_writes_;
}

bool Inverter::probesByLoopback() const
{
  // Two ways to ask in turn, until it is known that the drive has the loop-back.
  const bool worth_it = config.modbus_tcp ? loopbackUsable() : loopback.worthATry();
  return loopback.proven() || (worth_it && probes % 2 == 0);
}

bool Inverter::loopbackUsable() const
{
  return loopback.usable() && (ever_known_ || !config.ownPort());
}

wire::Request Inverter::probe(std::uint16_t number, Duration response_timeout) const
{
  const auto echo = probesByLoopback() ? drive.loopback(config.node, number) : std::nullopt;
  wire::Request request =
      echo ? *echo : drive.read(config.node, drive.runBlock() ? *drive.runBlock() : drive.fastBlocks().front());
  request = prepared(request);
  request.response_timeout = std::min(request.response_timeout, response_timeout);
  return request;
}

Duration Inverter::slowestReply() const
{
  return slowest_reply_;
}

void Inverter::lateReply(Duration delay)
{
  latest_late_reply_ = std::max(latest_late_reply_, delay);
  record.noteLate();
}

// --- judgement -------------------------------------------------------------------------------------------------------

Judgement Inverter::judge(TimePoint now)
{
  Judgement judgement;
  const drive::Monitor& monitor = refresh.fresh();
  noteBack();
  liveness.complete(now);
  silence_until_ = TimePoint();
  record.restart();
  interlock.online(now);
  // A status that can't tell of a trip does not end one.
  const bool faulted = monitor.tripped().value_or(interlock.isFaulted());
  const bool new_trip = faulted && !interlock.isFaulted();
  judgement.tripped = new_trip || early_trip_;
  early_trip_ = false;
  interlock.faulted(faulted);
  if (judgement.tripped)
  {
    judgement.trip_text = drive.tripText(monitor);
    judgement.stop_reason = new_trip ? judgement.trip_text : std::string();
  }
  judgeRun(monitor, refresh.freshSentAt(), judgement);
  judgeOperation(now, monitor, refresh.freshSentAt(), judgement);
  judgeRestart(monitor, refresh.freshSentAt(), judgement);
  compareMovement(now, monitor);
  if (movement.runConfirmed() && now - command_source_at_ >= seconds(COMMAND_SOURCE_PERIOD_S))
  {
    // A panel or a terminal may take the drive over at any time.
    settings.commanded();
    command_source_at_ = now;
  }
  leftover_judged_ = leftover_judged_ || monitor.run_seen || !drive.reports("run_seen");
  return judgement;
}

/// The drive says that it has forgotten what it was told since its last return.
void Inverter::judgeRestart(const drive::Monitor& monitor, TimePoint sent_at, Judgement& judgement)
{
  if (!monitor.restarted || !settings.connected())
  {
    return;
  }
  if (!*monitor.restarted)
  {
    no_restart_until_ = sent_at;
    return;
  }
  refresh.restartNoted();
  if (movement.runConfirmed() && no_restart_until_ < movement.runChangedAt() && !stop.pending())
  {
    // It may have restarted before it got the RUN that is in force. If that is gone, the next read shows it.
    settings.connectAgain();
    refresh.askForRun();
    run_proven_ = false;
    return;
  }
  settings.restart();
  // What was selected for its block read may count only now.
  block_note_.clear();
  refresh.useBlock(std::nullopt);
  run_proven_ = false;
  if (movement.runPossible() && !stop.pending())
  {
    judgement.stop_reason = "the drive has restarted (switched off and on, or reset)";
  }
}

Judgement Inverter::judgeWords(TimePoint now)
{
  Judgement judgement;
  const drive::Monitor& words = refresh.words();
  if (words.tripped().value_or(false) && !interlock.isFaulted())
  {
    interlock.faulted(true);
    early_trip_ = true;
    judgement.stop_reason = words.unknown_trip ? drive.tripText(words) : "the drive has tripped";
  }
  judgeRun(words, refresh.wordsSentAt(), judgement);
  judgeOperation(now, words, refresh.wordsSentAt(), judgement);
  judgeRestart(words, refresh.wordsSentAt(), judgement);
  return judgement;
}

void Inverter::judgeRun(const drive::Monitor& monitor, TimePoint sent_at, Judgement& judgement)
{
  // Words that were asked for before our last change of RUN say nothing about it.
  const bool evidence = sent_at >= movement.runChangedAt();
  if (!leftover_judged_ && !drive.reports("run_seen") && !stop.pending() && !movement.runPossible())
  {
    judgement.stop_reason = "the drive can't tell whether a RUN of the bus is on";
    return;
  }
  if (!monitor.run_seen || !evidence || stop.pending())
  {
    return;
  }
  const bool run_seen = *monitor.run_seen;
  if (movement.runConfirmed() && !run_seen)
  {
    judgement.stop_reason = "the drive lost its RUN without a stop of ours (switched off and on, or reset)";
  }
  if (movement.zeroUnverified() && run_seen)
  {
    judgement.zero_failed = true;
  }
  if (movement.zeroUnverified() && !run_seen)
  {
    movement.stopped(sent_at);
    interlock.resting();
    return;
  }
  if (!run_seen || movement.runPossible())
  {
    return;
  }
  if (!leftover_judged_)
  {
    judgement.stop_reason = "a leftover RUN on the bus command is cleared";
    return;
  }
  const bool new_motion = !unexpected_motion_;
  unexpected_motion_ = true;
  if (new_motion && config.stop_unexpected_motion)
  {
    judgement.stop_reason = "RUN is on without a command of this node";
  }
}

void Inverter::judgeOperation(TimePoint now, const drive::Monitor& monitor, TimePoint sent_at, Judgement& judgement)
{
  const std::optional<bool>& operation = monitor.operation ? monitor.operation : monitor.running;
  if (!operation)
  {
    return;
  }
  if (!movement.runPossible())
  {
    operation_seen_ = false;
    operation_off_since_.reset();
    if (!*operation)
    {
      at_rest_seen_ = true;
      unexpected_motion_ = unexpected_motion_ && monitor.run_seen.value_or(false);
    }
    // A motor that runs out after our stop is no surprise; one that starts from rest is.
    const bool surprising = *operation && (at_rest_seen_ || !leftover_judged_) && !monitor.run_seen.value_or(false);
    if (surprising && !unexpected_motion_)
    {
      unexpected_motion_ = true;
      if (config.stop_unexpected_motion && !stop.pending())
      {
        judgement.stop_reason = "the motor runs without a command of this node";
      }
    }
    return;
  }
  at_rest_seen_ = false;
  unexpected_motion_ = false;
  if (movement.turnLostAt() && sent_at > *movement.turnLostAt())
  {
    movement.seenRunning();
    if (!*operation)
    {
      judgement.stop_reason = "the drive stopped while it was to turn round (switched off and on?)";
    }
  }
  operation_seen_ = operation_seen_ || *operation;
  const double commanded_hz = movement.target() ? movement.target()->counts * drive.frequencyResolution() : 0.0;
  const bool lost = operation_seen_ && !*operation && movement.runConfirmed() && commanded_hz >= LOWEST_JUDGED_HZ &&
                    sent_at >= movement.runChangedAt();
  if (lasts(operation_off_since_, lost, now, OPERATION_LOST_S))
  {
    judgement.stop_reason = "the drive stopped without a stop of ours (STOP key, terminal or safe stop)";
    operation_seen_ = false;
  }
}

void Inverter::compareMovement(TimePoint now, const drive::Monitor& monitor)
{
  const bool commanded = movement.runConfirmed() && movement.target() && !movement.target()->zero;
  const double frequency = monitor.output_frequency.value_or(0.0);
  const double target = commanded ? movement.target()->counts * drive.frequencyResolution() : 0.0;
  const bool still = commanded && monitor.output_frequency && frequency <= 0.0 && target >= LOWEST_JUDGED_HZ;
  lasts(idle_since_, still, now, MOVEMENT_PATIENCE_S);
  const int sense = commanded && movement.target()->reverse ? -1 : 1;
  const bool wrong = commanded && monitor.direction && *monitor.direction == -sense && frequency >= last_frequency_;
  lasts(wrong_direction_since_, wrong, now, MOVEMENT_PATIENCE_S);
  const bool deviates = commanded && monitor.at_speed.value_or(false) && monitor.output_frequency && frequency > 0.0 &&
                        std::fabs(frequency - target) > std::max(0.5, 0.02 * target);
  lasts(deviates_since_, deviates, now, DEVIATION_PATIENCE_S);
  last_frequency_ = frequency;
}

// --- status ----------------------------------------------------------------------------------------------------------

InverterStatus Inverter::status(TimePoint now) const
{
  InverterStatus status;
  status.index = index;
  status.model = settings.model();
  status.stamp = refresh.stamp();
  status.has_stamp = refresh.hasStamp();
  status.communication_error = offline_;
  status.refuses = offline_ && liveness.refusesForTheMoment() && now - last_reply_ < seconds(LATELY_S);
  if (!status.communication_error)
  {
    status.monitor = refresh.monitor(now);
  }
  status.run_command = movement.runCommand();
  status.move_velocity_active = movement.active();
  status.reset_active = reset_active;
  status.stop_active = stop.pending();
  status.locked = interlock.locked(now);
  showError(now, status);
  const auto& target = movement.target();
  status.commanded_velocity = target && !target->zero ? target->velocity : 0.0;
  return status;
}

Obstacles Inverter::obstacles() const
{
  Obstacles obstacles;
  obstacles.offline = offline_;
  obstacles.tripped = interlock.isFaulted();
  obstacles.stop_pending = interlock.stopPending();
  obstacles.reset_active = reset_active;
  obstacles.in_setup = inSetup();
  obstacles.wrong_drive = !wrongDrive().empty();
  return obstacles;
}

/// The one that says most: why it is offline or locked more than that it is, a command's own more than a single exchange's.
void Inverter::showError(TimePoint now, InverterStatus& status) const
{
  if (status.communication_error && exchange_error_ != 0 && !command_error_.countsWhileOffline())
  {
    status.error_id = exchange_error_;
    status.error_text = exchangeText();
    return;
  }
  if (lost_writes.raised())
  {
    status.error_id = wire::ERROR_TIMEOUT;
    status.error_text = lost_writes.text();
  }
  else if (command_error_.id() != 0)
  {
    Obstacles now_there = obstacles();
    now_there.locked = interlock.locked(now);
    status.error_id = command_error_.id();
    status.error_text = command_error_.text(now_there, exchange_error_ == 0 ? "" : exchangeText());
  }
  else if (velocity_error_ != 0)
  {
    status.error_id = velocity_error_;
    status.error_text = "the last velocity was not carried out: " + velocity_error_text_;
  }
  else if (exchange_error_ != 0)
  {
    status.error_id = exchange_error_;
    status.error_text = exchangeText();
  }
}

/// Why it is offline; else in the drive's own words where it has answered.
std::string Inverter::exchangeText() const
{
  const std::string why = offline_ && exchange_error_ != wire::ERROR_PORT_LOST ? liveness.reason() : "";
  const std::string text = why.empty() ? drive.exceptionText(exchange_error_) : why;
  return text.empty() ? errorText(exchange_error_, gateway_code_) : text;
}

void Inverter::velocityFailed(std::uint16_t error_id, const std::string& text)
{
  velocity_error_ = error_id;
  velocity_error_text_ = text;
}

void Inverter::velocityConfirmed()
{
  velocity_error_ = 0;
  velocity_error_text_.clear();
}

void Inverter::refuseCommand(std::uint16_t error_id, const std::string& text)
{
  command_error_.set(error_id, text, obstacles());
}

void Inverter::refuseForOther(std::uint16_t error_id, const std::string& reasons, std::uint16_t own_error_id,
                              const std::string& own_text)
{
  command_error_.setForOther(error_id, reasons, own_error_id, own_text, obstacles());
}

void Inverter::acceptCommand()
{
  command_error_.clear();
}

void Inverter::noteExchangeError(std::uint16_t error_id)
{
  exchange_error_ = error_id;
}

void Inverter::noteProbed(const wire::Reply& reply)
{
  // One that is answered is no status: what was missing is still missing.
  const bool port_is_back = exchange_error_ == wire::ERROR_PORT_LOST;
  const bool answered = reply.outcome == wire::Outcome::Ok;
  if (offline_ && (!answered || port_is_back))
  {
    exchange_error_ = answered ? wire::ERROR_TIMEOUT : reply.error_id;
  }
}

std::string Inverter::onlineText() const
{
  return "online; locked until it is sent 0, or nothing for " + util::durationText(interlock.silenceNeeded()) +
         (drive.sequence("forward") == nullptr && drive.sequence("reverse") == nullptr
              ? "; it gets no velocity, see /diagnostics"
              : "");
}

std::string Inverter::offlineReason() const
{
  const std::string seen = record.text(drive);
  return exchangeText() +
         (seen.empty() || exchange_error_ == wire::ERROR_PORT_LOST ? "" : "; since the last complete status " + seen);
}

std::string Inverter::offlineText(TimePoint now) const
{
  std::string text = "offline (" + errorIdText(exchange_error_) + " " + offlineReason() + "; last answer ";
  text += ever_answered_ ? util::durationText(now - last_reply_) + " ago)" : "never)";
  return text + (exchange_error_ == wire::ERROR_PORT_LOST ? "" : "; " + record.advice());
}

/// Before the first complete status.
std::string Inverter::silenceText() const
{
  const std::string seen = record.text(drive);
  return seen.empty() ? "has not been asked yet" : "no complete status yet: " + seen + "; " + record.advice();
}

std::vector<Finding> Inverter::errors(TimePoint now) const
{
  std::vector<Finding> findings;
  if (offline_ && exchange_error_ == wire::ERROR_PORT_LOST)
  {
    findings.push_back({ Level::Error, "offline (" + errorIdText(exchange_error_) +
                                           "), since the port is not open: what to do about it is told of the bus" });
    return findings;
  }
  if (offline_)
  {
    findings.push_back({ Level::Error, offlineText(now) });
    return findings;
  }
  if (lost_writes.raised())
  {
    findings.push_back(
        { Level::Error,
          lost_writes.text() + " (" + std::to_string(lost_writes.inARow()) +
              " in a row): stopped and locked, the stop is sent until it is acknowledged; check who "
              "else writes to the drive, its write protection, the gateway or converter, and the wiring" });
  }
  if (interlock.isFaulted())
  {
    const drive::Monitor& told = refresh.fresh();
    const std::uint16_t code = told.fault_code.value_or(0);
    const std::string why =
        told.unknown_trip ? drive.tripText(told) : std::to_string(code) + " " + drive.faultText(code);
    findings.push_back({ Level::Error, "tripped: " + why + "; remove the cause, then call reset" });
  }
  return findings;
}

std::vector<Finding> Inverter::findings(TimePoint now) const
{
  std::vector<Finding> findings = errors(now);
  const auto warn = [&](const std::string& text) { findings.push_back({ Level::Warn, text }); };
  if (!offline_ && !known_)
  {
    warn(silenceText());
  }
  for (const Finding& finding : settings.findings())
  {
    findings.push_back(finding);
  }
  if (unexpected_motion_)
  {
    warn("runs without a command of this node; look for a second master, the panel or terminals");
  }
  if (idle_since_ && now - *idle_since_ >= seconds(MOVEMENT_PATIENCE_S))
  {
    warn("does not move although RUN is on; check the enable inputs and who may command the drive");
  }
  if (wrong_direction_since_ && now - *wrong_direction_since_ >= seconds(MOVEMENT_PATIENCE_S))
  {
    warn("turns in the wrong direction; check the drive's direction settings and hz_per_unit");
  }
  if (deviates_since_ && now - *deviates_since_ >= seconds(DEVIATION_PATIENCE_S))
  {
    warn("runs at another speed than commanded; check for a takeover at the panel and the drive's frequency limits");
  }
  if (interlock.activePublishers(now) > 1)
  {
    warn("several publishers command this inverter");
  }
  if (latest_late_reply_ > Duration::zero())
  {
    warn("a reply came " + util::durationText(latest_late_reply_) +
         " after its request; a response_timeout above that "
         "would have caught it");
  }
  for (const std::string& mistake : drive.profile().mistakes)
  {
    warn("left out: " + mistake);
  }
  if (!drive.profile().unconfirmed.empty())
  {
    warn("unconfirmed in the profile: " + drive.unconfirmedText());
  }
  if (drive.profile().block && settings.blockSlots() && !refresh.block())
  {
    warn(blockFinding());
  }
  if (writesWear())
  {
    warn("every change of the set-point is written to the drive's EEPROM (" + std::to_string(eeprom_writes_) +
         " writes so far): " + drive.armingAdvice("connect"));
  }
  return findings;
}

/// The set-point goes to the EEPROM, because the drive could not be told otherwise at connect.
bool Inverter::writesWear() const
{
  return drive.wears("frequency") && !settings.connected() && drive.sequence("forward") != nullptr;
}

std::string Inverter::blockFinding() const
{
  if (!block_note_.empty())
  {
    return "block read and write are not used: " + block_note_;
  }
  const auto slots = settings.blockSlots();
  if (blockFits())
  {
    return "block read is selected but not in effect: direct reads are used; switch the drive off and on";
  }
  return "block read and write are not used, since the drive has selected " + util::joined(slots->write) + " and " +
         util::joined(slots->read) + " instead of " + util::joined(wantedWriteCodes()) + " and " +
         util::joined(config.block_read) + "; direct reads are used; set the drive, or configure_block: true";
}

std::vector<int> Inverter::wantedWriteCodes() const
{
  std::vector<int> codes;
  for (const auto& entry : drive.profile().block->select)
  {
    codes.push_back(static_cast<int>(entry.second));
  }
  return codes;
}

std::vector<std::pair<std::string, std::string>> Inverter::values(TimePoint now) const
{
  std::vector<std::pair<std::string, std::string>> values;
  values.emplace_back("node", std::to_string(config.node));
  values.emplace_back("drive", drive.profile().name);
  values.emplace_back("model", drive.profile().title);
  values.emplace_back("age of status",
                      refresh.hasStamp() ? util::durationText(now - refresh.stamp()) : std::string("no status yet"));
  values.emplace_back("slowest reply", util::durationText(slowest_reply_));
  values.emplace_back("returns", std::to_string(returns_));
  values.emplace_back("locked", interlock.locked(now) ? "yes" : "no");
  values.emplace_back("own reply delay", util::durationText(settings.replyDelay()));
  if (drive.profile().writes == drive::Writes::Eeprom || drive.wears("frequency"))
  {
    values.emplace_back("EEPROM writes by this node", std::to_string(eeprom_writes_));
  }
  if (drive.profile().block)
  {
    values.emplace_back("block read", refresh.block() ? "in use: " + util::joined(config.block_read) : "not used");
  }
  for (const auto& value : refresh.chosenValues())
  {
    values.push_back(value);
  }
  for (const auto& value : settings.values())
  {
    values.push_back(value);
  }
  return values;
}

InverterView Inverter::view(TimePoint now, Duration deadline_margin) const
{
  InverterView view;
  const drive::Monitor& monitor = refresh.fresh();
  view.offline = silent();
  const bool tells = monitor.run_seen || monitor.operation || monitor.running;
  view.at_rest = known_ && tells && !movement.runPossible() && !movement.target() &&
                 !monitor.operation.value_or(false) && !monitor.running.value_or(false) &&
                 !monitor.tripped().value_or(false);
  view.stop_pending = stop.pending();
  view.stop_attempts = stop.pending() ? stop.attempts() : 0;
  view.stop_written = stop.pending() && stop.written();
  view.stop_repeats = stop.pending() && stop.repeats() && !movement.runPossible();
  view.refresh_not_before = refresh_not_before;
  const bool rested = refused_setting_not_before_ <= now || settings.pauseBeforeNext() == Duration{ 0 };
  const bool may_ask = refresh_not_before <= now && setting_not_before <= now && rested;
  view.background = known_ && !offline_ && settings.pending() && may_ask;
  view.serve_by = serveBy(deadline_margin);
  return view;
}

std::optional<TimePoint> Inverter::serveBy(Duration deadline_margin) const
{
  const auto timeout = settings.driveTimeout();
  if (!timeout || !ever_answered_)
  {
    return std::nullopt;
  }
  const Duration latest = std::min(seconds(toSeconds(*timeout) * TIMEOUT_SHARE), *timeout - deadline_margin);
  // On a bus that is too full for it a drive is due early, but never always: the others want to be served too.
  return last_reply_ + std::max(latest, *timeout / 2);
}

std::vector<drive::ReadBlock> Inverter::reads() const
{
  std::vector<drive::ReadBlock> reads = refresh.fastBlocks();
  const std::vector<drive::ReadBlock> slow = refresh.slowBlocks();
  reads.insert(reads.end(), slow.begin(), slow.end());
  return reads;
}
}  // namespace bus
}  // namespace inverter_bus
