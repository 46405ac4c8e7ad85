// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_TEST_VIRTUAL_GATEWAY_H
#define INVERTER_BUS_TEST_VIRTUAL_GATEWAY_H

#include <algorithm>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "inverter_bus/simulation/simulated_bus.h"
#include "support/virtual_world.h"

namespace inverter_bus
{
/// A Modbus TCP gateway before the simulated line, in virtual time, as a port of the driver. Written from the Modbus
/// specifications, with what real gateways do beside them: one request after the other on the line, a time-out of its own
/// that keeps all others waiting, codes of its own, connections that it ends.
class VirtualGateway : public wire::Port
{
public:
  enum class Number
  {
    Same,
    Zero,
    PlusOne,
    Swapped
  };
  struct Behaviour
  {
    /// [s] it waits for a drive, so often.
    double silence = 0.3;
    int tries = 1;
    /// What follows: this exception; 0: nothing at all.
    int silent_code = 0x0B;
    /// Or it ends the connection in place of an answer.
    bool close_on_silence = false;
    /// [s] added to each request.
    double slow = 0.0;
    /// Stations that it refuses at once, with which code.
    std::map<int, int> refuse;
    bool answers_broadcast = false;
    /// [s] without traffic after which it ends the connection; 0: never.
    double idle_close = 0.0;
    /// Ends each connection at once, or at its first byte.
    bool close_at_once = false;
    bool close_at_first_byte = false;
    /// Takes everything and carries out nothing.
    bool mute = false;
    /// The next so many requests are neither carried out nor answered.
    int swallow = 0;
    /// Nothing listens at its port.
    bool gone = false;
    /// [s] until a connection is made.
    double connecting = 0.0;
    Number number = Number::Same;
    std::optional<int> unit;
    /// The next request that begins so is kept for `hold_time` [s] before it goes onto the line, once.
    wire::Bytes hold;
    double hold_time = 0.0;
    /// Others are not kept waiting by that, as where each connection has a queue of its own.
    bool hold_aside = false;
    /// What it says before it ends a connection.
    std::string words;
  };

  VirtualGateway(simulation::SimulatedBus& bus, AppointedClock& clock, double gap) : bus_(bus), clock_(clock), gap_(gap)
  {
  }

  Behaviour behaviour;

  // --- what tests look at ---------------------------------------------------------------------------------------------
  /// When each connection was asked for, and how many it has ended itself.
  const std::vector<TimePoint>& connections() const
  {
    return connections_;
  }
  std::size_t closed() const
  {
    return closed_;
  }
  /// Ended by the driver with RST.
  std::size_t abandoned() const
  {
    return abandoned_;
  }
  /// Most requests that ever waited in it at once, the one on the line included.
  std::size_t deepest() const
  {
    return deepest_;
  }
  /// A request that the driver no longer waits for is on the line.
  bool busy() const
  {
    return busy_;
  }
  /// [s] that it has spent waiting for drives that don't answer.
  double blocked() const
  {
    return blocked_;
  }
  /// Requests that `hold` was meant for.
  std::size_t held() const
  {
    return held_;
  }
  void hangUp()
  {
    closeByItself();
  }
  /// The connection is lost, not closed in good order.
  void cut()
  {
    closeByItself();
    cut_ = true;
  }

  // --- Port -----------------------------------------------------------------------------------------------------------
  wire::OpenResult open(std::string& error) override
  {
    if (!dialling_)
    {
      connections_.push_back(clock_.now());
      dialling_ = clock_.now() + seconds(behaviour.connecting);
    }
    if (clock_.now() < *dialling_)
    {
      clock_.sleepUntil(std::min(*dialling_, clock_.now() + std::chrono::milliseconds(50)));
      return clock_.now() < *dialling_ ? wire::OpenResult::Pending : open(error);
    }
    dialling_.reset();
    if (behaviour.gone)
    {
      error = "cannot connect to tcp://virtual: Connection refused";
      return wire::OpenResult::NotThere;
    }
    ++connection_;
    open_ = true;
    loss_ = wire::Loss::None;
    inbox_.clear();
    outbox_.clear();
    hung_up_ = false;
    cut_ = false;
    last_use_ = clock_.now();
    if (behaviour.close_at_once)
    {
      closeByItself();
    }
    return wire::OpenResult::Opened;
  }

  void close() override
  {
    open_ = false;
    ++connection_;
  }

  void abandon() override
  {
    ++abandoned_;
    close();
    loss_ = wire::Loss::None;
  }

  bool isOpen() const override
  {
    return open_;
  }

  std::string name() const override
  {
    return "tcp://virtual";
  }

  bool isNetwork() const override
  {
    return true;
  }

  wire::Loss lastLoss() const override
  {
    return loss_;
  }

