// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <iostream>
#include <memory>
#include <string>

#include <unistd.h>

#include <boost/program_options.hpp>

#include "bench/scan_list.h"
#include "inverter_bus/bus/configuration.h"
#include "inverter_bus/drive/profile.h"
#include "inverter_bus/simulation/bus_config.h"
#include "inverter_bus/simulation/bus_runner.h"
#include "inverter_bus/simulation/simulated_bus.h"

namespace
{
using namespace inverter_bus::simulation;  // NOLINT: the program is about nothing else
namespace po = boost::program_options;

BusRunner* runner_to_stop = nullptr;

void onSignal(int /*signal*/)
{
  if (runner_to_stop != nullptr)
  {
    runner_to_stop->stop();
  }
}

po::options_description describeOptions()
{
  po::options_description options("simulated_bus: plays inverters on an RS-485 bus, on a pseudo-terminal");
  options.add_options()                                                                                             //
      ("help,h", "this text")                                                                                       //
      ("scan-list", po::value<std::string>(), "the driver's parameters file (YAML)")                                //
      ("link", po::value<std::string>(), "name of the link to the pseudo-terminal")                                 //
      ("trace", po::value<std::string>(), "file that gets a line for each frame")                                   //
      ("gap", po::value<std::string>()->default_value("enforce"),                                                   //
       "enforce | ignore: a request without the 3.5-character silence before it is lost | is served and counted")   //
      ("gap-tolerance", po::value<double>()->default_value(0.0003, "0.0003"), "[s] a request may come this early")  //
      ("baud", po::value<int>(), "baud rate that the drives are set to, instead of the file's")                     //
      ("parity", po::value<std::string>(), "none | even | odd: that of the drives, instead of the file's")          //
      ("stop-bits", po::value<int>(), "1 | 2: those of the drives, instead of the file's")                          //
      ("client-parity", po::value<std::string>(),
       "none | even | odd: what the client uses, where its settings don't show it (pyserial)")           //
      ("seed", po::value<std::uint64_t>()->default_value(1), "of everything left to chance")             //
      ("realtime-priority", po::value<int>()->default_value(0), "> 0: SCHED_FIFO, for a punctual wire")  //
      ("spin", po::value<double>()->default_value(0.0, "0"),
       "[s] polls the clock in the last part of each wait: a punctual wire without that priority")  //
      ("turnaround", po::value<double>(), "[s] answer time of all drives after the silence");
  return options;
}

std::string required(const po::variables_map& values, const char* key)
{
  if (values.count(key) == 0)
  {
    throw ConfigError(std::string("--") + key + ": missing (allowed: a path)");
  }
  return values[key].as<std::string>();
}

Parity parityOf(const std::string& option, const std::string& text)
{
  if (text != "none" && text != "even" && text != "odd")
  {
    throw ConfigError("--" + option + ": " + text + " (allowed: none, even, odd)");
  }
  return text == "none" ? Parity::None : (text == "even" ? Parity::Even : Parity::Odd);
}

SerialOptions readSerialOptions(const po::variables_map& values)
{
  SerialOptions options;
  if (values.count("baud") != 0)
  {
    options.baud_rate = values["baud"].as<int>();
  }
  if (values.count("parity") != 0)
  {
    options.parity = parityOf("parity", values["parity"].as<std::string>());
  }
  if (values.count("stop-bits") != 0)
  {
    options.stop_bits = values["stop-bits"].as<int>();
  }
  return options;
}

BusConfig readConfig(const po::variables_map& values)
{
  const std::string path = required(values, "scan-list");
  inverter_bus::bench::SimulatedScanList list =
      inverter_bus::bench::readScanList(inverter_bus::bus::readYamlFile(path), path,
                                        inverter_bus::drive::shippedProfileDirectory(), readSerialOptions(values));
  for (const std::string& warning : list.warnings)
  {
    std::cerr << "simulated_bus: " << warning << std::endl;
  }
  for (DriveConfig& drive : list.config.drives)
  {
    drive.options.turnaround =
        values.count("turnaround") != 0 ? values["turnaround"].as<double>() : drive.options.turnaround;
  }
  return list.config;
}

LineOptions readLineOptions(const po::variables_map& values)
{
  const std::string gap = values["gap"].as<std::string>();
  if (gap != "enforce" && gap != "ignore")
  {
    throw ConfigError("--gap: " + gap + " (allowed: enforce, ignore)");
  }
  LineOptions options;
  options.gap = gap == "enforce" ? GapRule::Enforce : GapRule::Ignore;
  options.gap_tolerance = seconds(values["gap-tolerance"].as<double>());
  options.delivery_step = std::chrono::microseconds(500);
  options.seed = values["seed"].as<std::uint64_t>();
  return options;
}

std::unique_ptr<std::ofstream> openTrace(const po::variables_map& values)
{
  if (values.count("trace") == 0)
  {
    return nullptr;
  }
  const std::string path = values["trace"].as<std::string>();
  auto file = std::make_unique<std::ofstream>(path, std::ios::app);
  if (!*file)
  {
    throw ConfigError("--trace: " + path + " can't be written (allowed: a file in a writable directory)");
  }
  return file;
}

void catchSignals(BusRunner& runner)
{
  runner_to_stop = &runner;
  struct sigaction action = {};
  action.sa_handler = onSignal;
  for (const int signal : { SIGINT, SIGTERM, SIGHUP })
  {
    sigaction(signal, &action, nullptr);
  }
  std::signal(SIGPIPE, SIG_IGN);
}

void play(const po::variables_map& values)
{
  const BusConfig config = readConfig(values);
  const std::string link = required(values, "link");
  const std::unique_ptr<std::ofstream> trace = openTrace(values);
  SimulatedBus bus(config, readLineOptions(values), Clock::now());
  if (trace)
  {
    char text[96];
    std::snprintf(text, sizeof text, "# 0 is %.6f of CLOCK_MONOTONIC", toSeconds(bus.start().time_since_epoch()));
    *trace << text << std::endl;
    bus.setObserver([&](const FrameRecord& frame) { *trace << frameText(frame, bus.start()) << std::endl; });
  }
  BusRunner runner(bus, link);
  if (values.count("client-parity") != 0)
  {
    runner.assumeParity(parityOf("client-parity", values["client-parity"].as<std::string>()));
  }
  runner.spin(values["spin"].as<double>());
  catchSignals(runner);
  runner.readCommands(STDIN_FILENO, [](const std::string& answer) { std::cout << answer << std::endl; });
  std::cout << "simulated bus ready: " << link << " -> " << runner.terminal().path() << ", " << bus.drives().size()
            << " drives" << std::endl;
  runner.run(values["realtime-priority"].as<int>());
  runner_to_stop = nullptr;
  const LineCounters& counters = bus.line().counters();
  std::cout << "simulated bus stopped: " << counters.requests << " requests, " << counters.replies << " replies, "
            << counters.lost_gap << " lost to the gap, " << counters.early << " early, " << counters.collisions
            << " collisions" << std::endl;
  const Punctuality& punctuality = runner.punctuality();
  std::cout << "the wire was late by " << punctuality.mean() * 1e6 << " us on average, at most "
            << punctuality.latest() * 1e6 << " us, at " << punctuality.count() << " instants" << std::endl;
}
}  // namespace

int main(int argc, char** argv)
{
  try
  {
    const po::options_description options = describeOptions();
    po::variables_map values;
    po::store(po::command_line_parser(argc, argv).options(options).run(), values);
    po::notify(values);
    if (values.count("help") != 0)
    {
      std::cout << options << std::endl;
      return EXIT_SUCCESS;
    }
    play(values);
    return EXIT_SUCCESS;
  }
  catch (const po::error& error)
  {
    std::cerr << "simulated_bus: " << error.what() << "; simulated_bus --help lists the options" << std::endl;
    return EXIT_FAILURE;
  }
  catch (const std::exception& error)
  {
    std::cerr << "simulated_bus: " << error.what() << std::endl;
    return EXIT_FAILURE;
  }
}
