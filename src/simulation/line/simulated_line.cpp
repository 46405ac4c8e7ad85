// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

#include "inverter_bus/simulation/simulated_line.h"

#include <algorithm>

#include "simulation/compoway/compoway_frame.h"
#include "simulation/line/wire.h"

namespace inverter_bus
{
namespace simulation
{
using Source = FrameRecord::Source;

namespace
{
constexpr std::size_t LONGEST_UNFINISHED = 256;  // [bytes] no drive keeps more than this without an end

std::string stationOf(const Bytes& frame, Protocol protocol)
{
  if (protocol == Protocol::ModbusRtu)
  {
    return std::to_string(frame.front());
  }
  const std::optional<Bytes> found = findCompowayFrame(frame);
  return found ? compowayBody(*found).substr(0, 2) : std::string();
}
}  // namespace

SimulatedLine::SimulatedLine(const LineOptions& options, TimePoint start)
  : options_(options)
  , gap_(options.settings.frameGap())
  , end_(options.settings.frameEnd())
  , wire_(std::make_unique<Wire>(options.settings, options.seed, start - std::chrono::hours(1)))
  , last_seen_(wire_->lastActivity())
{
}

SimulatedLine::~SimulatedLine() = default;

void SimulatedLine::attach(SimulatedDrive& drive)
{
  drive.setLine(options_.settings);
  drives_.push_back(&drive);
}

void SimulatedLine::setObserver(std::function<void(const FrameRecord&)> observer)
{
  observer_ = std::move(observer);
}

const LineCounters& SimulatedLine::counters() const
{
  return counters_;
}

void SimulatedLine::clearCounters()
{
  counters_ = LineCounters();
}

const LineOptions& SimulatedLine::options() const
{
  return options_;
}

bool SimulatedLine::idle() const
{
  return wire_->live().empty() && owed_.empty() && waiting_.empty();
}

void SimulatedLine::setEcho(bool on)
{
  echo_ = on;
}

void SimulatedLine::setSilent(bool on)
{
  silent_ = on;
}

void SimulatedLine::setMaster(const LineSettings& settings, TimePoint now)
{
  advance(now);
  options_.settings = settings;
  wire_->set(settings);
  gap_ = settings.frameGap();
  end_ = settings.frameEnd();
  for (SimulatedDrive* drive : drives_)
  {
    drive->setLine(settings);
  }
}

void SimulatedLine::setConnected(bool connected, TimePoint now)
{
  advance(now);
  connected_ = connected;
  output_.clear();
  Transmission* sending = wire_->openRequest(Source::Master);
  if (!connected && sending != nullptr)
  {
    wire_->breakOff(*sending, now);
  }
}

TimePoint SimulatedLine::dueTime(const Transmission& transmission) const
{
  const TimePoint end = wire_->endOf(transmission);
  if (transmission.for_master && transmission.delivered < transmission.bytes.size())
  {
    const TimePoint first = transmission.bytes[transmission.delivered].start + wire_->characterTime();
    const bool whole = options_.delivery_step == Duration::zero();
    return whole ? end : std::min(end, first + options_.delivery_step);
  }
  return transmission.isRequest() ? end + end_ : end;
}

void SimulatedLine::send(Transmission& transmission, const Bytes& bytes, TimePoint start)
{
  counters_.collisions += wire_->append(transmission, bytes, start);
}

void SimulatedLine::receive(const Bytes& bytes, TimePoint now)
{
  advance(now);
  if (!connected_ || bytes.empty())
  {
    return;
  }
  Transmission* sending = wire_->openRequest(Source::Master);
  const bool next_frame = sending != nullptr && wholeForAny(sending->values());
  const TimePoint start = sending == nullptr ? now : std::max(now, wire_->endOf(*sending));
  const bool in_time = sending != nullptr && now + options_.gap_tolerance >= wire_->endOf(*sending) + gap_;
  if (next_frame && (in_time || options_.gap == GapRule::Ignore))
  {
    finishRequest(*sending);
    sending = nullptr;
  }
  if (sending == nullptr)
  {
    const TimePoint silent_since = std::max(wire_->lastActivity(), last_seen_);
    sending = &wire_->open(Source::Master);
    sending->early = unfinished_.empty() && start + options_.gap_tolerance < silent_since + gap_;
    sending->for_master = echo_;
  }
  sending->joined = sending->joined || (next_frame && !sending->bytes.empty());
  send(*sending, bytes, start);
}

void SimulatedLine::sendForeign(const Bytes& frame, bool wait, TimePoint now)
{
  advance(now);
  if (!frame.empty())
  {
    waiting_.push_back({ wait ? std::max(now, wire_->lastActivity() + gap_) : now, frame });
    advance(now);
  }
}

void SimulatedLine::sendNoise(std::size_t count, TimePoint now)
{
  advance(now);
  if (count > 0)
  {
    send(wire_->open(Source::Noise), wire_->noise(count), now);
  }
}

std::optional<TimePoint> SimulatedLine::nextEvent() const
{
  std::optional<TimePoint> next;
  const auto consider = [&next](TimePoint time) { next = next ? std::min(*next, time) : time; };
  for (const Transmission& transmission : wire_->live())
  {
    consider(dueTime(transmission));
  }
  for (const Owed& owed : owed_)
  {
    consider(owed.start);
  }
  for (const WaitingForeign& waiting : waiting_)
  {
    consider(waiting.start);
  }
  return next;
}

void SimulatedLine::advance(TimePoint now)
{
  for (std::optional<TimePoint> next = nextEvent(); next && *next <= now; next = nextEvent())
  {
    process(*next);
  }
}

void SimulatedLine::process(TimePoint time)
{
  processForeign(time);
  processOwed(time);
  for (std::size_t i = 0; i < wire_->live().size(); ++i)
  {
    Transmission& transmission = wire_->live()[i];
    if (dueTime(transmission) <= time)
    {
      processTransmission(transmission, time);
    }
  }
  wire_->removeOver();
}

void SimulatedLine::processForeign(TimePoint time)
{
  for (std::size_t i = 0; i < waiting_.size(); ++i)
  {
    if (waiting_[i].start > time)
    {
      continue;
    }
    const Bytes bytes = waiting_[i].bytes;
    waiting_.erase(waiting_.begin() + static_cast<std::ptrdiff_t>(i));
    ++counters_.foreign;
    send(wire_->open(Source::ForeignMaster), bytes, time);
    return;
  }
}

void SimulatedLine::processOwed(TimePoint time)
{
  const auto later = [time](const Owed& owed) { return owed.start > time; };
  const auto due = std::stable_partition(owed_.begin(), owed_.end(), later);
  const std::vector<Owed> now_due(due, owed_.end());
  owed_.erase(due, owed_.end());
  for (const Owed& owed : now_due)
  {
    owed.drive->advance(time);
    if (owed.drive->canSend() && !silent_ && !owed.bytes.empty())
    {
      Transmission& reply = wire_->open(Source::Drive);
      reply.drive = owed.drive;
      send(reply, owed.bytes, owed.start);
    }
  }
}

void SimulatedLine::processTransmission(Transmission& transmission, TimePoint time)
{
  if (transmission.for_master && transmission.delivered < transmission.bytes.size())
  {
    deliver(transmission, time);
  }
  if (dueTime(transmission) > time)
  {
    return;
  }
  transmission.over = true;
  if (transmission.isRequest())
  {
    finishRequest(transmission);
  }
  else
  {
    finishReply(transmission);
  }
}

void SimulatedLine::deliver(Transmission& transmission, TimePoint time)
{
  Delivery delivery;
  while (transmission.delivered < transmission.bytes.size())
  {
    const WireByte& byte = transmission.bytes[transmission.delivered];
    if (byte.start + wire_->characterTime() > time)
    {
      break;
    }
    delivery.time = byte.start + wire_->characterTime();
    delivery.bytes.push_back(byte.value);
    ++transmission.delivered;
  }
  if (connected_ && !delivery.bytes.empty())
  {
    output_.push_back(std::move(delivery));
  }
}

std::vector<Delivery> SimulatedLine::takeOutput(TimePoint now)
{
  std::vector<Delivery> output;
  output.swap(output_);
  if (!output.empty())
  {
    last_seen_ = std::max(last_seen_, now);
  }
  return output;
}

bool SimulatedLine::wholeForAny(const Bytes& frame) const
{
  return std::any_of(drives_.begin(), drives_.end(),
                     [&frame](const SimulatedDrive* drive) { return drive->isWholeFrame(frame); });
}

bool SimulatedLine::owes(const SimulatedDrive* drive) const
{
  return std::any_of(owed_.begin(), owed_.end(), [drive](const Owed& owed) { return owed.drive == drive; }) ||
         std::any_of(wire_->live().begin(), wire_->live().end(),
                     [drive](const Transmission& one) { return one.drive == drive; });
}

/// \p bytes are what was sent, and become the frame that the drives make of it. False: they wait for more.
bool SimulatedLine::takeFrame(Bytes& bytes)
{
  if (options_.settings.protocol == Protocol::ModbusRtu)
  {
    return true;
  }
  unfinished_.insert(unfinished_.end(), bytes.begin(), bytes.end());
  const std::optional<Bytes> frame = findCompowayFrame(unfinished_);
  if (frame)
  {
    bytes = *frame;
  }
  const auto start = std::find(unfinished_.rbegin(), unfinished_.rend(), COMPOWAY_STX);
  if (frame || start == unfinished_.rend() || unfinished_.size() > LONGEST_UNFINISHED)
  {
    unfinished_.clear();
  }
  return frame.has_value();
}

void SimulatedLine::finishRequest(Transmission& transmission)
{
  if (transmission.served || transmission.bytes.empty())
  {
    return;
  }
  transmission.served = true;
  counters_.requests += transmission.source == Source::Master ? 1 : 0;
  Bytes frame = transmission.values();
  std::string remark;
  if (silent_)
  {
    remark = "lost: line cut";
  }
  else if (!takeFrame(frame))
  {
    remark = "unfinished";
  }
  else if ((transmission.early || transmission.joined) && options_.gap == GapRule::Enforce)
  {
    remark = "lost: gap";
    ++counters_.lost_gap;
    for (SimulatedDrive* drive : drives_)
    {
      if (drive->addressedBy(frame))
      {
        drive->count(&ExchangeCounters::lost_gap);
      }
    }
  }
  else
  {
    serve(transmission, frame, wire_->endOf(transmission) + end_, remark);
  }
  report(transmission, remark);
}

void SimulatedLine::serve(const Transmission& transmission, const Bytes& frame, TimePoint time, std::string& remark)
{
  counters_.early += transmission.early ? 1 : 0;
  remark = transmission.early ? "early" : "";
  if (!wholeForAny(frame))
  {
    remark = transmission.collided ? "damaged: collision" : "damaged";
    ++counters_.damaged;
  }
  bool known = false;
  for (SimulatedDrive* drive : drives_)
  {
    if (!drive->addressedBy(frame))
    {
      continue;
    }
    known = true;
    if (transmission.early)
    {
      drive->count(&ExchangeCounters::early);
    }
    if (owes(drive))
    {
      drive->count(&ExchangeCounters::lost_busy);
      remark = "lost: busy with an earlier one";
      continue;
    }
    const std::uint64_t unheard = drive->counters().unheard;
    const std::optional<Answer> answer = drive->handle(frame, time);
    if (answer)
    {
      owed_.push_back({ time + answer->delay, drive, answer->bytes });
    }
    else if (drive->counters().unheard != unheard)
    {
      remark = drive->understandsLine() ? "lost: " + drive->name() + " does not listen"
                                        : "garbage to " + drive->name() + ": sent with " + options_.settings.text();
    }
  }
  if (!known && remark.empty())
  {
    remark = "no such station";
  }
}

void SimulatedLine::finishReply(Transmission& transmission)
{
  const bool reply = transmission.source == Source::Drive;
  counters_.replies += reply ? 1 : 0;
  report(transmission, transmission.collided ? "damaged: collision" : (reply ? "" : "noise"));
}

void SimulatedLine::report(const Transmission& transmission, const std::string& remark)
{
  if (observer_)
  {
    FrameRecord record;
    record.time = transmission.bytes.front().start;
    record.source = transmission.source;
    record.drive = transmission.drive != nullptr ? transmission.drive->name() : "";
    record.bytes = transmission.values();
    record.station = stationOf(record.bytes, options_.settings.protocol);
    record.remark = remark;
    observer_(record);
  }
}
}  // namespace simulation
}  // namespace inverter_bus
