// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

// Random commands, stops and faults against a whole bus in virtual time. A failing seed repeats exactly.

#include <random>

#include "support/virtual_bus.h"

namespace inverter_bus
{
namespace
{
constexpr std::size_t INVERTERS = 3;
const char* const SCAN_LIST = R"(
port: /dev/virtual
baud_rate: 19200
scan_list:
  - {name: a, node: 1, drive: omron_mx2}
  - {name: b, node: 2, drive: omron_rx}
  - {name: c, node: 3, drive: omron_mx2, command_timeout: 0.3}
simulation:
  a: {parameters: {F002: 1.0, F003: 1.0}}
  b: {parameters: {F002: 1.0, F003: 1.0}}
  c: {parameters: {F002: 1.0, F003: 1.0}}
)";

/// What the rules allow an inverter to do, kept by the test itself from what it asked for.
struct Permit
{
  bool moving = false;
  TimePoint since;
};

class Chaos
{
public:
  explicit Chaos(unsigned seed) : random_(seed), bus_(SCAN_LIST)
  {
  }

  void play(double duration)
  {
    const TimePoint end = bus_.now() + seconds(duration);
    while (bus_.now() < end && !::testing::Test::HasFailure())
    {
      act();
      bus_.run(0.005 + 0.2 * chance() * chance());
      judge();
    }
  }

  /// Faults off: everything must come back, every lock must open.
  void calmDown()
  {
    bus_.world("bus plug");
    bus_.world("bus silent off");
    for (const char* name : NAMES)
    {
      bus_.world(std::string(name) + " clear");
      bus_.world(std::string(name) + " online");
    }
    bus_.run(4.0);
    judge();
    for (std::size_t index = 0; index < INVERTERS; ++index)
    {
      const bus::Answer answer = bus_.wait(bus_.reset(index));
      EXPECT_TRUE(answer.success) << NAMES[index] << ": " << answer.message;
    }
    const bool calm = bus_.runUntil(10.0, [&] {
      for (std::size_t index = 0; index < INVERTERS; ++index)
      {
        const bus::InverterStatus& status = bus_.status(index);
        if (status.communication_error || status.locked || status.stop_active ||
            bus_.now() - status.stamp > seconds(1.0))
        {
          return false;
        }
      }
      return true;
    });
    EXPECT_TRUE(calm) << "the bus did not come back: " << state();
    judge();
    for (std::size_t index = 0; index < INVERTERS; ++index)
    {
      EXPECT_EQ(bus_.command(index, 20.0), 0) << NAMES[index];
      bus_.run(0.2);
      EXPECT_EQ(bus_.motor(NAMES[index], "run_coil"), 1) << NAMES[index];
    }
  }

private:
  static constexpr const char* NAMES[INVERTERS] = { "a", "b", "c" };

  std::string state()
  {
    std::ostringstream text;
    for (std::size_t index = 0; index < INVERTERS; ++index)
    {
      const bus::InverterStatus& status = bus_.status(index);
      text << "\n"
           << NAMES[index] << ": offline " << status.communication_error << " locked " << status.locked << " stop "
           << status.stop_active << " error " << status.error_id << " age " << toSeconds(bus_.now() - status.stamp)
           << "\n  " << bus_.world(std::string(NAMES[index]) + " show");
    }
    return text.str();
  }

  double chance()
  {
    return std::uniform_real_distribution<double>(0.0, 1.0)(random_);
  }

  std::size_t anyone()
  {
    return std::uniform_int_distribution<std::size_t>(0, INVERTERS - 1)(random_);
  }

  void act()
  {
    const double dice = chance();
    const std::size_t index = anyone();
    if (dice < 0.55)
    {
      move(index, chance() < 0.15 ? 0.0 : 60.0 * (chance() - 0.5), chance() < 0.8 ? "/one" : "/two");
    }
    else if (dice < 0.62)
    {
      halt(index);
    }
    else if (dice < 0.66)
    {
      bus_.reset(index);
    }
    else if (dice < 0.75)
    {
      bus_.readParameter(index, "F002");
    }
    else if (dice < 0.78)
    {
      bus_.writeParameter(index, "F002", 1.0 + static_cast<int>(chance() * 10), chance() < 0.3);
    }
    else if (dice < 0.80)
    {
      bus_.readFaults(index);
    }
    else if (dice < 0.97)
    {
      harm(index);
    }
    else
    {
      bus_.world("bus unplug " + std::to_string(0.1 + chance()));
    }
  }

  void harm(std::size_t index)
  {
    const std::vector<std::string> faults{ "damaged count 1",
                                           "truncated count 1",
                                           "late 0.15 count 1",
                                           "late 0.05 count 2",
                                           "noise 4 count 1",
                                           "foreign station count 1",
                                           "foreign shape count 1",
                                           "exception 34 count 1",
                                           "power_cycle 0.02",
                                           "power_cycle 1.2",
                                           "trip 7",
                                           "panel_stop",
                                           "offline 0.4",
                                           "offline 2" };
    const std::size_t which = std::uniform_int_distribution<std::size_t>(0, faults.size() - 1)(random_);
    bus_.provoke(std::string(NAMES[index]) + " " + faults[which]);
  }

  void move(std::size_t index, double velocity, const std::string& publisher)
  {
    if (bus_.command(index, velocity, publisher) == 0)
    {
      permits_[index].moving = velocity != 0.0;
      permits_[index].since = bus_.now();
    }
  }

  void halt(std::size_t index)
  {
    bus_.stop(index);
    permits_[index].moving = false;
    stopped_at_[index] = bus_.now();
  }

  /// No RUN frame without an accepted command that is still in force.
  void judge()
  {
    for (const simulation::FrameRecord& frame : bus_.frames())
    {
      const simulation::Bytes& bytes = frame.bytes;
      const bool run = frame.source == simulation::FrameRecord::Source::Master && bytes.size() == 8 &&
                       bytes[1] == 0x05 && bytes[2] == 0 && bytes[3] == 0 && bytes[4] == 0xFF;
      if (!run)
      {
        continue;
      }
      const std::size_t index = bytes[0] - 1U;
      const double age = toSeconds(frame.time - permits_[index].since);
      const double timeout = bus_.configuration().bus.inverters[index].command_timeout;
      // A stop called after the frame had left is no offence of the frame.
      const bool stopped_later = frame.time < stopped_at_[index];
      EXPECT_TRUE(permits_[index].moving || stopped_later || frame.time <= permits_[index].since)
          << "RUN to station " << int(bytes[0]) << " without a command in force";
      EXPECT_LE(age, timeout + 0.35) << "RUN to station " << int(bytes[0]) << " for a command that is over";
    }
    bus_.clearFrames();
  }

  std::mt19937 random_;
  VirtualBus bus_;
  Permit permits_[INVERTERS];
  TimePoint stopped_at_[INVERTERS];
};

constexpr const char* Chaos::NAMES[INVERTERS];

class ChaosSeeds : public ::testing::TestWithParam<unsigned>
{
};

TEST_P(ChaosSeeds, neverRunWithoutACommandAndEndInCalm)
{
  Chaos chaos(GetParam());
  chaos.play(60.0);
  chaos.calmDown();
}

INSTANTIATE_TEST_SUITE_P(Seeds, ChaosSeeds, ::testing::Range(1U, 41U));
}  // namespace
}  // namespace inverter_bus
