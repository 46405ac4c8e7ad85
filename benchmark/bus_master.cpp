// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

// The driver without ROS, on a port, for so long: what it costs the host, and what others on the same wire are compared with.
//
//   bus_master --scan-list FILE.yaml [--profiles config/drives] [--velocity 10] [--seconds 10]
//
// Lines on standard input: "stop N" stops the inverter with index N. Prints one JSON object at the end.

#include <sys/resource.h>
#include <unistd.h>

#include <poll.h>
#include <algorithm>
#include <boost/program_options.hpp>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "benchmark/figures.h"
#include "inverter_bus/bus/bus.h"

namespace
{
using namespace inverter_bus;
using benchmark::Json;
namespace po = boost::program_options;
using Clock = std::chrono::steady_clock;

struct Options
{
  std::string scan_list;
  std::string profiles;
  double velocity = 0.0;
  double warm_up = 3.0;
  double seconds = 10.0;
};

class Errors : public bus::Observer
{
public:
  void inverterStatus(const bus::InverterStatus& /*status*/) override
  {
  }
  void busStatus(const bus::BusStatus& /*status*/) override
  {
  }
  void log(const bus::Finding& finding) override
  {
    if (finding.level == bus::Level::Error)
    {
      std::cerr << finding.text << std::endl;
    }
  }
  void trace(bus::TraceDump /*dump*/) override
  {
  }
};

/// CPU time of this process so far [s].
double cpu()
{
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  const auto time = [](const timeval& value) {
    return static_cast<double>(value.tv_sec) + 1e-6 * static_cast<double>(value.tv_usec);
  };
  return time(usage.ru_utime) + time(usage.ru_stime);
}

/// Memory of this process that is in use [kB].
double resident()
{
  long size = 0;
  long pages = 0;
  std::ifstream("/proc/self/statm") >> size >> pages;
  return static_cast<double>(pages) * static_cast<double>(::sysconf(_SC_PAGESIZE)) / 1024.0;
}

/// Waits for so long, and does what standard input says meanwhile.
void pass(bus::Bus& driver, double time)
{
  const auto end = Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(time));
  std::string text;
  bool open = true;
  while (Clock::now() < end)
  {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(end - Clock::now()).count();
    pollfd input{ open ? STDIN_FILENO : -1, POLLIN, 0 };
    if (::poll(&input, 1, static_cast<int>(left) + 1) <= 0)
    {
      continue;
    }
    char buffer[256];
    const ssize_t size = ::read(STDIN_FILENO, buffer, sizeof buffer);
    open = size > 0;
    text.append(buffer, size > 0 ? static_cast<std::size_t>(size) : 0);
    for (std::size_t line = text.find('\n'); line != std::string::npos; line = text.find('\n'))
    {
      if (text.compare(0, 5, "stop ") == 0)
      {
        driver.stop(static_cast<std::size_t>(std::atoi(text.c_str() + 5)), 0, [](const bus::Answer&) {});
      }
      text.erase(0, line + 1);
    }
  }
}

std::uint16_t command(bus::Bus& driver, std::size_t index, double velocity)
{
  bus::VelocityCommand command;
  command.targets = { { index, velocity } };
  command.publisher.name = "/benchmark";
  return driver.command(command);
}

/// A 0 opens the lock of each; its velocity is repeated until it is accepted, for at most 10 s.
void startMotors(bus::Bus& driver, std::size_t inverters, double velocity)
{
  for (std::size_t index = 0; index < inverters; ++index)
  {
    command(driver, index, 0.0);
  }
  std::vector<bool> runs(inverters, false);
  for (int round = 0; round < 200 && std::count(runs.begin(), runs.end(), false) > 0; ++round)
  {
    for (std::size_t index = 0; index < inverters; ++index)
    {
      runs[index] = runs[index] || command(driver, index, velocity) == bus::ERROR_NONE;
    }
    pass(driver, 0.05);
  }
}

void play(const Options& options)
{
  Errors errors;
  bus::Configuration configuration =
      bus::readConfiguration(bus::readYamlFile(options.scan_list), options.scan_list, options.profiles);
  const std::size_t inverters = configuration.bus.inverters.size();
  auto port = bus::makePort(configuration.bus);
  bus::Bus driver(std::move(configuration), std::move(port), errors);
  driver.start();
  pass(driver, options.warm_up);
  startMotors(driver, inverters, options.velocity);
  const double before = cpu();
  const std::uint64_t requests = driver.report().bus.counters.requests;
  pass(driver, options.seconds);
  const bus::BusStatus status = driver.report().bus;
  Json json;
  json.number("seconds", options.seconds).number("cpu", cpu() - before).number("resident_kb", resident());
  json.number("exchanges", static_cast<double>(status.counters.requests - requests));
  json.number("timeouts", static_cast<double>(status.counters.timeouts)).number("efficiency", status.efficiency);
  std::cout << json.str() << std::endl;
  driver.shutdown();
}

Options readOptions(int argc, char** argv)
{
  Options options;
  po::options_description description("bus_master");
  description.add_options()("help", "this text")("scan-list", po::value(&options.scan_list)->required(),
                                                 "the driver's parameters file (YAML)")(
      "profiles", po::value(&options.profiles)->default_value(INVERTER_BUS_ROOT "/config/drives"),
      "directory of the drive profiles")("velocity", po::value(&options.velocity)->default_value(0.0),
                                         "of all motors, settled")(
      "warm-up", po::value(&options.warm_up)->default_value(3.0), "[s] before anything is counted")(
      "seconds", po::value(&options.seconds)->default_value(10.0), "how long");
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
    play(readOptions(argc, argv));
    return EXIT_SUCCESS;
  }
  catch (const std::exception& error)
  {
    std::cerr << "bus_master: " << error.what() << std::endl;
    return EXIT_FAILURE;
  }
}
