// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "bus_fuzz_checker.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "simulation/drives/motor.h"

// The line and what is published. What may move stands in bus_fuzz_checker_motion.cpp.

namespace inverter_bus
{
namespace fuzz
{
namespace
{
using Source = simulation::FrameRecord::Source;

constexpr std::size_t KEPT_ENDS = 512;
constexpr std::size_t KEPT_READS = 64;
constexpr std::size_t READS_IN_QUESTION = 3;  // a reset's or a probe's read may stand beside the refresh's
constexpr double KEPT_SAMPLES_S = 3.0;
constexpr double OLDEST_SLOW_VALUE_S = 1.0;  // contract, section 2
constexpr double TORQUE_TOLERANCE = 1.5;     // [%] of rated: drives tell whole percents
constexpr double PROBE_SHARE = 0.05;         // rule 3.7
constexpr unsigned READS_BY_DEADLINE = 4;    // a drive's own time-out goes first, with a whole refresh
constexpr unsigned BACKGROUND_EVERY = 8;     // rule 3.14
constexpr double SERVICE_SLACK_S = 0.6;      // the loop looks at its clock at least every 0.25 s
constexpr double GAP_TOLERANCE_S = 2e-6;
constexpr std::size_t LONGEST_NOISE = 8;
constexpr double MEMORY_OF_LATE_S = 2.0;  // the longest bar, and the exchange that it lets through
constexpr double BABBLE_S = 0.15;         // settle() waits at most 0.1 s for a line that is not silent

std::string text(double value)
{
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.3f", value);
  return buffer;
}
}  // namespace

Checker::Checker(const Scene& scene, simulation::SimulatedBus& world)
  : scene_(scene), world_(world), lanes_(scene.inverters.size())
{
  for (Lane& lane : lanes_)
  {
    lane.locked_at = world.start();
    lane.hertz = 0.0;
  }
}

void Checker::setBudgetWarns(std::function<bool(std::size_t)> warns)
{
  budget_warns_ = std::move(warns);
}

void Checker::setClock(std::function<TimePoint()> now)
{
  now_ = std::move(now);
}

void Checker::fail(TimePoint now, const std::string& rule, const std::string& text) const
{
  throw Violation(now, rule, text);
}

std::string Checker::nameOf(std::size_t index) const
{
  return scene_.inverters[index].name + " (" + scene_.inverters[index].drive + ")";
}

const Statistics& Checker::statistics() const
{
  return statistics_;
}

std::size_t Checker::openCalls() const
{
  return calls_.size();
}

bool Checker::online(std::size_t index) const
{
  return lanes_[index].online && connected_;
}

const bus::InverterStatus& Checker::status(std::size_t index) const
{
  return lanes_[index].status;
}

bool Checker::hasStatus(std::size_t index) const
{
  return lanes_[index].heard_of;
}

// --- the world ---------------------------------------------------------------------------------------------------------

std::string Checker::value(std::size_t index, const std::string& key) const
{
  for (const auto& value : world_.drives()[index]->describe())
  {
    if (value.first == key)
    {
      return value.second;
    }
  }
  return "";
}

bool Checker::flag(std::size_t index, const std::string& key) const
{
  return value(index, key) == "1";
}

bool Checker::runLatched(std::size_t index) const
{
  return world_.drives()[index]->runCommand();
}

Truth Checker::truth(std::size_t index) const
{
  const simulation::Motor& motor = world_.drives()[index]->motor();
  const Brand brand = scene_.inverters[index].brand;
  Truth truth;
  truth.hertz = std::fabs(motor.frequency());
  truth.direction = motor.frequency() == 0.0 ? 0 : (motor.frequency() > 0.0 ? 1 : -1);
  if (brand == Brand::HITACHI || brand == Brand::TOSHIBA)
  {
    truth.torque = std::fabs(motor.torque());
  }
  return truth;
}

void Checker::disturbed(TimePoint now)
{
  disturbed_at_ = now;
}

void Checker::lostPower(TimePoint now, std::size_t index)
{
  Lane& lane = lanes_[index];
  lane.cut_at = now;
  lane.latched_at_cut = runLatched(index);
  if (lane.run_answered && runLatched(index))
  {
    lane.power_lost = now;
  }
  lane.last_heard.reset();
}

/// How much longer than usual the line may be listened to before a request.
Duration Checker::babble(TimePoint now) const
{
  return disturbed_at_ != TimePoint() && now - disturbed_at_ < seconds(0.5) ? seconds(BABBLE_S) : Duration{ 0 };
}

// --- the line ------------------------------------------------------------------------------------------------------------

void Checker::opened(TimePoint now)
{
  connected_ = true;
  connected_since_ = now;
  last_heard_at_ = now;
  request_end_ = now;
  probe_allowance_ += 2.0 * toSeconds(scene_.longestExchange());
}

void Checker::lost(TimePoint now)
{
  connected_ = false;
  in_flight_ = false;
  for (Lane& lane : lanes_)
  {
    lane.due.reset();
    lane.zero_due.reset();
    lane.shown = false;
    lane.last_heard.reset();
    lane.silences = scene_.offline_after;
  }
  disturbed_at_ = now;
}

void Checker::heard(TimePoint now)
{
  last_heard_at_ = now;
  between_heard_at_ = in_flight_ ? between_heard_at_ : now;
  anything_heard_ = true;
}

void Checker::sending(TimePoint now, const simulation::Bytes& frame)
{
  if (in_flight_)
  {
    fail(now, "one request in flight", "a request begins while another one is waited for");
  }
  checkGap(now);
  ++exchange_;
  ++statistics_.exchanges;
  request_ = frame;
  facts_ = readRequest(scene_, frame);
  sent_at_ = now;
  request_end_ = now + seconds(scene_.character * static_cast<double>(frame.size()));
  in_flight_ = true;
  answered_before_ = answered_;
  answered_ = false;
  anything_heard_ = false;
  if (!facts_.inverter && !facts_.broadcast)
  {
    fail(now, "frames", "a request to a station that is not on the bus");
  }
  watchDeadMen(now);
  checkStopFirst(now);
  checkTurn(now);
  checkBounded(now);
  checkMotion(now);
  checkBackground(now);
  was_probe_ = facts_.inverter && lanes_[*facts_.inverter].heard_of && !lanes_[*facts_.inverter].online;
  if (facts_.inverter)
  {
    world_.drives()[*facts_.inverter]->advance(now);
    Lane& lane = lanes_[*facts_.inverter];
    lane.least = lane.most = truth(*facts_.inverter).hertz;
    lane.sign = truth(*facts_.inverter).direction;
  }
}

/// Rule 3.8: silence before each request, counted from the last byte that came or went.
void Checker::checkGap(TimePoint now)
{
  const TimePoint last = std::max(request_end_, last_heard_at_);
  if (now - last < scene_.gap() - seconds(GAP_TOLERANCE_S) && babble(now) == Duration{ 0 })
  {
    fail(now, "gap",
         "only " + text(toSeconds(now - last) * 1e3) + " ms of silence before a request instead of " +
             text(toSeconds(scene_.gap()) * 1e3) + " ms");
  }
}

/// A drive is given its time before the next request goes out; one that is offline is waited for as short as one likes.
void Checker::checkPatience(TimePoint now)
{
  if (answered_ || anything_heard_ || was_probe_ || !facts_.expects_reply || !facts_.inverter || !connected_)
  {
    return;
  }
  const double patience = scene_.inverters[*facts_.inverter].response_timeout;
  if (now - request_end_ < seconds(patience) - seconds(GAP_TOLERANCE_S))
  {
    fail(now, "one request in flight", "given up after " + text(toSeconds(now - request_end_)) + " s of silence");
  }
}

void Checker::stepped(TimePoint now)
{
  if (in_flight_)
  {
    endExchange(now);
  }
  checkOverdue(now);
  checkBlindness(now);
  for (const auto& call : calls_)
  {
    if (now > call.second.until + scene_.longestExchange() + babble(now))
    {
      fail(now, "every service is answered within its bound", call.second.what + " has no answer");
    }
  }
}

void Checker::endExchange(TimePoint now)
{
  in_flight_ = false;
  checkPatience(now);
  if (!facts_.inverter)
  {
    return;
  }
  noteFailedRead();
  Lane& lane = lanes_[*facts_.inverter];
  if (!answered_)
  {
    lane.shown = false;
    if (facts_.expects_reply)
    {
      unanswered_.push_back(now);
      lane.lost_at = now;
    }
    if (facts_.set_hertz)
    {
      // Nobody knows which set-point it has now.
      lane.set_answered.reset();
    }
    if (facts_.commands())
    {
      lane.settled = false;
      // Words that a refresh repeats are no velocity's.
      lane.lost_frames += facts_.stop || facts_.with_read ? 0 : 1;
      lane.held.reset();
    }
    lane.silences += facts_.expects_reply ? 1 : 0;
    // One that has answered since, however late, is back.
    if (was_probe_ && lane.silences > scene_.offline_after)
    {
      payProbe(now, now - sent_at_);
    }
  }
  while (!unanswered_.empty() && now - unanswered_.front() > seconds(10.0))
  {
    unanswered_.pop_front();
  }
  for (std::size_t index = 0; index < lanes_.size(); ++index)
  {
    world_.drives()[index]->advance(now);
    sample(now, index);
  }
}

/// Rule 3.7: 5 % of the bus time, as a bucket: what each inverter's first probes cost is allowed for when it goes offline.
void Checker::payProbe(TimePoint now, Duration cost)
{
  if (probe_paid_at_ == TimePoint())
  {
    probe_paid_at_ = now;
  }
  probe_debt_ = std::max(0.0, probe_debt_ - PROBE_SHARE * toSeconds(now - probe_paid_at_)) + toSeconds(cost);
  probe_allowance_ = std::min(
      probe_allowance_, probe_debt_ + 4.0 * static_cast<double>(lanes_.size()) * toSeconds(scene_.longestExchange()));
  probe_paid_at_ = now;
  if (probe_debt_ > probe_allowance_ + 2.0 * toSeconds(scene_.longestExchange()))
  {
    fail(now, "probes of dead drives take at most 5 % of the time",
         text(probe_debt_) + " s beyond their share, " + text(probe_allowance_) + " s are allowed for");
  }
}

void Checker::onFrame(TimePoint now, const simulation::FrameRecord& frame)
{
  if (frame.source == Source::Master || frame.source == Source::ForeignMaster)
  {
    const bool ours = frame.source == Source::Master;
    const RequestFacts facts = readRequest(scene_, frame.bytes);
    if (frame.remark.empty() && facts.inverter)
    {
      lanes_[*facts.inverter].heard = frame.bytes;
      lanes_[*facts.inverter].served = ours ? exchange_ : 0;
      noteHeard(now, *facts.inverter);
      // What it answers is what it has now, not at the end of the exchange.
      sample(now, *facts.inverter);
      if (facts.reset)
      {
        // It starts anew, and its supervision with it.
        lanes_[*facts.inverter].last_heard.reset();
      }
    }
    return;
  }
  if (frame.source != Source::Drive)
  {
    return;
  }
  for (std::size_t index = 0; index < lanes_.size(); ++index)
  {
    if (scene_.inverters[index].name == frame.drive)
    {
      takeReply(now, frame, index);
    }
  }
}

/// Rule 3.12, as the drive itself sees it.
void Checker::noteHeard(TimePoint end, std::size_t index)
{
  Lane& lane = lanes_[index];
  const double timeout = scene_.inverters[index].drive_timeout;
  const std::optional<TimePoint> before = lane.last_heard;
  lane.last_heard = end;
  if (!before || timeout == 0.0 || end - *before <= seconds(timeout) || !lane.timeout_known || !lane.online)
  {
    return;
  }
  const TimePoint from = *before - seconds(0.5);
  const auto lost = std::count_if(unanswered_.begin(), unanswered_.end(), [&](TimePoint time) { return time >= from; });
  const bool calm = disturbed_at_ < from && connected_since_ < from && lane.online_since < from && lost <= 1;
  if (calm && !shutting_down_ && lane.status.run_command && !(budget_warns_ && budget_warns_(index)))
  {
    fail(end, "a running drive is served within its own communication time-out",
         nameOf(index) + " heard nothing for " + text(toSeconds(end - *before)) + " s, its time-out is " +
             text(timeout) + " s");
  }
}

/// A reply that bears another drive's station, and the shape of what that one was asked and has not answered yet, can't be
/// told from its late reply.
void Checker::noteImitation(TimePoint now, const simulation::FrameRecord& frame, std::size_t index)
{
  const auto bears = bearerOf(scene_, frame.bytes);
  if (bears && *bears != index)
  {
    lanes_[*bears].imitated_at = now;
  }
}

void Checker::takeReply(TimePoint now, const simulation::FrameRecord& frame, std::size_t index)
{
  noteImitation(now, frame, index);
  Lane& lane = lanes_[index];
  lane.silences = 0;
  lane.reply_end = frame.time;
  unsigned refusal = 0;
  // Whether it was damaged, its check sum tells: what collided may be the noise before it.
  const bool prompt = in_flight_ && lane.served == exchange_ && facts_.inverter == index;
  if (!prompt)
  {
    // A stop is exempt from rule 3.9: the late reply to its first frame may stand for the second one.
    const bool of_stop = lane.served != 0 && readRequest(scene_, lane.heard).stop;
    if (of_stop && readNoisyReply(lane.heard, frame.bytes, refusal) == ReplyKind::NORMAL)
    {
      lane.stop_replied = now;
      lane.needs_stop_reply = lane.needs_stop_reply && lane.stop_sent < lane.locked_at;
      tryOpen(now, lane);
    }
    return;
  }
  const ReplyKind kind = readNoisyReply(request_, frame.bytes, refusal);
  if (kind != ReplyKind::OTHER)
  {
    notePromptReply(now, index, kind, refusal);
  }
}

/// Noise may stand before it.
ReplyKind Checker::readNoisyReply(const simulation::Bytes& request, const simulation::Bytes& reply,
                                  unsigned& refusal) const
{
  ReplyKind kind = readReply(scene_, request, reply, refusal);
  for (std::size_t skipped = 1; kind == ReplyKind::OTHER && skipped <= LONGEST_NOISE && skipped < reply.size();
       ++skipped)
  {
    const simulation::Bytes rest(reply.begin() + static_cast<std::ptrdiff_t>(skipped), reply.end());
    kind = readReply(scene_, request, rest, refusal);
  }
  return kind;
}

void Checker::notePromptReply(TimePoint now, std::size_t index, ReplyKind kind, unsigned refusal)
{
  Lane& lane = lanes_[index];
  answered_ = true;
  lane.lost_frames = facts_.commands() ? 0 : lane.lost_frames;
  lane.ends.push_back(now);
  if (lane.ends.size() > KEPT_ENDS)
  {
    lane.ends.pop_front();
  }
  world_.drives()[index]->advance(now);
  const bool good = kind == ReplyKind::NORMAL;
  lane.exception_at = good ? lane.exception_at : now;
  if (facts_.reads_frequency && good)
  {
    widen(index);
    lane.frequencies.push_back({ now, lane.least, lane.most });
    if (lane.frequencies.size() > KEPT_READS)
    {
      lane.frequencies.pop_front();
    }
  }
  if (facts_.reads_parameter)
  {
    lane.settings_read.insert(facts_.address);
    const auto wanted = settingsOf(index);
    lane.timeout_known = lane.timeout_known || (good && wanted.count(facts_.address) != 0 &&
                                                (facts_.address == 0x1450 || facts_.address == 0x0803));
  }
  if (facts_.reads_run)
  {
    lane.needs_stop_reply = lane.needs_stop_reply && !lane.stop_under_way;
    tryOpen(now, lane);
    // 1 to 3: the drive has no such read, and the acknowledged write has to do.
    const bool told = good || refusal <= 3;
    lane.run_read = told ? now : lane.run_read;
    const bool first = lane.stop_replied >= lane.stop_sent && lane.confirmed_at < lane.stop_replied;
    lane.confirmed_at = told && first ? now : lane.confirmed_at;
  }
  if (facts_.stop && good)
  {
    lane.stop_replied = now;
    lane.needs_stop_reply = lane.needs_stop_reply && sent_at_ < lane.locked_at && !lane.stop_under_way;

    tryOpen(now, lane);
  }
  if (facts_.run)
  {
    lane.run_answered = good || lane.run_answered;
    lane.run_reverse = good ? facts_.reverse : lane.run_reverse;
  }
  if (facts_.set_hertz && good)
  {
    lane.set_answered = facts_.set_hertz;
    lane.held = facts_.set_hertz;
  }
  const double steps = scene_.inverters[index].brand == Brand::JE ? 10.0 : 100.0;
  const bool newest = lane.set_answered && std::fabs(std::round(std::fabs(lane.hertz) * steps) -
                                                     std::round(*lane.set_answered * steps)) < 0.5;
  const bool complete = lane.permit && lane.run_answered && newest && lane.run_reverse == (lane.hertz < 0.0);
  lane.settled = good && (lane.settled || (facts_.commands() && complete));
  const bool told = facts_.reads_frequency && good;
  // The supply may have gone after the last byte, before anybody has looked at the reply.
  const bool latched = lane.cut_at > lane.reply_end ? lane.latched_at_cut : runLatched(index);
  lane.shown = told && scene_.inverters[index].brand == Brand::TOSHIBA && latched;
}

/// What each brand is asked for once after it has come, in the lowest class. Wire addresses: A001, A002, C076, C077 of MX2;
/// F803, F804.
std::set<unsigned> Checker::settingsOf(std::size_t index) const
{
  const InverterFacts& facts = scene_.inverters[index];
  if (facts.brand == Brand::HITACHI)
  {
    return facts.drive == "omron_mx2" ? std::set<unsigned>{ 0x1200, 0x1201, 0x144F, 0x1450 }
                                      : std::set<unsigned>{ 0x1200, 0x1201 };
  }
  return facts.brand == Brand::TOSHIBA ? std::set<unsigned>{ 0x0803, 0x0804 } : std::set<unsigned>{};
}

bool Checker::unreadSettings(std::size_t index) const
{
  const std::set<unsigned> wanted = settingsOf(index);
  const std::set<unsigned>& read = lanes_[index].settings_read;
  return !std::includes(read.begin(), read.end(), wanted.begin(), wanted.end());
}

/// The turn came to a drive that has lost an exchange: a loop-back goes before what is alike (rule 3.9).
bool Checker::clearsLineForSetting(TimePoint now) const
{
  if (!facts_.loopback || !facts_.inverter || !unreadSettings(*facts_.inverter))
  {
    return false;
  }
  const Lane& lane = lanes_[*facts_.inverter];
  return lane.first_time && lane.online && now - lane.lost_at < seconds(3.0);
}

/// Rule 3.14, for the time until each drive's settings have been read once.
void Checker::checkBackground(TimePoint now)
{
  bool waiting = false;
  unsigned supervised = 0;
  for (std::size_t index = 0; index < lanes_.size(); ++index)
  {
    Lane& lane = lanes_[index];
    supervised += scene_.inverters[index].drive_timeout > 0.0 ? 1 : 0;
    // After a lost exchange what is alike waits for a while (rule 3.9), and nobody asks a drive that is deaf after its reset.
    const bool undisturbed =
        (lane.lost_at == TimePoint() || now - lane.lost_at > seconds(3.0)) && now > lane.deaf_until;
    const bool unread = undisturbed && unreadSettings(index);
    waiting = waiting || (lane.first_time && lane.online && unread);
  }
  const bool counts = facts_.reads && !facts_.reads_run && !facts_.loopback;
  // One that a drive is told, and that it refuses for a while, has had the turn of one that is to be read.
  const bool its_turn = facts_.reads_parameter || facts_.writes_setting || clearsLineForSetting(now);
  if (!waiting || !counts || its_turn)
  {
    without_background_ = its_turn || !waiting ? 0 : without_background_;
    return;
  }
  if (++without_background_ > BACKGROUND_EVERY + READS_BY_DEADLINE * supervised + 2)
  {
    fail(now, "the lowest class gets every eighth exchange",
         std::to_string(without_background_) + " reads went before a setting that waits");
  }
}

// --- services --------------------------------------------------------------------------------------------------------------

std::function<void(const bus::Answer&)> Checker::asked(TimePoint now, const std::string& what, double bound,
                                                       std::function<void(const bus::Answer&)> judge)
{
  const std::uint64_t id = next_call_++;
  calls_[id] = { what, now + seconds(bound + SERVICE_SLACK_S) };
  ++statistics_.services;
  return [this, id, what, judge](const bus::Answer& answer) {
    if (calls_.erase(id) == 0)
    {
      fail(now_(), "every service is answered once", what + " is answered twice");
    }
    if (answer.success && judge)
    {
      judge(answer);
    }
    if (!answer.success && answer.error_id == 0)
    {
      fail(now_(), "services", what + " failed without an error id: " + answer.message);
    }
  };
}

// --- what is published -------------------------------------------------------------------------------------------------------

void Checker::widen(std::size_t index)
{
  Lane& lane = lanes_[index];
  const Truth seen = truth(index);
  // It may have turned round meanwhile.
  lane.least = seen.direction * lane.sign < 0 ? 0.0 : std::min(lane.least, seen.hertz);
  lane.most = std::max(lane.most, seen.hertz);
  lane.sign = seen.direction;
}

void Checker::glance(TimePoint now)
{
  for (std::size_t index = 0; index < lanes_.size(); ++index)
  {
    world_.drives()[index]->advance(now);
    widen(index);
    sample(now, index);
    lanes_[index].statuses_tripped = unlistedTrip(index) ? lanes_[index].statuses_tripped : 0;
  }
}

void Checker::sample(TimePoint now, std::size_t index)
{
  Lane& lane = lanes_[index];
  const Truth seen = truth(index);
  if (seen.torque)
  {
    lane.samples.push_back({ now, *seen.torque });
  }
  while (!lane.samples.empty() && now - lane.samples.front().time > seconds(KEPT_SAMPLES_S))
  {
    lane.samples.pop_front();
  }
}

void Checker::published(TimePoint now, const bus::InverterStatus& status)
{
  ++statistics_.statuses;
  Lane& lane = lanes_[status.index];
  const bool faulted = status.monitor.faulted.value_or(false) || status.monitor.unknown_trip;
  const bool was_faulted =
      lane.heard_of && (lane.status.monitor.faulted.value_or(false) || lane.status.monitor.unknown_trip);
  if (status.communication_error)
  {
    if (lane.online)
    {
      checkWentOffline(now, status.index);
    }
    if (lane.online || !lane.heard_of)
    {
      probe_allowance_ += 3.0 * toSeconds(scene_.longestExchange());
      lockUp(now, lane, false);
    }
    lane.online = false;
    lane.first_time = false;
    lane.needs_status = true;
    lane.open_at.reset();
    lane.timeout_known = false;
    lane.due.reset();
    lane.zero_due.reset();
    lane.last_heard.reset();
    lane.stopping = true;
  }
  else if (status.has_stamp)
  {
    world_.drives()[status.index]->advance(now);
    sample(now, status.index);
    checkValues(now, status.index, status);
    checkTrip(now, status.index, status);
    if (!lane.online)
    {
      lane.online = true;
      lane.online_since = now;
      lane.timeout_known = lane.timeout_known || scene_.inverters[status.index].brand == Brand::TECO;
    }
    lane.needs_status = false;
    lane.needs_no_fault = lane.needs_no_fault && faulted;
    lane.stopping = status.stop_active;
  }
  if (faulted && !was_faulted)
  {
    // The first of its reads may have told of the trip long before the last one.
    const TimePoint before = lane.heard_of ? lane.status.stamp : now;
    lockUp(now, lane, false);
    for (auto& stream : lane.streams)
    {
      // A 0 that came between the two may have come after the lock.
      stream.second.neutral = stream.second.zeroed_at > before && stream.second.zeroed_at == stream.second.last;
    }
    lane.locked_at = before;
    lane.open_at = before;
    lane.needs_no_fault = true;
    lane.stopping = true;
  }
  if (status.locked && lane.permit)
  {
    // The drive did something by itself, and the node has noticed.
    const TimePoint accepted_at = lane.accepted_at;
    lockUp(now, lane, false);
    // It may have stopped long ago what had never started.
    lane.locked_at = accepted_at;
    lane.open_at = accepted_at;
  }
  if (!lane.heard_of || status.stamp != lane.status.stamp || status.communication_error)
  {
    lane.failed_reads = 0;
    lane.pause_before = lane.pause;
    lane.pause = Duration{ 0 };
  }
  tryOpen(now, lane);
  lane.heard_of = true;
  lane.status = status;
}

/// The drive says that it has tripped in a word that its profile does not know.
bool Checker::unlistedTrip(std::size_t index) const
{
  const InverterFacts& facts = scene_.inverters[index];
  if (facts.drive == "omron_rx")
  {
    return flag(index, "tripped") && value(index, "status_b") != "2";
  }
  return !facts.listed_trips.empty() && flag(index, "tripped") &&
         facts.listed_trips.count(std::stoi(value(index, "trip"))) == 0;
}

/// Rule 4.8, and 8.6 of the contract. The second status since then was asked for in whole after the trip.
void Checker::checkTrip(TimePoint now, std::size_t index, const bus::InverterStatus& status)
{
  Lane& lane = lanes_[index];
  if (!unlistedTrip(index))
  {
    lane.statuses_tripped = 0;
    return;
  }
  const bool whole = !lane.heard_of || lane.status.stamp != status.stamp;
  lane.statuses_tripped += whole && !status.communication_error ? 1 : 0;
  if (lane.statuses_tripped < 2)
  {
    return;
  }
  if (!status.locked)
  {
    fail(now, "a trip that no table lists is a trip", nameOf(index) + " is not locked");
  }
  if (runLatched(index) && !status.stop_active)
  {
    fail(now, "a trip that no table lists is a trip", nameOf(index) + " still has RUN on");
  }
  if (status.monitor.faulted)
  {
    fail(now, "a trip that no table lists is a trip", nameOf(index) + ": nobody knows whether it is tripped");
  }
}

/// The dead man must not say that nobody commands while somebody is refused.
void Checker::logged(TimePoint now, const std::string& line) const
{
  for (std::size_t index = 0; index < lanes_.size(); ++index)
  {
    const Lane& lane = lanes_[index];
    const bool silence = line.compare(0, scene_.inverters[index].name.size() + 26,
                                      scene_.inverters[index].name + ": stopping: no command for") == 0;
    const Duration timeout = seconds(scene_.inverters[index].command_timeout);
    if (silence && lane.refused_at && *lane.refused_at < lane.accepted_at + timeout)
    {
      fail(now, "refusals are told", nameOf(index) + ": the log says that no command came, but they were refused");
    }
  }
}

void Checker::checkValues(TimePoint now, std::size_t index, const bus::InverterStatus& status)
{
  Lane& lane = lanes_[index];
  const auto& ends = lane.ends;
  const bool imitated = lane.imitated_at != TimePoint() && now - lane.imitated_at < seconds(MEMORY_OF_LATE_S);
  const bool of_a_reply = std::find(ends.begin(), ends.end(), status.stamp) != ends.end();
  if (!ends.empty() && status.stamp >= ends.front() && !of_a_reply && !imitated)
  {
    fail(now, "no value from another request's reply",
         nameOf(index) + ": the stamp is not the end of a reply to a request that was waited for");
  }
  const std::optional<double>& hertz = status.monitor.output_frequency;
  if (hertz && !lane.frequencies.empty() && status.stamp >= lane.frequencies.front().end)
  {
    ++statistics_.values;
    const double tolerance = scene_.inverters[index].brand == Brand::JE ? 0.11 : 0.021;
    std::size_t looked_at = 0;
    bool fits = false;
    std::string seen;
    for (auto read = lane.frequencies.rbegin(); read != lane.frequencies.rend() && looked_at < READS_IN_QUESTION;
         ++read)
    {
      if (read->end <= status.stamp)
      {
        ++looked_at;
        fits = fits || (*hertz >= read->least - tolerance && *hertz <= read->most + tolerance);
        seen += " " + text(read->least) + "-" + text(read->most);
      }
    }
    if (looked_at > 0 && !fits)
    {
      fail(now, "no value older than its stamp, none from another drive",
           nameOf(index) + ": published " + text(*hertz) + " Hz, the motor had" + seen + " Hz");
    }
  }
  const std::optional<double>& torque = status.monitor.torque;
  // A status that is published once more keeps its stamp and what was read with it; the rest is of the last second.
  const Duration age = seconds(OLDEST_SLOW_VALUE_S) + scene_.longestExchange();
  const TimePoint oldest = std::min(status.stamp, now) - age;
  if (!torque || lane.samples.empty() || lane.samples.front().time > oldest)
  {
    return;
  }
  double least = 1e9;
  double most = -1e9;
  for (const Sample& sample : lane.samples)
  {
    const bool counts = (sample.time >= oldest && sample.time <= status.stamp) || sample.time >= now - age;
    least = counts ? std::min(least, sample.torque) : least;
    most = counts ? std::max(most, sample.torque) : most;
  }
  if (least <= most && (std::fabs(*torque) < least - TORQUE_TOLERANCE || std::fabs(*torque) > most + TORQUE_TOLERANCE))
  {
    fail(now, "slow values are at most 1 s old",
         nameOf(index) + ": published torque " + text(*torque) + " %, within the last second it was " + text(least) +
             " to " + text(most) + " %");
  }
}
}  // namespace fuzz
}  // namespace inverter_bus
