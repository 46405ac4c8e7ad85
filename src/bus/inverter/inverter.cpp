// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "bus/inverter/inverter.h"

#include <algorithm>

#include "bus/link/own_exceptions.h"

namespace inverter_bus
{
namespace bus
{
namespace
{
// Share of the drive's own time-out after which it is served whatever else waits.
constexpr double TIMEOUT_SHARE = 0.8;

/// A refusal by the drive itself, not silence or damage.
bool isRefusal(std::uint16_t error_id)
{
  return error_id != 0 && error_id != wire::ERROR_TIMEOUT && error_id != wire::ERROR_DAMAGED &&
         error_id != wire::ERROR_PORT_LOST;
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
  , refresh(drive)
  , settings(drive, config.node, MapUse::wanted(drive, config))
  , loopback(config.modbus_tcp)
  , link(offline_after)
  , evidence(drive)
  , feeding(drive)
  , motion(drive, config)
  , block_transfer(drive, config)
  , map_use(drive, config)
  , lost_writes(retries, offline_after)
  , liveness(offline_after, seconds(offline_after * (1 + retries) * config.response_timeout))
  , setting_repeats(retries)
{
}

// --- link ------------------------------------------------------------------------------------------------------------

Duration Inverter::endTrial(std::uint16_t error_id)
{
  setting_repeats.restart();
  forgetDrive(!isRefusal(error_id));
  return link.endTrial();
}

bool Inverter::failed(TimePoint now, std::uint16_t error_id, bool write)
{
  if (liveness.mayBeDeaf(now) || link.offline())
  {
    return false;
  }
  link.failed(error_id);
  if (liveness.lost(write) && !liveness.tooSoon(now))
  {
    goOffline(error_id);
  }
  return link.offline();
}

bool Inverter::refusedStatus(std::uint16_t error_id)
{
  if (!link.offline() && liveness.refused())
  {
    goOffline(error_id);
    return true;
  }
  return false;
}

void Inverter::goOffline(std::uint16_t error_id)
{
  // A drive that refuses its status has been there all the time: it need not be identified again.
  const bool refused = isRefusal(error_id);
  link.goOffline(error_id);
  command_error.wentOffline();
  interlock.offline();
  stop.forgetConfirmation();
  movement.drop();
  motion.wentOffline();
  services.resetEnded();
  liveness.heard();
  // From now on nothing that it is sent is answered, and that is what users see.
  lost_writes.lower();
  forgetDrive(!refused);
}

/// What was read of it no longer counts; after silence another drive may be there, or it may have been switched off and on.
void Inverter::forgetDrive(bool after_silence)
{
  evidence.forget();
  motion.forget();
  services.setupLeft();
  block_transfer.tryAgain();
  map_use.restart();
  pauses.forget();
  movement.forgetWords();
  refresh.forget();
  if (after_silence)
  {
    settings.restart();
  }
}

wire::Request Inverter::prepared(wire::Request request) const
{
  request.response_timeout = seconds(config.response_timeout);
  request.reply_delay = settings.replyDelay();
  request.quiet_before = seconds(drive.profile().quiet_before);
  if (config.modbus_tcp)
  {
    request.own_exceptions = ownExceptions(drive.profile().exceptions, link.sendsData());
  }
  return request;
}

// --- what is settled at connect --------------------------------------------------------------------------------------

bool Inverter::connectDue(TimePoint now) const
{
  // Nothing but reads goes to a port of the drive's own before it has reported its status (contract, 8.8).
  const bool must_wait = config.ownPort() && !link.everKnown() && settings.nextWrites();
  return !link.silent() && pauses.connectAllowed(now) && settings.urgent() && !must_wait;
}

void Inverter::settled(TimePoint now, const wire::Reply& reply)
{
  settings.done(reply);
  pauses.settingEnded(now, reply.outcome != wire::Outcome::Ok, settings.pauseBeforeNext());
  drive::Ratings ratings = settings.ratings();
  ratings.current = config.rated_current ? config.rated_current : ratings.current;
  ratings.voltage = config.rated_voltage ? config.rated_voltage : ratings.voltage;
  refresh.setRatings(ratings);
  refresh.useBlock(block_transfer.read(settings.blockSlots()));
}

bool Inverter::standsStill() const
{
  const bool at_rest = link.known() && !movement.runPossible() && !movement.target() && !interlock.isFaulted() &&
                       !refresh.fresh().monitor.running.value_or(true);
  return at_rest && settings.identity() == Identity::Right;
}

void Inverter::dropBlock(const std::string& why)
{
  block_transfer.drop(why);
  refresh.useBlock(std::nullopt);
}

void Inverter::noteExchange(const wire::Reply& reply)
{
  const wire::Outcome outcome = reply.outcome;
  link.exchangeEnded(reply);
  evidence.exchangeEnded(outcome);
  if (outcome == wire::Outcome::Ok || outcome == wire::Outcome::Exception)
  {
    return;
  }
  // A short power cut may be behind it.
  refresh.slow().suspectRestart();
  refresh.draft().lost();
  map_use.lost();
  if (drive.wears("frequency"))
  {
    // After one the drive writes set-points to its EEPROM again.
    settings.connectAgain();
  }
}

void Inverter::noteStatus(const wire::Reply& reply, bool more)
{
  if (reply.outcome != wire::Outcome::Ok)
  {
    return;
  }
  link.dataRead();
  if (!refresh.chosen().read() && refresh.chosen().takeRefusal())
  {
    block_transfer.drop("it is selected but not in effect, or the drive refuses it");
  }
  if (const auto outcome = refresh.mapped().takeOutcome())
  {
    map_use.note(*outcome);
  }
  evidence.statusRead(more ? refresh.draft().words().monitor : refresh.fresh().monitor, reply, movement);
}

void Inverter::parameterWritten(const std::string& name)
{
  settings.reread(name);
  if (settings.map().has(name))
  {
    map_use.end("its parameters were changed; that takes effect after the drive is switched off and on");
  }
  if (block_transfer.isSelectedBy(name))
  {
    dropBlock("its selection was changed; that takes effect after the drive is switched off and on");
  }
}

Holds Inverter::holds() const
{
  Holds holds;
  holds.stop = stop.held();
  holds.unidentified = settings.identity() == Identity::Unknown;
  holds.resetting = services.resetting();
  holds.in_setup = services.setupOpen() || settings.leavingSetup();
  return holds;
}

bool Inverter::mayRepeatWords(TimePoint now) const
{
  return evidence.shows(now, movement) && !stop.pending() && !interlock.isFaulted();
}

bool Inverter::mayRun() const
{
  const drive::Monitor& monitor = refresh.fresh().monitor;
  return movement.runPossible() || monitor.operation.value_or(false) || monitor.running.value_or(false) ||
         monitor.output_frequency.value_or(0.0) > 0.0;
}

bool Inverter::loopbackUsable() const
{
  return loopback.usable() && (link.everKnown() || !config.ownPort());
}

// --- judgement -------------------------------------------------------------------------------------------------------

Judgement Inverter::statusComplete(TimePoint now)
{
  if (link.statusComplete())
  {
    loopback.tryAgain();
  }
  liveness.complete(now);
  record.restart();
  interlock.online(now);
  Judgement judgement = compare(now, refresh.fresh(), true);
  if (evidence.takeSourceDue(now, movement, refresh.reads().slowPeriod()))
  {
    settings.underCommand(true);
  }
  return judgement;
}

Judgement Inverter::wordsRead(TimePoint now)
{
  return compare(now, refresh.draft().words(), false);
}

/// What the drive does with its commands, and what follows for the parts of this inverter.
Judgement Inverter::compare(TimePoint now, const StatusWords& words, bool complete)
{
  const MotionVerdict verdict =
      motion.judge({ words.monitor, words.sent_at, now, complete, movement, stop.pending(), interlock.isFaulted() });
  if (verdict.faulted)
  {
    interlock.faulted(*verdict.faulted);
  }
  if (verdict.came_to_rest)
  {
    cameToRest(words.sent_at);
  }
  if (verdict.told_after_turn)
  {
    movement.seenRunning();
  }
  Judgement judgement = verdict.judgement;
  const std::string restart = noteRestart(words.monitor, words.sent_at);
  judgement.stop_reason = restart.empty() ? judgement.stop_reason : restart;
  return judgement;
}

void Inverter::cameToRest(TimePoint now)
{
  movement.stopped(now);
  interlock.resting();
}

/// The drive says that it has forgotten since its last return what it was sent. Returns the reason to stop it; empty: none.
std::string Inverter::noteRestart(const drive::Monitor& words, TimePoint sent_at)
{
  if (!words.restarted || !settings.connected())
  {
    return "";
  }
  const Restart restart = evidence.restartRead(*words.restarted, sent_at, movement, stop.pending());
  if (restart == Restart::None)
  {
    return "";
  }
  refresh.draft().restartNoted();
  if (restart == Restart::PerhapsBeforeRun)
  {
    settings.connectAgain();
    refresh.slow().askForRun();
    return "";
  }
  settings.restart();
  // What was selected for its block read may count only now.
  block_transfer.tryAgain();
  map_use.restart();
  refresh.useBlock(std::nullopt);
  // Nor does a velocity that was accepted before start it afterwards: until the drive has reported what it is, it is locked.
  const bool moves = movement.target() && !movement.target()->zero;
  const bool runs_on = (movement.runPossible() || moves) && !stop.pending();
  return runs_on ? "the drive has restarted (switched off and on, or reset)" : "";
}

// --- status ----------------------------------------------------------------------------------------------------------

Obstacles Inverter::obstacles(TimePoint now) const
{
  const Holds held = holds();
  Obstacles obstacles;
  obstacles.locked = interlock.locked(now, held);
  obstacles.offline = link.offline();
  obstacles.tripped = interlock.isFaulted();
  obstacles.stop_pending = interlock.stopPending();
  obstacles.reset_active = held.resetting;
  obstacles.in_setup = held.in_setup;
  obstacles.wrong_drive = settings.identity() != Identity::Right;
  return obstacles;
}

InverterView Inverter::view(TimePoint now, Duration deadline_margin) const
{
  InverterView view;
  const drive::Monitor& monitor = refresh.fresh().monitor;
  view.offline = link.silent();
  const bool tells = monitor.run_seen || monitor.operation || monitor.running;
  view.at_rest = link.known() && tells && !movement.runPossible() && !movement.target() &&
                 !monitor.operation.value_or(false) && !monitor.running.value_or(false) &&
                 !monitor.tripped().value_or(false);
  view.stop_pending = stop.pending();
  view.stop_attempts = stop.pending() ? stop.attempts() : 0;
  view.stop_written = stop.pending() && stop.written();
  view.stop_repeats = stop.pending() && stop.repeats() && !movement.runPossible();
  view.refresh_not_before = pauses.statusNotBefore();
  view.connect_due = connectDue(now);
  const bool refused = settings.pauseBeforeNext() > Duration{ 0 };
  view.background = link.known() && !link.offline() && settings.pending() && pauses.settingsAllowed(now, refused);
  view.serve_by = serveBy(deadline_margin);
  return view;
}

std::optional<TimePoint> Inverter::serveBy(Duration deadline_margin) const
{
  const auto timeout = settings.driveTimeout();
  if (!timeout || !link.lastAnswer())
  {
    return std::nullopt;
  }
  const TimePoint fed_at = feeding.needsWrites() ? feeding.fedAt().value_or(*link.lastAnswer()) : *link.lastAnswer();
  const Duration latest = std::min(seconds(toSeconds(*timeout) * TIMEOUT_SHARE), *timeout - deadline_margin);
  // On a bus that is too full for it a drive is due early, but not all the time: the others must be served too.
  return fed_at + std::max(latest, *timeout / 2);
}
}  // namespace bus
}  // namespace inverter_bus
