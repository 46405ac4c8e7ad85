// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

// Does the heap of a driver grow that runs for long? The whole core plays a day against simulated drives in virtual time:
// velocities of ever new publishers, stops, services, refusals, trips, drives that go offline, adapters that are pulled
// out. At the end of each hour everything is at rest for a minute and what lives on the heap is counted.
//
//   heap_benchmark --profiles config/drives [--hours 24] [--seed 1] [--bus modbus|compoway]

#include <unistd.h>

#include <algorithm>
#include <boost/program_options.hpp>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <stdexcept>
#include <string>

#include "support/heap_story.h"

namespace
{
using namespace inverter_bus;
namespace po = boost::program_options;

/// Growth after the first hour that is still none: buffers that keep the size of their largest content.
constexpr long long BOUND = 4 * 1024;
constexpr double HOUR_S = 3600.0;
/// Of each hour, for the calm at its end.
constexpr double CALM_S = 100.0;

struct Options
{
  std::string profiles;
  std::string bus;
  unsigned hours = 24;
  std::uint64_t seed = 1;
};

/// Pages of the whole process in memory [kB]: also what the C library keeps and what is taken without operator new.
long residentKilobytes()
{
  long size = 0;
  long resident = 0;
  std::ifstream("/proc/self/statm") >> size >> resident;
  return resident * (::sysconf(_SC_PAGESIZE) / 1024);
}

/// The most that one owner's heap grew beyond what it was after the first hour.
class Growth
{
public:
  explicit Growth(heap::Owner owner) : owner_(owner)
  {
  }

  heap::Live measure()
  {
    const heap::Live live = heap::live(owner_);
    first_ = measured_ ? first_ : live.bytes;
    measured_ = true;
    most_ = std::max(most_, live.bytes - first_);
    return live;
  }

  long long bytes() const
  {
    return most_;
  }

private:
  heap::Owner owner_;
  bool measured_ = false;
  long long first_ = 0;
  long long most_ = 0;
};

void printEvents(const heap::Story& story)
{
  const heap::Events& events = story.events();
  std::printf("  %lu commands (%lu refused) of %lu publishers, %lu stops, %lu other calls, %lu answers, %lu faults\n",
              events.commands, events.refused, events.publishers, events.stops, events.services, events.answers,
              events.faults);
  std::printf(
      "  %lu statuses, %lu log lines, %lu flight recorder dumps, %llu requests, %llu without a reply, %llu "
      "reconnects\n",
      events.statuses, events.log_lines, events.dumps, static_cast<unsigned long long>(story.counters().requests),
      static_cast<unsigned long long>(story.counters().timeouts), static_cast<unsigned long long>(story.reconnects()));
}

/// Returns whether the heap stayed what it was.
bool measure(const heap::Stage& stage, const Options& options)
{
  const auto begin = std::chrono::steady_clock::now();
  heap::Story story(stage, options.profiles, options.seed);
  Growth driver(heap::Owner::DRIVER);
  Growth simulation(heap::Owner::SIMULATION);
  std::printf("%s: %u h of bus time\n  hour   driver: bytes   blocks   simulated bus: bytes   blocks   resident kB\n",
              stage.name.c_str(), options.hours);
  for (unsigned hour = 1; hour <= options.hours; ++hour)
  {
    story.play(HOUR_S - CALM_S);
    if (!story.calm())
    {
      throw std::runtime_error("the bus did not come to rest after hour " + std::to_string(hour));
    }
    const heap::Live of_driver = driver.measure();
    const heap::Live of_simulation = simulation.measure();
    std::printf("  %4u   %13lld   %6lld   %20lld   %6lld   %11ld\n", hour, of_driver.bytes, of_driver.blocks,
                of_simulation.bytes, of_simulation.blocks, residentKilobytes());
    std::fflush(stdout);
  }
  printEvents(story);
  const double took = toSeconds(std::chrono::steady_clock::now() - begin);
  std::printf("  grew after the first hour by at most: driver %lld, simulated bus %lld bytes (allowed: %lld); %.0f s\n",
              driver.bytes(), simulation.bytes(), BOUND, took);
  return driver.bytes() <= BOUND && simulation.bytes() <= BOUND;
}

Options readOptions(int argc, char** argv)
{
  Options options;
  po::options_description description("heap_benchmark");
  description.add_options()("help", "this text")(
      "profiles", po::value(&options.profiles)->default_value("config/drives"), "directory of the drive profiles")(
      "bus", po::value(&options.bus)->default_value(""), "modbus or compoway only")(
      "hours", po::value(&options.hours)->default_value(24), "bus time")(
      "seed", po::value(&options.seed)->default_value(1), "another story");
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
    bool level = true;
    for (const heap::Stage& stage : heap::stages())
    {
      if (options.bus.empty() || options.bus == stage.name)
      {
        level = measure(stage, options) && level;
      }
    }
    return level ? EXIT_SUCCESS : EXIT_FAILURE;
  }
  catch (const std::exception& error)
  {
    std::cerr << "heap_benchmark: " << error.what() << std::endl;
    return EXIT_FAILURE;
  }
}