  bool send(const wire::Bytes& frame) override
  {
    pump();
    if (hung_up_)
    {
      loss_ = cut_ ? wire::Loss::Gone : wire::Loss::ClosedByPeer;
      return false;
    }
    last_use_ = clock_.now();
    if (behaviour.close_at_first_byte)
    {
      closeByItself();
      return true;
    }
    if (behaviour.swallow > 0)
    {
      --behaviour.swallow;
      return true;
    }
    if (!behaviour.mute)
    {
      inbox_.insert(inbox_.end(), frame.begin(), frame.end());
      takeRequests();
      pump();
    }
    return true;
  }

  wire::ReceiveResult receive(wire::Bytes& buffer, TimePoint deadline) override
  {
    for (;;)
    {
      pump();
      if (!outbox_.empty())
      {
        buffer.insert(buffer.end(), outbox_.begin(), outbox_.end());
        outbox_.clear();
        return wire::ReceiveResult::Data;
      }
      if (hung_up_)
      {
        loss_ = cut_ ? wire::Loss::Gone : wire::Loss::ClosedByPeer;
        return wire::ReceiveResult::Gone;
      }
      if (clock_.now() >= deadline)
      {
        return wire::ReceiveResult::Silence;
      }
      const auto event = nextEvent();
      clock_.sleepUntil(event && *event > clock_.now() ? std::min(*event, deadline) : deadline);
    }
  }

  /// The gateway works on while nothing is connected to it.
  void pump()
  {
    while (pumpOnce())
    {
    }
    const bool idle = behaviour.idle_close > 0.0 && open_ && !busy_ && queue_.empty();
    if (idle && clock_.now() - last_use_ >= seconds(behaviour.idle_close))
    {
      closeByItself();
    }
  }

private:
  struct Job
  {
    unsigned connection = 0;
    std::uint16_t number = 0;
    wire::Bytes body;
  };
  static constexpr std::size_t HEADER = 6;

  static std::uint16_t crc(const wire::Bytes& bytes)
  {
    std::uint16_t value = 0xFFFF;
    for (const std::uint8_t byte : bytes)
    {
      value = static_cast<std::uint16_t>(value ^ byte);
      for (int bit = 0; bit < 8; ++bit)
      {
        value = static_cast<std::uint16_t>((value & 1) != 0 ? (value >> 1) ^ 0xA001 : value >> 1);
      }
    }
    return value;
  }

  void closeByItself()
  {
    if (!open_ || hung_up_)
    {
      return;
    }
    outbox_.insert(outbox_.end(), behaviour.words.begin(), behaviour.words.end());
    hung_up_ = true;
    ++closed_;
  }

  void takeRequests()
  {
    while (inbox_.size() > HEADER)
    {
      const std::size_t length = static_cast<std::size_t>(inbox_[4] << 8 | inbox_[5]);
      if (inbox_.size() < HEADER + length)
      {
        return;
      }
      const auto begin = inbox_.begin();
      Job job;
      job.connection = connection_;
      job.number = static_cast<std::uint16_t>(inbox_[0] << 8 | inbox_[1]);
      job.body.assign(begin + HEADER, begin + static_cast<std::ptrdiff_t>(HEADER + length));
      inbox_.erase(begin, begin + static_cast<std::ptrdiff_t>(HEADER + length));
      queue_.push_back(job);
      deepest_ = std::max(deepest_, queue_.size() + (busy_ ? 1 : 0));
    }
  }

  /// One step that is due now; false: nothing is.
  bool pumpOnce()
  {
    const TimePoint now = clock_.now();
    bus_.advance(now);
    for (const simulation::Delivery& delivery : bus_.takeOutput(now))
    {
      reply_.insert(reply_.end(), delivery.bytes.begin(), delivery.bytes.end());
      last_byte_ = now;
    }
    if (!busy_)
    {
      reply_.clear();
      if (aside_ && now >= aside_at_)
      {
        queue_.push_front(*aside_);
        aside_.reset();
      }
      return !queue_.empty() && now >= ready_at_ && begin(now);
    }
    if (reply_.empty() ? now < give_up_at_ : now < last_byte_ + seconds(gap_))
    {
      return false;
    }
    reply_.empty() ? giveUp(now) : finish(now);
    return true;
  }

  bool begin(TimePoint now)
  {
    const wire::Bytes& hold = behaviour.hold;
    const wire::Bytes& next = queue_.front().body;
    if (!hold.empty() && next.size() >= hold.size() && std::equal(hold.begin(), hold.end(), next.begin()))
    {
      ++held_;
      behaviour.hold.clear();
      if (behaviour.hold_aside)
      {
        aside_ = queue_.front();
        aside_at_ = now + seconds(behaviour.hold_time);
        queue_.pop_front();
        return true;
      }
      ready_at_ = now + seconds(behaviour.hold_time);
      return true;
    }
    job_ = queue_.front();
    queue_.pop_front();
    busy_ = true;
    tried_ = 0;
    const auto refused = behaviour.refuse.find(job_.body[0]);
    if (refused != behaviour.refuse.end())
    {
      end(now,
          { job_.body[0], static_cast<std::uint8_t>(job_.body[1] | 0x80), static_cast<std::uint8_t>(refused->second) });
      return true;
    }
    transmit(now);
    return true;
  }

