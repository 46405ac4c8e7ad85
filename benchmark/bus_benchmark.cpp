// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

// Figures of the driver in real time: simulated drives on a pseudo-terminal with the wire time of a real line, the driver with its
// real serial port and threads on the other side, in one process and thus on one clock. What is measured is measured at the
// simulated line, not by the driver's own counters. Prints one JSON object with the raw samples.
//
//   bus_benchmark wire     [--baud 19200] [--calls 300]         the wire's own error, and what a master sees of it
//   bus_benchmark stops    [--inverters 31] [--dead 3] [--calls 1000]
//   bus_benchmark commands [--inverters 31] [--load idle|full] [--calls 300]

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <termios.h>
#include <unistd.h>

#include <boost/program_options.hpp>
#include <condition_variable>
#include <cstdlib>
#include <iostream>
#include <mutex>
#include <optional>
#include <random>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "benchmark/figures.h"
#include "benchmark/live_bus.h"
#include "simulation/modbus/modbus_frame.h"

namespace
{
using namespace inverter_bus;
using namespace inverter_bus::benchmark;
namespace po = boost::program_options;
using Clock = std::chrono::steady_clock;

struct Options
{
  std::string what;
  std::string profiles;
  std::string load = "full";
  Scene scene;
  unsigned dead = 0;
  unsigned calls = 1000;
  double warm_up = 3.0;
  Host host;
};

void pass(double time)
{
  std::this_thread::sleep_for(std::chrono::duration<double>(time));
}

/// The plainest master there is: writes, and waits for so many bytes.
class BareMaster
{
public:
  BareMaster(const std::string& path, unsigned baud) : descriptor_(::open(path.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK))
  {
    if (descriptor_ < 0)
    {
      throw std::runtime_error("the simulated port can't be opened");
    }
    termios settings{};
    ::tcgetattr(descriptor_, &settings);
    ::cfmakeraw(&settings);
    ::cfsetspeed(&settings, rateOf(baud));
    ::tcsetattr(descriptor_, TCSANOW, &settings);
  }

  ~BareMaster()
  {
    ::close(descriptor_);
  }

  BareMaster(const BareMaster&) = delete;
  BareMaster& operator=(const BareMaster&) = delete;

  /// @return when the last of so many bytes had been read
  TimePoint exchange(const simulation::Bytes& request, std::size_t reply)
  {
    const ssize_t written = ::write(descriptor_, request.data(), request.size());
    std::size_t heard = written < 0 ? reply : 0;
    while (heard < reply)
    {
      pollfd input{ descriptor_, POLLIN, 0 };
      if (::poll(&input, 1, 1000) <= 0)
      {
        throw std::runtime_error("the simulated drive did not answer");
      }
      char buffer[256];
      const ssize_t size = ::read(descriptor_, buffer, sizeof buffer);
      heard += size > 0 ? static_cast<std::size_t>(size) : 0;
    }
    return Clock::now();
  }

private:
  static speed_t rateOf(unsigned baud)
  {
    switch (baud)
    {
      case 9600:
        return B9600;
      case 19200:
        return B19200;
      case 115200:
        return B115200;
      default:
        throw std::runtime_error("--baud: " + std::to_string(baud) + " (allowed: 9600, 19200, 115200)");
    }
  }

