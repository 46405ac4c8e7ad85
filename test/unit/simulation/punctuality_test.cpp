// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

// A wire that is woken late hands bytes over late. What it plans must not be late for that: each instant is worked out from
// the request's first byte, not from the instants that were kept before it.

#include "inverter_bus/simulation/punctuality.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "inverter_bus/simulation/simulated_bus.h"
#include "simulation/modbus/modbus_frame.h"

namespace inverter_bus
{
namespace simulation
{
namespace
{
using std::chrono::microseconds;

/// Reads of four registers of one MX2, asked for and played by a host that comes late by chance, up to 300 us each time.
class LateHost
{
public:
  explicit LateHost(int baud)
    : bus_(busConfigFromText("baud_rate: " + std::to_string(baud) +
                             "\nscan_list: [{name: a, node: 1, drive: omron_mx2}]\n"
                             "simulation: {a: {turnaround: 0.003}}\n"),
           LineOptions(), now_)
  {
    bus_.setObserver([this](const FrameRecord& frame) { frames_.push_back(frame); });
  }

  void ask()
  {
    bus_.send(withModbusCrc({ 0x01, 0x03, 0x10, 0x00, 0x00, 0x04 }), now_);
    for (auto next = bus_.nextEvent(); next; next = bus_.nextEvent())
    {
      now_ = std::max(now_, *next) + microseconds(late_(random_));
      punctuality_.add(*next, now_);
      bus_.advance(now_);
      bus_.takeOutput(now_);
    }
    now_ += microseconds(20000);  // more than 3.5 characters at any rate
  }

  const Punctuality& punctuality() const
  {
    return punctuality_;
  }

  /// [s] from each request's first byte to its reply's first byte.
  std::vector<double> replies() const
  {
    std::vector<double> times;
    for (std::size_t index = 1; index < frames_.size(); index += 2)
    {
      EXPECT_EQ(frames_[index - 1].source, FrameRecord::Source::Master);
      EXPECT_EQ(frames_[index].source, FrameRecord::Source::Drive);
      times.push_back(toSeconds(frames_[index].time - frames_[index - 1].time));
    }
    return times;
  }

private:
  TimePoint now_ = TimePoint() + std::chrono::hours(1);
  SimulatedBus bus_;
  std::vector<FrameRecord> frames_;
  Punctuality punctuality_;
  std::mt19937 random_{ 1 };
  std::uniform_int_distribution<int> late_{ 0, 300 };
};

class WireTime : public ::testing::TestWithParam<int>
{
};

TEST_P(WireTime, whatAWireOfALateHostPlansIsRightWithinTwoPercentOfACharacter)
{
  LateHost host(GetParam());
  for (int exchange = 0; exchange < 500; ++exchange)
  {
    host.ask();
  }
  const double character = 10.0 / GetParam();  // start, eight data bits, stop
  const double silence = GetParam() > 19200 ? 0.00175 : 3.5 * character;
  const double ideal = 8 * character + silence + 0.003;
  double sum = 0.0;
  double worst = 0.0;
  for (const double time : host.replies())
  {
    sum += std::abs(time - ideal);
    worst = std::max(worst, std::abs(time - ideal));
  }
  ASSERT_EQ(host.replies().size(), 500U);
  EXPECT_LT(sum / 500, 0.02 * character);
  EXPECT_LT(worst, 0.02 * character) << "it does not add up over 500 exchanges either";
  // It was a late host: what it kept is nowhere near that at high rates.
  EXPECT_GT(host.punctuality().mean(), 100e-6);
}

INSTANTIATE_TEST_SUITE_P(Rates, WireTime, ::testing::Values(2400, 9600, 19200, 115200));

TEST(Punctuality, countsWhatIsLateAndTakesEarlyForExact)
{
  Punctuality punctuality;
  EXPECT_EQ(punctuality.count(), 0U);
  EXPECT_EQ(punctuality.mean(), 0.0);
  const TimePoint planned = TimePoint() + std::chrono::hours(1);
  punctuality.add(planned, planned + microseconds(30));
  punctuality.add(planned, planned + microseconds(60));
  punctuality.add(planned, planned - microseconds(90));
  EXPECT_EQ(punctuality.count(), 3U);
  EXPECT_DOUBLE_EQ(punctuality.mean(), 30e-6);
  EXPECT_DOUBLE_EQ(punctuality.latest(), 60e-6);
}
}  // namespace
}  // namespace simulation
}  // namespace inverter_bus
