// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

#include "inverter_bus/simulation/simulated_drive.h"

#include <algorithm>

namespace inverter_bus
{
namespace simulation
{
namespace
{
const Fault* find(const std::vector<Fault>& faults, FaultKind kind)
{
  const auto found =
      std::find_if(faults.begin(), faults.end(), [kind](const Fault& fault) { return fault.kind == kind; });
  return found == faults.end() ? nullptr : &*found;
}
}  // namespace

SimulatedDrive::SimulatedDrive(std::string name, int station, std::uint64_t seed, TimePoint start)
  : name_(std::move(name)), station_(station), random_(seed), clock_(start), deaf_until_(start)
{
}

SimulatedDrive::~SimulatedDrive() = default;

const std::string& SimulatedDrive::name() const
{
  return name_;
}

int SimulatedDrive::station() const
{
  return station_;
}

void SimulatedDrive::setStation(int station)
{
  station_ = station;
}

TimePoint SimulatedDrive::clock() const
{
  return clock_;
}

Random& SimulatedDrive::random()
{
  return random_;
}

Refusal SimulatedDrive::setLoad(double load, TimePoint now)
{
  advance(now);
  if (!(load >= 0.0 && load <= 3.0))
  {
    return "load out of range (0-3; 1 = rated torque)";
  }
  takeLoad(load);
  return std::nullopt;
}

void SimulatedDrive::setBusy(TimePoint until, TimePoint now)
{
  advance(now);
  takeBusy(until);
}

bool SimulatedDrive::powered() const
{
  return powered_;
}

bool SimulatedDrive::canSend() const
{
  return powered_ && online_;
}

bool SimulatedDrive::listening() const
{
  return canSend() && clock_ >= deaf_until_ && understandsLine();
}

bool SimulatedDrive::answersDamaged() const
{
  return false;
}

bool SimulatedDrive::understandsLine() const
{
  if (!serial_told_ || !serial_ || !line_)
  {
    return !serial_told_ || serial_;
  }
  return serial_->understands(*line_) && (!stop_bits_matter_ || serial_->stop_bits == line_->stop_bits);
}

void SimulatedDrive::setLine(const LineSettings& line)
{
  line_ = line;
}

void SimulatedDrive::setSerial(const std::optional<LineSettings>& serial, bool stop_bits_matter)
{
  stop_bits_matter_ = stop_bits_matter;
  serial_ = serial;
  serial_told_ = true;
}

void SimulatedDrive::goDeaf(TimePoint until)
{
  deaf_until_ = std::max(deaf_until_, until);
}

void SimulatedDrive::advance(TimePoint now)
{
  while (clock_ < now)
  {
    TimePoint next = now;
    if (power_returns_)
    {
      next = std::min(next, *power_returns_);
    }
    if (online_returns_)
    {
      next = std::min(next, *online_returns_);
    }
    next = std::max(clock_, nextChange(next));
    move(toSeconds(next - clock_));
    clock_ = next;
    changeConnection();
    change();
  }
}

void SimulatedDrive::changeConnection()
{
  if (power_returns_ && *power_returns_ <= clock_)
  {
    power_returns_.reset();
    powered_ = true;
    gainPower();
  }
  if (online_returns_ && *online_returns_ <= clock_)
  {
    setOnline();
  }
}

std::optional<Answer> SimulatedDrive::handle(const Bytes& frame, TimePoint now)
{
  advance(now);
  if (!addressedBy(frame))
  {
    return std::nullopt;
  }
  if (!listening())
  {
    ++counters_.unheard;
    return std::nullopt;
  }
  if (!isWholeFrame(frame))
  {
    ++counters_.damaged;
    if (!answersDamaged())
    {
      return std::nullopt;
    }
  }
  const bool for_all = isBroadcast(frame);
  const ExchangeFacts exchange{ functionOf(frame), accessOf(frame) };
  std::vector<Fault> faults = for_all ? std::vector<Fault>() : faults_.take(exchange, now);
  return serve(frame, exchange, std::move(faults), now);
}

std::optional<Answer> SimulatedDrive::serve(const Bytes& frame, const ExchangeFacts& exchange,
                                            std::vector<Fault> faults, TimePoint now)
{
  if (find(faults, FaultKind::LostRequest) != nullptr)
  {
    ++counters_.unheard;
    return std::nullopt;
  }
  const Fault* exception = find(faults, FaultKind::Exception);
  bool good = true;
  std::optional<Answer> reply = exception != nullptr
                                    ? std::optional<Answer>(exceptionAnswer(frame, static_cast<int>(exception->value)))
                                    : answer(frame, now, good);
  if (!good)
  {
    ++counters_.damaged;
    return std::nullopt;
  }
  if (!reply)
  {
    ++counters_.broadcasts;
    return std::nullopt;
  }
  ++counters_.exchanges;
  counters_.exceptions += reply->exception ? 1 : 0;
  const std::vector<Fault> of_long_ones = faults_.takeForReply(exchange, reply->bytes.size(), now);
  faults.insert(faults.end(), of_long_ones.begin(), of_long_ones.end());
  for (const Fault& fault : faults)
  {
    spoil(*reply, fault);
  }
  if (find(faults, FaultKind::LostReply) != nullptr)
  {
    return std::nullopt;
  }
  return reply;
}

void SimulatedDrive::spoil(Answer& answer, const Fault& fault)
{
  Bytes& bytes = answer.bytes;
  switch (fault.kind)
  {
    case FaultKind::Damaged:
      bytes[random_.below(bytes.size())] ^= random_.damage();
      break;
    case FaultKind::Truncated:
      bytes.resize(std::min(bytes.size() - 1, static_cast<std::size_t>(std::max(0.0, fault.value))));
      break;
    case FaultKind::Noise:
      for (int i = 0; i < static_cast<int>(fault.value); ++i)
      {
        bytes.insert(bytes.begin(), random_.byte());
      }
      break;
    case FaultKind::Late:
      answer.delay += seconds(fault.value);
      break;
    case FaultKind::ForeignStation:
      bytes = foreignReply(bytes, true);
      break;
    case FaultKind::ForeignShape:
      bytes = foreignReply(bytes, false);
      break;
    case FaultKind::LostRequest:
    case FaultKind::LostReply:
    case FaultKind::Exception:
      break;
  }
}

void SimulatedDrive::count(std::uint64_t ExchangeCounters::*counter)
{
  ++(counters_.*counter);
}

void SimulatedDrive::clearCounters()
{
  counters_ = ExchangeCounters();
}

const ExchangeCounters& SimulatedDrive::counters() const
{
  return counters_;
}

void SimulatedDrive::inject(const Fault& fault)
{
  faults_.add(fault);
}

void SimulatedDrive::clearFaults()
{
  faults_.clear();
}

void SimulatedDrive::setOffline(std::optional<TimePoint> until)
{
  online_ = false;
  online_returns_ = until;
}

void SimulatedDrive::setOnline()
{
  online_ = true;
  online_returns_.reset();
}

void SimulatedDrive::powerOff(TimePoint now, std::optional<TimePoint> until)
{
  advance(now);
  if (powered_)
  {
    losePower();
  }
  powered_ = false;
  power_returns_ = until;
}

void SimulatedDrive::powerCycle(TimePoint now)
{
  powerOff(now, now + seconds(2.0 + startUpTime()));
}

void SimulatedDrive::powerOn(TimePoint now)
{
  advance(now);
  power_returns_.reset();
  if (!powered_)
  {
    powered_ = true;
    goDeaf(now + seconds(startUpTime()));
    gainPower();
  }
}

Refusal SimulatedDrive::showTripAs(unsigned)
{
  return "this drive has no state word of its own";
}

KeyValues SimulatedDrive::describe() const
{
  KeyValues values{ { "name", name_ }, { "station", std::to_string(station_) } };
  describeMotor(values);
  const auto add = [&values](const char* key, std::uint64_t value) { values.emplace_back(key, std::to_string(value)); };
  add("powered", powered_ ? 1 : 0);
  add("online", online_ ? 1 : 0);
  add("listening", listening() ? 1 : 0);
  add("exchanges", counters_.exchanges);
  add("broadcasts", counters_.broadcasts);
  add("exceptions", counters_.exceptions);
  add("damaged_requests", counters_.damaged);
  add("unheard", counters_.unheard);
  add("lost_gap", counters_.lost_gap);
  add("early", counters_.early);
  add("lost_busy", counters_.lost_busy);
  add("faults_waiting", faults_.size());
  return values;
}
}  // namespace simulation
}  // namespace inverter_bus
