// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
#ifndef INVERTER_BUS_TEST_FAKE_PORT_H
#define INVERTER_BUS_TEST_FAKE_PORT_H

#include <algorithm>
#include <deque>
#include <string>
#include <utility>
#include <vector>

#include "inverter_bus/wire/port.h"

namespace inverter_bus
{
namespace wire
{
/// Time that passes only during a wait.
class VirtualClock : public util::Clock
{
public:
  TimePoint now() const override
  {
    return now_;
  }

  void sleepUntil(TimePoint time) override
  {
    now_ = std::max(now_, time);
  }

  void advance(Duration duration)
  {
    now_ += duration;
  }

private:
  TimePoint now_ = TimePoint() + std::chrono::hours(1);
};

/// A port on virtual time. What the line answers is laid down before each send.
class FakePort : public Port
{
public:
  /// Bytes that arrive a while after the beginning of the request.
  struct Answer
  {
    Duration after;
    Bytes bytes;
  };
  using Answers = std::vector<Answer>;

  explicit FakePort(VirtualClock& clock) : clock_(clock)
  {
  }

  /// The next send for which nothing has been laid down yet is followed by \p answers.
  void answerNext(Answers answers)
  {
    answers_.push_back(std::move(answers));
  }

  /// \p bytes arrive \p after now, asked or not.
  void deliver(Duration after, const Bytes& bytes)
  {
    arriving_.push_back({ clock_.now() + after, bytes });
    std::stable_sort(arriving_.begin(), arriving_.end(),
                     [](const Arrival& left, const Arrival& right) { return left.time < right.time; });
  }

  /// Every frame comes back after the time that its bytes take, in pieces of \p piece bytes.
  void echo(Duration character, std::size_t piece = 256)
  {
    echo_character_ = character;
    echo_piece_ = piece;
  }

  void noEcho()
  {
    echo_piece_ = 0;
  }

  void unplug()
  {
    gone_ = true;
  }

  void plugIn()
  {
    gone_ = false;
  }

  /// What was still to arrive does not: another connection.
  void cutOff()
  {
    arriving_.clear();
    answers_.clear();
  }

  const std::vector<Bytes>& sent() const
  {
    return sent_;
  }

  OpenResult open(std::string& error) override
  {
    error = gone_ ? "unplugged" : "";
    open_ = !gone_;
    return open_ ? OpenResult::Opened : OpenResult::NotThere;
  }

  void close() override
  {
    open_ = false;
  }

  bool isOpen() const override
  {
    return open_;
  }

  std::string name() const override
  {
    return "fake";
  }

  bool send(const Bytes& frame) override
  {
    if (gone_)
    {
      return false;
    }
    sent_.push_back(frame);
    sendEcho(frame);
    if (!answers_.empty())
    {
      for (const Answer& answer : answers_.front())
      {
        deliver(answer.after, answer.bytes);
      }
      answers_.pop_front();
    }
    return true;
  }

  ReceiveResult receive(Bytes& buffer, TimePoint deadline) override
  {
    if (gone_)
    {
      return ReceiveResult::Gone;
    }
    const TimePoint latest = std::max(deadline, clock_.now());
    if (arriving_.empty() || arriving_.front().time > latest)
    {
      clock_.sleepUntil(latest);
      return ReceiveResult::Silence;
    }
    clock_.sleepUntil(arriving_.front().time);
    while (!arriving_.empty() && arriving_.front().time <= clock_.now())
    {
      const Bytes& bytes = arriving_.front().bytes;
      buffer.insert(buffer.end(), bytes.begin(), bytes.end());
      arriving_.pop_front();
    }
    return ReceiveResult::Data;
  }

private:
  struct Arrival
  {
    TimePoint time;
    Bytes bytes;
  };

  void sendEcho(const Bytes& frame)
  {
    for (std::size_t begin = 0; echo_piece_ != 0 && begin < frame.size(); begin += echo_piece_)
    {
      const std::size_t end = std::min(begin + echo_piece_, frame.size());
      deliver(echo_character_ * static_cast<int>(end), Bytes(frame.begin() + static_cast<std::ptrdiff_t>(begin),
                                                             frame.begin() + static_cast<std::ptrdiff_t>(end)));
    }
  }

  VirtualClock& clock_;
  std::deque<Answers> answers_;
  std::deque<Arrival> arriving_;
  std::vector<Bytes> sent_;
  Duration echo_character_{ 0 };
  std::size_t echo_piece_ = 0;
  bool open_ = false;
  bool gone_ = false;
};
}  // namespace wire
}  // namespace inverter_bus

#endif  // INVERTER_BUS_TEST_FAKE_PORT_H
