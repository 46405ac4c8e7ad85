// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

// What the rules of the driver make of a bus, without any host: the whole core against simulated drives in virtual time, with
// the same result on every machine. Prints one JSON object with the raw samples; benchmark/ makes tables and pictures of it.
//
//   virtual_benchmark refresh [--inverters 5] [--baud 19200] [--drive omron_mx2] [--seconds 60]
//   virtual_benchmark dead    [--inverters 31] [--dead 3] ...     live ones beside dead ones, and the same without them
//   virtual_benchmark stops   [--inverters 31] [--dead 3] [--fault silent|late|broken] [--instants 10000]
//   virtual_benchmark velocities [--inverters 5] [--load idle|full] [--instants 1000]
//   virtual_benchmark fifo    the same users, served in the order in which they come

#include <algorithm>
#include <boost/program_options.hpp>
#include <cstdlib>
#include <functional>
#include <iostream>
#include <optional>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "benchmark/figures.h"
#include "benchmark/plain_master.h"
#include "benchmark/scene.h"
#include "support/virtual_bus.h"

namespace
{
using namespace inverter_bus;
using namespace inverter_bus::benchmark;
namespace po = boost::program_options;

struct Options
{
  std::string what;
  Scene scene;
  double seconds = 60.0;
  unsigned dead = 0;
  std::string fault = "silent";
  std::string load = "full";
  unsigned instants = 10000;
};

constexpr double USERS_PERIOD_S = 0.02;       // velocities at 50 Hz
constexpr double LIBMODBUS_TIME_OUT_S = 0.5;  // its default
constexpr double TIME_OUT_S = 0.1;            // response_timeout as shipped
constexpr double PATIENCE_S = 120.0;

std::string nameOf(std::size_t index)
{
  return "belt_" + std::to_string(index + 1);
}

/// Dead drives are spread evenly over the line.
std::vector<bool> deadOnes(unsigned inverters, unsigned dead)
{
  std::vector<bool> marks(inverters, false);
  for (unsigned number = 0; number < dead; ++number)
  {
    marks[(2 * number + 1) * inverters / (2 * dead)] = true;
  }
  return marks;
}

std::string deathOf(std::size_t index, const std::string& fault)
{
  if (fault == "late")
  {
    return nameOf(index) + " late 0.3 count 0";
  }
  if (fault == "broken")
  {
    return nameOf(index) + " truncated 3 count 0";
  }
  if (fault != "silent")
  {
    throw std::runtime_error("--fault: " + fault + " (allowed: silent, late, broken)");
  }
  return nameOf(index) + " offline";
}

/// Every motor turns: velocities at rest are no different to the wire, but this is what a user has.
void startMotors(VirtualBus& bus, std::size_t inverters)
{
  for (std::size_t index = 0; index < inverters; ++index)
  {
    bus.command(index, 0.0);
    bus.command(index, 10.0);
  }
}

/// Start-up is over when the settings of all drives were read: from then on the frames repeat.
void warmUp(VirtualBus& bus, std::size_t inverters)
{
  const bool online = bus.runUntil(PATIENCE_S, [&] {
    for (std::size_t index = 0; index < inverters; ++index)
    {
      if (!bus.hasStatus(index) || bus.status(index).communication_error)
      {
        return false;
      }
    }
    return true;
  });
  if (!online)
  {
    throw std::runtime_error("not all drives came online");
  }
  startMotors(bus, inverters);
  bus.run(2.0 * static_cast<double>(inverters));
  bus.clearFrames();
}

/// Share of the time in which there were bytes on the wire.
double wireUse(const std::vector<simulation::FrameRecord>& frames, unsigned baud, double duration)
{
  std::size_t bytes = 0;
  for (const simulation::FrameRecord& frame : frames)
  {
    bytes += frame.bytes.size();
  }
  return static_cast<double>(bytes) * 10.0 / baud / duration;
}

Json ofPlainLoop(const Scene& scene, double duration, const std::vector<bool>& dead, double time_out)
{
  PlainMaster master(scene, time_out);
  for (unsigned station = 1; station <= scene.inverters; ++station)
  {
    for (const simulation::Bytes& request : refreshOf(scene, station))
    {
      master.always(request);
    }
    if (!dead.empty() && dead[station - 1])
    {
      master.world(deathOf(station - 1, "silent"));
    }
  }
  master.run(duration);
  Json json;
  json.numbers("periods", refreshPeriods(master.frames, scene.inverters));
  json.number("wire_use", wireUse(master.frames, scene.baud, duration));
  return json;
}

void refresh(const Options& options)
{
  VirtualBus bus(scanList(options.scene, "/dev/virtual"));
  warmUp(bus, options.scene.inverters);
  bus.run(options.seconds);
  Json driver;
  driver.numbers("periods", refreshPeriods(bus.frames(), options.scene.inverters));
  driver.number("wire_use", wireUse(bus.frames(), options.scene.baud, options.seconds));
  Json json;
  json.object("driver", driver);
  json.object("plain", ofPlainLoop(options.scene, options.seconds, {}, LIBMODBUS_TIME_OUT_S));
  std::cout << json.str() << std::endl;
}

void kill(VirtualBus& bus, const std::vector<bool>& dead, const std::string& fault)
{
  for (std::size_t index = 0; index < dead.size(); ++index)
  {
    if (dead[index])
    {
      bus.world(deathOf(index, fault));
    }
  }
  bus.run(60.0);
  bus.clearFrames();
}

/// Refresh periods of the stations that are alive.
std::vector<double> livePeriods(VirtualBus& bus, const std::vector<bool>& dead)
{
  std::vector<simulation::FrameRecord> frames = bus.frames();
  frames.erase(std::remove_if(frames.begin(), frames.end(),
                              [&](const simulation::FrameRecord& frame) {
                                const std::size_t station = frame.bytes[0];
                                return station == 0 || station > dead.size() || dead[station - 1];
                              }),
               frames.end());
  return refreshPeriods(frames, static_cast<unsigned>(dead.size()));
}

/// All dead ones are switched on again. [s] until the last of them is back.
double timeBack(VirtualBus& bus, const std::vector<bool>& dead)
{
  const TimePoint begin = bus.now();
  for (std::size_t index = 0; index < dead.size(); ++index)
  {
    if (dead[index])
    {
      bus.world(nameOf(index) + " online");
    }
  }
  const bool back = bus.runUntil(PATIENCE_S, [&] {
    for (std::size_t index = 0; index < dead.size(); ++index)
    {
      if (dead[index] && bus.status(index).communication_error)
      {
        return false;
      }
    }
    return true;
  });
  return back ? toSeconds(bus.now() - begin) : -1.0;
}

void deadDrives(const Options& options)
{
  const std::vector<bool> dead = deadOnes(options.scene.inverters, options.dead);
  VirtualBus bus(scanList(options.scene, "/dev/virtual"));
  warmUp(bus, options.scene.inverters);
  kill(bus, dead, "silent");
  bus.run(options.seconds);
  Json json;
  json.numbers("periods", livePeriods(bus, dead));
  std::vector<double> back;
  for (int round = 0; round < 5; ++round)
  {
    // The phase of the probes is another each time.
    bus.run(0.37 * round);
    back.push_back(timeBack(bus, dead));
    kill(bus, dead, "silent");
  }
  json.numbers("back", back);

  Scene alone = options.scene;
  alone.inverters -= options.dead;
  VirtualBus others(scanList(alone, "/dev/virtual"));
  warmUp(others, alone.inverters);
  others.run(options.seconds);
  json.numbers("alone", refreshPeriods(others.frames(), alone.inverters));
  json.object("plain", ofPlainLoop(options.scene, options.seconds, dead, LIBMODBUS_TIME_OUT_S));
  std::cout << json.str() << std::endl;
}

/// Velocities of all inverters at 50 Hz, a parameter read that always waits, and stops at random instants.
class Users
{
public:
  Users(VirtualBus& bus, std::vector<bool> dead)
    : bus_(bus), dead_(std::move(dead)), fresh_(dead_.size(), true), held_(dead_.size(), false)
  {
    tick();
    read();
  }