  int descriptor_;
};

/// From a request to its whole reply, against the time that the wire and the drive take by their own arithmetic.
void playWire(const Options& options)
{
  prctl(PR_SET_TIMERSLACK, 1UL, 0UL, 0UL, 0UL);
  LiveWire live(options.scene, options.host);
  BareMaster master(live.path(), options.scene.baud);
  const double character = 10.0 / options.scene.baud;
  const simulation::Bytes request = simulation::withModbusCrc({ 1, 0x03, 0x10, 0, 0, 4 });
  const double ideal = (8 + 13) * character + std::max(silence(options.scene.baud), options.scene.reply_delay);
  std::vector<double> seen;
  std::vector<double> stamped;
  pass(0.1);
  for (unsigned call = 0; call < options.calls; ++call)
  {
    live.frames.clear();
    const TimePoint begin = Clock::now();
    seen.push_back(toSeconds(master.exchange(request, 13) - begin) - ideal);
    const auto stamp = live.frames.first({ 1, 0x03 }, begin);
    stamped.push_back(stamp ? toSeconds(*stamp - begin) : -1.0);
    pass(2 * silence(options.scene.baud));
  }
  const simulation::Punctuality punctuality = live.end();
  Json json;
  json.number("character", character).number("mean", punctuality.mean()).number("latest", punctuality.latest());
  json.number("instants", static_cast<double>(punctuality.count()));
  json.numbers("seen", seen).numbers("stamped", stamped);
  std::cout << json.str() << std::endl;
}

/// One stop call: [s] from the call to the first byte of its frame on the line, and to its confirmed answer.
std::pair<double, double> stopOnce(LiveBus& live, std::size_t index)
{
  std::mutex mutex;
  std::condition_variable answered;
  bool done = false;
  live.wire.frames.clear();
  const TimePoint call = Clock::now();
  live.driver->stop(index, 0, [&](const bus::Answer&) {
    const std::lock_guard<std::mutex> guard(mutex);
    done = true;
    answered.notify_all();
  });
  std::unique_lock<std::mutex> lock(mutex);
  answered.wait(lock, [&] { return done; });
  const double confirmed = toSeconds(Clock::now() - call);
  const auto first = live.wire.frames.first({ static_cast<std::uint8_t>(index + 1), 0x05, 0, 0, 0, 0 }, call);
  return { first ? toSeconds(*first - call) : -1.0, confirmed };
}

void playStops(const Options& options)
{
  LiveBus live(options.scene, options.profiles, options.host);
  pass(options.warm_up);
  for (unsigned number = 0; number < options.dead; ++number)
  {
    live.wire.world("belt_" + std::to_string(options.scene.inverters - number) + " offline");
  }
  const unsigned alive = options.scene.inverters - options.dead;
  Load load(live, alive, 1);
  pass(options.dead > 0 ? options.warm_up : 1.0);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> pause(0.0, 0.05);
  std::vector<double> delays;
  std::vector<double> confirmed;
  WakeUps wake_ups;
  for (unsigned call = 0; call < options.calls; ++call)
  {
    const std::size_t index = random() % alive;
    pass(pause(random));
    load.hold(index);
    const auto both = stopOnce(live, index);
    load.restart(index);
    delays.push_back(both.first);
    confirmed.push_back(both.second);
  }
  Json json;
  json.numbers("stops", delays).numbers("confirmed", confirmed).numbers("wake_ups", wake_ups.end());
  std::cout << json.str() << std::endl;
}

/// The first frame since then that begins so; nothing: none within about \p limit milliseconds.
std::optional<TimePoint> waitFor(const FrameLog& frames, const simulation::Bytes& head, TimePoint since, int limit)
{
  std::optional<TimePoint> first;
  for (int wait = 0; wait < limit && !first; ++wait)
  {
    pass(0.001);
    first = frames.first(head, since);
  }
  return first;
}

/// [s] from a velocity message to the first byte of a frame that writes it.
void playCommands(const Options& options)
{
  LiveBus live(options.scene, options.profiles, options.host);
  pass(options.warm_up);
  const bool full = options.load == "full";
  Load load(live, options.scene.inverters, full ? 20 : 0);
  pass(2.0);
  if (!full)
  {
    for (std::size_t index = 0; index < options.scene.inverters; ++index)
    {
      load.hold(index);
    }
  }
  std::mt19937 random(1);
  std::uniform_real_distribution<double> pause(0.05, 0.1);
  std::vector<double> delays;
  WakeUps wake_ups;
  for (unsigned call = 0; call < options.calls; ++call)
  {
    const std::size_t index = random() % options.scene.inverters;
    const simulation::Bytes head{ static_cast<std::uint8_t>(index + 1), 0x10, 0, 0 };
    live.wire.frames.clear();
    const TimePoint held = Clock::now();
    load.hold(index);
    pass(pause(random));
    if (full)
    {
      // The one before it is written first, or the new one would only take its place in the queue.
      waitFor(live.wire.frames, head, held, 2000);
    }
    live.wire.frames.clear();
    bus::VelocityCommand command;
    command.targets = { { index, 30.0 + 0.05 * (call % 400) } };
    command.publisher.name = "/benchmark";
    const TimePoint begin = Clock::now();
    live.driver->command(command);
    const auto first = waitFor(live.wire.frames, head, begin, 10000);
    delays.push_back(first ? toSeconds(*first - begin) : -1.0);
    if (full)
    {
      load.resume(index);
    }
  }
  std::cout << Json().numbers("commands", delays).numbers("wake_ups", wake_ups.end()).str() << std::endl;
}

Options readOptions(int argc, char** argv)
{
  Options options;
  po::options_description description("bus_benchmark wire|stops|commands");
  description.add_options()("help", "this text")("what", po::value(&options.what), "wire, stops or commands")(
      "profiles", po::value(&options.profiles)->default_value(INVERTER_BUS_ROOT "/config/drives"),
      "directory of the drive profiles")("inverters", po::value(&options.scene.inverters)->default_value(31),
                                         "MX2 on the bus")("baud", po::value(&options.scene.baud)->default_value(19200),
                                                           "baud rate, 8N1")(
      "dead", po::value(&options.dead)->default_value(0), "drives that do not answer")(
      "load", po::value(&options.load)->default_value("full"), "idle or full")(
      "calls", po::value(&options.calls)->default_value(1000), "stops, velocities or exchanges")(
      "warm-up", po::value(&options.warm_up)->default_value(3.0), "[s] until the settings of all drives are read")(
      "spin", po::value(&options.host.spin)->default_value(0.0001),
      "[s] of each wait of the wire spent looking at the clock")(
      "realtime-priority", po::value(&options.host.realtime_priority)->default_value(0),
      "of the wire, where permitted");
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
    const std::vector<std::pair<std::string, void (*)(const Options&)>> all{ { "wire", playWire },
                                                                             { "stops", playStops },
                                                                             { "commands", playCommands } };
    for (const auto& [what, play] : all)
    {
      if (what == options.what)
      {
        play(options);
        return EXIT_SUCCESS;
      }
    }
    throw std::runtime_error("one of wire, stops, commands, not '" + options.what + "'");
  }
  catch (const std::exception& error)
  {
    std::cerr << "bus_benchmark: " << error.what() << std::endl;
    return EXIT_FAILURE;
  }
}
