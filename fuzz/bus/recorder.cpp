// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#include "fuzz/bus/recorder.h"

#include <cmath>

namespace inverter_bus
{
namespace fuzz
{
namespace
{
constexpr std::size_t LONGEST_NOISE = 8;
// A VF-S15 restarts; no profile says more.
constexpr double DEAF_AFTER_RESET_S = 3.0;
constexpr double PAUSE_S = 0.025;  // contract, 8.12
constexpr double LEAST_PAUSE_S = 0.001;
constexpr double TIME_TOLERANCE_S = 2e-6;
}  // namespace

Recorder::Recorder(const Scene& scene, const Plant& plant)
  : scene_(scene), plant_(plant), observed_(scene), stations_(scene.inverters.size())
{
}

const Observed& Recorder::observed() const
{
  return observed_;
}

// --- the line --------------------------------------------------------------------------------------------------------

void Recorder::opened(TimePoint now)
{
  observed_.connected = true;
  observed_.connected_since = now;
}

void Recorder::lost(TimePoint now)
{
  observed_.connected = false;
  observed_.exchange.in_flight = false;
  for (InverterRecord& inverter : observed_.inverters)
  {
    inverter.words.shown = false;
    inverter.link.last_heard.reset();
  }
  disturbed(now);
}

void Recorder::disturbed(TimePoint now)
{
  observed_.disturbed_at = now;
}

void Recorder::heard(TimePoint now)
{
  observed_.heard_in_between = observed_.exchange.in_flight ? observed_.heard_in_between : now;
  observed_.exchange.heard_at = observed_.exchange.in_flight ? now : observed_.exchange.heard_at;
}

void Recorder::begins(TimePoint now, const simulation::Bytes& request)
{
  Exchange& exchange = observed_.exchange;
  const std::uint64_t number = exchange.number + 1;
  exchange = Exchange();
  exchange.in_flight = true;
  exchange.number = number;
  exchange.began = now;
  exchange.request = request;
  exchange.facts = readRequest(scene_, request);
  exchange.request_end = now + seconds(scene_.character * static_cast<double>(request.size()));
  if (!exchange.facts.inverter)
  {
    return;
  }
  RequestFacts& facts = exchange.facts;
  const InverterRecord& inverter = observed_.inverters[*facts.inverter];
  // MX2 and RX have a coil of its own for the direction: RUN says nothing about it.
  const bool undirected = scene_.inverters[*facts.inverter].brand == Brand::HITACHI;
  facts.reverse = facts.run && undirected ? inverter.order.hertz < 0.0 : facts.reverse;
  exchange.to_offline = inverter.told.any && !inverter.told.online;
  exchange.repeats_run =
      facts.run && inverter.words.run_answered && (undirected || inverter.words.run_reverse == facts.reverse);
  exchange.precedes_command = scene_.compoway && observed_.decidedBefore(now, inverter.order.accepted_at);
}

void Recorder::sent(TimePoint now)
{
  const Exchange& exchange = observed_.exchange;
  const RequestFacts& facts = exchange.facts;
  if (facts.broadcast)
  {
    return;
  }
  InverterRecord& inverter = observed_.inverters[*facts.inverter];
  Words& words = inverter.words;
  if (facts.run)
  {
    const bool counts = !exchange.repeats_run && inverter.order.valid && !exchange.precedes_command;
    words.run_copies += counts ? 1 : 0;
    words.run_sent = true;
    // Whether it runs is unknown until this one is answered.
    words.run_answered = words.run_answered && exchange.repeats_run;
  }
  // Words in force that are repeated with a refresh are no copies.
  if (facts.set_hertz && !(facts.run && words.shown))
  {
    // A block write sends all words at once, also where it is selected between the set-point and RUN.
    int& copies = facts.run ? words.run_set_copies : words.set_copies;
    copies += exchange.precedes_command ? 0 : 1;
  }
  if (facts.stop)
  {
    inverter.stop.sent = now;
    inverter.stop.active = true;
    words.run_answered = false;
    words.run_sent = false;
    words.settled = false;
    words.set_answered.reset();
  }
}

void Recorder::ended(TimePoint now)
{
  Exchange& exchange = observed_.exchange;
  exchange.in_flight = false;
  const RequestFacts& facts = exchange.facts;
  if (!facts.inverter)
  {
    return;
  }
  exchange.cut = givenUpEarly(now);
  InverterRecord& inverter = observed_.inverters[*facts.inverter];
  inverter.link.deaf_until = facts.reset ? now + seconds(DEAF_AFTER_RESET_S) : inverter.link.deaf_until;
  if (exchange.answered)
  {
    return;
  }
  if (exchange.cut)
  {
    // What a stop has cut was no try (contract, 8.4).
    Words& words = inverter.words;
    words.run_copies -= facts.run && words.run_copies > 0 ? 1 : 0;
    int& copies = facts.run ? words.run_set_copies : words.set_copies;
    copies -= facts.set_hertz && copies > 0 ? 1 : 0;
  }
  inverter.words.shown = false;
  inverter.words.settled = inverter.words.settled && !facts.commands();
  inverter.link.lost_at = facts.expects_reply ? now : inverter.link.lost_at;
  if (facts.set_hertz)
  {
    // Which set-point it has now is unknown.
    inverter.words.set_answered.reset();
    // What a stop has cut counts as no try (contract, 8.4), and goes again.
    int& copies = facts.run ? inverter.words.run_set_copies : inverter.words.set_copies;
    copies -= exchange.cut && copies > 0 ? 1 : 0;
  }
}

/// The exchange that ends has not had its time: neither that of the drive, nor, once something came, that of a pause.
bool Recorder::givenUpEarly(TimePoint now) const
{
  const Exchange& exchange = observed_.exchange;
  const double patience = scene_.inverters[*exchange.facts.inverter].response_timeout - TIME_TOLERANCE_S;
  const bool in_time = now - exchange.request_end < seconds(patience);
  const Duration since = now - exchange.heard_at;
  const bool heard = exchange.heard_at != TimePoint();
  // What ends it at once was taken for an answer: the late one to a stop can't be told from that.
  const bool paused = heard && (since >= seconds(PAUSE_S - TIME_TOLERANCE_S) || since < seconds(LEAST_PAUSE_S));
  return observed_.connected && !exchange.answered && exchange.facts.expects_reply && in_time && !paused;
}

void Recorder::reached(TimePoint now, std::size_t index, const simulation::Bytes& request, bool ours)
{
  stations_[index].request = request;
  stations_[index].exchange = ours ? observed_.exchange.number : 0;
  std::optional<TimePoint>& last_heard = observed_.inverters[index].link.last_heard;
  last_heard = now;
  if (readRequest(scene_, request).reset)
  {
    // It restarts, and its supervision with it.
    last_heard.reset();
  }
}

ReplyFacts Recorder::replied(TimePoint now, const simulation::FrameRecord& frame, std::size_t index)
{
  // A reply that bears another drive's station, and the shape of what that one was asked and has not answered yet,
  // can't be told from its late reply.
  const auto bearer = bearerOf(scene_, frame.bytes);
  if (bearer && *bearer != index)
  {
    observed_.inverters[*bearer].link.imitated_at = now;
  }
  Station& station = stations_[index];
  station.reply_began = frame.time;
  const Exchange& exchange = observed_.exchange;
  ReplyFacts reply;
  // Its check sum shows whether it was damaged: what collided may be the noise before it.
  if (exchange.in_flight && station.exchange == exchange.number && exchange.facts.inverter == index)
  {
    const ReplyKind kind = readNoisyReply(exchange.request, frame.bytes, reply.refusal);
    reply.good = kind == ReplyKind::NORMAL;
    reply.kind = kind == ReplyKind::OTHER ? ReplyFacts::Kind::Nothing : ReplyFacts::Kind::Answer;
    return reply;
  }
  // A stop is exempt from rule 3.9: the late reply to its first frame may pass for the second one's.
  const bool of_stop = station.exchange != 0 && readRequest(scene_, station.request).stop;
  if (of_stop && readNoisyReply(station.request, frame.bytes, reply.refusal) == ReplyKind::NORMAL)
  {
    reply.kind = ReplyFacts::Kind::LateStop;
  }
  return reply;
}

/// Noise may precede it.
ReplyKind Recorder::readNoisyReply(const simulation::Bytes& request, const simulation::Bytes& reply,
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

void Recorder::answered(TimePoint now, std::size_t index, const ReplyFacts& reply)
{
  InverterRecord& inverter = observed_.inverters[index];
  if (reply.kind == ReplyFacts::Kind::LateStop)
  {
    inverter.stop.acknowledged = now;
    return;
  }
  observed_.exchange.answered = true;
  const RequestFacts& facts = observed_.exchange.facts;
  inverter.link.timeout_known = inverter.link.timeout_known || (facts.reads_parameter && reply.good &&
                                                                tellsTimeout(scene_.inverters[index], facts.address));
  inverter.stop.acknowledged = facts.stop && reply.good ? now : inverter.stop.acknowledged;
  noteWords(index, reply.good);
  // The supply may have gone after the last byte, before the node has looked at the reply.
  const Station& station = stations_[index];
  const bool latched = inverter.link.cut_at > station.reply_began ? station.latched_at_cut : plant_.runLatched(index);
  inverter.words.shown =
      facts.reads_frequency && reply.good && scene_.inverters[index].brand == Brand::TOSHIBA && latched;
}

void Recorder::noteWords(std::size_t index, bool good)
{
  const RequestFacts& facts = observed_.exchange.facts;
  const Order& order = observed_.inverters[index].order;
  Words& words = observed_.inverters[index].words;
  if (facts.run)
  {
    words.run_answered = good || words.run_answered;
    words.run_reverse = good ? facts.reverse : words.run_reverse;
  }
  words.set_answered = facts.set_hertz && good ? facts.set_hertz : words.set_answered;
  const double steps = scene_.inverters[index].brand == Brand::JE ? 10.0 : 100.0;
  const bool newest = words.set_answered && std::fabs(std::round(std::fabs(order.hertz) * steps) -
                                                      std::round(*words.set_answered * steps)) < 0.5;
  const bool complete = order.valid && words.run_answered && newest && words.run_reverse == (order.hertz < 0.0);
  words.settled = good && (words.settled || (facts.commands() && complete));
}

// --- users -----------------------------------------------------------------------------------------------------------

void Recorder::booked(TimePoint now, std::size_t index, const bus::Publisher& publisher, bool zero)
{
  Stream& stream = observed_.inverters[index].streams[publisher.name];
  // Near zero is silence: a publisher that has sent nothing else yet has no spacing.
  stream.spacing = stream.last != TimePoint() ? now - stream.last : Duration{ 0 };
  stream.last = now;
  stream.zeroed_at = zero ? now : stream.zeroed_at;
  stream.topics.insert(publisher.topic);
}

void Recorder::bookedNearZero(std::size_t index, const bus::Publisher& publisher)
{
  observed_.inverters[index].streams[publisher.name].topics.insert(publisher.topic);
}

void Recorder::accepted(TimePoint now, std::size_t index, double hertz, const std::string& publisher)
{
  Order& order = observed_.inverters[index].order;
  Words& words = observed_.inverters[index].words;
  words.settled = words.settled && order.valid && std::fabs(hertz - order.hertz) < 1e-9;
  words.run_copies = 0;
  words.set_copies = 0;
  words.run_set_copies = 0;
  order.valid = true;
  order.accepted_at = now;
  order.hertz = hertz;
  order.fed = now;
  order.publisher = publisher;
}

void Recorder::forbidden(TimePoint now, std::size_t index)
{
  Order& order = observed_.inverters[index].order;
  order.ended_at = order.valid ? now : order.ended_at;
  order.valid = false;
  order.fed.reset();
  observed_.inverters[index].words.settled = false;
}

void Recorder::starved(std::size_t index)
{
  observed_.inverters[index].order.fed.reset();
}

void Recorder::stopRequested(std::size_t index)
{
  observed_.inverters[index].stop.active = true;
}

void Recorder::shutdownBegun()
{
  observed_.shutting_down = true;
}

// --- the drives, and what is published of them -----------------------------------------------------------------------

void Recorder::lostPower(TimePoint now, std::size_t index)
{
  stations_[index].latched_at_cut = plant_.runLatched(index);
  observed_.inverters[index].link.cut_at = now;
  observed_.inverters[index].link.last_heard.reset();
}

void Recorder::wentOffline(std::size_t index)
{
  InverterRecord& inverter = observed_.inverters[index];
  inverter.told.online = false;
  inverter.link.timeout_known = false;
  inverter.link.last_heard.reset();
  inverter.stop.active = true;
}

void Recorder::isOnline(const bus::InverterStatus& status)
{
  InverterRecord& inverter = observed_.inverters[status.index];
  const bool came = !inverter.told.online;
  inverter.told.online = true;
  // A 7200MA can't be asked for it: its profile says it.
  inverter.link.timeout_known =
      inverter.link.timeout_known || (came && scene_.inverters[status.index].brand == Brand::TECO);
  inverter.stop.active = status.stop_active;
}

void Recorder::published(const bus::InverterStatus& status)
{
  observed_.inverters[status.index].told.any = true;
  observed_.inverters[status.index].told.status = status;
}
}  // namespace fuzz
}  // namespace inverter_bus