  /// Nobody sends anything from now on, except what velocity() and stop() do.
  void rest()
  {
    held_.assign(held_.size(), true);
    reading_ = false;
  }

  /// [s] from a velocity at a random instant to the first byte of a frame that writes it; -1: none within 10 s.
  double velocity()
  {
    std::uniform_real_distribution<double> pause(0.0, 0.5);
    const std::size_t index = anyLive();
    const bool held = held_[index];
    bus_.clearFrames();
    held_[index] = true;
    const TimePoint begin = bus_.now();
    if (!held)
    {
      // The one before it is written first, or the new one would only take its place in the queue.
      bus_.runUntil(5.0, [&] { return write(index, begin).has_value(); });
    }
    bus_.clearFrames();
    ++sent_;
    TimePoint called = TimePoint::max();
    bus_.at(pause(random_), [&] {
      called = bus_.now();
      bus_.command(index, 30.0 + 0.05 * (sent_ % 400));
    });
    bus_.runUntil(10.5, [&] { return write(index, called).has_value(); });
    held_[index] = held;
    const auto first = write(index, called);
    return first ? toSeconds(*first - called) : -1.0;
  }

  /// [s] from a stop call at a random instant to the first byte of its frame; -1: there was none.
  double stop()
  {
    std::uniform_real_distribution<double> pause(0.02, 0.15);
    const std::size_t index = anyLive();
    TimePoint called;
    VirtualBus::Box answer;
    bus_.clearFrames();
    bus_.at(pause(random_), [&] {
      called = bus_.now();
      held_[index] = true;
      answer = bus_.stop(index);
    });
    bus_.runUntil(PATIENCE_S, [&] { return answer && answer->has_value(); });
    held_[index] = false;
    fresh_[index] = true;
    for (const simulation::FrameRecord& frame : bus_.frames())
    {
      if (frame.time >= called && frame.bytes == stopOf(static_cast<unsigned>(index + 1)))
      {
        return toSeconds(frame.time - called);
      }
    }
    return -1.0;
  }

private:
  /// The first frame since then that writes a frequency.
  std::optional<TimePoint> write(std::size_t index, TimePoint since) const
  {
    const simulation::Bytes head{ static_cast<std::uint8_t>(index + 1), 0x10, 0, 0 };
    for (const simulation::FrameRecord& frame : bus_.frames())
    {
      if (frame.source == simulation::FrameRecord::Source::Master && frame.time >= since &&
          std::equal(head.begin(), head.end(), frame.bytes.begin()))
      {
        return frame.time;
      }
    }
    return std::nullopt;
  }