  void transmit(TimePoint now)
  {
    wire::Bytes frame = job_.body;
    const std::uint16_t check = crc(frame);
    frame.push_back(static_cast<std::uint8_t>(check & 0xFF));
    frame.push_back(static_cast<std::uint8_t>(check >> 8));
    reply_.clear();
    bus_.send(frame, now);
    ++tried_;
    const bool broadcast = job_.body[0] == 0;
    // A broadcast is over when it has left; no drive answers it.
    give_up_at_ = now + seconds((broadcast ? 0.02 : behaviour.silence) + behaviour.slow);
  }

  void giveUp(TimePoint now)
  {
    const bool broadcast = job_.body[0] == 0;
    if (broadcast)
    {
      broadcastOver(now);
      return;
    }
    blocked_ += behaviour.silence;
    if (tried_ < behaviour.tries)
    {
      transmit(now);
      return;
    }
    if (behaviour.close_on_silence && job_.connection == connection_)
    {
      closeByItself();
    }
    const auto code = static_cast<std::uint8_t>(behaviour.silent_code);
    end(now, code != 0 && !behaviour.close_on_silence
                 ? wire::Bytes{ job_.body[0], static_cast<std::uint8_t>(job_.body[1] | 0x80), code }
                 : wire::Bytes());
  }

  void broadcastOver(TimePoint now)
  {
    end(now, behaviour.answers_broadcast ? wire::Bytes(job_.body.begin(), job_.body.begin() + 6) : wire::Bytes());
  }

  void finish(TimePoint now)
  {
    const wire::Bytes body(reply_.begin(),
                           reply_.end() - std::min<std::ptrdiff_t>(2, static_cast<std::ptrdiff_t>(reply_.size())));
    const std::uint16_t check = crc(body);
    const bool whole = reply_.size() > 4 && reply_[reply_.size() - 2] == (check & 0xFF) && reply_.back() == check >> 8;
    end(now, whole ? body : wire::Bytes{ job_.body[0], static_cast<std::uint8_t>(job_.body[1] | 0x80), 0x0B });
  }

  void end(TimePoint now, wire::Bytes body)
  {
    busy_ = false;
    ready_at_ = now + seconds(gap_ + behaviour.slow);
    last_use_ = now;
    if (body.empty() || job_.connection != connection_ || !open_ || hung_up_)
    {
      return;
    }
    if (behaviour.unit)
    {
      body[0] = static_cast<std::uint8_t>(*behaviour.unit);
    }
    const std::uint16_t number = numberOf(job_.number);
    const wire::Bytes head{ static_cast<std::uint8_t>(number >> 8), static_cast<std::uint8_t>(number & 0xFF), 0, 0, 0,
                            static_cast<std::uint8_t>(body.size()) };
    outbox_.insert(outbox_.end(), head.begin(), head.end());
    outbox_.insert(outbox_.end(), body.begin(), body.end());
  }

  std::uint16_t numberOf(std::uint16_t number) const
  {
    switch (behaviour.number)
    {
      case Number::Zero:
        return 0;
      case Number::PlusOne:
        return static_cast<std::uint16_t>(number + 1);
      case Number::Swapped:
        return static_cast<std::uint16_t>(number << 8 | number >> 8);
      case Number::Same:
        break;
    }
    return number;
  }

  std::optional<TimePoint> nextEvent() const
  {
    std::optional<TimePoint> next = bus_.nextEvent();
    const auto consider = [&](TimePoint time) { next = next ? std::min(*next, time) : time; };
    if (busy_)
    {
      consider(reply_.empty() ? give_up_at_ : last_byte_ + seconds(gap_));
    }
    if (!busy_ && !queue_.empty())
    {
      consider(ready_at_);
    }
    if (aside_)
    {
      consider(std::max(aside_at_, ready_at_));
    }
    if (behaviour.idle_close > 0.0 && open_)
    {
      consider(last_use_ + seconds(behaviour.idle_close));
    }
    return next;
  }

  simulation::SimulatedBus& bus_;
  AppointedClock& clock_;
  double gap_;
  bool open_ = false;
  bool hung_up_ = false;
  bool cut_ = false;
  wire::Loss loss_ = wire::Loss::None;
  std::optional<TimePoint> dialling_;
  unsigned connection_ = 0;
  std::vector<TimePoint> connections_;
  std::size_t closed_ = 0;
  std::size_t abandoned_ = 0;
  std::size_t deepest_ = 0;
  double blocked_ = 0.0;
  std::size_t held_ = 0;
  wire::Bytes inbox_;
  wire::Bytes outbox_;
  std::deque<Job> queue_;
  std::optional<Job> aside_;
  TimePoint aside_at_;
  bool busy_ = false;
  Job job_;
  int tried_ = 0;
  wire::Bytes reply_;
  TimePoint last_byte_;
  TimePoint give_up_at_;
  TimePoint ready_at_;
  TimePoint last_use_;
};
}  // namespace inverter_bus

#endif  // INVERTER_BUS_TEST_VIRTUAL_GATEWAY_H
