// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

// Figures of the driver on the simulated bus: pseudo-terminal, wire time of a real line, real libmodbus, in one process.
// What is measured is measured at the simulated line, not by the driver's own counters.
//
//   bus_benchmark --profiles config/drives [--inverters 5] [--baud 19200] [--seconds 10] [--calls 1000]

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <boost/program_options.hpp>
#include <condition_variable>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <mutex>
#include <random>
#include <sstream>
#include <thread>
#include <vector>

#include "inverter_bus/bus/bus.h"
#include "inverter_bus/simulation/bus_runner.h"

namespace
{
using namespace inverter_bus;
namespace po = boost::program_options;

struct Options
{
  std::string profiles;
  unsigned inverters = 5;
  unsigned baud = 19200;
  double seconds = 10.0;
  unsigned calls = 1000;
};

class Silent : public bus::Observer
{
public:
  void inverterStatus(const bus::InverterStatus&) override
  {
  }
  void busStatus(const bus::BusStatus&) override
  {
  }
  void log(const bus::Finding& finding) override
  {
    if (finding.level != bus::Level::Ok)
    {
      std::cerr << finding.text << std::endl;
    }
  }
  void trace(bus::TraceDump) override
  {
  }
};

/// The first bytes of the master's frames, as the simulated line saw them.
class FrameLog
{
public:
  void add(const simulation::FrameRecord& frame)
  {
    if (frame.source != simulation::FrameRecord::Source::Master)
    {
      return;
    }
    const std::lock_guard<std::mutex> guard(mutex_);
    frames_.push_back(frame);
    added_.notify_all();
  }

  void clear()
  {
    const std::lock_guard<std::mutex> guard(mutex_);
    frames_.clear();
  }