  std::size_t anyLive()
  {
    std::uniform_int_distribution<std::size_t> any(0, dead_.size() - 1);
    std::size_t index = any(random_);
    while (dead_[index])
    {
      index = any(random_);
    }
    return index;
  }

  void tick()
  {
    ++round_;
    for (std::size_t index = 0; index < dead_.size(); ++index)
    {
      if (!held_[index])
      {
        // A stop locks: 0 opens it.
        bus_.command(index, fresh_[index] ? 0.0 : 10.0 + 0.1 * (round_ % 100));
        fresh_[index] = false;
      }
    }
    bus_.at(USERS_PERIOD_S, [this] { tick(); });
  }

  void read()
  {
    if (reading_ && (!box_ || box_->has_value()))
    {
      box_ = bus_.readParameter(anyLive(), "F002");
    }
    bus_.at(0.001, [this] { read(); });
  }

  VirtualBus& bus_;
  std::vector<bool> dead_;
  std::vector<bool> fresh_;
  std::vector<bool> held_;
  bool reading_ = true;
  VirtualBus::Box box_;
  unsigned round_ = 0;
  unsigned sent_ = 0;
  std::mt19937 random_{ 1 };
};

void stops(const Options& options)
{
  VirtualBus bus(scanList(options.scene, "/dev/virtual"));
  warmUp(bus, options.scene.inverters);
  const std::vector<bool> dead = deadOnes(options.scene.inverters, options.dead);
  kill(bus, dead, options.fault);
  Users users(bus, dead);
  bus.run(2.0);
  std::vector<double> delays;
  for (unsigned instant = 0; instant < options.instants; ++instant)
  {
    delays.push_back(users.stop());
  }
  std::cout << Json().numbers("stops", delays).str() << std::endl;
}

void velocities(const Options& options)
{
  VirtualBus bus(scanList(options.scene, "/dev/virtual"));
  warmUp(bus, options.scene.inverters);
  Users users(bus, std::vector<bool>(options.scene.inverters, false));
  bus.run(2.0);
  if (options.load == "idle")
  {
    users.rest();
    bus.run(10.0);
  }
  std::vector<double> delays;
  for (unsigned instant = 0; instant < options.instants; ++instant)
  {
    delays.push_back(users.velocity());
  }
  std::cout << Json().numbers("velocities", delays).str() << std::endl;
}

/// The same users in front of one queue. As many instants as a tenth: each takes about a cycle of all that waits.
void fifo(const Options& options)
{
  PlainMaster master(options.scene, TIME_OUT_S);
  const std::vector<bool> dead = deadOnes(options.scene.inverters, options.dead);
  for (unsigned station = 1; station <= options.scene.inverters; ++station)
  {
    for (const simulation::Bytes& request : refreshOf(options.scene, station))
    {
      master.always(request);
    }
    if (dead[station - 1])
    {
      master.world(deathOf(station - 1, "silent"));
    }
  }
  master.always(simulation::Bytes{ 1, 0x03, 0x11, 0x02, 0, 2, 0x60, 0xF7 });
  std::function<void()> tick = [&] {
    for (unsigned station = 1; station <= options.scene.inverters; ++station)
    {
      master.velocity(station);
    }
    master.at(master.now() + seconds(USERS_PERIOD_S), tick);
  };
  tick();
  std::mt19937 random(1);
  std::uniform_real_distribution<double> pause(0.02, 0.15);
  std::vector<double> delays;
  const unsigned instants = std::max(100U, options.instants / 10);
  std::function<void()> stop = [&] {
    const TimePoint called = master.now();
    master.once(stopOf(1), [&, called](TimePoint sent) {
      delays.push_back(toSeconds(sent - called));
      master.at(master.now() + seconds(pause(random)), stop);
    });
  };
  master.run(10.0);
  master.at(master.now(), stop);
  while (delays.size() < instants)
  {
    master.run(1.0);
    master.frames.clear();
  }
  std::cout << Json().numbers("stops", delays).str() << std::endl;
}

Options readOptions(int argc, char** argv)
{
  Options options;
  po::options_description description("virtual_benchmark refresh|dead|stops|velocities|fifo");
  description.add_options()("help", "this text")("what", po::value(&options.what),
                                                 "refresh, dead, stops, velocities or fifo")(
      "inverters", po::value(&options.scene.inverters)->default_value(5), "drives on the bus")(
      "baud", po::value(&options.scene.baud)->default_value(19200), "baud rate, 8N1")(
      "drive", po::value(&options.scene.drive)->default_value("omron_mx2"), "omron_mx2 or toshiba_vfs15")(
      "mapped", po::bool_switch(&options.scene.mapped), "MX2: with their register map")(
      "seconds", po::value(&options.seconds)->default_value(60.0), "of bus time to watch")(
      "dead", po::value(&options.dead)->default_value(0), "drives that do not answer")(
      "fault", po::value(&options.fault)->default_value("silent"), "silent, late or broken: how they do not")(
      "load", po::value(&options.load)->default_value("full"), "idle or full: what users do beside a velocity")(
      "instants", po::value(&options.instants)->default_value(10000), "stops at random instants");
  po::positional_options_description words;
  words.add("what", 1);
  po::variables_map values;
  po::store(po::command_line_parser(argc, argv).options(description).positional(words).run(), values);
  if (values.count("help") != 0)
  {
    std::cout << description << std::endl;
    std::exit(EXIT_SUCCESS);
  }
  po::notify(values);
  if (options.dead >= options.scene.inverters)
  {
    throw std::runtime_error("--dead: fewer than --inverters");
  }
  return options;
}
}  // namespace

int main(int argc, char** argv)
{
  try
  {
    const Options options = readOptions(argc, argv);
    const std::vector<std::pair<std::string, void (*)(const Options&)>> all{
      { "refresh", refresh }, { "dead", deadDrives }, { "stops", stops }, { "velocities", velocities }, { "fifo", fifo }
    };
    for (const auto& [what, play] : all)
    {
      if (what == options.what)
      {
        play(options);
        return EXIT_SUCCESS;
      }
    }
    throw std::runtime_error("one of refresh, dead, stops, velocities, fifo, not '" + options.what + "'");
  }
  catch (const std::exception& error)
  {
    std::cerr << "virtual_benchmark: " << error.what() << std::endl;
    return EXIT_FAILURE;
  }
}