  /// Start times of the frames that begin with \p head.
  std::vector<TimePoint> starts(const simulation::Bytes& head) const
  {
    const std::lock_guard<std::mutex> guard(mutex_);
    std::vector<TimePoint> times;
    for (const simulation::FrameRecord& frame : frames_)
    {
      if (frame.bytes.size() >= head.size() && std::equal(head.begin(), head.end(), frame.bytes.begin()))
      {
        times.push_back(frame.time);
      }
    }
    return times;
  }

private:
  mutable std::mutex mutex_;
  std::condition_variable added_;
  std::vector<simulation::FrameRecord> frames_;
};

std::string scanList(const Options& options, const std::string& link)
{
  std::ostringstream yaml;
  yaml << "port: " << link << "\nbaud_rate: " << options.baud << "\ndefaults: {drive: omron_mx2, command_timeout: 0}\n"
       << "scan_list:\n";
  for (unsigned node = 1; node <= options.inverters; ++node)
  {
    yaml << "  - {name: belt_" << node << ", node: " << node << "}\n";
  }
  return yaml.str();
}

double median(std::vector<double> values)
{
  if (values.empty())
  {
    return 0.0;
  }
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

/// A bus of both sides, running.
class Bench
{
public:
  explicit Bench(const Options& options) : link_("/tmp/inverter_bus_benchmark_" + std::to_string(::getpid()))
  {
    const std::string yaml = scanList(options, link_);
    const std::string path = link_ + ".yaml";
    std::ofstream(path) << yaml;
    bus::Configuration configuration = bus::readConfiguration(bus::readYamlFile(path), path, options.profiles);
    std::remove(path.c_str());
    simulation::LineOptions line;
    line.delivery_step = std::chrono::microseconds(500);
    simulated_ = std::make_unique<simulation::SimulatedBus>(simulation::busConfigFromText(yaml), line,
                                                            std::chrono::steady_clock::now());
    simulated_->setObserver([this](const simulation::FrameRecord& frame) { frames.add(frame); });
    runner_ = std::make_unique<simulation::BusRunner>(*simulated_, link_);
    player_ = std::thread([this] { runner_->run(); });
    auto port = wire::makeSerialPort(configuration.bus.serial);
    driver = std::make_unique<bus::Bus>(std::move(configuration), std::move(port), observer_);
    driver->start();
  }

  ~Bench()
  {
    driver->shutdown();
    runner_->stop();
    player_.join();
  }

  FrameLog frames;
  std::unique_ptr<bus::Bus> driver;

private:
  std::string link_;
  Silent observer_;
  std::unique_ptr<simulation::SimulatedBus> simulated_;
  std::unique_ptr<simulation::BusRunner> runner_;
  std::thread player_;
};

void pass(double time)
{
  std::this_thread::sleep_for(std::chrono::duration<double>(time));
}

/// Two reads per inverter: 24 coils (8 + 8 characters) and 4 registers (8 + 13), each with a gap of 3.5 characters before
/// the request and before the reply; 10 bits a character. This is the wire alone: a drive that answers without thinking.
double wireLimit(const Options& options)
{
  const double character = 10.0 / options.baud;
  const double gap = options.baud > 19200 ? 0.00175 : 3.5 * character;
  return options.inverters * ((8 + 8 + 8 + 13) * character + 4 * gap);
}

void measureCycle(Bench& bench, const Options& options)
{
  pass(3.0);  // start-up: settings of the drives are read
  bench.frames.clear();
  pass(options.seconds);
  const std::vector<TimePoint> starts = bench.frames.starts({ 1, 0x01 });
  std::vector<double> cycles;
  for (std::size_t index = 1; index < starts.size(); ++index)
  {
    cycles.push_back(toSeconds(starts[index] - starts[index - 1]));
  }
  const bus::BusStatus status = bench.driver->report().bus;
  const double limit = wireLimit(options);
  // Turnaround of the simulated drives beyond the gap, twice per inverter.
  const double drives = options.inverters * 2 * 0.002;
  std::printf("refresh cycle of %u MX2 at %u baud 8N1 over %.0f s (%zu cycles)\n", options.inverters, options.baud,
              options.seconds, cycles.size());
  std::printf("  wire limit of the two reads per inverter       %8.1f ms\n", limit * 1e3);
  std::printf("  with the drives' turnaround of 2 ms             %8.1f ms\n", (limit + drives) * 1e3);
  std::printf("  measured, slow values included (median)         %8.1f ms   ratio to the wire limit %.2f\n",
              median(cycles) * 1e3, median(cycles) / limit);
  std::printf("  shortest (a cycle without slow values)          %8.1f ms   ratio to the wire limit %.2f\n",
              *std::min_element(cycles.begin(), cycles.end()) * 1e3,
              *std::min_element(cycles.begin(), cycles.end()) / limit);
  std::printf("  bus_status: utilization %.2f, efficiency %.2f, time-outs %llu\n", status.utilization,
              status.efficiency, static_cast<unsigned long long>(status.counters.timeouts));
}

/// Keeps the queues full: parameter reads and changing velocities of every inverter.
class Load
{
public:
  explicit Load(Bench& bench, unsigned inverters) : bench_(bench), inverters_(inverters)
  {
    thread_ = std::thread([this] { run(); });
  }

  ~Load()
  {
    stop_ = true;
    thread_.join();
  }

private:
  void run()
  {
    unsigned round = 0;
    while (!stop_)
    {
      for (std::size_t index = 0; index < inverters_; ++index)
      {
        if (waiting_ < 20)
        {
          ++waiting_;
          bench_.driver->readParameter(index, "F002", [this](const bus::Answer&) { --waiting_; });
        }
        bus::VelocityCommand command;
        command.targets = { { index, 10.0 + (round % 100) * 0.1 } };
        command.publisher.name = "/benchmark";
        bench_.driver->command(command);
      }
      ++round;
      pass(0.02);
    }
  }

  Bench& bench_;
  unsigned inverters_;
  std::atomic<bool> stop_{ false };
  std::atomic<int> waiting_{ 0 };
  std::thread thread_;
};

/// One stop call: from the call to the first byte of its frame on the line, and to its confirmed answer.
std::pair<double, double> measureOneStop(Bench& bench, std::size_t index)
{
  std::mutex mutex;
  std::condition_variable answered;
  bool done = false;
  bench.frames.clear();
  const TimePoint call = std::chrono::steady_clock::now();
  bench.driver->stop(index, 0, [&](const bus::Answer&) {
    const std::lock_guard<std::mutex> guard(mutex);
    done = true;
    answered.notify_all();
  });
  std::unique_lock<std::mutex> lock(mutex);
  answered.wait(lock, [&] { return done; });
  const double confirmed = toSeconds(std::chrono::steady_clock::now() - call);
  const auto station = static_cast<std::uint8_t>(index + 1);
  for (const TimePoint start : bench.frames.starts({ station, 0x05, 0x00, 0x00, 0x00, 0x00 }))
  {
    if (start >= call)
    {
      return { toSeconds(start - call), confirmed };
    }
  }
  return { -1.0, confirmed };
}

void measureStops(Bench& bench, const Options& options)
{
  std::vector<double> first_byte;
  std::vector<double> confirmed;
  unsigned missing = 0;
  std::mt19937 random(1);
  std::uniform_real_distribution<double> pause(0.0, 0.03);
  const Load load(bench, options.inverters);
  pass(1.0);
  for (unsigned call = 0; call < options.calls; ++call)
  {
    const auto delays = measureOneStop(bench, call % options.inverters);
    missing += delays.first < 0.0 ? 1 : 0;
    first_byte.push_back(delays.first);
    confirmed.push_back(delays.second);
    pass(pause(random));
  }
  const double character = 10.0 / options.baud;
  const double gap = options.baud > 19200 ? 0.00175 : 3.5 * character;
  // The longest exchange of an MX2 here: 10 slow registers (8 + 25 characters) and 2 ms of the drive's own.
  const double longest = (8 + 25) * character + 2 * gap + 0.002;
  std::printf(
      "stop call to the first byte of its frame, %u calls under full load (20 parameter reads waiting, all "
      "velocities changing)\n",
      options.calls);
  std::printf("  median %.1f ms, maximum %.1f ms; longest exchange in flight + gap %.1f ms\n", median(first_byte) * 1e3,
              *std::max_element(first_byte.begin(), first_byte.end()) * 1e3, (longest + gap) * 1e3);
  std::printf("  to the confirmed answer: median %.1f ms, maximum %.1f ms; calls without a frame: %u\n",
              median(confirmed) * 1e3, *std::max_element(confirmed.begin(), confirmed.end()) * 1e3, missing);
}

Options readOptions(int argc, char** argv)
{
  Options options;
  po::options_description description("bus_benchmark");
  description.add_options()("help", "this text")(
      "profiles", po::value(&options.profiles)->default_value("config/drives"), "directory of the drive profiles")(
      "inverters", po::value(&options.inverters)->default_value(5), "MX2 on the bus")(
      "baud", po::value(&options.baud)->default_value(19200), "baud rate, 8N1")(
      "seconds", po::value(&options.seconds)->default_value(10.0), "time to measure the cycle")(
      "calls", po::value(&options.calls)->default_value(1000), "stop calls");
  po::variables_map values;
  po::store(po::parse_command_line(argc, argv, description), values);
  if (values.count("help") != 0)
  {
    std::cout << description << std::endl;
    std::exit(EXIT_SUCCESS);
  }
  po::notify(values);
  return options;
}
}  // namespace

int main(int argc, char** argv)
{
  try
  {
    const Options options = readOptions(argc, argv);
    Bench bench(options);
    measureCycle(bench, options);
    measureStops(bench, options);
    return EXIT_SUCCESS;
  }
  catch (const std::exception& error)
  {
    std::cerr << "bus_benchmark: " << error.what() << std::endl;
    return EXIT_FAILURE;
  }
}
